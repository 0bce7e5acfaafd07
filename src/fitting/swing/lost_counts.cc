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
#include "pendulum/fitting/swing/offset_steps.h"
#include "pendulum/recording/oversampling.h"

namespace pendulum {
namespace {

using Eigen::Index;

constexpr int kMaxOffsetSteps = 60;
constexpr int kMaxStepTraces = 200;

/// The residuals of the original readings about a fit to the corrected readings.
struct CorrectedFit {
  double rms = 0;
  bool has_misfit = false;  // more misfit than noise
  FitResiduals residuals;
  Index first_moving = 0;  // a jump before this sample belongs to the hand: it moved in the hold or at the release
};

/// The first sample a tenth of a period after the release; 0 for a start in motion.
Index FirstMoving(const FitProblem& problem, const std::vector<double>& parameters, double period) {
  constexpr double kBegun = 0.1;  // of a period
  const auto release = problem.Find(kReleaseTime.name);
  if (!release) return 0;
  return (problem.data.times().array() < parameters[*release] + kBegun * period).count();
}

/// Computes the residuals of the recording at these parameters. Returns false if the trajectory cannot be computed.
bool ComputeResiduals(const Recording& recording, const FitProblem& problem, const TrajectoryCost& cost,
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
void RefineWithinRuns(const Recording& edges, const FitProblem& problem, const TrajectoryCost& cost,
                      std::vector<double> parameters, FitResiduals& residuals) {
  constexpr int kMaxSteps = 12, kMaxStepHalvings = 5;
  constexpr double kSame = 1e-3;  // of the rms
  RunRegression now = RegressWithinRuns(residuals, edges);
  for (int step = 0, halves = 0; step < kMaxSteps && halves < kMaxStepHalvings; ++step) {
    std::vector<double> trial = parameters;
    // Bounds are ignored. A parameter held at a bound would distort the others, and this result is not an estimate.
    for (std::size_t i = 0; i < trial.size(); ++i) trial[i] += now.change[static_cast<Index>(i)];
    FitResiduals next_residuals;
    const bool traced = ComputeResiduals(edges, problem, cost, trial, next_residuals);
    RunRegression next = traced ? RegressWithinRuns(next_residuals, edges) : now;
    if (!traced || !(next.rms < now.rms)) {
      now.change *= 0.5;
      ++halves;
      continue;
    }
    const bool is_same = next.rms > (1 - kSame) * now.rms;
    parameters = std::move(trial);
    residuals = std::move(next_residuals);
    now = std::move(next);
    halves = 0;
    if (is_same) return;
  }
}

std::optional<CorrectedFit> FitCorrected(const Recording& recording, const Recording& corrected,
                                         const FitOptions& options) {
  const Result<FitReport> fit = FitRecording(corrected, options);
  if (!fit || fit->termination == Termination::kFailed) return std::nullopt;
  const Result<FitProblem> problem = MakeFitProblem(corrected, OptionsLike(*fit, options));
  if (!problem || problem->infos.size() != fit->parameters.size()) return std::nullopt;
  std::vector<double> parameters;
  for (std::size_t i = 0; i < problem->infos.size(); ++i) {
    parameters.push_back(problem->Internal(i, fit->parameters[i].estimate));
  }
  const auto cost = MakeTrajectoryCost(problem->model, problem->start.start, problem->data);
  CorrectedFit corrected_fit{
      fit->statistics.rms_residual, fit->HasWarning("lack_of_fit") || fit->HasWarning("correlated_residuals"), {}};
  if (!ComputeResiduals(recording, *problem, *cost, parameters, corrected_fit.residuals)) return std::nullopt;
  corrected_fit.first_moving = FirstMoving(*problem, parameters, corrected_fit.residuals.period);
  if (recording.edge) RefineWithinRuns(recording, *problem, *cost, std::move(parameters), corrected_fit.residuals);
  return corrected_fit;
}

/// A step as a number of counts.
struct StepInCounts {
  double number = 0, std_error = 0;

  bool IsWhole() const {
    constexpr double kMaxStdError = 0.2;
    constexpr double kWithin = 3.5;
    const double off = std::abs(number - std::round(number));
    return std_error < kMaxStdError && off < std::max(kWithin * std_error, 0.1) && std::round(number) != 0;
  }
};

/// The size of a step in counts. Returns {}, which is not a whole number of counts, if the recording has no resolution
/// or has a sensor range. Readings with a range cannot be corrected, because the ends of the range would not shift with
/// them.
StepInCounts InCounts(const OffsetStep& step, const Recording& recording) {
  const double count = CountOf(recording);
  if (!(count > 0) || recording.range) return {};
  return {step.size / count, step.std_error / count};
}

/// Whether a step is larger than the rounding of readings or numbers. The mean of readings with little noise is rounded
/// to whole counts as they are.
bool IsSignificant(const OffsetStep& step, const Recording& recording) {
  constexpr double kMinCount = 0.75;
  constexpr double kMinDeviations = 5;
  constexpr double kRounding = 1e-6;
  const double range = recording.value.maxCoeff() - recording.value.minCoeff();
  const double least = std::max({kMinDeviations * step.std_error, kMinCount * CountOf(recording), kRounding * range});
  return std::abs(step.size) > least;
}

Recording WithoutSteps(Recording recording, const std::vector<OffsetStep>& steps) {
  for (const OffsetStep& step : steps) {
    const StepInCounts counts = InCounts(step, recording);
    const double size = counts.IsWhole() ? std::round(counts.number) * CountOf(recording) : step.size;
    recording.value.tail(recording.size() - step.sample).array() -= size;
  }
  return recording;
}

bool AreSame(const OffsetStep& one, const OffsetStep& other) {
  return one.sample == other.sample && std::abs(one.size - other.size) < 0.2 * other.std_error;
}

/// The first sample at which two searches disagree or a step is not a whole number of counts; std::nullopt if there is
/// none.
std::optional<Index> FirstUncertainSample(const Recording& recording, const std::vector<OffsetStep>& before,
                                          const std::vector<OffsetStep>& now) {
  std::optional<Index> first;
  const auto look = [&](const std::vector<OffsetStep>& steps, const std::vector<OffsetStep>& others) {
    for (const OffsetStep& step : steps) {
      const bool agrees = std::ranges::any_of(others, [&](const OffsetStep& other) { return AreSame(step, other); });
      if (agrees && InCounts(step, recording).IsWhole()) continue;
      first = std::min(first.value_or(step.sample), step.sample);
    }
  };
  look(now, before);
  look(before, now);
  return first;
}

std::string SizeText(const Recording& recording, const OffsetStep& step) {
  const StepInCounts counts = InCounts(step, recording);
  if (!counts.IsWhole()) {
    return NumberText(step.size, 3) + " +- " + NumberText(step.std_error, 2) + " " + recording.value_unit();
  }
  const double whole = std::round(counts.number);
  return NumberText(whole) + (std::abs(whole) == 1 ? " count" : " counts");
}

/// "by 3 counts at 12.34 s, by ...".
std::string DescribeJumps(const Recording& recording, const std::vector<OffsetStep>& steps) {
  constexpr std::size_t kMaxListed = 5;
  std::string text;
  for (std::size_t k = 0; k < std::min(steps.size(), kMaxListed); ++k) {
    text += (k == 0 ? "by " : ", by ") + SizeText(recording, steps[k]) + " at " +
            NumberText(recording.time[steps[k].sample], 6) + " s";
  }
  if (steps.size() > kMaxListed) text += " and at " + std::to_string(steps.size() - kMaxListed) + " more times";
  return text;
}

}  // namespace

bool MayHaveOffsetJump(const FitReport& fit) {
  constexpr double kDeviations = 4;
  constexpr double kMinCount = 0.4;
  constexpr double kRounding = 1e-9;  // of the swing; smaller residuals are floating-point rounding errors
  const Index count = fit.residual.size();
  if (fit.quantity != Quantity::kAngle || count < 2) return false;
  const double mean = fit.residual.mean();
  const double scatter = std::sqrt((fit.residual.array() - mean).square().mean());
  if (!(scatter > kRounding * (fit.fitted.maxCoeff() - fit.fitted.minCoeff()))) return false;
  const double count_size = std::max(fit.noise.resolution, fit.noise.averaging.count);
  double sum = 0;
  for (Index i = 0; i + 1 < count; ++i) {
    sum += fit.residual[i] - mean;
    const auto before = static_cast<double>(i + 1), after = static_cast<double>(count - i - 1);
    const double weight = before * after / static_cast<double>(count);
    // With very little noise, readings repeat the same rounding error throughout a hold.
    const double least = std::max(kDeviations * scatter / std::sqrt(weight), kMinCount * count_size);
    if (std::abs(sum) > least * weight) return true;
  }
  return false;
}

namespace {

/// Result of alternating search and fit: the steps, and the readings corrected by these steps.
struct ConsistentSteps {
  std::vector<OffsetStep> steps;
  Recording corrected;
  std::optional<Index> uncertain;  // first sample that the last two searches place differently; absent if they agree
  bool explains_misfit = false;    // the steps explain at least a good part of the misfit
};

/// Alternates between fitting and searching for steps. Returns std::nullopt if a fit fails.
std::optional<ConsistentSteps> FindConsistentSteps(const Recording& recording, const FitOptions& options) {
  constexpr int kMaxRounds = 8;
  constexpr double kMaxRmsRatio = 0.9;
  ConsistentSteps consistent{{}, recording, std::nullopt, false};
  double rms = 0;
  for (int round = 0; round < kMaxRounds; ++round) {
    const auto corrected_fit = FitCorrected(recording, consistent.corrected, options);
    if (!corrected_fit) return std::nullopt;
    if (round == 0) rms = corrected_fit->rms;
    consistent.explains_misfit = round > 0 && (!corrected_fit->has_misfit || corrected_fit->rms < kMaxRmsRatio * rms);
    std::vector<OffsetStep> found = recording.edge
                                        ? FindEdgeSteps(corrected_fit->residuals, recording)
                                        : FindOffsetSteps(corrected_fit->residuals, kMaxOffsetSteps, options.stop);
    if (options.stop.stop_requested()) return std::nullopt;
    std::erase_if(found, [&](const OffsetStep& step) {
      return step.sample < corrected_fit->first_moving || !IsSignificant(step, recording);
    });
    const bool is_consistent = std::ranges::equal(found, consistent.steps, AreSame);
    consistent.uncertain = FirstUncertainSample(recording, consistent.steps, found);
    consistent.steps = std::move(found);
    consistent.corrected = WithoutSteps(recording, consistent.steps);
    if (is_consistent) break;
  }
  return consistent;
}

}  // namespace

std::optional<OffsetJumps> FindOffsetJumps(const Recording& recording, const FitOptions& options) {
  if (recording.quantity != Quantity::kAngle) return std::nullopt;
  std::optional<ConsistentSteps> consistent =
      FindConsistentSteps(recording, TrialOptions(recording, options, kMaxStepTraces));
  if (!consistent || consistent->steps.empty() || !consistent->explains_misfit) return std::nullopt;
  const std::vector<OffsetStep>& steps = consistent->steps;
  OffsetJumps jumps;
  jumps.warning.finding = "the zero jumps " + DescribeJumps(recording, steps);
  if (consistent->uncertain) {
    jumps.uncertain_from = recording.time[*consistent->uncertain];
    jumps.warning.finding += ", perhaps not by whole counts";
    if (steps.size() > 1) jumps.warning.finding += " from " + NumberText(*jumps.uncertain_from, 6) + " s on";
    jumps.warning.explanation = "the sensor slipped, or an unknown number of counts was lost";
    jumps.warning.advice = "choose a window before or after the jump with --from and --to";
    jumps.warning.flags = {"from", "to"};
    return jumps;
  }
  for (const OffsetStep& step : steps) {
    const double counts = std::round(InCounts(step, recording).number);
    jumps.lost.push_back({recording.time[step.sample], static_cast<int>(counts)});
  }
  jumps.corrected = std::move(consistent->corrected);
  jumps.warning.code = "lost_counts";
  jumps.warning.finding += ": counts were lost";
  jumps.warning.explanation = "the readings after each jump were corrected by its size, here and in the series";
  return jumps;
}

void WarnOfOffsetJumps(const std::optional<OffsetJumps>& jumps, bool has_misfit, FitReport& fit) {
  // For events, a misfit cannot hide a jump: a lasting offset between two edges is a step of the zero.
  const bool can_detect =
      fit.noise.family == NoiseFamily::kEdges ||
      (!has_misfit && fit.noise.family != NoiseFamily::kQuantized && fit.noise.family != NoiseFamily::kAveraged);
  if (!jumps && can_detect && MayHaveOffsetJump(fit)) {
    fit.warnings.push_back({.code = "offset_unsteady",
                            .finding = "the mean of the residuals changes within the window by more than chance "
                                       "explains: the zero may have jumped or drifted by a small amount",
                            .advice = "look at the residuals (--report)",
                            .flags = {"report"}});
  }
  if (!jumps) return;
  if (!jumps->AreCorrected()) return RejectFor(Termination::kNotConverged, jumps->warning, "the zero jumps", fit);
  fit.warnings.push_back(jumps->warning);
}

}  // namespace pendulum
