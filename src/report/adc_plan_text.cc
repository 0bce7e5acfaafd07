// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/adc_plan_text.h"

#include <algorithm>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/report/layout.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

std::string FourDigits(double value) { return NumberText(value, 4); }

/// Describes the swing about the middle of the travel that the counts cover.
std::string CoveredRangeText(const AdcSensor& sensor) {
  const SensorRange usable = sensor.UsableAnglesDeg();
  const double swing = std::min(-usable.low, usable.high);
  return swing > 0 ? "± " + FourDigits(swing) : "none";
}

std::vector<std::string> SensorRow(const AdcSensor& sensor) {
  const SensorRange usable = sensor.UsableAnglesDeg();
  const SensorRange counts = sensor.ReadingRange();
  return {FourDigits(sensor.reference_voltage),
          FourDigits(sensor.DegPerCount()),
          FourDigits(sensor.CountsPerDeg()),
          FourDigits(usable.low) + " to " + FourDigits(usable.high),
          CoveredRangeText(sensor),
          NumberText(counts.low) + " to " + NumberText(counts.high)};
}

/// Describes the angle at which the converter saturates within the potentiometer's travel.
std::string SaturationText(const AdcSensor& sensor) {
  const auto angle = sensor.SaturationAngleDeg();
  if (!angle) return "";
  AdcSensor divided = sensor;
  divided.divider = sensor.reference_voltage / sensor.supply_voltage;
  const double highest = sensor.divider * sensor.supply_voltage;
  return Prose("With a reference of " + FourDigits(sensor.reference_voltage) + " V, below the " + FourDigits(highest) +
               " V that the potentiometer gives, all angles above " + FourDigits(*angle) + " deg read " +
               NumberText(sensor.FullScale()) + (*angle <= 0 ? ", the middle of the travel among them" : "") +
               ". --divider " + FourDigits(divided.divider) +
               " would keep the voltage of the whole travel below the reference, at " +
               FourDigits(divided.DegPerCount()) + " deg per count.");
}

}  // namespace

std::string AdcPlanText(std::span<const AdcSensor> sensors) {
  if (sensors.empty()) return "";
  const AdcSensor& first = sensors.front();
  std::vector<std::vector<std::string>> rows;
  std::string remarks;
  for (const AdcSensor& sensor : sensors) {
    rows.push_back(SensorRow(sensor));
    remarks += SaturationText(sensor);
  }
  return "[[Sensor]]\n" +
         Prose("Potentiometer of " + FourDigits(first.travel_deg) + " deg across " + FourDigits(first.supply_voltage) +
               " V" + (first.divider == 1 ? "" : ", divided by " + FourDigits(1 / first.divider)) + ", read by " +
               std::to_string(first.bits) + " bits; angles in deg from the middle of the travel.") +
         AlignedTable({{"reference [V]", true},
                       {"deg per count", true},
                       {"counts per deg", true},
                       {"usable [deg]", true},
                       {"about the middle [deg]", true},
                       {"counts", true}},
                      rows, kTextIndent) +
         remarks;
}

}  // namespace pendulum
