// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "pendulum/recording/sensor.h"

namespace pendulum {

/// A potentiometer across a supply. An analog-to-digital converter (ADC) reads its wiper through a voltage divider.
/// Angles are in deg from the middle of the travel. The wiper's voltage rises linearly along the travel, from 0 to
/// supply:
///   volts = divider supply (1/2 + angle / travel),   counts = ⌊volts 2ᵇⁱᵗˢ / reference⌋, from 0 to 2ᵇⁱᵗˢ - 1
/// (MODEL.md eq. (8.4)). Sources: Microchip, ATmega328P data sheet (DS40002061), "ADC Conversion Result": ADC = V_IN
/// 1024 / V_REF; full scale represents V_REF minus one step. Divider and converter are assumed to draw no current from
/// the wiper. Preconditions: 1 <= bits <= 32, voltages and travel positive, 0 < divider <= 1.
struct AdcSensor {
  int bits = 10;
  /// V. The reference is one step above full scale; the supply is across the potentiometer.
  double reference_voltage = 5, supply_voltage = 5;
  double travel_deg = 270;  ///< Deg, electrical travel of the potentiometer.
  double divider = 1;       ///< V at the converter for 1 V at the wiper: R2 / (R1 + R2), 1 without a divider.

  /// The largest count, 2ᵇⁱᵗˢ - 1.
  double FullScale() const;

  /// V at the converter. Beyond the travel, the voltage is the same as at the end of the travel.
  double Volts(double angle_deg) const;

  /// The reading of the converter, a whole number; full scale at the reference voltage and above.
  double Counts(double angle_deg) const;

  /// The middle [deg] of the angles for which the converter gives this count.
  double AngleDeg(double counts) const;

  /// q = travel reference / (2ᵇⁱᵗˢ divider supply), and 1 / q.
  double DegPerCount() const;

  double CountsPerDeg() const;

  /// Counts at both ends of the travel.
  SensorRange ReadingRange() const;

  /// The angle [deg] at which the reference voltage is reached. Above it the converter always shows full scale.
  /// std::nullopt: the supply through the divider does not exceed the reference.
  std::optional<double> SaturationAngleDeg() const;

  /// The angles [deg] that counts can distinguish: the travel, or its part below saturation.
  SensorRange UsableAnglesDeg() const;
};

}  // namespace pendulum
