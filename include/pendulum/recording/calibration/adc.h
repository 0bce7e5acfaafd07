// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "pendulum/recording/sensor.h"

namespace pendulum {

/// A potentiometer across a supply, its wiper read by an analog-to-digital converter (ADC) through a voltage divider.
/// Angles are in deg from the middle of the travel, along which the wiper's voltage rises evenly from 0 to the supply:
///   volts = divider supply (1/2 + angle / travel),   counts = ⌊volts 2ᵇⁱᵗˢ / reference⌋, from 0 to 2ᵇⁱᵗˢ - 1
/// (MODEL.md eq. (43)). Sources: Microchip, ATmega328P data sheet (DS40002061), "ADC Conversion Result": ADC = V_IN
/// 1024 / V_REF, full scale stands for V_REF less one step. The divider and the converter are taken to draw no current
/// from the wiper. Preconditions: 1 <= bits <= 32, voltages and travel positive, 0 < divider <= 1.
struct AdcSensor {
  int bits = 10;
  double reference_voltage = 5, supply_voltage = 5;  ///< V: just beyond full scale; across the potentiometer.
  double travel_deg = 270;                           ///< Deg, electrical travel of the potentiometer.
  double divider = 1;  ///< V at the converter for 1 V at the wiper: R2 / (R1 + R2), 1 without a divider.

  /// The highest count, 2ᵇⁱᵗˢ - 1.
  double FullScale() const;

  /// V at the converter. Beyond the travel it is that of its end.
  double Volts(double angle_deg) const;

  /// What the converter shows, a whole number; full scale from the reference voltage on.
  double Counts(double angle_deg) const;

  /// The angle [deg] in the middle of those that the converter shows as this count.
  double AngleDeg(double counts) const;

  /// q = travel reference / (2ᵇⁱᵗˢ divider supply), and 1 / q.
  double DegPerCount() const;

  double CountsPerDeg() const;

  /// Counts at both ends of the travel.
  SensorRange ReadingRange() const;

  /// The angle [deg] from which on the converter shows full scale whatever the angle: that of the reference voltage.
  /// None: the supply through the divider does not exceed the reference.
  std::optional<double> SaturationAngleDeg() const;

  /// The angles [deg] that counts tell: the travel, or its part below saturation.
  SensorRange UsableAnglesDeg() const;
};

}  // namespace pendulum
