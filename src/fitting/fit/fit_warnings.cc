// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/fit_warnings.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/QR>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/base/rounding.h"
#include "pendulum/closed_form/turning_points.h"
#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/fitting/residuals/autocorrelation.h"
#include "pendulum/fitting/residuals/swing_misfit.h"

namespace pendulum {
namespace {

/// A reading at an end of the sensor's range only states that the angle is at that end or beyond.
void WarnOfSaturation(const FitProblem& problem, std::vector<Warning>& warnings) {
  if (problem.censored == 0) return;
  warnings.push_back({.code = "saturated",
                      .finding = std::to_string(problem.censored) + " readings are at an end of the sensor's range",
                      .explanation = "the fit only assumes that the angle is at that end or beyond it"});
}

/// The size of the misfit, in resolutions if the readings are quantized.
std::string MisfitSize(const Recording& recording, double misfit) {
  if (recording.resolution > 0) return NumberText(misfit / recording.resolution, 2) + " resolutions";
  return NumberText(misfit, 2) + " " + recording.value_unit();
}

/// Whether residuals that are more than white noise follow the swing. An acceleration along the rod oscillates twice in
/// a period, and a fit without a minimum has no noise.
bool MayBeMisfit(const Recording& recording, const FitReport& report, const Eigen::VectorXd& z) {
  if (report.termination != Termination::kConverged || recording.quantity == Quantity::kAcceleration) return true;
  const Autocorrelation& known = report.noise.autocorrelation;
  const bool is_known = known.kind != Autocorrelation::Kind::kWhite;
  return IsSwingMisfit(recording.time, report.fitted, z,
                       is_known ? std::optional(known.SquaredInflation()) : std::nullopt);
}

void WarnOfCorrelation(const Recording& recording, const FitReport& report, const Eigen::VectorXd& z,
                       std::vector<Warning>& warnings) {
  constexpr double kRatio = 1.3;
  constexpr double kLargestShown = 99;
  const double ratio = RatioToNeighbourNoise(recording.time, z);
  const bool is_misfit = ratio > kRatio && MayBeMisfit(recording, report, z);
  if (!is_misfit) {
    const bool is_modelled = report.noise.autocorrelation.kind != Autocorrelation::Kind::kWhite &&
                             report.termination == Termination::kConverged;
    warnings.push_back(
        {.code = "correlated_residuals",
         .finding = is_modelled ? "the residuals are autocorrelated: the error bars assume autocorrelated noise (" +
                                      report.noise.autocorrelation.Name() + ") and are valid if the model is right"
                                : "the residuals are autocorrelated, and the error bars ignore that"});
    return;
  }
  const std::string times = ratio > kLargestShown ? "more than 99" : NumberText(ratio, 2);
  const double misfit = report.statistics.rms_residual * std::sqrt(1 - 1 / (ratio * ratio));
  warnings.push_back(
      {.code = "lack_of_fit",
       .finding = "the residuals are autocorrelated and " + times +
                  " times as large as the noise between neighbouring samples",
       .explanation = "the misfit is " + MisfitSize(recording, misfit) +
                      "; the model does not describe the whole recording, or its noise is slow; the error bars may be "
                      "wrong",
       .advice = "look at the residuals (--report), and try other laws (--models all) or another window",
       .flags = {"report", "models"}});
}

/// A line through the mean residuals of whole periods. The swing itself does not affect these means.
void WarnOfDrift(const Recording& recording, const FitProblem& problem, const FitReport& report,
                 std::vector<Warning>& warnings) {
  constexpr Eigen::Index kMinWholePeriods = 5;
  constexpr double kSure = 5;  // standard errors
  if (problem.zero_motion == ZeroMotion::kDrifts || problem.data.sensor.kind != SensorKind::kDirect) return;
  const Eigen::VectorXd& time = recording.time;
  const double period = 2 * kPi / (problem.start.natural_frequency * recording.clock_scale);
  std::vector<double> when, mean;
  for (Eigen::Index first = 0; first < time.size();) {
    Eigen::Index end = first;
    while (end < time.size() && time[end] - time[first] < period) ++end;
    if (end < time.size()) {
      when.push_back(time.segment(first, end - first).mean());
      mean.push_back(report.residual.segment(first, end - first).mean());
    }
    first = end;
  }
  const auto count = static_cast<Eigen::Index>(when.size());
  if (count < kMinWholePeriods) return;
  const Eigen::Map<const Eigen::VectorXd> y(mean.data(), count);
  Eigen::MatrixX2d basis(count, 2);
  basis << Eigen::VectorXd::Ones(count), Eigen::Map<const Eigen::VectorXd>(when.data(), count).array() - when.front();
  const Eigen::Vector2d line = basis.colPivHouseholderQr().solve(y);
  const double scatter = (y - basis * line).norm() / std::sqrt(static_cast<double>(count - 2));
  const double spread = (basis.col(1).array() - basis.col(1).mean()).matrix().norm();
  constexpr double kMatters = 0.5;  // of the residuals
  const double drift = line[1] * (when.back() - when.front());
  if (!(std::abs(line[1]) * spread > kSure * scatter)) return;
  if (std::abs(drift) < kMatters * report.statistics.rms_residual) return;
  const bool angle = recording.quantity != Quantity::kRate;
  const std::string name(angle ? kZeroDrift.name : kBiasDrift.name);
  warnings.push_back({.code = "zero_drift",
                      .finding = "the zero of the readings drifts by about " + NumberText(drift, 2) + " " +
                                 recording.value_unit() + " over the window",
                      .advice = "--init " + name + "=0 makes the drift a parameter of the fit",
                      .flags = {"init"}});
}

/// Warns if the noise is below half a resolution: the readings are then rounded values of a smooth curve, not a curve
/// with white noise.
void WarnOfQuietSensor(const Recording& recording, const FitReport& report, std::vector<Warning>& warnings) {
  constexpr double kQuiet = 0.5;
  const double rms = std::min(report.statistics.rms_residual, report.noise.sigma);  // without outliers
  const bool is_quantized = report.noise.family == NoiseFamily::kQuantized ||
                            report.noise.family == NoiseFamily::kEdges || report.noise.family == NoiseFamily::kAveraged;
  if (is_quantized || !(rms < kQuiet * recording.resolution)) return;
  warnings.push_back({.code = "noise_below_resolution",
                      .finding = "the residuals are " + NumberText(rms / recording.resolution, 2) +
                                 " resolutions: rounding errors do not average out with so little noise, so the error "
                                 "bars may be several times too small",
                      .advice = "use --noise quantized",
                      .flags = {"noise"}});
}

void WarnOfTraceAccuracy(const FitReport& report, std::vector<Warning>& warnings) {
  constexpr double kNegligible = 0.01;
  constexpr double kRounding = 1e-11;  // rad or rad/s: smaller noise is rounding error
  if (!(report.trace_error > std::max(kNegligible * report.noise.sigma, kRounding))) return;
  warnings.push_back({.code = "trajectory_accuracy",
                      .finding = "the numerical error of the trajectory is " + NumberText(report.trace_error, 1) +
                                 ", which is not small compared with the noise of " +
                                 NumberText(report.noise.sigma, 1) + ", because rounding errors grow near the top",
                      .advice = "choose a window with smaller swings"});
}

/// Compares the prior with the estimate from the recording alone, which follows from prior and posterior. If the
/// estimate has variance s² and the prior p², the recording's own variance is 1 / (1/s² - 1/p²). If s >= p, which
/// happens if the law does not fit, this expression is not positive. The estimate is then compared with the prior
/// alone.
void WarnOfPriors(const FitProblem& problem, const Solution& solution, const FitReport& report,
                  std::vector<Warning>& warnings) {
  constexpr double kFar = 3;  // standard deviations of their difference
  for (const PriorTerm& prior : problem.priors) {
    const ParameterEstimate& parameter = report.parameters[prior.parameter];
    if (!parameter.std_error) continue;
    const double error = *parameter.std_error / problem.si_per_internal[prior.parameter] * prior.weight;  // s / p
    const double own = error < 1 ? 1 / (1 / (error * error) - 1) : 0;                                     // in p²
    const double distance =
        std::abs(solution.parameters[prior.parameter] - prior.mean) * prior.weight * std::sqrt(1 + own);
    if (!(distance > kFar)) continue;
    const std::string name(parameter.info.name);
    warnings.push_back({.code = "prior_conflict",
                        .finding = "the prior of " + name + " (--prior) and the recording disagree by " +
                                   NumberText(distance, 3) + " standard deviations of their difference",
                        .flags = {"prior"},
                        .about = {.parameters = {name}}});
  }
}

constexpr std::string_view kBoundIsExact =
    "the standard errors of the others assume that this value is exact, the intervals by profile likelihood do not";

/// The warning of parameters at a bound: "viscous is at its bound 0".
Warning AtBound(const std::vector<ParameterInfo>& parameters, const std::string& bound, std::string advice) {
  Warning warning{
      .code = "at_bound",
      .finding = NameList(parameters) + (parameters.size() == 1 ? " is at its " : " are each at their ") + bound,
      .explanation = std::string(kBoundIsExact),
      .advice = std::move(advice)};
  for (const ParameterInfo& parameter : parameters) warning.about.parameters.emplace_back(parameter.name);
  return warning;
}

/// If one parameter is at its bound, the errors of the others are valid only if the true value lies on that bound.
void WarnOfBounds(const FitReport& report, std::vector<Warning>& warnings) {
  std::vector<ParameterInfo> friction, bounded, extreme;
  for (const ParameterEstimate& parameter : report.parameters) {
    if (!parameter.at_bound) continue;
    if (parameter.info.name != kReleaseTime.name) {
      const bool none = parameter.estimate == 0 && parameter.info.lower == 0;  // the result is a simpler law
      const bool own = parameter.estimate == parameter.info.lower || parameter.estimate == parameter.info.upper;
      (none ? friction : own ? extreme : bounded).push_back(parameter.info);
      continue;
    }
    warnings.push_back(
        {.code = "at_bound",
         .finding = "release_time is at an end of the hold: the readings suggest a release outside it",
         .explanation = std::string(kBoundIsExact),
         .advice = "choose a window with all of the hold, or --start moving with a window after the release",
         .flags = {"start"},
         .about = {.parameters = {"release_time"}}});
  }
  if (!extreme.empty()) {
    warnings.push_back(AtBound(extreme, "limit", ""));
    warnings.back().explanation += "; the recording hardly determines its value";
  }
  if (!bounded.empty()) {
    warnings.push_back(AtBound(bounded, "given bound", "widen --bounds"));
    warnings.back().flags = {"bounds"};
  }
  if (friction.empty()) return;
  warnings.push_back(AtBound(friction, "bound 0", "a simpler model or a longer recording gives smaller errors"));
}

/// Warns about the stop of a pendulum that dry friction brings to rest.
void WarnOfStop(const FitProblem& problem, const Solution& solution, const TraceSummary& trace, const FitReport& report,
                std::vector<Warning>& warnings) {
  const int holding = problem.solve.holding_parameter;
  if (holding < 0 || !report.parameters[holding].std_error) return;
  const ParameterEstimate& friction = report.parameters[holding];
  const double si = problem.si_per_internal[holding];
  const double error = *friction.std_error / si;
  const std::string name(friction.info.name);
  constexpr double kNearlyAsWell = 9;  // in -2 log L
  const auto other =
      std::find_if(solution.other_minima.begin(), solution.other_minima.end(), [&](const Minimum& minimum) {
        const double distance = minimum.parameters[holding] - solution.parameters[holding];
        return minimum.sum - solution.sum <= kNearlyAsWell && std::abs(distance) >= error;
      });
  if (other != solution.other_minima.end()) {
    warnings.push_back({.code = "another_minimum",
                        .finding = "with " + name + " " + NumberText(si * other->parameters[holding], 6) +
                                   (friction.unit.empty() ? "" : " " + std::string(friction.unit)) +
                                   " and another number of half swings the fit is nearly as good",
                        .explanation = "the error bars apply to the best minimum only",
                        .about = {.parameters = {name}}});
  }
  if (trace.stop_time < problem.data.time.back() && trace.smallest_reversal_margin < 3 * error) {
    warnings.push_back({.code = "uncertain_stop",
                        .finding = "at a late turning point gravity and " + name +
                                   " balance within three standard errors, so the number of half swings is uncertain "
                                   "and the error bars are rough",
                        .advice = "end the window before the pendulum stops (--to)",
                        .flags = {"to"}});
  }
}

// ---- Suspicions -----------------------------------------------------------------------------------------------------

/// What a cause does, what to measure or set, and the flag for it; empty: there is none.
struct CauseText {
  WarningCode code;
  std::string_view what, advice, flag;
};

CauseText TextOf(Cause cause) {
  switch (cause) {
    case Cause::kGain:
      return {"suspected_gain", "the sensor's gain is wrong", "calibrate the sensor at known angles", "--calibration"};
    case Cause::kNonlinearity:
      return {"suspected_nonlinearity", "the sensor's curve is bent or the sensor is eccentric",
              "calibrate the sensor at ten angles or more", "--calibration"};
    case Cause::kLag:
      return {"suspected_lag", "the readings are late", "switch off filters and averaging, or state the lag",
              "--sensor"};
    case Cause::kBacklash:
      return {"suspected_backlash", "the sensor has a play", "tighten the coupling of the sensor", ""};
    case Cause::kDrift:
      return {"suspected_drift", "the zero of the readings drifts", "let the sensor warm up, or fit the drift",
              "--init zero_drift=0"};
    case Cause::kPush:
      return {"suspected_push", "the pendulum was pushed or let go slowly, as with a rate at the release",
              "release it with a thread, or begin the window after the release", "--from"};
    case Cause::kHold:
      return {"suspected_hold", "the pendulum was not held still at the angle of the release: its hold is off",
              "hold it at a stop, or begin the window after the release", "--from"};
    case Cause::kFrictionLaw:
      return {"suspected_friction_law", "friction depends on the rate in another way", "compare the laws",
              "--models all"};
    case Cause::kPositionFriction:
      return {"suspected_position_friction", "dry friction depends on the angle or the load",
              "look for rubbing cables and bent shafts", ""};
    case Cause::kPresliding: break;
  }
  return {"suspected_presliding", "dry friction builds up after each reversal, as bristles do",
          "leave out small swings (--to), or fit the law dahl", "--model dahl"};
}

/// A unit as it is shown, and the factor to it.
struct ShownUnit {
  double factor = 1;
  std::string name;
};

ShownUnit ShownUnitOf(const std::string& unit) {
  constexpr double kPercent = 100, kMilliseconds = 1000;
  if (unit.starts_with("rad")) return {180 / kPi, "deg" + unit.substr(3)};
  if (unit == "1") return {kPercent, "%"};
  if (unit == "s") return {kMilliseconds, "ms"};
  return {1, unit};
}

/// How large the cause is, or how much it changes the readings.
std::string EffectText(const Suspicion& suspicion) {
  const bool is_size = suspicion.cause != Cause::kNonlinearity && IsCorrectable(suspicion.cause);
  const bool is_noun = suspicion.cause == Cause::kBacklash || suspicion.cause == Cause::kPush;
  if (is_size) return (is_noun ? " of " : " by ") + SizeText(suspicion);
  return " (it changes the readings by up to " + SizeText(suspicion) + ")";
}

/// law: the law that corrects for the cause if it is fitted alone; empty: none.
Warning SuspicionWarning(const Suspicion& suspicion, const std::string& law) {
  const CauseText text = TextOf(suspicion.cause);
  Warning warning{.code = text.code,
                  .finding = "the residuals suggest that " + std::string(text.what) + EffectText(suspicion) + ", " +
                             NumberText(std::min(suspicion.significance, 99.0), 2) + " standard deviations",
                  .explanation = suspicion.is_corrected ? "the estimates are those of corrected readings"
                                                        : "the estimates do not allow for it",
                  .advice = AdviceFor(suspicion.cause)};
  if (!text.flag.empty()) warning.flags.emplace_back(text.flag.substr(2, text.flag.find(' ') - 2));
  if (!law.empty()) {
    warning.advice += ", or fit this recording with --model " + law + " alone, which allows for it";
    warning.flags.emplace_back("model");
  }
  return warning;
}

}  // namespace

double RatioToNeighbourNoise(const Eigen::VectorXd& time, const Eigen::VectorXd& residual) {
  Recording residuals;
  residuals.time = time;
  residuals.value = residual;
  const double rms = std::sqrt(residual.squaredNorm() / static_cast<double>(residual.size()));
  return rms / SuccessiveDifferenceNoise(residuals);
}

std::vector<Warning> FitWarnings(const Recording& recording, const FitProblem& problem, const Solution& solution,
                                 const Description& described) {
  const FitReport& report = described.report;
  std::vector<Warning> warnings;
  WarnOfSaturation(problem, warnings);
  if (described.correlated) WarnOfCorrelation(recording, report, described.quantile_residuals, warnings);
  if (described.correlated) WarnOfDrift(recording, problem, report, warnings);
  WarnOfQuietSensor(recording, report, warnings);
  WarnOfTraceAccuracy(report, warnings);
  if (report.termination != Termination::kConverged) return warnings;
  WarnOfPriors(problem, solution, report, warnings);
  WarnOfBounds(report, warnings);
  WarnOfStop(problem, solution, described.trace, report, warnings);
  return warnings;
}

std::string_view FlagFor(Cause cause) { return TextOf(cause).flag; }

std::string_view RemedyFor(Cause cause) { return TextOf(cause).advice; }

std::string AdviceFor(Cause cause) {
  const std::string_view flag = FlagFor(cause);
  return std::string(RemedyFor(cause)) + (flag.empty() ? "" : " (" + std::string(flag) + ")");
}

std::string SizeText(const Suspicion& suspicion) {
  const auto [factor, unit] = ShownUnitOf(suspicion.unit);
  return PlusMinusText(factor * suspicion.size, factor * suspicion.std_error) + " " + unit;
}

std::string PlainSizeText(double size, const std::string& unit) {
  const auto [factor, name] = ShownUnitOf(unit);
  return NumberText(factor * size, 3) + " " + name;
}

void WarnOfSuspicions(bool is_correctable, FitReport& report) {
  const std::vector<Cause>& causes = report.effects.correction.causes;
  for (const Suspicion& suspicion : report.suspicions) {
    const bool alone = is_correctable && std::ranges::find(causes, suspicion.cause) != causes.end();
    report.warnings.push_back(SuspicionWarning(suspicion, alone ? std::string(report.model.name) : ""));
  }
}

}  // namespace pendulum
