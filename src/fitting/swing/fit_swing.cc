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

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/swing/lost_counts.h"
#include "pendulum/fitting/swing/not_a_pendulum.h"
#include "pendulum/fitting/swing/undersampled.h"
#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

/// Limits of the fits that compare windows: samples, samples per half swing, and trajectories.
constexpr Eigen::Index kMaxTrialSamples = 3000;
constexpr double kPerHalfSwing = 12;
constexpr int kMaxTrialTraces = 60;

/// Fits the richest law to windows of one recording, and gives the residuals of these fits in parts of the recording.
class WindowTrials {
 public:
  WindowTrials(Recording recording, const FitOptions& options)
      : recording_(std::move(recording)), options_(TrialOptions(recording_, options, kMaxTrialTraces)) {}

  /// rms of the residuals in [from, to] of a fit to [begin, end], all in s; infinite if there are none.
  double Rms(double begin, double end, double from, double to) {
    const Trial& trial = Fit(begin, end);
    double sum = 0;
    double count = 0;
    for (Eigen::Index i = 0; i < trial.residual.size(); ++i) {
      if (trial.time[i] < from || trial.time[i] > to) continue;
      sum += trial.residual[i] * trial.residual[i];
      ++count;
    }
    return count > 0 ? std::sqrt(sum / count) : kUnbounded;
  }

 private:
  struct Trial {
    double begin, end;
    Eigen::VectorXd time, residual;
  };

  const Trial& Fit(double begin, double end) {
    const auto known =
        std::ranges::find_if(trials_, [&](const Trial& trial) { return trial.begin == begin && trial.end == end; });
    if (known != trials_.end()) return *known;
    Trial trial{begin, end, {}, {}};
    if (const auto part = SelectWindow(recording_, begin, end)) {
      if (auto fit = FitRecording(*part, options_); fit && fit->termination != Termination::kFailed) {
        trial.time = part->time;
        trial.residual = std::move(fit->residual);
      }
    }
    return trials_.emplace_back(std::move(trial));
  }

  Recording recording_;
  FitOptions options_;
  std::vector<Trial> trials_;
};

/// Numbers of turning points that may be left out at one end of a window: 0, 1, 2, 4 and so on, and a quarter of all.
std::vector<std::size_t> TrimCandidates(std::size_t turns) {
  const std::size_t most = std::max<std::size_t>(turns / 4, 1);
  std::vector<std::size_t> steps = {0};
  for (std::size_t k = 1; k < most; k *= 2) steps.push_back(k);
  if (turns >= most + 4) steps.push_back(most);
  return steps;
}

/// The number of turning points to leave out at one end of a window: the smallest number in `steps` for which leaving
/// out more hardly improves the fit of the remaining window. If there is no such number, returns the largest one in
/// `steps`. window(k) gives the window without k turning points.
template <typename Window>
std::size_t CountDisturbedTurningPoints(WindowTrials& trials, const std::vector<std::size_t>& steps,
                                        const Window& window) {
  // No law is exact: the shorter a window is, the better a law fits it.
  constexpr double kAllowedRatio = 1.1;
  constexpr double kAllowedPerTurningPoint = 0.02;
  const auto fits = [&](std::size_t less, std::size_t more) {
    const auto [from, to] = window(less);
    const auto [inner_from, inner_to] = window(more);
    const double allowed = kAllowedRatio + kAllowedPerTurningPoint * static_cast<double>(more - less - 1);
    return trials.Rms(from, to, inner_from, inner_to) <=
           allowed * trials.Rms(inner_from, inner_to, inner_from, inner_to);
  };
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const bool enough = std::all_of(steps.begin() + static_cast<std::ptrdiff_t>(i) + 1, steps.end(),
                                    [&](std::size_t more) { return fits(steps[i], more); });
    if (enough) return steps[i];
  }
  return steps.back();
}

/// Turning points at which a window may begin or end. The hold and the first sample are excluded.
std::vector<double> InnerTurningPoints(const FreeSwing& swing) {
  std::vector<double> turns;
  for (const double turn : swing.turns) {
    if (turn > swing.from + 0.6 * swing.half_period && turn < swing.to) turns.push_back(turn);
  }
  return turns;
}

/// Leaves out a disturbed part at the end of the swing, or at its beginning.
void TrimDisturbedPart(const Recording& recording, const FitOptions& options, bool at_end, FreeSwing& swing) {
  const Recording excerpt = Excerpt(recording, kMaxTrialSamples, kPerHalfSwing / swing.half_period, at_end);
  const double from = excerpt.time[0];
  const double to = excerpt.time[excerpt.size() - 1];
  std::vector<double> turns;
  for (const double turn : InnerTurningPoints(swing)) {
    if (turn > from && turn < to) turns.push_back(turn);
  }
  if (turns.size() < 2) return;
  const auto window = [&](std::size_t k) {
    if (k == 0) return std::pair(from, to);
    return at_end ? std::pair(from, turns[turns.size() - k]) : std::pair(turns[k - 1], to);
  };
  WindowTrials trials(excerpt, options);
  const std::size_t k = CountDisturbedTurningPoints(trials, TrimCandidates(turns.size()), window);
  if (k == 0) return;
  const auto [inner_from, inner_to] = window(k);
  if (at_end) {
    swing.to = inner_to;
    swing.ends = {WindowEnd::Reason::kDisturbed};
  } else {
    swing.from = inner_from;
    swing.begins = {WindowBegin::Reason::kDisturbed};
  }
}

/// Whether the user gave a value, bound or prior for the start of the motion. It refers to the first sample or to the
/// release in the present window, so the window must keep its beginning.
bool ConstrainsStart(const FitOptions& options) {
  const auto names = [](const auto& map) {
    return std::ranges::any_of(map, [](const auto& entry) {
      return entry.first == kReleaseAngle.name || entry.first == kReleaseTime.name ||
             entry.first == kInitialAngle.name || entry.first == kInitialRate.name;
    });
  };
  return names(options.fixed) || names(options.initial) || names(options.bounds) || names(options.priors);
}

/// Leaves out disturbed parts at both ends of the swing, unless the user chose the end.
void Trim(const Recording& recording, const FitOptions& options, FreeSwing& swing) {
  if (!(swing.half_period > 0)) return;
  if (!swing.from_given && !ConstrainsStart(options)) TrimDisturbedPart(recording, options, false, swing);
  if (!swing.to_given) TrimDisturbedPart(recording, options, true, swing);
}

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

Result<SwingFit> FitBetween(Recording recording, const FreeSwing& swing, const FitOptions& options) {
  Result<Recording> used = SelectWindow(std::move(recording), swing.from, swing.to);
  if (!used) return tl::unexpected(used.error());
  used->warnings.clear();
  const std::string turns_message = UnwrapOffset(*used);
  Result<FitReport> fit = FitRecording(*used, options);
  if (!fit) return tl::unexpected(fit.error());
  if (!turns_message.empty()) fit->warnings.push_back({"whole_turns_removed", turns_message});
  SwingFit result{*std::move(used), swing, *std::move(fit)};
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
  fit.warnings.push_back(
      {"larger_motion_outside", "outside the window the motion is " +
                                    NumberText(swing.amplitude_outside / swing.amplitude, 2) +
                                    " times as large as inside, but not a free swing; look at the recording, and "
                                    "choose another window with --from and --to if needed"});
}

/// Marks the fit as not of a pendulum, and removes its errors, which are valid only for a pendulum.
void RejectAsNotAPendulum(const std::string& why, FitReport& fit) {
  fit.termination = Termination::kNotConverged;
  fit.reason = "this is not a free pendulum's swing: " + why;
  fit.warnings.push_back({"not_a_pendulum", fit.reason});
  WithdrawErrors("not a pendulum", fit);
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
  const auto linear = LinearOscillatorReason(result.used, result.fit, stop);
  result.linear_reason = linear.value_or("");
  return linear;
}

// ---- Rescues -------------------------------------------------------------------------------------------------------

/// A fit of a swing, and what the rescues have found so far.
struct SwingState {
  FreeSwing swing;                   ///< The window of the next fit.
  SwingFit result;                   ///< Result of the last fit.
  std::optional<OffsetJumps> jumps;  ///< Jumps of the readings' zero; std::nullopt: not searched or none.
  bool was_trimmed = false;          ///< Disturbed ends were left out.
  bool is_pendulum = true;

  /// Whether the fit leaves more than noise.
  bool IsLacking() const {
    const FitReport& fit = result.fit;
    return fit.termination != Termination::kConverged || fit.HasWarning("lack_of_fit") ||
           fit.HasWarning("correlated_residuals");
  }
  bool HasNewWindow() const { return swing.from != result.swing.from || swing.to != result.swing.to; }
};

/// A rescue of a swing's fit. If it applies, it may change the window, the readings or the verdict.
struct WindowRescue {
  std::string_view name;  ///< As in SolverSummary::attempts.
  bool (*applies)(const SwingState& state);
  Result<bool> (*run)(const FitOptions& options, SwingState& state);  ///< Returns whether the fit has changed.
  bool is_attempt = true;                                             ///< False: it may only reject the fit.
};

bool IsLacking(const SwingState& state) { return state.IsLacking(); }

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

/// If a hand disturbed the beginning or the end of a swing, this part does not fit the remaining swing.
Result<bool> TrimDisturbedEnds(const FitOptions& options, SwingState& state) {
  Trim(state.result.used, options, state.swing);
  if (!state.HasNewWindow()) return false;
  Result<SwingFit> result = FitBetween(std::move(state.result.used), state.swing, options);
  if (!result) return tl::unexpected(result.error());
  state.result = *std::move(result);
  state.was_trimmed = true;
  return true;
}

/// A disturbed end may have hidden jumps inside the window.
bool MayHaveJumpedInside(const SwingState& state) {
  return state.was_trimmed && !(state.jumps && state.jumps->AreCorrected());
}

/// Near a stop of the pendulum the cost may have no minimum; an earlier end of the window may help.
bool MayConvergeWithEarlierEnd(const SwingState& state) {
  return state.result.fit.termination != Termination::kConverged && !state.swing.to_given;
}

Result<bool> TryEarlierEnd(const FitOptions& options, SwingState& state) {
  const double to = state.result.swing.to;
  state.result = EndEarlier(std::move(state.result), options);
  return state.result.swing.to != to;
}

constexpr std::array<WindowRescue, 5> kWindowRescues = {{
    {"offset_jumps", MayHaveJumped, CorrectJumps},
    {"not_a_pendulum", IsLacking, RejectIfNoPendulum, false},
    {"disturbed_ends", IsLacking, TrimDisturbedEnds},
    {"offset_jumps_inside", MayHaveJumpedInside, CorrectJumps},
    {"earlier_end", MayConvergeWithEarlierEnd, TryEarlierEnd},
}};

/// Applies the rescues in order, until the fit leaves only noise or the motion is not a pendulum's.
Result<std::vector<AttemptRecord>> ApplyRescues(const FitOptions& options, SwingState& state) {
  std::vector<AttemptRecord> records;
  for (const WindowRescue& rescue : kWindowRescues) {
    if (!state.is_pendulum || !rescue.applies(state)) continue;
    const Result<bool> changed = rescue.run(options, state);
    if (!changed) return tl::unexpected(changed.error());
    // A check that finds nothing is no attempt.
    if (*changed || rescue.is_attempt) records.push_back({std::string(rescue.name), *changed});
  }
  return records;
}

void AddWarnings(const FitOptions& options, SwingState& state) {
  FitReport& fit = state.result.fit;
  if (state.was_trimmed) {
    fit.warnings.push_back(
        {"ends_trimmed", "disturbed ends were left out, because they do not fit the rest: the window is now " +
                             NumberText(state.result.swing.from, 4) + " s to " + NumberText(state.result.swing.to, 4) +
                             " s; choose another one with --from and --to"});
  }
  WarnOfLargerMotion(state.swing, fit);
  WarnOfOffsetJumps(state.jumps, state.IsLacking(), fit);
  const auto why = state.IsLacking() ? TwoModesReason(state.result.used, fit, options.stop) : std::nullopt;
  if (why) RejectAsNotAPendulum(*why, fit);
}

/// After a stop request the result is meaningless.
Result<SwingFit> FitUnlessStopped(Recording recording, FreeSwing swing, const FitOptions& options) {
  if (swing.undersampled) return FitUndersampled(std::move(recording), std::move(swing), options);
  Result<SwingFit> first = FitBetween(std::move(recording), swing, options);
  if (!first) return first;
  SwingState state{std::move(swing), *std::move(first), std::nullopt};
  const auto records = ApplyRescues(options, state);
  if (!records) return tl::unexpected(records.error());
  if (state.is_pendulum) AddWarnings(options, state);
  std::vector<AttemptRecord>& attempts = state.result.fit.solver.attempts;
  attempts.insert(attempts.begin(), records->begin(), records->end());
  return std::move(state.result);
}

/// Fits a linear oscillator with a linear restoring torque, and says so. If this does not help, the result stays.
void FitAsSpring(const FitOptions& options, Result<SwingFit>& result) {
  const std::optional<std::string> unit = ReasonForUnit(result->used);
  const std::optional<MotionModel> spring = WithGravity(result->fit.model, Gravity::kLinear);
  if (!unit || !spring) return;
  FitOptions linear = options;
  linear.model = spring->name;
  linear.gravity = Gravity::kLinear;
  Result<SwingFit> other = FitUnlessStopped(result->used, result->swing, linear);
  if (!other || other->fit.termination != Termination::kConverged) return;
  const std::string& why = result->linear_reason;
  other->fit.warnings.insert(
      other->fit.warnings.begin(),
      {"linear_restoring_torque",
       "a restoring torque proportional to the angle is assumed, as of a spring or wire (model " + linear.model +
           "; G is its stiffness k), because " + why.substr(0, why.rfind(';')) + ". The readings are in " +
           result->used.unit + ": " + *unit +
           ". For a pendulum give --gravity sin, and correct the unit (--unit, or in the column's name)"});
  result = std::move(other);
}

}  // namespace

Result<SwingFit> FitSwing(Recording recording, FreeSwing swing, const FitOptions& options) {
  Result<SwingFit> result = FitUnlessStopped(std::move(recording), std::move(swing), options);
  if (result && options.may_be_spring && !result->linear_reason.empty()) FitAsSpring(options, result);
  if (options.stop.stop_requested()) return FitStopped();
  return result;
}

}  // namespace pendulum
