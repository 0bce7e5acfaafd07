// SPDX-License-Identifier: Apache-2.0
#include "fitting/swing/disturbed_ends.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

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

}  // namespace

std::vector<std::size_t> TrimCandidates(std::size_t turns) {
  const std::size_t most = std::max<std::size_t>(turns / 4, 1);
  std::vector<std::size_t> steps = {0};
  for (std::size_t k = 1; k < most; k *= 2) steps.push_back(k);
  if (turns >= most + 4) steps.push_back(most);
  return steps;
}

std::vector<double> InnerTurningPoints(const FreeSwing& swing) {
  std::vector<double> turns;
  for (const double turn : swing.turns) {
    if (turn > swing.from + 0.6 * swing.half_period && turn < swing.to) turns.push_back(turn);
  }
  return turns;
}

bool ConstrainsStart(const FitOptions& options) {
  const auto names = [](const auto& map) {
    return std::ranges::any_of(map, [](const auto& entry) {
      return entry.first == kReleaseAngle.name || entry.first == kReleaseTime.name ||
             entry.first == kInitialAngle.name || entry.first == kInitialRate.name;
    });
  };
  return names(options.fixed) || names(options.initial) || names(options.bounds) || names(options.priors);
}

void LeaveOutDisturbedEnds(const Recording& recording, const FitOptions& options, FreeSwing& swing) {
  if (!(swing.half_period > 0)) return;
  if (!swing.from_given && !ConstrainsStart(options)) TrimDisturbedPart(recording, options, false, swing);
  if (!swing.to_given) TrimDisturbedPart(recording, options, true, swing);
}

}  // namespace pendulum
