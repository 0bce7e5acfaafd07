// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit_swing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

/// Every so many-th sample, for fits that only compare windows.
Recording Thinned(Recording recording) {
  constexpr Eigen::Index kMostSamples = 5000;
  const Eigen::Index stride = (recording.size() + kMostSamples - 1) / kMostSamples;
  if (stride <= 1) return recording;
  const Eigen::Index count = (recording.size() + stride - 1) / stride;
  recording.time = recording.time(Eigen::seqN(0, count, stride)).eval();
  recording.value = recording.value(Eigen::seqN(0, count, stride)).eval();
  return recording;
}

/// Fits to parts of one recording by its richest law, compared by what they leave of another part.
class WindowTrials {
 public:
  WindowTrials(const Recording& recording, const FitOptions& options) : recording_(Thinned(recording)) {
    options_.model = options.model == "linear" ? "linear" : "drag";
    options_.start = options.start;
  }

  /// rms over [from, to] of a fit to [begin, end], all in s; infinite when there is none.
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

/// How many turning points may be left out at an edge: none, one, two, four and so on to a quarter of them.
std::vector<std::size_t> Steps(std::size_t turns) {
  std::vector<std::size_t> steps = {0};
  for (std::size_t k = 1; k <= std::max<std::size_t>(turns / 4, 1) && turns >= k + 4; k *= 2) steps.push_back(k);
  return steps;
}

/// The fewest turning points to leave out at an edge such that leaving out more makes the rest fit not much better.
/// window(k) is the window without k of them.
template <typename Window>
std::size_t LeaveOut(WindowTrials& trials, const std::vector<std::size_t>& steps, const Window& window) {
  // No law is exact: a shorter window fits a little better, the more so the shorter it is.
  constexpr double kDisturbed = 1.1;
  constexpr double kInexact = 0.02;  // per turning point
  const auto fits = [&](std::size_t less, std::size_t more) {
    const auto [from, to] = window(less);
    const auto [inner_from, inner_to] = window(more);
    const double allowed = kDisturbed + kInexact * static_cast<double>(more - less - 1);
    return trials.Rms(from, to, inner_from, inner_to) <= allowed * trials.Rms(inner_from, inner_to, inner_from, inner_to);
  };
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const bool enough = std::all_of(steps.begin() + static_cast<std::ptrdiff_t>(i) + 1, steps.end(),
                                    [&](std::size_t more) { return fits(steps[i], more); });
    if (enough) return steps[i];
  }
  return 0;
}

/// Turning points that may begin or end a window: not the hold, nor the first sample.
std::vector<double> InnerTurns(const FreeSwing& swing) {
  std::vector<double> turns;
  for (const double turn : swing.turns) {
    if (turn > swing.from + 0.6 * swing.half_period && turn < swing.to) turns.push_back(turn);
  }
  return turns;
}

/// Leaves out what disturbs the swing at its two ends, unless the user chose them.
void Trim(const Recording& recording, const FitOptions& options, FreeSwing& swing) {
  WindowTrials trials(recording, options);
  const std::vector<double> turns = InnerTurns(swing);
  const std::vector<std::size_t> steps = Steps(turns.size());
  if (!swing.from_given) {
    const std::size_t k = LeaveOut(trials, steps, [&](std::size_t left_out) {
      return std::pair(left_out == 0 ? swing.from : turns[left_out - 1], swing.to);
    });
    if (k > 0) {
      swing.begins = "what is before it does not fit what follows: a hand, or another disturbance";
      swing.from = turns[k - 1];
    }
  }
  if (!swing.to_given) {
    const std::size_t k = LeaveOut(trials, steps, [&](std::size_t left_out) {
      return std::pair(swing.from, left_out == 0 ? swing.to : turns[turns.size() - left_out]);
    });
    if (k > 0) {
      swing.ends = "what follows it does not fit what is before: a hand, or another disturbance";
      swing.to = turns[turns.size() - k];
    }
  }
}

bool Lacks(const FitReport& fit) {
  return std::ranges::any_of(fit.warnings, [](const Warning& warning) { return warning.code == "lack_of_fit"; }) ||
         fit.termination != Termination::kConverged;
}

}  // namespace

Result<SwingFit> FitSwing(const Recording& recording, FreeSwing swing, const FitOptions& options) {
  Result<Recording> used = SelectWindow(recording, swing.from, swing.to);
  if (!used) return tl::unexpected(used.error());
  Result<FitReport> fit = FitRecording(*used, options);
  if (fit && Lacks(*fit)) {
    const FreeSwing whole = swing;
    Trim(*used, options, swing);
    if (swing.from != whole.from || swing.to != whole.to) {
      used = SelectWindow(recording, swing.from, swing.to);
      if (!used) return tl::unexpected(used.error());
      fit = FitRecording(*used, options);
    }
  }
  if (!fit) return tl::unexpected(fit.error());
  return SwingFit{*std::move(used), std::move(swing), *std::move(fit)};
}

}  // namespace pendulum
