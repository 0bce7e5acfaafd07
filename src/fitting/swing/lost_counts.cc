// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/lost_counts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/likelihood/edge_noise.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/swing/edge_steps.h"
#include "pendulum/fitting/swing/zero_steps.h"

namespace pendulum {
namespace {

using Eigen::Index;

constexpr int kMostJumps = 60;
constexpr int kMostStepTraces = 200;

/// The residuals of the original readings about a fit to the corrected readings.
struct Left {
  double rms = 0;
  bool lacks = false;  // more misfit than noise
  FitResiduals residuals;
};

/// Computes the residuals of the recording at these parameters. Returns false if the trajectory cannot be computed.
bool LeaveOver(const Recording& recording, const FitProblem& problem, const TrajectoryCost& cost,
               const std::vector<double>& parameters, FitResiduals& residuals) {
  Eigen::VectorXd readings;
  if (!cost.Readings(parameters, &readings, &residuals.jacobian)) return false;
  residuals.time = problem.data.times();
  residuals.residual = recording.value - readings;
  residuals.rate = RatesOf(residuals.time, readings);
  residuals.period = 2 * kPi / problem.start.natural_frequency;
  return true;
}

/// Moves the parameters to the least-squares fit of the edges within runs, regardless of the counts between runs. Uses
/// Gauss-Newton steps, halved until the sum decreases.
void SettleWithinRuns(const Recording& edges, const FitProblem& problem, const TrajectoryCost& cost,
                      std::vector<double> parameters, FitResiduals& residuals) {
  constexpr int kMostSteps = 12, kMostHalves = 5;
  constexpr double kSame = 1e-3;  // of the rms
  RunRegression now = RegressWithinRuns(residuals, edges);
  for (int step = 0, halves = 0; step < kMostSteps && halves < kMostHalves; ++step) {
    std::vector<double> there = parameters;
    // Bounds are ignored: they would restrict the other parameters, and this result is not an estimate.
    for (std::size_t i = 0; i < there.size(); ++i) there[i] += now.change[static_cast<Index>(i)];
    FitResiduals left;
    const bool traced = LeaveOver(edges, problem, cost, there, left);
    RunRegression next = traced ? RegressWithinRuns(left, edges) : now;
    if (!traced || !(next.rms < now.rms)) {
      now.change *= 0.5;
      ++halves;
      continue;
    }
    const bool is_same = next.rms > (1 - kSame) * now.rms;
    parameters = std::move(there);
    residuals = std::move(left);
    now = std::move(next);
    halves = 0;
    if (is_same) return;
  }
}

std::optional<Left> FitCorrected(const Recording& recording, const Recording& corrected, const FitOptions& options) {
  const Result<FitReport> fit = FitRecording(corrected, options);
  if (!fit || fit->termination == Termination::kFailed) return std::nullopt;
  const Result<FitProblem> problem = MakeFitProblem(corrected, OptionsLike(*fit, options));
  if (!problem || problem->infos.size() != fit->parameters.size()) return std::nullopt;
  std::vector<double> parameters;
  for (std::size_t i = 0; i < problem->infos.size(); ++i) {
    parameters.push_back(problem->Internal(i, fit->parameters[i].estimate));
  }
  const auto cost = MakeTrajectoryCost(problem->model, problem->start.start, problem->data);
  Left left{fit->statistics.rms_residual, fit->Warns("lack_of_fit") || fit->Warns("correlated_residuals"), {}};
  if (!LeaveOver(recording, *problem, *cost, parameters, left.residuals)) return std::nullopt;
  if (recording.edge) SettleWithinRuns(recording, *problem, *cost, std::move(parameters), left.residuals);
  return left;
}

/// A step as a number of counts.
struct StepInCounts {
  double number = 0, std_error = 0;

  bool IsWhole() const {
    constexpr double kSurely = 0.2;
    constexpr double kWithin = 3.5;
    const double off = std::abs(number - std::round(number));
    return std_error < kSurely && off < std::max(kWithin * std_error, 0.1) && std::round(number) != 0;
  }
};

/// Not a whole number without a resolution, or with a range, which would have to shift with the readings.
StepInCounts InCounts(const ZeroStep& step, const Recording& recording) {
  if (!(recording.resolution > 0) || recording.range) return {};
  return {step.size / recording.resolution, step.std_error / recording.resolution};
}

/// Whether a step is larger than the rounding of readings or numbers.
bool Matters(const ZeroStep& step, const Recording& recording) {
  constexpr double kLeastCount = 0.75;
  constexpr double kSurely = 5;
  constexpr double kRounding = 1e-6;
  const double range = recording.value.maxCoeff() - recording.value.minCoeff();
  const double least = std::max({kSurely * step.std_error, kLeastCount * recording.resolution, kRounding * range});
  return std::abs(step.size) > least;
}

Recording MovedBack(Recording recording, const std::vector<ZeroStep>& steps) {
  for (const ZeroStep& step : steps) {
    const StepInCounts counts = InCounts(step, recording);
    const double size = counts.IsWhole() ? std::round(counts.number) * recording.resolution : step.size;
    recording.value.tail(recording.size() - step.sample).array() -= size;
  }
  return recording;
}

bool AreSame(const ZeroStep& one, const ZeroStep& other) {
  return one.sample == other.sample && std::abs(one.size - other.size) < 0.2 * other.std_error;
}

/// The first sample at which two searches disagree or a step is not a whole number of counts; std::nullopt if there is
/// none.
std::optional<Index> FirstDoubtful(const Recording& recording, const std::vector<ZeroStep>& before,
                                   const std::vector<ZeroStep>& now) {
  std::optional<Index> first;
  const auto look = [&](const std::vector<ZeroStep>& steps, const std::vector<ZeroStep>& others) {
    for (const ZeroStep& step : steps) {
      const bool agrees = std::ranges::any_of(others, [&](const ZeroStep& other) { return AreSame(step, other); });
      if (agrees && InCounts(step, recording).IsWhole()) continue;
      first = std::min(first.value_or(step.sample), step.sample);
    }
  };
  look(now, before);
  look(before, now);
  return first;
}

std::string SizeText(const Recording& recording, const ZeroStep& step) {
  const StepInCounts counts = InCounts(step, recording);
  if (!counts.IsWhole()) {
    return NumberText(step.size, 3) + " +- " + NumberText(step.std_error, 2) + " " + recording.value_unit();
  }
  const double whole = std::round(counts.number);
  return NumberText(whole) + (std::abs(whole) == 1 ? " count" : " counts");
}

/// "by 3 counts at 12.34 s, by ...".
std::string Jumps(const Recording& recording, const std::vector<ZeroStep>& steps) {
  constexpr std::size_t kMostSaid = 5;
  std::string text;
  for (std::size_t k = 0; k < std::min(steps.size(), kMostSaid); ++k) {
    text += (k == 0 ? "by " : ", by ") + SizeText(recording, steps[k]) + " at " +
            NumberText(recording.time[steps[k].sample], 6) + " s";
  }
  if (steps.size() > kMostSaid) text += " and " + std::to_string(steps.size() - kMostSaid) + " times more";
  return text;
}

}  // namespace

bool MayJump(const FitReport& fit) {
  constexpr double kDeviations = 4;
  constexpr double kLeastCount = 0.4;
  constexpr double kRounding = 1e-9;  // of the swing: rounding errors of the numbers, not of a model
  const Index count = fit.residual.size();
  if (fit.quantity != Quantity::kAngle || count < 2) return false;
  const double mean = fit.residual.mean();
  const double scatter = std::sqrt((fit.residual.array() - mean).square().mean());
  if (!(scatter > kRounding * (fit.fitted.maxCoeff() - fit.fitted.minCoeff()))) return false;
  double sum = 0;
  for (Index i = 0; i + 1 < count; ++i) {
    sum += fit.residual[i] - mean;
    const auto before = static_cast<double>(i + 1), after = static_cast<double>(count - i - 1);
    const double weight = before * after / static_cast<double>(count);
    // With very little noise, readings repeat the same rounding error throughout a hold.
    const double least = std::max(kDeviations * scatter / std::sqrt(weight), kLeastCount * fit.noise.resolution);
    if (std::abs(sum) > least * weight) return true;
  }
  return false;
}

namespace {

/// Steps on which fit and search agree, and the readings corrected by them.
struct Settled {
  std::vector<ZeroStep> steps;
  Recording corrected;
  std::optional<Index> doubtful;  // sample
  bool explain = false;           // the steps explain at least a good part of the misfit
};

/// Alternates between fitting and searching for steps. Returns std::nullopt if a fit fails.
std::optional<Settled> SettleSteps(const Recording& recording, const FitOptions& options) {
  constexpr int kMostRounds = 8;
  constexpr double kGoodPart = 0.9;
  Settled settled{{}, recording, std::nullopt, false};
  double rms = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    const auto left = FitCorrected(recording, settled.corrected, options);
    if (!left) return std::nullopt;
    if (round == 0) rms = left->rms;
    settled.explain = round > 0 && (!left->lacks || left->rms < kGoodPart * rms);
    std::vector<ZeroStep> found = recording.edge ? FindEdgeSteps(left->residuals, recording)
                                                 : FindZeroSteps(left->residuals, kMostJumps, options.stop);
    if (options.stop.stop_requested()) return std::nullopt;
    std::erase_if(found, [&](const ZeroStep& step) { return !Matters(step, recording); });
    const bool is_settled = std::ranges::equal(found, settled.steps, AreSame);
    settled.doubtful = FirstDoubtful(recording, settled.steps, found);
    settled.steps = std::move(found);
    settled.corrected = MovedBack(recording, settled.steps);
    if (is_settled) break;
  }
  return settled;
}

}  // namespace

std::optional<ZeroJumps> FindZeroJumps(const Recording& recording, const FitOptions& options) {
  if (recording.quantity != Quantity::kAngle) return std::nullopt;
  std::optional<Settled> settled = SettleSteps(recording, TrialOptions(recording, options, kMostStepTraces));
  if (!settled || settled->steps.empty() || !settled->explain) return std::nullopt;
  const std::vector<ZeroStep>& steps = settled->steps;
  ZeroJumps jumps;
  jumps.message = "the zero jumps " + Jumps(recording, steps);
  if (settled->doubtful) {
    jumps.doubtful_from = recording.time[*settled->doubtful];
    jumps.message += ", not surely by whole counts";
    if (steps.size() > 1) jumps.message += " from " + NumberText(*jumps.doubtful_from, 6) + " s on";
    jumps.message +=
        ": the sensor slipped, or counts were lost that cannot be told; choose a window before it or after it with "
        "--from and --to";
    return jumps;
  }
  for (const ZeroStep& step : steps) {
    const double counts = std::round(InCounts(step, recording).number);
    jumps.lost.push_back({recording.time[step.sample], static_cast<int>(counts)});
  }
  jumps.corrected = std::move(settled->corrected);
  jumps.message +=
      ": counts were lost; the readings after each are moved back by as much, in all that follows and in the series";
  return jumps;
}

namespace {

/// If readings have several zeros, the errors of the fit are not valid.
void WithdrawJumping(const std::string& why, FitReport& fit) {
  fit.termination = Termination::kNotConverged;
  fit.reason = why;
  fit.warnings.push_back({"zero_jumps", fit.reason});
  WithdrawErrors("the zero jumps", fit);
}

}  // namespace

void WarnOfJumps(const std::optional<ZeroJumps>& jumps, bool lacks, FitReport& fit) {
  // For events, a misfit cannot hide a jump: a lasting offset between two edges is a step of the zero.
  const bool may_tell =
      fit.noise.family == NoiseFamily::kEdges || (!lacks && fit.noise.family != NoiseFamily::kQuantized);
  if (!jumps && may_tell && MayJump(fit)) {
    fit.warnings.push_back({"zero_unsteady",
                            "the mean of the residuals changes within the window by more than chance has it: the zero "
                            "may have jumped or drifted by too little to be told; look at --residuals"});
  }
  if (!jumps) return;
  if (!jumps->AreMended()) return WithdrawJumping(jumps->message, fit);
  fit.warnings.push_back({"lost_counts", jumps->message});
}

}  // namespace pendulum
