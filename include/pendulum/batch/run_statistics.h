// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace pendulum {

/// One parameter as K runs have it, in one unit.
struct RunValues {
  std::vector<double> estimate;
  std::vector<double> std_error;   ///< NaN where a run quotes none.
  std::vector<std::size_t> group;  ///< Which rig, from 0.
  std::vector<double> order;       ///< What a trend is over; NaN where a run has no such value.

  std::size_t size() const { return estimate.size(); }
};

/// How K values lie: quartiles, and counts between `from` and `to`, three interquartile ranges about the middle half
/// at most, so that an outlier does not leave one bar. Bins as D. Freedman and P. Diaconis, Z.
/// Wahrscheinlichkeitstheorie 57:453 (1981), 60 at most.
struct Distribution {
  double minimum = 0, lower_quartile = 0, median = 0, upper_quartile = 0, maximum = 0;
  double mean = 0, std_dev = 0;  ///< std_dev 0 of one run.
  double from = 0, to = 0;
  std::vector<std::size_t> counts;
  std::size_t below = 0, above = 0;
};

Distribution Describe(const std::vector<double>& values);

/// A run whose value is none of its group's: `z`, its distance from the group's median over the larger of its own error
/// and the group's robust scale (1.4826 times the median distance).
struct Outlier {
  std::size_t run = 0;
  double z = 0;
};

/// Those beyond what the farthest of K normal values reaches once in twenty batches (Šidák), the farthest first. A
/// group of fewer than five runs has none.
std::vector<Outlier> FindOutliers(const RunValues& values);

/// How the runs of one group repeat: their scatter over what their errors let expect.
struct GroupRepeatability {
  std::size_t group = 0, runs = 0;
  double mean = 0, std_error = 0;  ///< Weighted by the errors; as the errors say.
  double chi2 = 0;                 ///< Of the values about the mean, runs - 1 degrees of freedom.
  double between = 0;              ///< Standard deviation beyond the errors (random_effects.h).

  double ScatterRatio() const;
  double P() const;  ///< That errors which are true give as much.
};

/// The groups of two and more runs with errors, outliers left out, and all of them together (MODEL.md eq. (63)).
struct Repeatability {
  std::vector<GroupRepeatability> groups;
  std::size_t runs = 0, dof = 0;
  double chi2 = 0, between = 0;
  double lower_p = 0, upper_p = 0;  ///< That true errors give a scatter as small, as large.
  enum class Verdict { kAgrees, kScatterLarger, kScatterSmaller } verdict = Verdict::kAgrees;

  double ScatterRatio() const;
};

/// None where no group has two runs with errors. The verdict is not kAgrees where p is below 1 % and the ratio 10 %
/// off.
std::optional<Repeatability> Repeat(const RunValues& values, const std::vector<Outlier>& outliers);

/// One slope of the values over their order in all groups, each with a mean of its own, by least squares, with an error
/// from the scatter about it (MODEL.md eq. (64)).
struct Trend {
  std::size_t runs = 0;
  double slope = 0, std_error = 0;
  double p = 1;  ///< Of no slope, by Student's t; 1 where nothing scatters.
};

/// None where the groups leave no degree of freedom, or one order only. Outliers are left out.
std::optional<Trend> FitTrend(const RunValues& values, const std::vector<Outlier>& outliers);

/// Days since 1970-01-01 of an ISO 8601 date, "2026-03-01", "2026-03-01T12:30:00Z" or "2026-03-01 13:30+01:00" (UTC
/// unless it says otherwise), or the number that a text is; none of another text. `is_date` says which.
std::optional<double> OrderOf(const std::string& text, bool& is_date);

}  // namespace pendulum
