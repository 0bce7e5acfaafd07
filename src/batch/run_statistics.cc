// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/run_statistics.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <system_error>

#include <Eigen/Core>

#include "pendulum/analysis/random_effects.h"
#include "pendulum/base/distributions.h"

namespace pendulum {
namespace {

/// Quantile of sorted values, type 7 of Hyndman and Fan.
double Quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

void Count(const std::vector<double>& sorted, Distribution& distribution) {
  constexpr double kMaxBins = 60;
  const double range = distribution.upper_quartile - distribution.lower_quartile;
  distribution.from = std::max(distribution.minimum, distribution.lower_quartile - 3 * range);
  distribution.to = std::min(distribution.maximum, distribution.upper_quartile + 3 * range);
  const double span = distribution.to - distribution.from;
  const double width = 2 * range / std::cbrt(static_cast<double>(sorted.size()));
  const double bins = width > 0 && span > 0 ? std::clamp(std::ceil(span / width), 1.0, kMaxBins) : 1;
  distribution.counts.assign(static_cast<std::size_t>(bins), 0);
  for (const double value : sorted) {
    if (value < distribution.from) {
      ++distribution.below;
    } else if (value > distribution.to) {
      ++distribution.above;
    } else {
      const double at = span > 0 ? bins * (value - distribution.from) / span : 0;
      ++distribution.counts[std::min(static_cast<std::size_t>(at), distribution.counts.size() - 1)];
    }
  }
}

/// The runs of each group.
std::map<std::size_t, std::vector<std::size_t>> Groups(const RunValues& values) {
  std::map<std::size_t, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < values.size(); ++i) groups[values.group[i]].push_back(i);
  return groups;
}

std::vector<bool> IsOutlier(std::size_t runs, const std::vector<Outlier>& outliers) {
  std::vector<bool> is(runs, false);
  for (const Outlier& outlier : outliers) is[outlier.run] = true;
  return is;
}

/// Sets the z of the runs of one group.
void SetGroupDistances(const RunValues& values, const std::vector<std::size_t>& runs, std::vector<double>& z) {
  std::vector<double> estimates;
  for (const std::size_t run : runs) estimates.push_back(values.estimate[run]);
  const double median = MedianOf(estimates), scale = RobustStdDev(estimates);
  for (const std::size_t run : runs) {
    const double own = values.std_error[run];
    const double sigma = std::isfinite(own) ? std::max(scale, own) : scale;
    if (sigma > 0) z[run] = std::abs(values.estimate[run] - median) / sigma;
  }
}

GroupRepeatability RepeatGroup(std::size_t group, const std::vector<double>& value, const std::vector<double>& error) {
  const Eigen::Map<const Eigen::VectorXd> x(value.data(), static_cast<Eigen::Index>(value.size()));
  const Eigen::Map<const Eigen::VectorXd> e(error.data(), x.size());
  const Eigen::VectorXd weight = e.array().square().inverse();
  GroupRepeatability result{group, value.size()};
  result.mean = weight.dot(x) / weight.sum();
  result.std_error = std::sqrt(1 / weight.sum());
  result.chi2 = (weight.array() * (x.array() - result.mean).square()).sum();
  result.between = SummarizeScatter(x, e).between;
  return result;
}

double MeanOf(const std::vector<double>& values, const std::vector<std::size_t>& of) {
  double sum = 0;
  for (const std::size_t i : of) sum += values[i];
  return of.empty() ? 0 : sum / static_cast<double>(of.size());
}

double UpperP(double chi2, std::size_t dof) {
  if (!std::isfinite(chi2)) return 0;
  return ChiSquareTail(chi2, static_cast<double>(dof));
}

}  // namespace

double MedianOf(std::vector<double> values) {
  std::ranges::sort(values);
  return Quantile(values, 0.5);
}

double RobustStdDev(const std::vector<double>& values) {
  constexpr double kSigmaFromMedianDistance = 1.4826;  // of a normal distribution
  const double median = MedianOf(values);
  std::vector<double> distances;
  for (const double value : values) distances.push_back(std::abs(value - median));
  return kSigmaFromMedianDistance * MedianOf(distances);
}

bool IsOfTheRig(std::string_view name) {
  constexpr std::array<std::string_view, 8> kOfTheRun = {"release_angle", "release_time", "initial_angle",
                                                         "initial_rate",  "zero_angle",   "rate_bias",
                                                         "zero_drift",    "bias_drift"};
  return std::ranges::find(kOfTheRun, name) == kOfTheRun.end();
}

Distribution Describe(const std::vector<double>& values) {
  std::vector<double> sorted = values;
  std::ranges::sort(sorted);
  Distribution distribution;
  distribution.minimum = sorted.front();
  distribution.maximum = sorted.back();
  distribution.lower_quartile = Quantile(sorted, 0.25);
  distribution.median = Quantile(sorted, 0.5);
  distribution.upper_quartile = Quantile(sorted, 0.75);
  const auto count = static_cast<double>(sorted.size());
  distribution.mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / count;
  double squares = 0;
  for (const double value : sorted) squares += (value - distribution.mean) * (value - distribution.mean);
  if (sorted.size() > 1) distribution.std_dev = std::sqrt(squares / (count - 1));
  Count(sorted, distribution);
  return distribution;
}

std::vector<double> DistancesFromGroup(const RunValues& values) {
  std::vector<double> z(values.size(), std::numeric_limits<double>::quiet_NaN());
  for (const auto& [group, runs] : Groups(values)) SetGroupDistances(values, runs, z);
  return z;
}

std::vector<Outlier> FindOutliers(const RunValues& values) {
  constexpr std::size_t kMinRuns = 5;
  constexpr double kFalseAlarms = 0.05;
  std::vector<Outlier> outliers;
  if (values.size() < kMinRuns) return outliers;
  const double each = -std::expm1(std::log1p(-kFalseAlarms) / static_cast<double>(values.size()));
  const double limit = -NormalQuantile(each / 2);
  const std::vector<double> z = DistancesFromGroup(values);
  for (const auto& [group, runs] : Groups(values)) {
    for (const std::size_t run : runs) {
      if (runs.size() >= kMinRuns && z[run] > limit) outliers.push_back({run, z[run]});
    }
  }
  std::ranges::sort(outliers, std::greater(), &Outlier::z);
  return outliers;
}

double GroupRepeatability::ScatterRatio() const { return std::sqrt(chi2 / static_cast<double>(runs - 1)); }
double GroupRepeatability::P() const { return UpperP(chi2, runs - 1); }

std::pair<double, double> GroupRepeatability::ScatterInterval() const {
  constexpr double kTail = 0.025;
  const auto freedom = static_cast<double>(runs - 1);
  const auto end = [&](double probability) { return std::sqrt(chi2 / ChiSquareQuantile(probability, freedom)); };
  return {end(1 - kTail), end(kTail)};
}

std::pair<double, double> GroupRepeatability::MeanInterval() const {
  return {mean - kNormal95 * std_error, mean + kNormal95 * std_error};
}

double Repeatability::ScatterRatio() const { return std::sqrt(chi2 / static_cast<double>(dof)); }

bool Repeatability::HasEnoughRuns() const {
  constexpr std::size_t kEnough = 20;
  return dof >= kEnough;
}

bool Repeatability::Disagrees(const GroupRepeatability& group) const {
  constexpr double kLevel = 0.05;
  return group.P() < kLevel / static_cast<double>(groups.size());
}

std::optional<Repeatability> AnalyzeRepeatability(const RunValues& values, const std::vector<Outlier>& outliers) {
  const std::vector<bool> left_out = IsOutlier(values.size(), outliers);
  Repeatability all;
  double between_squares = 0;
  for (const auto& [group, runs] : Groups(values)) {
    std::vector<double> value, error;
    for (const std::size_t run : runs) {
      if (left_out[run] || !(values.std_error[run] > 0)) continue;
      value.push_back(values.estimate[run]);
      error.push_back(values.std_error[run]);
    }
    if (value.size() < 2) continue;
    all.groups.push_back(RepeatGroup(group, value, error));
    const GroupRepeatability& own = all.groups.back();
    all.runs += own.runs;
    all.dof += own.runs - 1;
    all.chi2 += own.chi2;
    between_squares += static_cast<double>(own.runs - 1) * own.between * own.between;
  }
  if (all.dof == 0) return std::nullopt;
  all.between = std::sqrt(between_squares / static_cast<double>(all.dof));
  all.upper_p = UpperP(all.chi2, all.dof);
  all.lower_p = 1 - all.upper_p;
  constexpr double kLevel = 0.01, kMargin = 1.1;
  const double ratio = all.ScatterRatio();
  if (all.upper_p < kLevel && ratio > kMargin) all.verdict = Repeatability::Verdict::kScatterLarger;
  if (all.lower_p < kLevel && ratio < 1 / kMargin) all.verdict = Repeatability::Verdict::kScatterSmaller;
  return all;
}

std::optional<Trend> FitTrend(const RunValues& values, const std::vector<Outlier>& outliers) {
  const std::vector<bool> left_out = IsOutlier(values.size(), outliers);
  double sxx = 0, sxy = 0, syy = 0, freedom = -1;
  std::size_t count = 0;
  for (const auto& [group, runs] : Groups(values)) {
    std::vector<std::size_t> used;
    for (const std::size_t run : runs) {
      if (!left_out[run] && std::isfinite(values.order[run])) used.push_back(run);
    }
    const double x0 = MeanOf(values.order, used), y0 = MeanOf(values.estimate, used);
    for (const std::size_t run : used) {
      const double dx = values.order[run] - x0, dy = values.estimate[run] - y0;
      sxx += dx * dx;
      sxy += dx * dy;
      syy += dy * dy;
    }
    count += used.size();
    freedom += used.empty() ? 0 : static_cast<double>(used.size() - 1);
  }
  if (freedom < 1 || !(sxx > 0) || !std::isfinite(sxx + sxy + syy)) return std::nullopt;
  Trend trend{count, sxy / sxx};
  trend.std_error = std::sqrt(std::max(syy - sxy * sxy / sxx, 0.0) / freedom / sxx);
  if (!(trend.std_error > 0)) return trend;
  const double t = std::abs(trend.slope / trend.std_error);
  trend.p = 2 * StudentTail(t, freedom);
  return trend;
}

namespace {

constexpr int kHours = 24, kMinutes = 60;

/// The offset from UTC, in minutes, of a time zone such as "Z" or "+01:00"; 0 for an empty text.
std::optional<double> MinutesOfZone(const std::string& zone) {
  if (zone.empty() || zone == "Z") return 0;
  std::array<char, 2> sign{};
  unsigned int hour = 0, minute = 0;
  int end = 0;
  if (std::sscanf(zone.c_str(), "%1[+-]%2u:%2u%n", sign.data(), &hour, &minute, &end) != 3) return std::nullopt;
  if (end != static_cast<int>(zone.size()) || hour >= kHours || minute >= kMinutes) return std::nullopt;
  return (sign[0] == '-' ? -1.0 : 1.0) * (kMinutes * hour + minute);
}

/// A time of day, such as "T12:30" or "T12:30:21.6Z", in days; 0 for an empty text.
std::optional<double> DaysOfTime(const std::string& time) {
  if (time.empty()) return 0;
  unsigned int hour = 0, minute = 0;
  double second = 0;
  int end = 0;
  if (std::sscanf(time.c_str(), "%*1[T ]%2u:%2u%n:%lf%n", &hour, &minute, &end, &second, &end) < 2) return std::nullopt;
  const auto zone = MinutesOfZone(time.substr(end));
  if (!zone || hour >= kHours || minute >= kMinutes || !(second >= 0 && second <= kMinutes)) return std::nullopt;
  return (kMinutes * hour + minute - *zone + second / kMinutes) / (kHours * kMinutes);
}

}  // namespace

std::optional<double> ParseOrderValue(const std::string& text, bool& is_date) {
  is_date = false;
  double number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && rest == text.data() + text.size() && std::isfinite(number)) return number;
  int year = 0, end = 0;
  unsigned int month = 0, day = 0;
  if (std::sscanf(text.c_str(), "%4d-%2u-%2u%n", &year, &month, &day, &end) < 3) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(month), std::chrono::day(day)};
  const auto time = DaysOfTime(text.substr(end));
  if (!date.ok() || !time) return std::nullopt;
  is_date = true;
  return static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count()) + *time;
}

}  // namespace pendulum
