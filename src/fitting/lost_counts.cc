// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/lost_counts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/fit_problem.h"
#include "pendulum/fitting/zero_steps.h"

namespace pendulum {
namespace {

using Eigen::Index;

constexpr int kMostSteps = 60;

FitOptions RichestLaw(const Recording& recording, const FitOptions& options) {
  constexpr int kMostTraces = 200;
  FitOptions richest;
  richest.model = "drag";
  if (!recording.is_calibrated()) richest.gravity = Gravity::kLinear;
  richest.start = options.start;
  richest.max_traces = kMostTraces;
  richest.noise = options.loss == Loss::kNone ? NoiseChoice::kGaussian : NoiseChoice::kAuto;
  richest.loss = options.loss;
  richest.interval = IntervalMethod::kCovariance;
  richest.threads = options.threads;
  richest.stop = options.stop;
  return richest;
}

/// What a fit to `corrected` leaves of `recording`, which differs by steps alone.
std::optional<FitResiduals> ResidualsOf(const Recording& recording, const Recording& corrected,
                                        const FitOptions& options) {
  const Result<FitReport> fit = FitRecording(corrected, options);
  if (!fit || fit->termination == Termination::kFailed) return std::nullopt;
  const Result<FitProblem> problem = MakeFitProblem(corrected, AskAlike(*fit, options));
  if (!problem || problem->infos.size() != fit->parameters.size()) return std::nullopt;
  std::vector<double> parameters;
  for (std::size_t i = 0; i < problem->infos.size(); ++i) {
    parameters.push_back(problem->Internal(i, fit->parameters[i].estimate));
  }
  const auto cost = MakeTrajectoryCost(problem->model, problem->start.start, problem->data);
  FitResiduals residuals;
  Eigen::VectorXd readings;
  if (!cost->Readings(parameters, &readings, &residuals.jacobian)) return std::nullopt;
  residuals.time = problem->data.times();
  residuals.residual = recording.value - readings;
  residuals.period = 2 * kPi / problem->start.natural_frequency;
  const Index count = readings.size();
  residuals.rate.resize(count);
  for (Index i = 0; i < count; ++i) {
    const Index a = std::max<Index>(i - 1, 0), b = std::min(i + 1, count - 1);
    residuals.rate[i] = (readings[b] - readings[a]) / (residuals.time[b] - residuals.time[a]);
  }
  return residuals;
}

/// A step as a number of counts.
struct Counts {
  double number = 0, std_error = 0;

  bool IsWhole() const {
    constexpr double kSurely = 0.2;
    constexpr double kWithin = 3.5;
    const double off = std::abs(number - std::round(number));
    return std_error < kSurely && off < std::max(kWithin * std_error, 0.1) && std::round(number) != 0;
  }
};

Counts InCounts(const ZeroStep& step, double resolution) {
  if (!(resolution > 0)) return {};
  return {step.size / resolution, step.std_error / resolution};
}

/// What matters of the steps found: those of a size, and surely.
bool Matters(const ZeroStep& step, double resolution) {
  constexpr double kLeastCount = 0.75;
  constexpr double kSurely = 5;
  return std::abs(step.size) > kSurely * step.std_error && std::abs(step.size) > kLeastCount * resolution;
}

Recording MovedBack(Recording recording, const std::vector<ZeroStep>& steps) {
  for (const ZeroStep& step : steps) {
    const Counts counts = InCounts(step, recording.resolution);
    const double size = counts.IsWhole() ? std::round(counts.number) * recording.resolution : step.size;
    recording.value.tail(recording.size() - step.sample).array() -= size;
  }
  return recording;
}

bool AreAlike(const std::vector<ZeroStep>& a, const std::vector<ZeroStep>& b) {
  return std::ranges::equal(a, b, [](const ZeroStep& one, const ZeroStep& other) {
    return one.sample == other.sample && std::abs(one.size - other.size) < 0.2 * other.std_error;
  });
}

std::string Jumps(const Recording& recording, const std::vector<ZeroStep>& steps) {
  constexpr std::size_t kMostSaid = 5;
  std::string text;
  for (std::size_t k = 0; k < std::min(steps.size(), kMostSaid); ++k) {
    const Counts counts = InCounts(steps[k], recording.resolution);
    const std::string size = counts.IsWhole()
                                 ? NumberText(std::round(counts.number)) + " counts"
                                 : NumberText(steps[k].size, 3) + " " + recording.value_unit();
    text += (k == 0 ? "by " : ", by ") + size + " at " + NumberText(recording.time[steps[k].sample], 6) + " s";
  }
  if (steps.size() > kMostSaid) text += " and " + std::to_string(steps.size() - kMostSaid) + " times more";
  return text;
}

}  // namespace

bool MayJump(const Eigen::VectorXd& residual) {
  constexpr double kDeviations = 4;
  const Index count = residual.size();
  const double mean = residual.mean();
  const double scatter = std::sqrt((residual.array() - mean).square().mean());
  double sum = 0;
  for (Index i = 0; i + 1 < count; ++i) {
    sum += residual[i] - mean;
    const auto before = static_cast<double>(i + 1), after = static_cast<double>(count - i - 1);
    if (std::abs(sum) > kDeviations * scatter * std::sqrt(before * after / static_cast<double>(count))) return true;
  }
  return false;
}

std::optional<ZeroJumps> FindZeroJumps(const Recording& recording, const FitOptions& options) {
  constexpr int kMostRounds = 8;
  if (recording.quantity != Quantity::kAngle) return std::nullopt;
  const FitOptions richest = RichestLaw(recording, options);
  ZeroJumps jumps;
  jumps.corrected = recording;
  std::vector<ZeroStep> steps;
  bool settled = false;
  for (int round = 0; round < kMostRounds && !settled && !options.stop.stop_requested(); ++round) {
    const auto residuals = ResidualsOf(recording, jumps.corrected, richest);
    if (!residuals) return std::nullopt;
    std::vector<ZeroStep> found = FindZeroSteps(*residuals, kMostSteps, options.stop);
    std::erase_if(found, [&](const ZeroStep& step) { return !Matters(step, recording.resolution); });
    settled = AreAlike(found, steps);
    steps = std::move(found);
    jumps.corrected = MovedBack(recording, steps);
    if (getenv("VERBOSE"))
      for (auto& s : steps)
        fprintf(stderr, "ROUND %d t %.5f size %.3f +- %.3f\n", round, recording.time[s.sample],
                s.size / recording.resolution, s.std_error / recording.resolution);
  }
  if (steps.empty() || options.stop.stop_requested()) return std::nullopt;
  const auto is_whole = [&](const ZeroStep& step) { return InCounts(step, recording.resolution).IsWhole(); };
  const std::string found = "the zero jumps " + Jumps(recording, steps);
  if (settled && std::ranges::all_of(steps, is_whole)) {
    for (const ZeroStep& step : steps) {
      const double counts = std::round(InCounts(step, recording.resolution).number);
      jumps.lost.push_back({recording.time[step.sample], static_cast<int>(counts)});
    }
    jumps.message = found +
                    ": counts were lost; the readings after it are moved back by as much, in all that follows and in "
                    "the series";
    return jumps;
  }
  jumps.message = found + ", and not by whole counts: the sensor slipped, or counts were lost that cannot be told; "
                          "choose a window before it or after it with --from and --to";
  return jumps;
}

}  // namespace pendulum
