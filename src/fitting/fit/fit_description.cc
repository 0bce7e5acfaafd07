// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/fit_description.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "pendulum/base/median.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/residuals/estimate_autocorrelation.h"
#include "pendulum/fitting/uncertainty/standard_errors.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Residuals below a billionth of the range of the readings are floating-point rounding errors, not a misfit.
bool IsRounding(const Recording& recording, const FitReport& report) {
  constexpr double kRounding = 1e-9;
  const double range = recording.value.maxCoeff() - recording.value.minCoeff();
  return report.statistics.rms_residual < kRounding * range;
}

/// Samples per period, as a number of lags.
int PeriodLags(const FitProblem& problem) {
  const std::vector<double>& time = problem.data.time;
  constexpr std::size_t kMaxSamples = 100'000;
  const std::size_t stride = time.size() / kMaxSamples + 1;
  std::vector<double> intervals;
  for (std::size_t i = 0; i + 1 < time.size(); i += stride) intervals.push_back(time[i + 1] - time[i]);
  const double lags = 2 * kPi / problem.start.natural_frequency / Median(std::move(intervals));
  return static_cast<int>(std::min(lags, static_cast<double>(time.size())));
}

/// Converts the unit of a parameter to the unit of the readings if they are not calibrated.
void SetReadingUnit(const Recording& recording, const SensorModel& sensor, ParameterEstimate& parameter) {
  const std::string_view name = parameter.info.name;
  const bool is_length = name == kPivotX.name || name == kPivotY.name || name == kRadius.name;
  if (is_length && sensor.kind != SensorKind::kAcceleration) parameter.unit = recording.unit;
  if (sensor.kind == SensorKind::kScaledRate && name == kRateBias.name) parameter.unit = recording.unit;
  if (name == kRateScale.name) parameter.unit = recording.unit + " s/rad";
  if (sensor.kind != SensorKind::kDirect || recording.is_calibrated() || !parameter.unit.starts_with("rad")) return;
  // Without a calibration, angles are in the unit of an angle's readings, and rates in the unit of a rate's readings.
  const bool is_rate = parameter.unit == "rad/s";
  if (recording.quantity != Quantity::kRate) {
    parameter.unit.replace(0, 3, recording.unit);
  } else {
    parameter.unit = is_rate ? recording.unit : parameter.unit == "rad" ? recording.unit + " s" : recording.unit + "/s";
  }
}

/// Value, unit and flags of parameter i, without its errors.
ParameterEstimate MakeEstimate(const FittedRun& run, std::size_t i) {
  const Recording& recording = run.recording;
  const FitProblem& problem = run.problem;
  ParameterEstimate parameter;
  parameter.info = problem.infos[i];
  parameter.unit = SiRig(run.options) ? parameter.info.unit : parameter.info.relative_unit;
  SetReadingUnit(recording, problem.data.sensor, parameter);
  parameter.estimate = problem.Reported(i, run.solution.parameters[i]);
  parameter.fixed = problem.solve.fixed[i];
  const auto is_one_of = [&](auto... infos) { return ((parameter.info.name == infos.name) || ...); };
  const bool is_seen = recording.is_calibrated() || problem.data.sensor.kind == SensorKind::kDirect;
  const bool has_closed_form = is_seen && !IsSensorParameter(parameter.info.name) &&
                               !is_one_of(kInitialAngle, kInitialRate, kZeroDrift, kBiasDrift);
  if (has_closed_form && !parameter.fixed) parameter.closed_form = problem.Reported(i, problem.start.parameters[i]);
  return parameter;
}

NoiseEstimate DescribeNoise(const FitProblem& problem, const Solution& solution, const Eigen::VectorXd& z) {
  NoiseEstimate noise;
  noise.family = solution.noise.family;
  noise.sigma = solution.noise.sigma;
  noise.resolution = problem.resolution;
  noise.censored = problem.censored;
  noise.why = solution.noise_reason;
  noise.lag1_correlation = Lag1Correlation(z);
  if (noise.family == NoiseFamily::kAveraged) noise.averaging = solution.noise.averaging;
  if (noise.family != NoiseFamily::kEdges) return noise;
  noise.stamp_ratio = solution.noise.stamp_ratio;
  noise.lag = solution.noise.lag;
  noise.edge = solution.noise.edge;
  noise.spread = solution.noise.spread;
  return noise;
}

}  // namespace

FitReport InitializeReport(const FittedRun& run) {
  FitReport report;
  report.model = run.problem.model;
  report.start = run.problem.start.start;
  report.start_values = run.problem.start;
  report.quantity = run.recording.quantity;
  report.sensor = run.problem.data.sensor;
  report.reading_unit = run.recording.value_unit();
  report.solver = {run.solution.iterations, run.cost.traces(), run.solution.message, {}};
  return report;
}

Description Describe(const FittedRun& run, int free_parameters) {
  const Recording& recording = run.recording;
  const FitProblem& problem = run.problem;
  const Solution& solution = run.solution;
  Description described;
  FitReport& report = described.report;
  report = InitializeReport(run);
  const Eigen::VectorXd& z = described.quantile_residuals =
      QuantileResiduals(solution.noise, recording.value, solution.readings);
  report.fitted = solution.readings;
  report.residual = recording.value - report.fitted;
  report.trace_error = solution.trace_error;
  report.statistics = ComputeStatistics(report.residual, z, solution.log_likelihood, free_parameters);
  report.statistics.rms_residual = problem.RmsResidual(report.fitted);
  report.noise = DescribeNoise(problem, solution, z);
  described.trace = run.cost.Trace(solution.parameters);
  described.correlated =
      !IsRounding(recording, report) &&
      (AreAutocorrelated(z, PeriodLags(problem)) ||
       HavePhaseOrAmplitudeErrors(recording.time, report.fitted, z,
                                  2 * kPi / (problem.start.natural_frequency * recording.clock_scale)));
  return described;
}

void SetParameters(const FittedRun& run, const Optimum& optimum, FitReport& report) {
  report.parameters.clear();
  for (int i = 0; i < static_cast<int>(run.problem.infos.size()); ++i) {
    ParameterEstimate parameter = MakeEstimate(run, static_cast<std::size_t>(i));
    parameter.at_bound = std::ranges::find(optimum.at_bound, i) != optimum.at_bound.end();
    if (parameter.fixed) {
      parameter.reason = "fixed";
    } else if (report.termination != Termination::kConverged) {
      parameter.reason = "the fit is " + std::string(TerminationName(report.termination));
    } else if (parameter.at_bound) {
      parameter.reason = "at its bound";
    }
    report.parameters.push_back(std::move(parameter));
  }
}

void SetCovariance(const FitProblem& problem, const Optimum& optimum, const Errors& errors, FitReport& report) {
  Eigen::VectorXd scale(static_cast<Index>(optimum.free.size()));
  for (std::size_t i = 0; i < optimum.free.size(); ++i) {
    const auto index = static_cast<std::size_t>(optimum.free[i]);
    const auto row = static_cast<Index>(i);
    report.covariance_names.emplace_back(problem.infos[index].name);
    scale[row] = problem.si_per_internal[index];
    report.parameters[index].std_error = scale[row] * std::sqrt(errors.covariance(row, row));
    report.parameters[index].t95 = errors.t95[row];
  }
  report.covariance = scale.asDiagonal() * errors.covariance * scale.asDiagonal();
  report.std_error_method = errors.runs[0].method;
}

void SetSystematicErrors(const FitProblem& problem, const std::vector<SystematicCovariance>& covariances,
                         FitReport& report) {
  const auto size = static_cast<Index>(report.parameters.size());
  const Eigen::Map<const Eigen::VectorXd> units(problem.si_per_internal.data(), size);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
  for (const SystematicCovariance& covariance : covariances) {
    sum += covariance.of_estimates;
    for (Index i = 0; i < size; ++i) {
      const double error = units[i] * std::sqrt(std::max(covariance.of_estimates(i, i), 0.0));
      report.parameters[static_cast<std::size_t>(i)].systematic.Add(covariance.kind, error);
    }
    for (BudgetLine line : covariance.lines) {
      line.parts = units.cwiseProduct(line.parts);
      report.budget.push_back(std::move(line));
    }
  }
  std::vector<Index> concerned;
  for (Index i = 0; i < size; ++i) {
    if (!(sum(i, i) > 0)) continue;
    report.systematic_names.emplace_back(report.parameters[static_cast<std::size_t>(i)].info.name);
    concerned.push_back(i);
  }
  report.systematic_covariance = (units.asDiagonal() * sum * units.asDiagonal())(concerned, concerned);
}

void SetDerived(const FittedRun& run, const Optimum& optimum, const Errors& errors,
                const std::vector<SystematicCovariance>& covariances, FitReport& report) {
  const FitProblem& problem = run.problem;
  const std::vector<double>& parameters = run.solution.parameters;
  const auto size = static_cast<Index>(problem.infos.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  covariance(optimum.free, optimum.free) = errors.covariance;
  report.derived = DerivedQuantities(problem.infos, parameters);
  SetDerivedErrors(covariance, optimum.at_bound, report.derived);
  std::vector<IntervalEnds> intervals;
  for (std::size_t i = 0; i < problem.infos.size(); ++i) {
    const ParameterEstimate& parameter = report.parameters[i];
    const auto internal = [&](const std::optional<double>& end) {
      if (parameter.fixed) return std::optional(parameters[i]);
      return end ? std::optional(problem.Internal(i, *end)) : std::nullopt;
    };
    intervals.push_back({internal(parameter.lower95), internal(parameter.upper95)});
  }
  SetDerivedIntervals(problem.infos, parameters, intervals, report.derived);
  if (run.options.with_losses) {
    std::vector<DerivedQuantity> shares =
        LossQuantities(problem.model, report.start, parameters, problem.data.time.back());
    std::vector<int> torques_at_bound;
    std::ranges::copy_if(optimum.at_bound, std::back_inserter(torques_at_bound),
                         [&](int i) { return problem.infos[static_cast<std::size_t>(i)].scales_with_gravity(); });
    SetDerivedErrors(covariance, torques_at_bound, shares);
    if (errors.t95.size() > 0) SetSymmetricIntervals(errors.t95.maxCoeff(), shares);
    std::ranges::move(shares, std::back_inserter(report.derived));
  }
  for (const SystematicCovariance& of : covariances) AddSystematicErrors(of.kind, of.of_ratios, report.derived);
}

Autocorrelation AutocorrelationOf(const FittedRun& run, const Optimum& optimum, const Description& described) {
  const Eigen::VectorXd& z = described.quantile_residuals;
  if (optimum.free.empty() || !(described.correlated || MayBeCorrelated(z))) return {};
  const Eigen::MatrixXd jacobian = FreeJacobian(run.cost, run.solution, optimum);
  if (jacobian.rows() == 0) return {};
  const TrajectoryData& data = run.problem.data;
  return EstimateAutocorrelation(run.solution.noise, data.times(), z, jacobian, data.stop);
}

}  // namespace pendulum
