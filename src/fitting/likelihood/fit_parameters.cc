// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/likelihood/fit_parameters.h"

namespace pendulum {

std::vector<ParameterInfo> FitParameters(const MotionModel& model, StartKind start, Quantity quantity, ZeroMotion zero,
                                         const SensorModel& sensor) {
  std::vector<ParameterInfo> infos = PhysicalParameters(model);
  if (start == StartKind::kRelease) {
    infos.insert(infos.end(), {kReleaseAngle, kReleaseTime});
  } else {
    infos.insert(infos.end(), {kInitialAngle, kInitialRate});
  }
  if (sensor.kind != SensorKind::kDirect) {
    const std::vector<ParameterInfo> of_sensor = sensor.Parameters();
    infos.insert(infos.end(), of_sensor.begin(), of_sensor.end());
    return infos;
  }
  infos.push_back(quantity == Quantity::kRate ? kRateBias : kZeroAngle);
  if (zero == ZeroMotion::kDrifts) infos.push_back(quantity == Quantity::kRate ? kBiasDrift : kZeroDrift);
  if (zero == ZeroMotion::kLags) infos.push_back(kHysteresis);
  return infos;
}

bool IsDrift(std::string_view name) { return name == kZeroDrift.name || name == kBiasDrift.name; }

}  // namespace pendulum
