// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/prediction.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/analysis/fitted_motion.h"
#include "pendulum/analysis/linear_fit.h"
#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/base/try.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/swing/undersampled.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Data that is the same for every left-out part. Times are true s from the first sample.
struct Task {
  const Recording& used;
  FitOptions options;        // options of the fits to the remaining samples
  Eigen::VectorXd instants;  // N
  double begin;              // begin of the motion
  double end;
  double period;     // period of small swings
  NoiseModel noise;  // determines which readings are censored
};

/// Samples [first, last).
struct Part {
  Index first;
  Index last;
};

Part PartBetween(const Task& task, double from, double to) {
  const double* const first = task.instants.data();
  const auto sample = [&](double time) { return std::lower_bound(first, first + task.instants.size(), time) - first; };
  return {sample(from), to < task.end ? sample(to) : task.used.size()};
}

/// Uses the estimates of the whole fit as start values. The remaining samples have a gap, so start values from their
/// turning points would be wrong.
StartValues StartAtEstimates(const FitProblem& problem, const FitReport& fit) {
  StartValues start = problem.start;
  for (std::size_t i = 0; i < problem.infos.size(); ++i) {
    const ParameterEstimate* const parameter = fit.Find(problem.infos[i].name);
    if (parameter == nullptr) continue;
    const double internal = problem.Internal(i, parameter->estimate);
    start.parameters[i] = std::clamp(internal, problem.solve.lower[i], problem.solve.upper[i]);
  }
  start.natural_frequency = 1 / std::sqrt(start.parameters[0]);
  return start;
}

FitOptions OptionsAtEstimates(const FitProblem& problem, const FitReport& fit, FitOptions options) {
  options = OptionsLike(fit, std::move(options));
  options.search.start_values = StartAtEstimates(problem, fit);
  options.initial.clear();
  if (problem.zero_motion != ZeroMotion::kNone)
    options.initial[std::string(problem.infos.back().name)] = fit.parameters.back().estimate;
  options.interval = IntervalMethod::kCovariance;
  options.progress = nullptr;
  return options;
}

Result<Task> MakeTask(const Recording& used, const FitReport& fit, FitOptions options) {
  if (IsUndersampled(used, options.rig)) {
    return Error(StatusCode::kFailedPrecondition, "the samples are too far apart to leave some of them out");
  }
  options = OptionsLike(fit, std::move(options));
  ASSIGN_OR_RETURN(const FitProblem problem, MakeFitProblem(used, options));
  options = OptionsAtEstimates(problem, fit, std::move(options));
  const FittedMotion motion(used, fit, options.rig, options.stop);
  const int release = problem.solve.release_time;
  const double begin = release < 0 ? 0.0 : options.search.start_values->parameters[static_cast<std::size_t>(release)];
  const double end = motion.instants()[used.size() - 1];
  const double period = motion.small_angle_period();
  if (!(end - begin >= kMinPeriods * period)) {
    return Error(StatusCode::kFailedPrecondition, "the recording swings for " + NumberText((end - begin) / period, 2) +
                                                      " periods; at least " + NumberText(kMinPeriods) +
                                                      " are needed to leave some of them out");
  }
  return Task{used, std::move(options), motion.instants(), begin, end, period, problem.noise};
}

Recording Without(const Recording& used, const Part& part) {
  Recording rest = used;
  const Index after = used.size() - part.last;
  for (Eigen::VectorXd* const samples : {&rest.time, &rest.value}) {
    samples->segment(part.first, after) = samples->tail(after).eval();
    samples->conservativeResize(part.first + after);
  }
  return rest;
}

/// Variance of a reading about the trajectory. A Gaussian σ includes the rounding of the readings; a quantized σ does
/// not. For a robust family it is the variance of all residuals: the scale of the family is not a standard deviation,
/// and the predicted readings include outliers.
double ReadingVariance(const FitReport& fit) {
  const NoiseEstimate& noise = fit.noise;
  const double square = noise.sigma * noise.sigma;
  if (noise.family == NoiseFamily::kGaussian) return square;
  if (noise.family == NoiseFamily::kEdges) {
    if (!noise.spread) return square;
    const auto edges = static_cast<Index>(noise.spread->size());
    return square * Eigen::Map<const Eigen::ArrayXd>(noise.spread->data(), edges).square().mean();
  }
  if (noise.family == NoiseFamily::kAveraged)
    return std::pow(NoiseOfFit(fit, -kInfinity, kInfinity).MeanDeviation(), 2);
  if (noise.family == NoiseFamily::kQuantized) return square + noise.resolution * noise.resolution / 12;
  const auto samples = static_cast<double>(fit.residual.size() - noise.censored);
  const auto free = static_cast<double>(fit.covariance_names.size());
  return fit.statistics.rms_residual * fit.statistics.rms_residual * samples / std::max(samples - free, 1.0);
}

/// J C Jᵀ for each row of the N x P derivatives; fixed parameters and those at a bound are left out.
Eigen::VectorXd TrajectoryVariance(const FitReport& fit, const Eigen::MatrixXd& jacobian) {
  std::vector<Index> free;
  for (const std::string& name : fit.covariance_names) free.push_back(fit.Find(name) - fit.parameters.data());
  const Eigen::MatrixXd rows = jacobian(Eigen::all, free);
  return (rows * fit.covariance).cwiseProduct(rows).rowwise().sum().cwiseMax(0.0);
}

/// Sums over the predicted readings.
struct Sums {
  double squares = 0, standardized = 0;
  Index samples = 0;
  std::string without_errors;  // why a part's predictions have no standard deviation
};

void AddPart(const Task& task, const Part& part, const Eigen::VectorXd& predicted, const Eigen::VectorXd& variance,
             Sums& sums) {
  for (Index i = part.first; i < part.last; ++i) {
    const double measured = task.used.value[i];
    if (task.noise.IsCensored(measured) || task.noise.IsSilence(measured)) continue;
    const double square = (measured - predicted[i]) * (measured - predicted[i]);
    sums.squares += square;
    sums.standardized += square / variance[i];
    ++sums.samples;
  }
}

/// Fits all samples outside a part and adds the prediction of the part. An error gives the reason for a failure.
Result<void> PredictPart(const Task& task, const Part& part, Sums& sums) {
  if (part.first == part.last) return {};
  const Recording rest = Without(task.used, part);
  const auto parameters = static_cast<Index>(task.options.search.start_values->parameters.size());
  if (rest.size() < std::max<Index>(kMinimumSamples, 2 * parameters)) {
    return Error(StatusCode::kFailedPrecondition, "too few samples are left");
  }
  ASSIGN_OR_RETURN(const FitReport fit, FitRecording(rest, task.options));
  const auto untraced = [&] { return Error(StatusCode::kFailedPrecondition, fit.reason); };
  if (fit.termination == Termination::kFailed) return untraced();
  Eigen::MatrixXd jacobian;
  const auto predicted =
      FittedMotion(rest, fit, task.options.rig, task.options.stop).Readings(task.instants, &jacobian);
  if (!predicted) return untraced();
  if (fit.termination != Termination::kConverged) sums.without_errors = fit.reason;
  const Eigen::VectorXd variance = TrajectoryVariance(fit, jacobian).array() + ReadingVariance(fit);
  AddPart(task, part, *predicted, variance, sums);
  return {};
}

Prediction NoPrediction(const std::string& reason) {
  Prediction prediction;
  prediction.reason = reason;
  return prediction;
}

Prediction PredictionOf(const Sums& sums) {
  if (sums.samples < kMinimumSamples) return NoPrediction("there are too few readings to predict");
  if (!std::isfinite(sums.squares)) return NoPrediction("a fit to the remaining readings diverges");
  Prediction prediction;
  const auto samples = static_cast<double>(sums.samples);
  prediction.rms = std::sqrt(sums.squares / samples);
  const bool has_errors = sums.without_errors.empty() && std::isfinite(sums.standardized);
  if (has_errors) {
    prediction.standardized = std::sqrt(sums.standardized / samples);
    prediction.samples = sums.samples;
  } else {
    prediction.reason = "a fit to the remaining readings has no errors: " +
                        (sums.without_errors.empty() ? "its residuals are all 0" : sums.without_errors);
  }
  return prediction;
}

/// Leaves out and predicts each part in turn.
Prediction PredictParts(const Task& task, const std::vector<Part>& parts) {
  Sums sums;
  for (const Part& part : parts) {
    const Result<void> done = PredictPart(task, part, sums);
    if (!done) return NoPrediction("a fit to the remaining readings cannot be made: " + done.error().message());
  }
  return PredictionOf(sums);
}

}  // namespace

/// A prediction y* comes from a fit to the remaining samples. Its standard deviation is sqrt(s² + J C Jᵀ): s is the
/// standard deviation of a reading about the fitted trajectory, C is the covariance of the fitted parameters p, and J =
/// ∂y*/∂p. The first period is never left out: the start would be extrapolated backwards in time, where a dissipative
/// motion diverges. The fits have the kind of start and the noise of `fit`, and their search begins at the estimates of
/// `fit`.
Prediction CrossValidate(const Recording& used, const FitReport& fit, const FitOptions& options) {
  const Result<Task> task = MakeTask(used, fit, options);
  if (!task) return NoPrediction(task.error().message());
  const double first = task->begin + task->period;
  const double length = (task->end - first) / kBlocks;
  std::vector<Part> parts;
  for (int k = 0; k < kBlocks; ++k) {
    const double to = k + 1 < kBlocks ? first + (k + 1) * length : task->end;
    parts.push_back(PartBetween(*task, first + k * length, to));
  }
  return PredictParts(*task, parts);
}

/// The prediction errors come from a few parameters. Even for the right model `standardized` scatters more about 1 than
/// in cross-validation, where each block except the last lies between fitted samples.
Prediction PredictForward(const Recording& used, const FitReport& fit, const FitOptions& options) {
  const Result<Task> task = MakeTask(used, fit, options);
  if (!task) return NoPrediction(task.error().message());
  const double from = task->begin + kFirstPart * (task->end - task->begin);
  return PredictParts(*task, {PartBetween(*task, from, task->end)});
}

}  // namespace pendulum
