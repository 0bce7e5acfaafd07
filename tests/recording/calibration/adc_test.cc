// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/calibration/adc.h"

#include <cmath>

#include <gtest/gtest.h>

namespace pendulum::adc_test {
namespace {

/// 5 V across 300 deg, converted with 10 bits: 1024 counts in 300 deg.
AdcSensor Sensor(double reference_voltage = 5, double divider = 1) {
  return {
      .bits = 10, .reference_voltage = reference_voltage, .supply_voltage = 5, .travel_deg = 300, .divider = divider};
}

// Computed by hand from ADC = V_IN 1024 / V_REF of the data sheet.
TEST(AdcSensor, GivesTheCountsOfTheDataSheet) {
  EXPECT_EQ(Sensor().Counts(0), 512);       // 2.5 V
  EXPECT_EQ(Sensor().Counts(-150), 0);      // 0 V
  EXPECT_EQ(Sensor().Counts(60), 716);      // 3.5 V: 716.8, truncated
  EXPECT_EQ(Sensor(3.3).Counts(0), 775);    // 775.76
  EXPECT_EQ(Sensor(1.1).Counts(-90), 930);  // 1 V: 930.9
  EXPECT_DOUBLE_EQ(Sensor().Volts(60), 3.5);
  EXPECT_DOUBLE_EQ(Sensor(5, 0.5).Volts(60), 1.75);
}

TEST(AdcSensor, ResolvesMoreWithALowerReference) {
  EXPECT_DOUBLE_EQ(Sensor().DegPerCount(), 300.0 / 1024);
  EXPECT_DOUBLE_EQ(Sensor(3.3).DegPerCount(), 300.0 / 1024 * 0.66);
  EXPECT_DOUBLE_EQ(Sensor(1.1).DegPerCount(), 300.0 / 1024 * 0.22);
  EXPECT_DOUBLE_EQ(Sensor(1.1).CountsPerDeg(), 1024 / 300.0 / 0.22);
  AdcSensor fine = Sensor();
  fine.bits = 16;
  EXPECT_DOUBLE_EQ(fine.DegPerCount(), 300.0 / 65536);
  EXPECT_EQ(fine.FullScale(), 65535);
}

TEST(AdcSensor, SaturatesWhereTheVoltagePassesTheReference) {
  const AdcSensor sensor = Sensor(3.3);
  EXPECT_NEAR(sensor.SaturationAngleDeg().value(), 48, 1e-12);  // 3.3 V = 5 V (1/2 + 48/300)
  EXPECT_EQ(sensor.Counts(47.9), 1023);
  EXPECT_EQ(sensor.Counts(47.7), 1022);
  EXPECT_EQ(sensor.Counts(48.1), 1023);
  EXPECT_EQ(sensor.Counts(150), 1023);
  EXPECT_EQ(sensor.UsableAnglesDeg().low, -150);
  EXPECT_NEAR(sensor.UsableAnglesDeg().high, 48, 1e-12);
  EXPECT_NEAR(Sensor(1.1).SaturationAngleDeg().value(), -84, 1e-12);  // below the middle
}

TEST(AdcSensor, DoesNotSaturateBehindADivider) {
  for (const AdcSensor& sensor : {Sensor(5), Sensor(3.3, 0.66), Sensor(3.3, 0.5)}) {
    EXPECT_FALSE(sensor.SaturationAngleDeg());
    EXPECT_EQ(sensor.UsableAnglesDeg().high, 150);
  }
  EXPECT_DOUBLE_EQ(Sensor(3.3, 0.66).DegPerCount(), Sensor().DegPerCount());
}

TEST(AdcSensor, GivesTheReadingsAtTheEndsOfTheTravel) {
  EXPECT_EQ(Sensor().ReadingRange().low, 0);
  EXPECT_EQ(Sensor().ReadingRange().high, 1023);  // 5 V is just above full scale
  EXPECT_EQ(Sensor(5, 0.5).ReadingRange().high, 512);
  EXPECT_EQ(Sensor().Counts(1000), 1023);  // beyond the stop
  EXPECT_EQ(Sensor().Counts(-1000), 0);
}

TEST(AdcSensor, ReproducesTheAngleWithinHalfACount) {
  for (const AdcSensor& sensor : {Sensor(), Sensor(3.3), Sensor(5, 0.3)}) {
    const SensorRange usable = sensor.UsableAnglesDeg();
    for (double angle = usable.low; angle < usable.high; angle += 0.37) {
      const double counts = sensor.Counts(angle);
      EXPECT_LE(std::abs(sensor.AngleDeg(counts) - angle), sensor.DegPerCount() * (0.5 + 1e-9)) << angle;
      EXPECT_EQ(sensor.Counts(sensor.AngleDeg(counts)), counts) << angle;
    }
  }
}

}  // namespace
}  // namespace pendulum::adc_test
