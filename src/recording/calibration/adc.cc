// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/calibration/adc.h"

#include <algorithm>
#include <cmath>

namespace pendulum {

double AdcSensor::FullScale() const { return std::ldexp(1.0, bits) - 1; }

double AdcSensor::Volts(double angle_deg) const {
  const double share = std::clamp(0.5 + angle_deg / travel_deg, 0.0, 1.0);
  return divider * supply_voltage * share;
}

double AdcSensor::Counts(double angle_deg) const {
  const double steps = Volts(angle_deg) / reference_voltage * std::ldexp(1.0, bits);
  return std::min(std::floor(steps), FullScale());
}

double AdcSensor::AngleDeg(double counts) const { return (counts + 0.5) * DegPerCount() - travel_deg / 2; }

double AdcSensor::DegPerCount() const {
  return travel_deg * reference_voltage / (std::ldexp(1.0, bits) * divider * supply_voltage);
}

double AdcSensor::CountsPerDeg() const { return 1 / DegPerCount(); }

SensorRange AdcSensor::ReadingRange() const { return {Counts(-travel_deg / 2), Counts(travel_deg / 2)}; }

std::optional<double> AdcSensor::SaturationAngleDeg() const {
  constexpr double kRounding = 1e-9;  // 3.3 V is 0.66 of 5 V, but not exactly in doubles.
  const double share = reference_voltage / (divider * supply_voltage);
  if (share >= 1 - kRounding) return std::nullopt;
  return travel_deg * (share - 0.5);
}

SensorRange AdcSensor::UsableAnglesDeg() const {
  return {-travel_deg / 2, SaturationAngleDeg().value_or(travel_deg / 2)};
}

}  // namespace pendulum
