// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pendulum {

/// One parameter in K runs, in one unit.
struct RunValues {
  std::vector<double> estimate;
  std::vector<double> std_error;   ///< NaN if a run has no standard error.
  std::vector<std::size_t> group;  ///< Index of the rig, from 0.
  std::vector<double> order;       ///< Abscissa of the trend; NaN if a run has no such value.

  std::size_t size() const { return estimate.size(); }
};

/// Whether a parameter or derived quantity belongs to the rig; start and zero differ between runs.
bool IsOfTheRig(std::string_view name);

/// Distribution of K values: quartiles, and counts in bins between `from` and `to`. These two limits are at most three
/// interquartile ranges outside the quartiles, so that an outlier does not reduce the histogram to one bar. Bin width:
/// D. Freedman and P. Diaconis, Z. Wahrscheinlichkeitstheorie 57:453 (1981), with at most 60 bins.
struct Distribution {
  double minimum = 0, lower_quartile = 0, median = 0, upper_quartile = 0, maximum = 0;
  double mean = 0, std_dev = 0;  ///< std_dev is 0 for one run.
  double from = 0, to = 0;
  std::vector<std::size_t> counts;
  std::size_t below = 0, above = 0;
};

Distribution Describe(const std::vector<double>& values);

/// The median of one value or more; of an even number the mean of the two in the middle.
double MedianOf(std::vector<double> values);

/// A standard deviation that outliers do not change: 1.4826 times the median distance from the median, which is σ for a
/// normal distribution.
double RobustStdDev(const std::vector<double>& values);

/// A run whose value does not fit its group. `z`: the distance of the value from the group's median, divided by the
/// larger of the run's standard error and the group's robust scale (1.4826 times the median distance).
struct Outlier {
  std::size_t run = 0;
  double z = 0;
};

/// The z of every run (Outlier), whether it fits its group or not; NaN if its group has no scale.
std::vector<double> DistancesFromGroup(const RunValues& values);

/// Finds runs whose z exceeds a limit, the largest z first. The largest of K normal values exceeds this limit in one of
/// twenty batches (Šidák). A group of fewer than five runs has no outliers.
std::vector<Outlier> FindOutliers(const RunValues& values);

/// Repeatability of one group: the observed scatter compared with the scatter expected from the errors.
struct GroupRepeatability {
  std::size_t group = 0, runs = 0;
  double mean = 0, std_error = 0;  ///< Mean weighted by the errors, and its error from these errors alone.
  double chi2 = 0;                 ///< χ² of the values about the mean, with runs - 1 degrees of freedom.
  double between = 0;              ///< Standard deviation between runs beyond their errors (random_effects.h).

  double ScatterRatio() const;
  double P() const;  ///< Probability of this chi2 or a larger one if the errors are right.
  /// The 95 % confidence interval of the ratio, by χ² with runs - 1 degrees of freedom.
  std::pair<double, double> ScatterInterval() const;
  /// The 95 % confidence interval of the mean if the errors are right.
  std::pair<double, double> MeanInterval() const;
};

/// Repeatability of each group with at least two runs that have errors, and of these groups together (MODEL.md eq.
/// (11.2)). Outliers are left out.
struct Repeatability {
  std::vector<GroupRepeatability> groups;
  std::size_t runs = 0, dof = 0;
  double chi2 = 0, between = 0;
  double lower_p = 0, upper_p = 0;  ///< Probabilities of at most, and at least, this scatter if the errors are right.
  enum class Verdict { kAgrees, kScatterLarger, kScatterSmaller } verdict = Verdict::kAgrees;

  double ScatterRatio() const;
  /// Whether a difference of a third between scatter and errors would be seen: 20 degrees of freedom or more.
  bool HasEnoughRuns() const;
  /// Whether a group disagrees with its errors, at a level of 5 % for all groups together (Bonferroni).
  bool Disagrees(const GroupRepeatability& group) const;
};

/// std::nullopt if no group has two runs with errors. The verdict differs from kAgrees if p is below 1 % and the
/// scatter ratio is above 1.1 or below 1 / 1.1.
std::optional<Repeatability> AnalyzeRepeatability(const RunValues& values, const std::vector<Outlier>& outliers);

/// One least-squares slope of the values over their order, common to all groups; each group has a separate mean. The
/// error comes from the scatter about the line (MODEL.md eq. (11.3)).
struct Trend {
  std::size_t runs = 0;
  double slope = 0, std_error = 0;
  double p = 1;  ///< p-value of the hypothesis of no slope (Student's t); 1 without scatter.
};

/// std::nullopt without a degree of freedom, or if `order` is constant in each group. Outliers are left out.
std::optional<Trend> FitTrend(const RunValues& values, const std::vector<Outlier>& outliers);

/// Days since 1970-01-01 of an ISO 8601 date, "2026-03-01", "2026-03-01T12:30:00Z" or "2026-03-01 13:30+01:00" (UTC by
/// default), or the value of a text that is a number; std::nullopt for other texts. `is_date`: the text is a date.
std::optional<double> ParseOrderValue(const std::string& text, bool& is_date);

}  // namespace pendulum
