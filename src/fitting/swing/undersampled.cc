// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/undersampled.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "fitting/swing/aliases.h"
#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/closed_form/sampling.h"
#include "pendulum/closed_form/turning_point_view.h"
#include "pendulum/closed_form/turning_points.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/model/rig_check.h"
#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// A difference of -2 log L that corresponds to three standard deviations.
constexpr double kNearlyAsWell = 9;

/// A difference of -2 log L that even a slightly wrong law does not cause: ten standard deviations.
constexpr double kMinDevianceGap = 100;

/// With this many samples per period the readings show the swing. A person who chose the sampling rate saw the period.
constexpr double kShown = 8;

/// With this many samples per period, turning points and windows are searched as in any other recording.
constexpr double kSurelyShown = 12;

/// Limit of trajectories for fits that are only compared. Fits that explain the readings need a few tens.
constexpr int kMaxAliasTraces = 300;

/// Removes constant readings at the start, because the time of a release between two samples is unknown. The first
/// reading is removed too, because it may belong to the hold even if the second reading does not.
void RemoveHold(Recording& used, FreeSwing& swing) {
  const double range = used.value.maxCoeff() - used.value.minCoeff();
  const double band = 0.05 * range + 2 * used.resolution;
  Index held = 1;
  while (held < used.size()) {
    const auto first = used.value.head(held + 1);
    if (first.maxCoeff() - first.minCoeff() > band) break;
    ++held;
  }
  held = std::min(held, used.size() - kMinimumSamples);
  if (held <= 0) return;
  swing.from = used.time[held];
  swing.begins = {held == 1 ? WindowBegin::Reason::kUndersampledAfterFirst
                            : WindowBegin::Reason::kUndersampledAfterHold};
  const Index left = used.size() - held;
  used.time = used.time.tail(left).eval();
  used.value = used.value.tail(left).eval();
}

/// The reason to reject a poor fit, or std::nullopt. With few samples per period, a misfit may look like noise, because
/// successive residuals are independent.
std::optional<std::string> NotDescribedReason(const Recording& used, const FitReport& fit) {
  constexpr double kMaxUnexplained = 0.02;
  constexpr Index kMinPerParameter = 2;
  const double variance = (used.value.array() - used.value.mean()).square().sum();
  const double left = fit.residual.squaredNorm() / variance;
  if (left > kMaxUnexplained) {
    return "the best trajectory leaves " + NumberText(100 * left, 2) +
           " % of the reading's variance unexplained; samples this far apart cannot distinguish noise from another "
           "motion, so sample faster";
  }
  const auto parameters = static_cast<Index>(fit.parameters.size());
  if (used.size() >= kMinPerParameter * parameters) return std::nullopt;
  return std::to_string(used.size()) + " samples are too few for " + std::to_string(parameters) +
         " parameters and the choice of a frequency; record for longer";
}

/// Whether the samples show each period of a fit that neither rig nor bounds limit.
bool IsShown(const Alias& alias, const AllowedFrequencies& allowed, double rate) {
  return !allowed.bounded && rate >= kShown * alias.frequency;
}

/// Of the fits that explain the readings equally well, the one whose periods the samples show comes first.
void PreferShown(const AllowedFrequencies& allowed, double rate, std::vector<Alias>& aliases) {
  for (const Alias* alias : NearlyAsGood(aliases, kNearlyAsWell)) {
    if (!IsShown(*alias, allowed, rate)) continue;
    const auto shown = aliases.begin() + (alias - aliases.data());
    std::rotate(aliases.begin(), shown, shown + 1);
    return;
  }
}

/// The reason to reject a fit if neither rig nor bounds limit the frequency. Only the slowest pendulum is accepted, and
/// only if the samples show its periods, or no faster pendulum explains the readings nearly as well.
std::optional<Warning> UnboundedFrequency(const std::vector<Alias>& aliases, double rate, const FitOptions& options) {
  constexpr double kMinPerPeriodIfUnambiguous = 4.5;  // if no pendulum could alias to this frequency
  const double frequency = aliases.front().frequency;
  const bool slowest = frequency < 0.5 * rate;
  const bool alone = NearlyAsGood(aliases, kMinDevianceGap).size() == 1;
  const bool is_unambiguous = alone && rate - frequency > kFastestHz;
  if (slowest && rate > (is_unambiguous ? kMinPerPeriodIfUnambiguous : kShown) * frequency) return std::nullopt;
  const double apparent = ApparentFrequency(frequency, rate);
  return Warning{.code = "ambiguous_frequency",
                 .finding = "sampled at " + Hz(rate) + ", the pendulum may swing at " + Hz(apparent) + " or faster",
                 .explanation = "the readings suggest " + Hz(frequency) + " (" + BoundsFlag(frequency, options) +
                                "); --rig with rod and bob, or with length and gravity, or samples at 6 Hz or faster "
                                "would tell",
                 .advice = "if it swings at about " + Hz(apparent) + ", give " + BoundsFlag(apparent, options),
                 .flags = {"bounds"}};
}

/// Whether evenly spaced samples show nearly the same two phases of a swing throughout the recording.
bool SamplesTwoPhasesOnly(const Recording& used, double frequency) {
  constexpr double kTooNear = 1;  // cycles over the recording
  constexpr double kEven = 0.02;  // cycles; time stamps with more jitter show other phases
  const double jitter = used.clock_scale * DescribeSampling(used, std::nullopt, std::nullopt).jitter;
  const double apparent = 0.5 * ApparentFrequency(2 * frequency, SampleRateOf(used));
  return apparent * DurationOf(used) < kTooNear && jitter * frequency < kEven;
}

/// The reason for an ambiguous result, or std::nullopt.
std::optional<Warning> AmbiguityOf(const Recording& used, const std::vector<Alias>& aliases,
                                   const AllowedFrequencies& allowed, const FitOptions& options) {
  const double rate = SampleRateOf(used);
  const auto near = NearlyAsGood(aliases, kNearlyAsWell);
  if (near.size() > 1 && !IsShown(aliases.front(), allowed, rate)) {
    return Warning{.code = "ambiguous_frequency",
                   .finding = "several inertias fit the readings nearly equally well, because their samples at " +
                              Hz(rate) + " look the same: " + ListOf(near, rate),
                   .advice = "sample faster, or choose one with --bounds of inertia",
                   .flags = {"bounds"}};
  }
  if (const double frequency = aliases.front().frequency; SamplesTwoPhasesOnly(used, frequency)) {
    return Warning{.code = "ambiguous_frequency",
                   .finding = "sampled at " + Hz(rate) + ", once or twice per swing of " + Hz(frequency) +
                              ", all readings show nearly the same two phases, so a slightly lower and a slightly "
                              "higher frequency look the same",
                   .advice = "sample at another rate"};
  }
  return allowed.bounded ? std::nullopt : UnboundedFrequency(aliases, rate, options);
}

/// The assumption that the samples show each swing.
Warning ShownFrequency(double frequency, double rate) {
  return {.code = "ambiguous_frequency",
          .finding = NumberText(rate / frequency, 2) + " samples per period show a swing of " + Hz(frequency) +
                     ", which is assumed",
          .explanation = "a swing of " + Hz(rate - frequency) + " would look the same",
          .advice = "if it is faster, give a rig file with masses and length, or --bounds of inertia",
          .flags = {"bounds"}};
}

/// The assumption on which an unambiguous result depends.
Warning AssumptionOf(const std::vector<Alias>& aliases, const AllowedFrequencies& allowed, double rate,
                     bool is_linear) {
  const std::string chosen = ListOf({&aliases.front()}, rate);
  if (!allowed.bounded && (is_linear || NearlyAsGood(aliases, kNearlyAsWell).size() > 1)) {
    return ShownFrequency(aliases.front().frequency, rate);
  }
  if (!allowed.bounded) {
    return {.code = "ambiguous_frequency",
            .finding = "sampled at " + Hz(rate) + ", a pendulum faster than " + Hz(0.5 * rate) +
                       " would look slower than it is",
            .explanation = "up to " + Hz(kFastestHz) + " only " + chosen + " fits the readings",
            .advice = "give a rig file with masses and length to be certain"};
  }
  return {.code = "ambiguous_frequency",
          .finding = "sampled at " + Hz(rate) + ", two frequencies at equal distances from a multiple of " +
                     Hz(0.5 * rate) + " differ only in how the period depends on the amplitude",
          .explanation = "only " + chosen + " fits the readings"};
}

/// Whether the readings fit far better at a frequency that contradicts the rig.
std::optional<Warning> RigMismatch(const Recording& used, const FitReport& fit, const FitOptions& options) {
  const auto expected = ExpectedFrequency(options.rig);
  if (!expected || options.bounds.contains(kInertia.name) || options.fixed.contains(kInertia.name)) return std::nullopt;
  const AllowedFrequencies wide{{0.5 * kTurn * *expected, 2 * kTurn * *expected}, false};
  const Result<std::vector<Alias>> aliases = FitAliases(used, wide, options);
  if (!aliases || aliases->empty()) return std::nullopt;
  const Alias& best = aliases->front();
  if (2 * (best.likelihood() - fit.statistics.log_likelihood) < kMinDevianceGap) return std::nullopt;
  return Warning{.code = "ambiguous_frequency",
                 .finding = "the readings fit far better at " + Hz(best.frequency) + " than within 15 % of the " +
                            Hz(*expected) + " that the rig predicts",
                 .advice = "check the rig file, or give --bounds of inertia",
                 .flags = {"bounds"}};
}

/// The reason to reject a fit, independent of its own errors.
struct Rejection {
  Termination termination;
  std::string why;
  std::optional<Warning> ambiguity;  // if that is the reason
};

std::optional<Rejection> RejectionOf(const Recording& used, const std::vector<Alias>& aliases,
                                     const AllowedFrequencies& allowed, const FitOptions& options) {
  if (const auto why = NotDescribedReason(used, aliases.front().fit))
    return Rejection{Termination::kNotConverged, *why, std::nullopt};
  auto ambiguity = AmbiguityOf(used, aliases, allowed, options);
  if (!ambiguity) ambiguity = RigMismatch(used, aliases.front().fit, options);
  if (!ambiguity) return std::nullopt;
  return Rejection{Termination::kNotIdentifiable, MessageText(*ambiguity), ambiguity};
}

/// Sets the termination and warnings of a fit from the information in the samples.
void CompleteReport(const Recording& used, const std::vector<Alias>& aliases, const AllowedFrequencies& allowed,
                    const std::optional<Rejection>& rejection, FitReport& fit) {
  const double rate = SampleRateOf(used);
  const bool mirrors = CanAliasWithinRange(allowed.range.low / kTurn, allowed.range.high / kTurn, rate);
  if (!rejection && mirrors) {
    fit.warnings.push_back(AssumptionOf(aliases, allowed, rate, fit.model.gravity.is_linear()));
  }
  // A start from a scan is not a closed-form estimate.
  for (ParameterEstimate& parameter : fit.parameters) parameter.closed_form.reset();
  if (!rejection) return;
  const std::string without_errors = "the fit is " + std::string(TerminationName(rejection->termination));
  if (rejection->ambiguity) return RejectFor(rejection->termination, *rejection->ambiguity, without_errors, fit);
  Reject(rejection->termination, rejection->why, without_errors, fit);
}

/// Warns about the sampling, with the frequency that the rig predicts or that a converged fit found.
void WarnOfSampling(const Recording& used, double frequency, const FitOptions& options, FitReport& fit) {
  auto expected = ExpectedFrequency(options.rig);
  if (expected && fit.termination == Termination::kConverged) expected = frequency;
  if (expected) *expected *= used.clock_scale;
  std::optional<double> half_period;
  if (!expected && fit.termination == Termination::kConverged) half_period = 0.5 / (frequency * used.clock_scale);
  for (Warning& warning : SamplingWarnings(DescribeSampling(used, half_period, expected))) {
    fit.warnings.push_back(std::move(warning));
  }
}

/// Samples per period as the turning points show it, in a free swing or not; 0 if fewer than three turning points are
/// seen.
double SeenPerPeriod(const Recording& recording) {
  const TurningPointTable table = FindAllTurningPoints(TurningPointView(recording));
  return 2 * table.half_period * recording.clock_scale * SampleRateOf(recording);
}

}  // namespace

std::optional<double> ExpectedFrequency(const std::optional<Rig>& rig) {
  const std::optional<double> ratio = rig ? PredictedRatio(*rig) : std::nullopt;
  return ratio ? std::optional(std::sqrt(*ratio) / kTurn) : std::nullopt;
}

std::optional<Warning> AssumedFrequency(const Recording& used, double half_period, const FitOptions& options) {
  const double frequency = 0.5 / (half_period * used.clock_scale);
  const double rate = SampleRateOf(used);
  const bool is_settled = IsFrequencyKnown(options) || IsLinear(options) || !(half_period > 0);
  if (is_settled || rate >= 2 * kFastestHz || rate - frequency > kFastestHz) return std::nullopt;
  return ShownFrequency(frequency, rate);
}

std::optional<SwingFit> FitFasterAlias(const SwingFit& slow, const FitOptions& options) {
  constexpr double kSame = 0.05;
  Result<SwingFit> other = FitUndersampled(slow.used, WholeRecording(slow.used), options);
  if (!other || std::abs(other->swing.half_period / slow.swing.half_period - 1) < kSame) return std::nullopt;
  return *std::move(other);
}

bool IsUndersampled(const Recording& recording, const std::optional<Rig>& rig) {
  // Measured for amplitudes from 0.1 to 1.2 rad: with 7.2 samples per period of the reference rig, FindFreeSwings finds
  // 600 of 600 swings. With 6.6 samples it misses 31, with 5.9 samples most of them.
  constexpr double kMinPerPeriod = 7;
  const auto expected = ExpectedFrequency(rig);
  const double rate = SampleRateOf(recording);
  if (expected) return rate < kMinPerPeriod * (1 + kExpectedWithin) * *expected;
  if (rate >= 2 * kFastestHz || AreMaxima(recording)) return false;
  const Result<std::vector<FreeSwing>> swings = FindFreeSwings(recording);
  if (!swings) return SeenPerPeriod(recording) < kSurelyShown;
  return std::ranges::any_of(*swings, [&](const FreeSwing& swing) {
    const double seen = 0.5 / (swing.half_period * recording.clock_scale);
    return rate < kMinPerPeriod * seen || (rate < kSurelyShown * seen && rate - seen <= kFastestHz);
  });
}

FreeSwing WholeRecording(const Recording& recording) {
  FreeSwing swing;
  swing.from = recording.time[0];
  swing.to = recording.time[recording.size() - 1];
  swing.begins = {WindowBegin::Reason::kUndersampled};
  swing.ends = {WindowEnd::Reason::kEndOfRecording};
  swing.undersampled = true;
  return swing;
}

Result<SwingFit> FitUndersampled(Recording recording, FreeSwing swing, const FitOptions& options) {
  if (options.start == StartKind::kRelease) {
    return Error(StatusCode::kFailedPrecondition,
                 "sampled too slowly to find the time of the release; --start moving fits the motion after it");
  }
  ASSIGN_OR_RETURN(Recording used, SelectWindow(std::move(recording), swing.from, swing.to));
  used.warnings.clear();
  if (used.value.maxCoeff() == used.value.minCoeff()) {
    return Error(StatusCode::kFailedPrecondition, "the reading is constant: no swing");
  }
  RemoveHold(used, swing);
  const AllowedFrequencies allowed = FindAllowedFrequencies(used, options);
  FitOptions whole = options;
  whole.start = StartKind::kMoving;
  // The scan finds every start in the range. One start for all aliases would lead to the same alias each time.
  whole.initial.erase(std::string(kInertia.name));
  FitOptions moving = whole;
  moving.interval = IntervalMethod::kCovariance;
  moving.search.max_traces = std::min(options.search.max_traces, kMaxAliasTraces);
  ASSIGN_OR_RETURN(std::vector<Alias> aliases, FitAliases(used, allowed, moving));
  if (aliases.empty()) {
    return Error(StatusCode::kFailedPrecondition, "no pendulum of " + Hz(allowed.range.low / kTurn) + " to " +
                                                      Hz(allowed.range.high / kTurn) +
                                                      " fits the readings; check --rig, or sample faster");
  }
  PreferShown(allowed, SampleRateOf(used), aliases);
  const std::optional<Rejection> rejection = RejectionOf(used, aliases, allowed, moving);
  FitReport fit = aliases.front().fit;
  if (!rejection) {
    whole.search.start_values = aliases.front().start;
    ASSIGN_OR_RETURN(FitReport best, FitRecording(used, whole));
    fit = std::move(best);
  }
  const double frequency = aliases.front().frequency;
  swing.half_period = 0.5 / (frequency * used.clock_scale);
  CompleteReport(used, aliases, allowed, rejection, fit);
  WarnOfSampling(used, frequency, options, fit);
  return SwingFit{std::move(used), std::move(swing), std::move(fit)};
}

}  // namespace pendulum
