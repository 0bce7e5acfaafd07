// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/fit_swing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fitting/swing/disturbed_ends.h"
#include "fitting/swing/hold_agreement.h"
#include "fitting/swing/plausible_period.h"
#include "fitting/swing/presliding.h"
#include "fitting/swing/steady_hold.h"
#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/base/rounding.h"
#include "pendulum/base/try.h"
#include "pendulum/closed_form/swing_information.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/swing/lost_counts.h"
#include "pendulum/fitting/swing/not_a_pendulum.h"
#include "pendulum/fitting/swing/undersampled.h"
#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

/// Removes whole turns over the top from the readings, so that the zero angle is near the sensor's zero. Returns a
/// sentence with the number of turns, or an empty one.
std::string UnwrapOffset(Recording& used) {
  if (used.quantity != Quantity::kAngle || !used.is_calibrated()) return "";
  const double mean = used.value.mean();
  const double turns = std::abs(mean) > 1.5 * kPi ? std::round(mean / (2 * kPi)) : 0;
  if (turns == 0) return "";
  used.value.array() -= 2 * kPi * turns;
  if (used.edge) *used.edge -= 2 * kPi * turns;
  if (used.range) used.range = SensorRange{used.range->low - 2 * kPi * turns, used.range->high - 2 * kPi * turns};
  if (used.calibration) used.calibration->coefficients[0] -= 2 * kPi * turns / used.calibration->RadFromUnit();
  return NumberText(turns) +
         " whole turns were subtracted from the readings, so the zero refers to the turn in which the pendulum swings";
}

Result<SwingFit> FitBetween(Recording recording, const FreeSwing& swing, FitOptions options) {
  ASSIGN_OR_RETURN(Recording used, SelectWindow(std::move(recording), swing.from, swing.to));
  used.warnings.clear();
  const std::string turns_message = UnwrapOffset(used);
  if (swing.vibration) options.search.vibration_period = used.clock_scale / swing.vibration->frequency;
  Result<FitReport> fit = FitRecording(used, options);
  if (!fit) return tl::unexpected(fit.error());
  if (!turns_message.empty()) fit->warnings.push_back({"whole_turns_removed", turns_message});
  SwingFit result{std::move(used), swing, *std::move(fit)};
  // The fit decides how the swing began.
  const bool released = result.fit.start == StartKind::kRelease;
  WindowBegin::Reason& begins = result.swing.begins.reason;
  if (released && begins == WindowBegin::Reason::kInMotion) begins = WindowBegin::Reason::kHeld;
  if (!released && swing.begins.reason == WindowBegin::Reason::kHeld) begins = WindowBegin::Reason::kReleaseNotUsed;
  return result;
}

/// Ends the window earlier until the fit converges. Near a stop of the pendulum the cost may have no minimum.
SwingFit EndEarlier(SwingFit result, const FitOptions& options) {
  const std::vector<double> turns = InnerTurningPoints(result.swing);
  const Recording thinned =
      Thinned(result.used,
              std::max(kMaxTrialSamples, static_cast<Eigen::Index>(kPerHalfSwing * static_cast<double>(turns.size()))));
  FitOptions quick = options;
  quick.search.max_traces = 5 * kMaxTrialTraces;
  if (!IsRobust(quick.noise)) quick.noise = NoiseFamily::kGaussian;
  quick.interval = IntervalMethod::kCovariance;
  const auto converges = [](const Result<SwingFit>& trial) {
    return trial && trial->fit.termination == Termination::kConverged;
  };
  for (const std::size_t k : TrimCandidates(turns.size())) {
    if (k == 0) continue;
    FreeSwing shorter = result.swing;
    shorter.to = turns[turns.size() - k];
    shorter.ends = {WindowEnd::Reason::kNotConverging};
    if (!converges(FitBetween(thinned, shorter, quick))) continue;
    if (Result<SwingFit> trial = FitBetween(result.used, shorter, options); converges(trial)) return *std::move(trial);
  }
  return result;
}

/// If the motion outside the window is larger, the swing may be only the quiet end of another motion.
void WarnOfLargerMotion(const FreeSwing& swing, FitReport& fit) {
  constexpr double kLarger = 1.3;
  if (!(swing.amplitude_outside > kLarger * swing.amplitude)) return;
  fit.warnings.push_back({.code = "larger_motion_outside",
                          .finding = "outside the window the motion is " +
                                     NumberText(swing.amplitude_outside / swing.amplitude, 2) +
                                     " times as large as inside, but not a free swing",
                          .advice = "look at the recording, and choose another window with --from and --to if needed",
                          .flags = {"from", "to"}});
}

void WarnOfVibration(const Recording& used, const Vibration& vibration, FitReport& fit) {
  fit.warnings.push_back({.code = "vibration",
                          .finding = "a faster vibration of " + NumberText(vibration.frequency / used.clock_scale, 2) +
                                     " Hz, " + NumberText(vibration.amplitude, 2) + " " + used.value_unit() +
                                     " in size, lies over the swing",
                          .explanation = "it is treated as noise",
                          .advice = "damp it, or choose a window without it with --from and --to",
                          .flags = {"from", "to"}});
}

/// Marks the fit as not of a pendulum, and removes its errors, which are valid only for a pendulum.
void RejectAsNotAPendulum(const std::string& why, FitReport& fit) {
  RejectFor(Termination::kNotConverged, {"not_a_pendulum", "this is not a free pendulum's swing: " + why},
            "not a pendulum", fit);
}

/// If the number of counts lost at a jump is uncertain, ends the window before that jump. At least half of the window
/// must remain, and all losses in it must be certain.
void EndBeforeUncertainJump(const FitOptions& options, FreeSwing& swing, SwingFit& result, OffsetJumps& jumps) {
  constexpr int kMaxTrials = 6;
  constexpr double kMinLength = 0.5, kStep = 0.05;  // of the window
  FreeSwing shorter = swing;
  std::optional<double> uncertain = jumps.uncertain_from;
  const double length = swing.to - swing.from;
  for (int trial = 0; trial < kMaxTrials && uncertain; ++trial) {
    shorter.to = std::min(std::nexttoward(*uncertain, swing.from), shorter.to - kStep * length);
    shorter.ends = {WindowEnd::Reason::kCountsLost};
    if (shorter.to - swing.from < kMinLength * length) return;
    Result<SwingFit> part = FitBetween(result.used, shorter, options);
    std::optional<OffsetJumps> found = part ? FindOffsetJumps(part->used, options) : std::nullopt;
    if (!found) return;
    uncertain = found->uncertain_from;
    if (uncertain) continue;
    swing = shorter;
    result = *std::move(part);
    jumps = *std::move(found);
  }
}

/// Shifts the readings after lost counts back and fits them again. Returns the jumps that were found.
std::optional<OffsetJumps> CorrectOffset(FreeSwing& swing, const FitOptions& options, Result<SwingFit>& result) {
  std::optional<OffsetJumps> jumps = FindOffsetJumps(result->used, options);
  if (jumps && !swing.to_given) EndBeforeUncertainJump(options, swing, *result, *jumps);
  if (jumps && jumps->AreCorrected()) result = FitBetween(std::exchange(jumps->corrected, {}), swing, options);
  return jumps;
}

std::optional<std::string> NotAPendulumReason(SwingFit& result, const std::stop_token& stop) {
  if (result.swing.has_beats) return "its amplitude grows repeatedly, as in coupled pendulums";
  const auto linear = FindLinearMotion(result.used, result.fit, stop);
  if (!linear) return std::nullopt;
  result.linear_reason = linear->why;
  return linear->why + "; " + linear->advice;
}

/// Whether a fit does not converge, or leaves more than noise.
bool LeavesMoreThanNoise(const FitReport& fit) {
  return fit.termination != Termination::kConverged || fit.HasWarning("lack_of_fit") ||
         fit.HasWarning("correlated_residuals");
}

// ---- Rescues -------------------------------------------------------------------------------------------------------

/// A fit of a swing, and what the rescues have found so far.
struct SwingState {
  FreeSwing swing;                   ///< The window of the next fit.
  SwingFit result;                   ///< Result of the last fit.
  std::optional<OffsetJumps> jumps;  ///< Jumps of the readings' zero; std::nullopt: not searched or none.
  bool was_trimmed = false;          ///< Disturbed ends were left out.
  /// Small swings that friction makes faster, which explains a lack of fit. They were left out if that improved the
  /// fit and the user did not choose the end.
  std::optional<Presliding> presliding = std::nullopt;
  bool is_pendulum = true;
  /// How the hold disagrees with the swing; it was left out if the user did not ask for it.
  std::optional<HoldDisagreement> hold = std::nullopt;

  bool IsLacking() const { return LeavesMoreThanNoise(result.fit); }
  bool HasNewWindow() const { return swing.from != result.swing.from || swing.to != result.swing.to; }
};

/// A rescue of a swing's fit. If it applies, it may change the window, the readings or the verdict.
struct WindowRescue {
  std::string_view name;  ///< As in SolverSummary::attempts.
  bool (*applies)(const SwingState& state);
  Result<bool> (*run)(const FitOptions& options, SwingState& state);  ///< Returns whether the fit has changed.
  bool is_attempt = true;  ///< False: it is recorded only if it changed the fit.
};

bool IsLacking(const SwingState& state) { return state.IsLacking(); }

// ---- The hold -------------------------------------------------------------------------------------------------------

/// Whether the hold may disturb a fit that begins with a release: its residuals suggest a hand that moved or pushed,
/// and the readings were not corrected for it, or the law does not describe them.
bool HoldMayDisturb(const SwingState& state) {
  const FitReport& fit = state.result.fit;
  if (fit.start != StartKind::kRelease || fit.termination != Termination::kConverged) return false;
  const auto of_hand = [](const Suspicion& suspicion) {
    return suspicion.cause == Cause::kHold || suspicion.cause == Cause::kPush;
  };
  const auto named = std::ranges::find_if(fit.suspicions, of_hand);
  if (named != fit.suspicions.end()) return !named->is_corrected;
  return fit.HasWarning("lack_of_fit");
}

/// The swing without its hold, and without the first motion, during which a finger may still have touched it.
FreeSwing WithoutHold(const SwingFit& result) {
  constexpr double kTouched = 0.1;  // half periods
  const double release = result.fit.Find(kReleaseTime.name)->estimate;
  FreeSwing moving = result.swing;
  moving.from = std::max(moving.after_hold, release + kTouched * moving.half_period);
  moving.begins = {WindowBegin::Reason::kHoldDisagrees};
  return moving;
}

/// Whether a disagreement of the hold is more than the misfit of a law that does not describe the swing either.
bool ExceedsMisfit(const HoldDisagreement& hold, const FitReport& fit) {
  constexpr double kFar = 3;
  const double misfit = fit.HasWarning("lack_of_fit") ? kFar * fit.statistics.rms_residual : 0;
  return std::abs(hold.offset) > misfit || std::abs(hold.creep) > misfit;
}

/// A hand may hold the pendulum at another angle before it lets go, or push it. Such a hold says only that the swing
/// begins after it.
Result<bool> LeaveOutHold(const FitOptions& options, SwingState& state) {
  const std::optional<HoldDisagreement> hold = FindHoldDisagreement(state.result.used, state.result.fit, options);
  if (!hold) return false;
  if (options.start || state.swing.from_given || ConstrainsStart(options)) {
    if (ExceedsMisfit(*hold, state.result.fit)) state.hold = hold;
    return false;
  }
  const FreeSwing moving = WithoutHold(state.result);
  Result<SwingFit> result = FitBetween(state.result.used, moving, options);
  const bool is_better = result && result->fit.termination == Termination::kConverged &&
                         result->fit.start == StartKind::kMoving && ExceedsMisfit(*hold, result->fit);
  if (!is_better) return false;
  state.hold = hold;
  state.swing = moving;
  state.result = *std::move(result);
  return true;
}

// ---- The window and the readings ------------------------------------------------------------------------------------

/// Lost counts shift the zero in steps, so the residuals are more than noise.
bool MayHaveJumped(const SwingState& state) { return state.IsLacking() || MayHaveOffsetJump(state.result.fit); }

Result<bool> CorrectJumps(const FitOptions& options, SwingState& state) {
  Result<SwingFit> result = std::move(state.result);
  const double from = result->swing.from, to = result->swing.to;
  state.jumps = CorrectOffset(state.swing, options, result);
  if (!result) return tl::unexpected(result.error());
  state.result = *std::move(result);
  return (state.jumps && state.jumps->AreCorrected()) || state.result.swing.from != from || state.result.swing.to != to;
}

Result<bool> RejectIfNoPendulum(const FitOptions& options, SwingState& state) {
  const auto why = NotAPendulumReason(state.result, options.stop);
  if (why) RejectAsNotAPendulum(*why, state.result.fit);
  state.is_pendulum = !why;
  return why.has_value();
}

/// Small swings to which the law does not apply would otherwise outweigh the large ones.
Result<bool> LeaveOutPresliding(const FitOptions& options, SwingState& state) {
  constexpr double kBetter = 0.9;
  state.presliding = FindPresliding(state.result.used, state.result.fit.model.gravity);
  if (!state.presliding || state.swing.to_given) return false;
  FreeSwing shorter = state.swing;
  shorter.to = state.presliding->from;
  shorter.ends = {WindowEnd::Reason::kPresliding};
  ASSIGN_OR_RETURN(SwingFit result, FitBetween(state.result.used, shorter, options));
  const Eigen::VectorXd former = state.result.fit.residual.head(result.used.size());
  const bool is_better = result.fit.residual.norm() < kBetter * former.norm();
  if (!is_better && state.result.fit.termination == Termination::kConverged) return false;
  state.swing = shorter;
  state.result = std::move(result);
  return true;
}

bool MayBeDisturbed(const SwingState& state) { return state.IsLacking() && !state.presliding; }

/// The options, with inertia and friction of a fit as start values, unless the user gives them.
FitOptions StartingFrom(const FitReport& fit, FitOptions options) {
  const std::size_t physical = PhysicalParameters(fit.model).size();
  for (std::size_t i = 0; i < physical; ++i) {
    const ParameterEstimate& parameter = fit.parameters[i];
    if (!parameter.fixed) options.initial.emplace(parameter.info.name, parameter.estimate);
  }
  return options;
}

/// If a hand disturbed the beginning or the end of a swing, this part does not fit the remaining swing. But the search
/// may have missed estimates that describe the whole swing, as near a stop, where the likelihood has many maxima; those
/// of the remaining swing are a better start.
Result<bool> TrimDisturbedEnds(const FitOptions& options, SwingState& state) {
  const FreeSwing whole = state.swing;
  LeaveOutDisturbedEnds(state.result.used, options, state.swing);
  if (!state.HasNewWindow()) return false;
  ASSIGN_OR_RETURN(SwingFit result, FitBetween(state.result.used, state.swing, options));
  if (result.fit.termination == Termination::kConverged) {
    Result<SwingFit> again = FitBetween(std::move(state.result.used), whole, StartingFrom(result.fit, options));
    if (again && !LeavesMoreThanNoise(again->fit)) {
      state.swing = whole;
      state.result = *std::move(again);
      return true;
    }
  }
  state.result = std::move(result);
  state.was_trimmed = true;
  return true;
}

/// A disturbed end may have hidden jumps inside the window.
bool MayHaveJumpedInside(const SwingState& state) {
  return state.was_trimmed && !(state.jumps && state.jumps->AreCorrected());
}

/// A disturbed end, such as a push by hand, may have hidden that the motion is no pendulum's.
bool MayBeNoPendulumInside(const SwingState& state) { return state.was_trimmed && state.IsLacking(); }

/// Near a stop of the pendulum the cost may have no minimum; an earlier end of the window may help.
bool MayConvergeWithEarlierEnd(const SwingState& state) {
  return state.result.fit.termination != Termination::kConverged && !state.swing.to_given;
}

Result<bool> TryEarlierEnd(const FitOptions& options, SwingState& state) {
  const double to = state.result.swing.to;
  state.result = EndEarlier(std::move(state.result), options);
  return state.result.swing.to != to;
}

constexpr std::array<WindowRescue, 8> kWindowRescues = {{
    {"hold_left_out", HoldMayDisturb, LeaveOutHold, false},
    {"offset_jumps", MayHaveJumped, CorrectJumps},
    {"not_a_pendulum", IsLacking, RejectIfNoPendulum, false},
    {"presliding", IsLacking, LeaveOutPresliding, false},
    {"disturbed_ends", MayBeDisturbed, TrimDisturbedEnds},
    {"offset_jumps_inside", MayHaveJumpedInside, CorrectJumps},
    {"not_a_pendulum_inside", MayBeNoPendulumInside, RejectIfNoPendulum, false},
    {"earlier_end", MayConvergeWithEarlierEnd, TryEarlierEnd},
}};

/// Applies the rescues in order, until the fit leaves only noise or the motion is not a pendulum's.
Result<std::vector<AttemptRecord>> ApplyRescues(const FitOptions& options, SwingState& state) {
  std::vector<AttemptRecord> records;
  for (const WindowRescue& rescue : kWindowRescues) {
    if (!state.is_pendulum || !rescue.applies(state)) continue;
    ASSIGN_OR_RETURN(const bool changed, rescue.run(options, state));
    // A check that finds nothing is no attempt.
    if (changed || rescue.is_attempt) records.push_back({std::string(rescue.name), changed});
  }
  return records;
}

void WarnOfHold(const HoldDisagreement& hold, const Recording& used, FitReport& fit) {
  const std::string why = Sentence(hold, used) + ": the hand moved, or pushed or braked the pendulum at the release";
  if (fit.start == StartKind::kRelease) {
    fit.warnings.push_back({.code = "hold_disagrees",
                            .finding = "the hold does not agree with the swing: " + why,
                            .explanation = "the hold affects all estimates",
                            .advice = "leave it out with --start moving and --from after the release",
                            .flags = {"start", "from"}});
    return;
  }
  fit.warnings.push_back({"hold_left_out", "the hold before the release was left out: " + why});
}

void AddWarnings(const FitOptions& options, SwingState& state) {
  FitReport& fit = state.result.fit;
  if (state.hold) WarnOfHold(*state.hold, state.result.used, fit);
  if (state.was_trimmed) {
    const auto [from, to] = SpanTexts(state.result.swing.from, state.result.swing.to);
    fit.warnings.push_back(
        {.code = "ends_trimmed",
         .finding = "disturbed ends were left out, because they do not fit the rest: the window is now " + from +
                    " s to " + to + " s",
         .advice = "choose another one with --from and --to",
         .flags = {"from", "to"}});
  }
  if (state.presliding) {
    fit.warnings.push_back(WarningOf(*state.presliding, state.result.used.value_unit(),
                                     state.swing.ends.reason == WindowEnd::Reason::kPresliding));
  }
  WarnOfLargerMotion(state.swing, fit);
  if (const auto assumed = AssumedFrequency(state.result.used, state.swing.half_period, options)) {
    fit.warnings.push_back(*assumed);
  }
  WarnOfOffsetJumps(state.jumps, state.IsLacking(), fit);
  if (state.swing.vibration) WarnOfVibration(state.result.used, *state.swing.vibration, fit);
  const bool is_explained = state.swing.vibration || state.presliding;
  const auto why =
      state.IsLacking() && !is_explained ? TwoModesReason(state.result.used, fit, options.stop) : std::nullopt;
  if (why) RejectAsNotAPendulum(*why, fit);
}

/// A release that the user asks for needs the hold, even if it seems unsteady.
void KeepRequestedHold(const FitOptions& options, FreeSwing& swing) {
  const bool is_requested = options.start == StartKind::kRelease && !swing.from_given;
  if (!is_requested || !(swing.hold_from < swing.hold_to)) return;
  swing.from = swing.hold_from;
  swing.begins = {WindowBegin::Reason::kHeld};
}

/// Whether a hold was left out as unsteady, but the noise of the swing may show that it is steady.
bool MayUseHold(const FitOptions& options, const SwingState& state) {
  const FreeSwing& swing = state.result.swing;
  return swing.begins.reason == WindowBegin::Reason::kUnsteadyHold && !options.start && !ConstrainsStart(options) &&
         state.result.fit.termination == Termination::kConverged &&
         state.result.used.quantity != Quantity::kAcceleration && !(state.jumps && state.jumps->AreCorrected());
}

/// Fits the swing with its hold, if that is as steady as the swing. recording: with the hold.
void FitWithHold(const Recording& recording, const FitOptions& options, SwingState& state) {
  const std::optional<FreeSwing> held = WithSteadyHold(recording, state.result.swing, state.result.fit.noise.sigma);
  if (!held) return;
  Result<SwingFit> released = FitBetween(recording, *held, options);
  const bool is_released =
      released && released->fit.termination == Termination::kConverged && released->fit.start == StartKind::kRelease;
  if (!is_released || FindHoldDisagreement(released->used, released->fit, options)) return;
  state.swing = released->swing;
  state.result = *std::move(released);
}

/// With few samples, a fast swing may look like a slow one, whose law it does not follow.
bool MayBeFaster(const FitOptions& options, const SwingState& state) {
  return state.IsLacking() && AssumedFrequency(state.result.used, state.swing.half_period, options);
}

// ---- Other kinds of motion or of readings ---------------------------------------------------------------------------

/// Fits a linear oscillator with a linear restoring torque, and says so. If this does not help, the result stays.
/// recording, swing: as they were before the first fit, which may have changed readings and window.
void FitAsSpring(Recording recording, const FreeSwing& swing, const FitOptions& options, SwingFit& result) {
  if (result.linear_reason.empty()) return;
  const std::optional<std::string> unit = ReasonForUnit(result.used);
  const std::optional<MotionModel> spring = WithGravity(result.fit.model, Gravity::kLinear);
  if (!unit || !spring) return;
  FitOptions linear = options;
  linear.model = spring->name;
  linear.gravity = Gravity::kLinear;
  linear.may_be_spring = false;
  Result<SwingFit> other = FitSwing(std::move(recording), swing, linear);
  if (!other || other->fit.termination != Termination::kConverged) return;
  other->fit.warnings.insert(
      other->fit.warnings.begin(),
      {.code = "linear_restoring_torque",
       .finding = "a restoring torque proportional to the angle is assumed, as of a spring or wire (law " +
                  linear.model + ", where G is the stiffness k)",
       .explanation =
           "the reason: " + result.linear_reason + "; the readings are in " + result.used.unit + ": " + *unit,
       .advice = "for a pendulum, give --gravity sin and correct the unit (--unit, or in the column's name)",
       .flags = {"gravity", "unit"},
       .assumed = "the restoring torque of a spring (--gravity sin for a pendulum)"});
  result = *std::move(other);
}

/// Whether an accelerometer's readings decide that `other`, which contains gravity where `first` does not or the
/// reverse, is right: it describes at least as many of them, and better.
bool IsBetterAcceleration(const SwingFit& other, const SwingFit& first) {
  constexpr double kBetter = 0.8;
  const bool is_described = other.fit.termination == Termination::kConverged && !other.fit.HasWarning("lack_of_fit");
  if (!is_described || other.used.size() < first.used.size()) return false;
  return !LeavesMoreThanNoise(other.fit) ||
         other.fit.statistics.rms_residual < kBetter * first.fit.statistics.rms_residual;
}

/// Whether the readings contradict a fit. One that is not identifiable may describe them: without friction an
/// accelerometer across the rod shows the same with gravity as without it, at another radius (MODEL.md eq. (14.6)).
bool IsContradicted(const FitReport& fit) {
  if (fit.termination == Termination::kNotIdentifiable) return fit.HasWarning("lack_of_fit");
  return LeavesMoreThanNoise(fit);
}

/// Fits an acceleration whose name says wrongly whether it contains gravity. If this does not help, the result stays.
/// recording, swing: as for FitAsSpring.
void FitWithOtherGravity(Recording recording, const FreeSwing& swing, FitOptions options, SwingFit& result) {
  if (!IsContradicted(result.fit)) return;
  recording.shows_gravity = !recording.shows_gravity;
  const bool is_shown = recording.shows_gravity;
  options.search.may_doubt_gravity = false;
  Result<SwingFit> other = FitSwing(std::move(recording), swing, options);
  if (!other || !IsBetterAcceleration(*other, result)) return;
  const std::string says = is_shown ? "that gravity was removed" : "nothing of gravity being removed";
  other->fit.warnings.insert(
      other->fit.warnings.begin(),
      {.code = "gravity_in_readings",
       .finding = "the readings fit only if the acceleration " +
                  std::string(is_shown ? "contains gravity" : "is one without gravity") + ", but its name says " + says,
       .explanation = "they were fitted so",
       .advice = std::string("correct the name (") + (is_shown ? "Acceleration" : "Linear Acceleration") + ")"});
  result = *std::move(other);
}

bool MayHaveOtherGravity(const Recording& recording, const FitOptions& options) {
  return recording.quantity == Quantity::kAcceleration && options.search.may_doubt_gravity;
}

bool MayBeSpring(const Recording& recording, const FitOptions& options) {
  return recording.quantity != Quantity::kAcceleration && options.may_be_spring && ReasonForUnit(recording);
}

/// Whether the recording as it was before the first fit may be needed.
bool MayBeFittedAgain(const Recording& recording, const FreeSwing& swing, const FitOptions& options) {
  return swing.begins.reason == WindowBegin::Reason::kUnsteadyHold || MayHaveOtherGravity(recording, options) ||
         MayBeSpring(recording, options);
}

}  // namespace

Result<void> CheckSwing(const Recording& recording, const FreeSwing& swing, const FitOptions& options) {
  if (const auto why = ImplausiblePeriodReason(recording, swing, options)) {
    return Error(StatusCode::kFailedPrecondition, *why);
  }
  if (swing.undersampled) return {};
  ASSIGN_OR_RETURN(const Recording used, SelectWindow(recording, swing.from, swing.to));
  return CheckReadings(used, options);
}

Result<SwingFit> FitSwing(Recording recording, FreeSwing swing, const FitOptions& options) {
  if (const auto why = ImplausiblePeriodReason(recording, swing, options)) {
    return Error(StatusCode::kFailedPrecondition, *why);
  }
  KeepRequestedHold(options, swing);
  std::optional<Recording> original;
  if (MayBeFittedAgain(recording, swing, options)) original = recording;
  ASSIGN_OR_RETURN(SwingFit first, swing.undersampled ? FitUndersampled(std::move(recording), swing, options)
                                                      : FitBetween(std::move(recording), swing, options));
  SwingState state{swing, std::move(first), std::nullopt};
  SwingFit& result = state.result;
  if (!swing.undersampled && MayBeFaster(options, state)) {
    if (std::optional<SwingFit> faster = FitFasterAlias(result, options)) result = *std::move(faster);
  }
  if (!result.swing.undersampled) {
    ASSIGN_OR_RETURN(const auto records, ApplyRescues(options, state));
    if (original && MayUseHold(options, state)) FitWithHold(*original, options, state);
    if (state.is_pendulum) AddWarnings(options, state);
    std::vector<AttemptRecord>& attempts = result.fit.solver.attempts;
    attempts.insert(attempts.begin(), records.begin(), records.end());
  }
  if (original && MayHaveOtherGravity(*original, options)) {
    FitWithOtherGravity(*std::move(original), swing, options, result);
  } else if (original && MayBeSpring(*original, options)) {
    FitAsSpring(*std::move(original), swing, options, result);
  }
  if (options.stop.stop_requested()) return FitStopped();
  result.swing.left_out = LeftOutOf(swing, result.swing.from, result.swing.to);
  return std::move(state.result);
}

}  // namespace pendulum
