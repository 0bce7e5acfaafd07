// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/readings_at.h"

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/analysis/fitted_motion.h"
#include "pendulum/base/format.h"
#include "pendulum/base/try.h"

namespace pendulum {
namespace {

/// Index of the parameter of that name.
Result<std::size_t> FindParameter(const FitReport& fit, const std::string& name) {
  if (const ParameterEstimate* const found = fit.Find(name)) {
    return static_cast<std::size_t>(found - fit.parameters.data());
  }
  std::vector<ParameterInfo> infos;
  for (const ParameterEstimate& parameter : fit.parameters) infos.push_back(parameter.info);
  return Error(StatusCode::kInvalidArgument, "this fit of model " + std::string(fit.model.name) +
                                                 " has no parameter '" + name + "'; it has " + NameList(infos));
}

/// The least and the greatest permitted value of a parameter, in the unit of the report.
std::pair<double, double> RangeOf(const ParameterEstimate& parameter, const Recording& used) {
  constexpr double kLeastInertia = 1e-2;  // of the estimate
  if (parameter.info.name == kReleaseTime.name) return {used.time[0], used.time[used.size() - 1]};
  if (parameter.info.name == kInertia.name) return {kLeastInertia * parameter.estimate, kUnbounded};
  return {parameter.info.lower, parameter.info.upper};
}

Result<void> CheckValue(const ParameterEstimate& parameter, double value, const Recording& used) {
  const auto [least, greatest] = RangeOf(parameter, used);
  if (std::isfinite(value) && value >= least && value <= greatest) return {};
  const auto with_unit = [&](double number) {
    return NumberText(number) + (parameter.unit == "1" ? "" : " " + parameter.unit);
  };
  const std::string rule = !std::isfinite(least)      ? "finite"
                           : !std::isfinite(greatest) ? "at least " + with_unit(least)
                                                      : "from " + NumberText(least) + " to " + with_unit(greatest);
  return Error(StatusCode::kInvalidArgument,
               std::string(parameter.info.name) + " is " + with_unit(value) + "; it must be " + rule);
}

}  // namespace

Result<Eigen::VectorXd> ReadingsAt(const Recording& used, const FitReport& fit, const std::optional<Rig>& rig,
                                   const ParameterValues& values, const std::stop_token& stop) {
  if (fit.termination == Termination::kFailed) {
    return Error(StatusCode::kFailedPrecondition,
                 "the fit of model " + std::string(fit.model.name) + " has no estimates: " + fit.reason);
  }
  std::vector<double> all;
  for (const ParameterEstimate& parameter : fit.parameters) all.push_back(parameter.estimate);
  for (const auto& [name, value] : values) {
    ASSIGN_OR_RETURN(const std::size_t i, FindParameter(fit, name));
    RETURN_IF_ERROR(CheckValue(fit.parameters[i], value, used));
    all[i] = value;
  }
  const FittedMotion motion = FittedMotion(used, fit, rig, stop).WithValues(all);
  std::optional<Eigen::VectorXd> readings = motion.Readings(motion.instants());
  if (!readings && stop.stop_requested()) {
    return Error(StatusCode::kTryAgain, "the readings were stopped before the motion was computed");
  }
  if (!readings || !readings->allFinite()) {
    return Error(StatusCode::kInvalidArgument,
                 "with these values there is no motion that can be computed: friction holds the pendulum at its "
                 "start, or a value is far from its estimate");
  }
  if (fit.correction.size() > 0) *readings += fit.correction;
  return *std::move(readings);
}

}  // namespace pendulum
