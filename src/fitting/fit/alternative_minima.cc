// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/alternative_minima.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "pendulum/base/format.h"

namespace pendulum {
namespace {

/// Whether a different value means a different pendulum or sensor. The axis ψ is excluded, because π - ψ with the
/// motion to the other side gives the same readings.
bool IsOfPendulumOrSensor(const FitProblem& problem, std::size_t i) {
  const std::string_view name = problem.infos[i].name;
  return i <= static_cast<std::size_t>(problem.solve.last_friction) || (IsSensorParameter(name) && name != kAxis.name);
}

/// The parameters in which a solution differs from the report by more than their errors allow.
std::vector<std::size_t> DifferingParameters(const FitProblem& problem, const AlternativeMinimum& alternative,
                                             const FitReport& report) {
  constexpr double kMaxDistance = 3;  // standard errors
  std::vector<std::size_t> different;
  for (std::size_t i = 0; i < report.parameters.size(); ++i) {
    const ParameterEstimate& parameter = report.parameters[i];
    if (!IsOfPendulumOrSensor(problem, i) || !parameter.std_error) continue;
    const double distance = std::abs(problem.Reported(i, alternative.parameters[i]) - parameter.estimate);
    if (distance > kMaxDistance * *parameter.std_error) different.push_back(i);
  }
  return different;
}

/// "radius 0.59 m instead of 0.3 m".
std::string DescribeDifferences(const FitProblem& problem, const AlternativeMinimum& alternative,
                                const FitReport& report, const std::vector<std::size_t>& different) {
  std::string text;
  for (const std::size_t i : different) {
    const ParameterEstimate& parameter = report.parameters[i];
    const std::string unit = parameter.unit == "1" ? "" : " " + parameter.unit;
    const std::string other_value = NumberText(problem.Reported(i, alternative.parameters[i]), 4) + unit;
    if (!text.empty()) text += ", ";
    text.append(parameter.info.name).append(" ").append(other_value);
    text.append(" instead of ").append(NumberText(parameter.estimate, 4)).append(unit);
  }
  return text;
}

/// The parameter whose known value would decide between the solutions. A parameter of the sensor is preferred, because
/// it can be measured.
std::size_t DecidingParameter(const FitProblem& problem, const std::vector<std::size_t>& different) {
  const auto of_sensor =
      std::ranges::find_if(different, [&](std::size_t i) { return IsSensorParameter(problem.infos[i].name); });
  return of_sensor == different.end() ? different.front() : *of_sensor;
}

}  // namespace

std::optional<std::vector<double>> MirrorImage(const FitProblem& problem, std::vector<double> parameters) {
  const SensorModel& sensor = problem.data.sensor;
  if (sensor.kind != SensorKind::kAcceleration || problem.start.start != StartKind::kMoving) return std::nullopt;
  const std::size_t axis = *problem.Find(kAxis.name);
  const std::size_t radius = *problem.Find(kRadius.name);
  const std::size_t angle = *problem.Find(kInitialAngle.name);
  const std::size_t rate = *problem.Find(kInitialRate.name);
  if (std::abs(std::cos(parameters[axis])) < std::sqrt(0.5)) return std::nullopt;
  const double square = 1 / parameters[0];
  parameters[radius] = 2 * sensor.gravity / square - parameters[radius];
  parameters[angle] = -parameters[angle];
  parameters[rate] = -parameters[rate];
  for (const std::size_t i : {radius, angle, rate}) {
    const bool is_excluded = problem.solve.fixed[i] || BoundSide(problem.solve, i, parameters[i]) != 0;
    if (is_excluded) return std::nullopt;
  }
  return parameters;
}

void CheckAlternativeMinima(const FitProblem& problem, std::span<const AlternativeMinimum> alternatives,
                            const AlternativeMinimum& fit, double effective_share, FitReport& report) {
  constexpr double kNearlyAsWell = 9;  // in -2 log L
  if (report.termination != Termination::kConverged) return;
  const auto behind = [&](const AlternativeMinimum& other) {
    return 2 * effective_share * (fit.log_likelihood - other.log_likelihood) + other.prior_sum - fit.prior_sum;
  };
  const AlternativeMinimum* nearest = nullptr;
  for (const AlternativeMinimum& alternative : alternatives) {
    if (behind(alternative) > kNearlyAsWell) continue;
    if (DifferingParameters(problem, alternative, report).empty()) continue;
    if (nearest == nullptr || behind(alternative) < behind(*nearest)) nearest = &alternative;
  }
  if (nearest == nullptr) return;
  const std::vector<std::size_t> different = DifferingParameters(problem, *nearest, report);
  const std::string_view deciding = problem.infos[DecidingParameter(problem, different)].name;
  Warning ambiguous{.code = "ambiguous_sensor",
                    .finding = "with " + DescribeDifferences(problem, *nearest, report, different) +
                               " the fit is nearly as good (-2 log L is " +
                               NumberText(std::max(behind(*nearest), 0.0), 2) + " higher" +
                               (effective_share < 1 ? ", by the effective samples" : "") + ")",
                    .advice = MeasurementFor(deciding)};
  for (Identifiability& known : report.identifiability) {
    if (std::ranges::none_of(different, [&](std::size_t i) { return problem.infos[i].name == known.parameter; }))
      continue;
    known.verdict = Identifiability::Verdict::kNotIdentifiable;
    known.direction = {known.parameter};
    known.advice = MeasurementFor(known.parameter);
  }
  const std::string without_errors = "the fit is " + std::string(TerminationName(Termination::kNotIdentifiable));
  RejectFor(Termination::kNotIdentifiable, std::move(ambiguous), without_errors, report);
}

}  // namespace pendulum
