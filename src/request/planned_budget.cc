// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/planned_budget.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/parallel.h"
#include "pendulum/base/physics.h"
#include "pendulum/base/try.h"
#include "pendulum/identify/identify.h"
#include "pendulum/request/simulation_text.h"

namespace pendulum {
namespace {

/// The simulation of a row, with at most so many samples if that is enough for each swing: more of them hardly change
/// what sensor, clock and rig do, and take long. Correlated noise depends on the rate.
Simulation SimulationOf(const PlanRow& row, Simulation base) {
  constexpr double kMostSamples = 20000, kPerSwing = 40;
  if (base.resolution > 0) base.resolution *= row.run.resolution / base.synthetic.resolution;
  base.synthetic = row.run;
  const double frequency = 1 / (2 * kPi * std::sqrt(row.run.parameters.front()));
  const double enough = std::max(kMostSamples / row.run.duration, kPerSwing * frequency);
  if (row.run.noise_correlation == 0) base.synthetic.sample_rate = std::min(row.run.sample_rate, enough);
  return base;
}

/// What fit_pendulum would say of a simulated recording.
Result<Identification> Identified(const Simulation& simulation, const std::optional<Rig>& rig,
                                  const std::optional<SensorStatement>& sensor) {
  ASSIGN_OR_RETURN(std::string csv, SimulatedCsv(simulation, simulation.synthetic.seed));
  IdentifyOptions options;
  options.models = {std::string(simulation.synthetic.model.name)};
  options.fit.model = options.models.front();
  options.fit.gravity = simulation.synthetic.model.gravity;
  options.fit.interval = IntervalMethod::kCovariance;
  options.fit.threads = 1;
  options.checks = Checks::kNone;
  options.sensor = sensor.value_or(SensorStatement{});  // the file says that its sensor is ideal
  RunFiles files{{"the simulated recording", std::move(csv)}, nullptr, nullptr};
  if (rig) files.rig = Share({rig->name, rig->source.dump()});
  ASSIGN_OR_RETURN(Identification identification, IdentifyBytes(options, std::move(files)));
  const FitReport& fit = identification.fits.front();
  if (fit.termination == Termination::kConverged) return identification;
  return Error(StatusCode::kInternal, "the fit of a simulated recording did not converge: " + fit.reason);
}

/// Gives the fit the row's true values and its bounds of the noise, which no seed changes, and sets the total errors.
void SetTotals(const Plan& plan, double gravity_torque, FitReport& fit, PlanRow& row) {
  for (std::size_t i = 0; i < plan.parameters.size(); ++i) {
    const auto fitted = std::ranges::find(fit.parameters, plan.parameters[i].name,
                                          [](const ParameterEstimate& one) { return one.info.name; });
    if (fitted == fit.parameters.end() || fitted->at_bound) continue;
    const double unit = plan.parameters[i].scales_with_gravity() ? gravity_torque : 1;
    if (row.is_base) fitted->estimate = unit * plan.truth[i];
    if (row.std_errors[i]) fitted->std_error = unit * *row.std_errors[i];
    if (const auto total = TotalStdError(fitted->std_error, fitted->systematic)) row.total_errors[i] = *total / unit;
  }
}

}  // namespace

void AddTotalErrors(const Simulation& simulation, const std::optional<Rig>& rig,
                    const std::optional<SensorStatement>& sensor, Plan& plan) {
  const auto base = std::ranges::find_if(plan.rows, &PlanRow::is_base);
  const double gravity_torque = rig ? simulation.gravity_torque : 1;
  for (PlanRow& row : plan.rows) row.total_errors.assign(plan.parameters.size(), std::nullopt);
  Result<Identification> of_base = Identified(SimulationOf(*base, simulation), rig, sensor);
  if (!of_base) {
    plan.without_totals = of_base.error().message();
    return;
  }
  plan.sensor = of_base->recordings.front().data.sensor;
  plan.fit = std::move(of_base->fits.front());
  SetTotals(plan, gravity_torque, *plan.fit, *base);

  // The resolution of a row must not suggest another kind of sensor.
  SensorStatement same = sensor.value_or(SensorStatement{});
  same.kind = plan.sensor.kind;
  std::vector<PlanRow*> others;  // the other base rows are the same recording
  for (PlanRow& row : plan.rows) {
    if (row.is_base) row.total_errors = base->total_errors;
    if (!row.is_base && row.reason.empty()) others.push_back(&row);
  }
  ParallelFor(static_cast<int>(others.size()), 0, [&](int k) {
    PlanRow& row = *others[static_cast<std::size_t>(k)];
    Result<Identification> found = Identified(SimulationOf(row, simulation), rig, same);
    if (found) {
      SetTotals(plan, gravity_torque, found->fits.front(), row);
    } else {
      row.without_totals = found.error().message();
    }
  });
}

}  // namespace pendulum
