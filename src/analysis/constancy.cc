// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/constancy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "pendulum/analysis/amplitude_trend.h"
#include "pendulum/analysis/linear_fit.h"
#include "pendulum/analysis/part_fit.h"
#include "pendulum/base/distributions.h"
#include "pendulum/base/format.h"
#include "pendulum/base/rounding.h"
#include "pendulum/closed_form/turning_points.h"
#include "pendulum/fitting/swing/undersampled.h"
#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// ---- Where to cut --------------------------------------------------------------------------------------------------

/// The first instant that is certainly after the release [s, file's clock].
double BeginOfMotion(const Recording& used, const FitReport& fit) {
  constexpr double kSurely = 4;  // standard errors
  const ParameterEstimate* const release = fit.Find(kReleaseTime.name);
  if (release == nullptr) return used.time[0];
  return release->estimate + kSurely * release->std_error.value_or(0);
}

/// The beginning of the motion and each turning point after it [s, file's clock]: M + 1 ends of M half swings.
std::vector<double> HalfSwingEnds(const Recording& used, double begin) {
  constexpr double kFirst = 0.5;  // of a half swing: an earlier turning point is the start itself
  const Result<Recording> moving = SelectWindow(used, begin, std::numeric_limits<double>::quiet_NaN());
  const auto turns = moving ? FindTurningPoints(*moving) : tl::unexpected(moving.error());
  std::vector<double> ends = {begin};
  if (!turns) return ends;
  const double half_swing =
      (turns->points.back().time - turns->points.front().time) / static_cast<double>(turns->half_swings());
  for (const TurningPoint& turn : turns->points) {
    if (turn.time > begin + kFirst * half_swing) ends.push_back(turn.time);
  }
  return ends;
}

// ---- Halves --------------------------------------------------------------------------------------------------------

/// How much the deviance of a half rises from its estimate without bounds if it has the whole fit's inertia and
/// friction and a start of its own; std::nullopt if there is no such fit.
std::optional<double> RiseWithWholeFit(const Parts& parts, const PartFit& half, const UnboundedEstimate& estimate) {
  const PartFit held = parts.Fit(half.part.time[0], half.part.time[half.part.size() - 1], estimate.names);
  if (!held.converged()) return std::nullopt;
  const NoiseModel noise = parts.NoiseOf(half.fit);
  const auto log_likelihood = [&](const VectorXd& fitted) { return LogLikelihood(noise, half.part.value, fitted); };
  return estimate.gain + 2 * (log_likelihood(half.fit.fitted) - log_likelihood(held.fit.fitted));
}

/// How many times too significant the halves' difference is, because the likelihood of a half is no parabola as far as
/// the whole fit: MODEL.md eq. (9.8), at least 1. This happens where a half hardly shows a parameter.
double ExcessOfDifference(double statistic, double of_likelihood, const std::array<std::optional<double>, 2>& rises) {
  constexpr double kLeast = 1;  // a difference that the readings do not see at all
  if (!rises[0] || !rises[1] || !(of_likelihood > 0)) return 1;
  const double correlated = statistic / of_likelihood;
  return std::max(1.0, statistic / std::max(correlated * (*rises[0] + *rises[1]), kLeast));
}

void SetHalves(const UnboundedEstimate& first, const UnboundedEstimate& second, const FitReport& fit, double excess,
               Constancy& result) {
  const VectorXd difference = second.value - first.value;
  const MatrixXd covariance = excess * (first.covariance + second.covariance);
  result.halves.clear();
  for (Index i = 0; i < difference.size(); ++i) {
    const ParameterEstimate& parameter = *fit.Find(first.names[static_cast<std::size_t>(i)]);
    result.halves.push_back({std::string(parameter.info.name), parameter.unit, first.value[i], second.value[i],
                             std::sqrt(excess * first.covariance(i, i)), std::sqrt(excess * second.covariance(i, i)),
                             difference[i] / std::sqrt(covariance(i, i))});
  }
  if (difference.size() == 0) return;
  result.halves_dof = static_cast<int>(difference.size());
  const double statistic = SquaredLength(difference, covariance);
  if (!std::isfinite(statistic)) return;
  result.halves_statistic = statistic;
  result.halves_p = ChiSquareTail(statistic, result.halves_dof);
}

/// Returns why there is no test; empty if there is one.
std::string CompareHalves(const Parts& parts, const std::vector<double>& ends, const FitReport& fit,
                          const FitOptions& options, Constancy& result) {
  if (ends.size() - 1 < 2 * kMinHalfSwings) return TooFewHalfSwings(ends, "halves", 2 * kMinHalfSwings);
  const double cut = ends[CutEvenly(ends, 2, parts)[1]];
  const std::array ranges = {std::pair(ends.front(), cut), std::pair(NextDoubleAfter(cut), ends.back())};
  std::vector<PartFit> halves;
  std::vector<ReadingTerms> terms;
  std::vector<LinearFit> linear;
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const std::string which = k == 0 ? "first" : "second";
    const PartFit& half = halves.emplace_back(parts.Fit(ranges[k].first, ranges[k].second, {}));
    if (!half.converged()) return "the fit to the " + which + " half did not converge: " + half.reason;
    terms.push_back(TermsOf(parts.NoiseOf(half.fit), half.part.value, half.fit.fitted));
    std::optional<LinearFit> own =
        LinearizeFit(half.part, half.fit, options.rig, terms.back(), {}, false, options.stop);
    if (!own) return "the " + which + " half does not determine all parameters";
    linear.push_back(*std::move(own));
  }
  const Autocorrelation autocorrelation = parts.PooledAutocorrelation(parts.PooledNoise(halves), halves, linear);
  const auto estimate = [&](std::size_t k) {
    return EstimateUnbounded(halves[k].part, halves[k].fit, parts.NoiseOf(halves[k].fit), terms[k], linear[k],
                             autocorrelation);
  };
  const UnboundedEstimate first = estimate(0), second = estimate(1);
  SetHalves(first, second, fit, 1, result);
  if (result.halves_differ()) {
    const double of_likelihood =
        SquaredLength(second.value - first.value, first.likelihood_covariance + second.likelihood_covariance);
    const std::array rises = {RiseWithWholeFit(parts, halves[0], first), RiseWithWholeFit(parts, halves[1], second)};
    SetHalves(first, second, fit, ExcessOfDifference(result.halves_statistic, of_likelihood, rises), result);
  }
  if (result.halves.empty()) return "inertia and friction are fixed, so there is nothing to compare";
  return result.halves_p ? "" : "the covariance of the halves' difference cannot be inverted";
}

// ---- Words ---------------------------------------------------------------------------------------------------------

std::string Join(const std::string& first, const std::string& second, const std::string& between) {
  return first.empty() || second.empty() ? first + second : first + between + second;
}

/// Names the parameter that differs most between the halves.
std::string DescribeHalves(const Constancy& result) {
  const auto row =
      std::ranges::max_element(result.halves, {}, [](const HalvesRow& candidate) { return std::abs(candidate.z); });
  const bool alone = row->differs();
  const std::string what =
      alone ? row->name + " differs" : "inertia and friction together differ, most of all " + row->name + ",";
  return what + " between the halves: " + PlusMinusText(row->first, row->first_std_error) + " then " +
         PlusMinusText(row->second, row->second_std_error) + (row->unit == "1" ? "" : " " + row->unit) + " (p " +
         ProbabilityText(alone ? TwoSidedP(row->z) : *result.halves_p) + ")";
}

/// "230": the size of a relative change in percent.
std::string PercentText(double change) {
  constexpr int kDigits = 2;
  const double percent = 100 * std::abs(change);
  return RoundedText(percent, SignificantRounding(percent, kDigits));
}

std::string DescribeTrend(const AmplitudeTrend& trend) {
  const std::string change = trend.span > 0 ? " falls by " : " rises by ";
  const std::string why = trend.name == kInertia.name
                              ? "the period does not depend on amplitude as in the model"
                              : "friction does not depend on amplitude as in the model, or depends on time";
  return trend.name + change + PercentText(trend.span) + " % from the largest to the smallest swings (p " +
         ProbabilityText(trend.p) + "): " + why;
}

std::string DescribeScatter(const AmplitudeTrend& trend) {
  return trend.name + " scatters between windows of the recording by more than its errors (p " +
         ProbabilityText(trend.scatter_p) + ")";
}

std::string Describe(const Constancy& result) {
  std::string found;
  if (result.halves_differ()) found = DescribeHalves(result);
  for (const AmplitudeTrend& trend : result.trends) {
    if (trend.has_trend()) {
      found = Join(found, DescribeTrend(trend), "; ");
    } else if (trend.scatters()) {
      found = Join(found, DescribeScatter(trend), "; ");
    }
  }
  if (!found.empty()) return found;
  if (!result.halves_p && result.trends.empty()) return "not tested: " + result.reason;
  std::string names;
  for (const auto& trend : result.trends)
    names = Join(names, trend.name + " (p " + ProbabilityText(trend.p) + ")", " or ");
  return "inertia and friction are constants of the recording: " +
         Join(result.halves_p ? "halves agree (p " + ProbabilityText(*result.halves_p) + ")" : "",
              names.empty() ? "" : "no trend of " + names + " with amplitude", ", ");
}

/// The corrected readings and their fit, so that the fits to parts see what the whole fit has seen.
std::pair<Recording, FitReport> CorrectedReadings(Recording used, FitReport fit) {
  if (fit.correction.size() > 0) {
    used.value -= fit.correction;
    fit.fitted -= fit.correction;
    fit.correction.resize(0);
  }
  return {std::move(used), std::move(fit)};
}

}  // namespace

bool HalvesRow::differs() const { return TwoSidedP(z) < kNotConstant; }

bool AmplitudeTrend::has_trend() const { return p < kNotConstant; }

bool AmplitudeTrend::scatters() const { return scatter_p < kNotConstant; }

bool Constancy::halves_differ() const {
  return halves_p.value_or(1) < kNotConstant || std::ranges::any_of(halves, &HalvesRow::differs);
}

bool Constancy::windows_differ() const {
  return std::ranges::any_of(trends, [](const AmplitudeTrend& trend) { return trend.has_trend() || trend.scatters(); });
}

bool Constancy::constant() const { return !halves_differ() && !windows_differ(); }

bool Constancy::is_too_short_for_halves() const { return half_swings && *half_swings < 2 * kMinHalfSwings; }

bool Constancy::is_too_short_for_windows() const { return half_swings && *half_swings < kMinWindows * kMinHalfSwings; }

Constancy UntestedConstancy(const Recording& recorded, const FitReport& report, const FitOptions& options,
                            std::string reason) {
  Constancy result;
  result.reason = std::move(reason);
  if (report.termination == Termination::kConverged && !IsUndersampled(recorded, options.rig))
    result.half_swings = HalfSwingEnds(recorded, BeginOfMotion(recorded, report)).size() - 1;
  return result;
}

Constancy TestConstancy(const Recording& recorded, const FitReport& report, const FitOptions& options) {
  const auto [used, fit] = CorrectedReadings(recorded, report);
  Constancy result;
  if (fit.termination != Termination::kConverged) {
    result.reason = "the fit did not converge";
  } else if (IsUndersampled(used, options.rig)) {
    result.reason = "the recording is sampled too slowly to be cut at its turning points";
  } else {
    const std::vector<double> ends = HalfSwingEnds(used, BeginOfMotion(used, fit));
    result.half_swings = ends.size() - 1;
    const Parts parts(used, fit, options);
    const std::string halves = CompareHalves(parts, ends, fit, options, result);
    result.reason = Join(halves, CompareWindows(used, parts, ends, fit, options, result), "; ");
  }
  if (std::erase_if(result.trends, [](const AmplitudeTrend& trend) { return !std::isfinite(trend.p); }) > 0) {
    result.reason = Join(result.reason, "a trend with amplitude has no error", "; ");
  }
  result.verdict = Describe(result);
  return result;
}

}  // namespace pendulum
