// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/planned_budget.h"

#include <algorithm>
#include <string>
#include <utility>

#include "pendulum/base/try.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/sensor_defaults.h"

namespace pendulum {
namespace {

/// The fit of a row's recording, and what was assumed of its sensor.
struct RowFit {
  FitReport report;
  SensorErrors sensor;
};

/// More samples than these hardly change what sensor, clock and rig do, and take long.
constexpr double kMostSamples = 20000;

Result<RowFit> FitOf(SyntheticOptions run, const std::optional<Rig>& rig,
                     const std::optional<SensorStatement>& sensor) {
  run.sample_rate = std::min(run.sample_rate, kMostSamples / run.duration);
  ASSIGN_OR_RETURN(Recording recording, SimulateRecording(run));
  recording.stated_sensor.reset();
  recording.sensor_errors = SensorErrorsOf(recording, recording.time[0], recording.time[recording.size() - 1], sensor);
  FitOptions options;
  options.model = run.model.name;
  options.gravity = run.model.gravity;
  options.start = run.start;
  options.rig = rig;
  options.interval = IntervalMethod::kCovariance;
  options.search.may_doubt_gravity = false;
  ASSIGN_OR_RETURN(FitReport report, FitRecording(recording, options));
  if (report.termination == Termination::kConverged) return RowFit{std::move(report), recording.sensor_errors};
  return Error(StatusCode::kInternal, "the fit of a simulated recording did not converge: " + report.reason);
}

/// Gives the fit the row's true values and its bounds of the noise, which no seed changes, and sets the total errors.
void SetTotals(const Plan& plan, double gravity_torque, FitReport& fit, PlanRow& row) {
  for (std::size_t i = 0; i < plan.parameters.size(); ++i) {
    const auto fitted = std::ranges::find(fit.parameters, plan.parameters[i].name,
                                          [](const ParameterEstimate& one) { return one.info.name; });
    if (!row.std_errors[i] || fitted == fit.parameters.end()) continue;
    const double unit = plan.parameters[i].scales_with_gravity() ? gravity_torque : 1;
    if (row.is_base) fitted->estimate = unit * plan.truth[i];
    fitted->std_error = unit * *row.std_errors[i];
    row.total_errors[i] = *TotalStdError(fitted->std_error, fitted->systematic) / unit;
  }
}

}  // namespace

void AddTotalErrors(const std::optional<Rig>& rig, const std::optional<SensorStatement>& sensor, Plan& plan) {
  const double gravity_torque = rig ? rig->gravity_torque.value : 1;
  for (PlanRow& row : plan.rows) {
    row.total_errors.assign(plan.parameters.size(), std::nullopt);
    if (!row.reason.empty()) continue;
    if (row.is_base && plan.fit) {
      SetTotals(plan, gravity_torque, *plan.fit, row);
      continue;
    }
    Result<RowFit> fit = FitOf(row.run, rig, sensor);
    if (fit) SetTotals(plan, gravity_torque, fit->report, row);
    if (!row.is_base) continue;
    if (!fit) {
      plan.without_totals = fit.error().message();
      return;
    }
    plan.fit = std::move(fit->report);
    plan.sensor = std::move(fit->sensor);
  }
}

}  // namespace pendulum
