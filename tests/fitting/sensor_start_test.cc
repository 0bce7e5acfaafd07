// SPDX-License-Identifier: Apache-2.0
// Fits of readings that are neither an angle nor a rate: their truth is found again, within the errors they give.
#include "pendulum/fitting/sensor_start.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/fitting/fit.h"
#include "pendulum/trajectory/synthetic.h"

namespace pendulum::sensor_start_test {
namespace {

using testing::HasSubstr;
using testing::Le;

/// A swing of 0.6 rad for 30 s at 100 Hz, seen by a sensor with some noise.
SyntheticOptions Seen(Quantity quantity, SensorKind kind, std::vector<double> parameters, double noise) {
  SyntheticOptions options;
  options.parameters = {1 / 22.0, 0.05 / 22, 0.05 / 22};
  options.start = StartKind::kMoving;
  options.initial_angle = 0.6;
  options.initial_rate = 0;
  options.duration = 30;
  options.quantity = quantity;
  options.sensor.kind = kind;
  if (kind == SensorKind::kAcceleration) options.sensor.gravity = kStandardGravity;
  options.sensor_parameters = std::move(parameters);
  options.noise = noise;
  return options;
}

FitReport Fit(const SyntheticOptions& options, const FitOptions& fit = {}) {
  const Result<Recording> recording = SimulateRecording(options);
  EXPECT_TRUE(recording) << recording.error().message;
  const Result<FitReport> report = FitRecording(*recording, fit);
  EXPECT_TRUE(report) << report.error().message;
  return report.value_or(FitReport{});
}

/// Every parameter within 4.5 of its standard errors of the truth: twelve of them miss that once in 12 000 fits.
void ExpectTruth(const SyntheticOptions& options, const FitReport& fit) {
  ASSERT_EQ(fit.termination, Termination::kConverged) << fit.reason;
  const std::vector<double> truth = TrueParameters(options);
  ASSERT_EQ(fit.parameters.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const ParameterEstimate& parameter = fit.parameters[i];
    ASSERT_TRUE(parameter.std_error) << parameter.info.name;
    EXPECT_THAT(std::abs(parameter.estimate - truth[i]), Le(4.5 * *parameter.std_error)) << parameter.info.name;
  }
}

TEST(FitRecording, FindsTheScaleOfAGyroInVolts) {
  const SyntheticOptions options = Seen(Quantity::kRate, SensorKind::kScaledRate, {1.65, 0.115}, 0.002);
  const FitReport fit = Fit(options);
  ExpectTruth(options, fit);
  EXPECT_EQ(fit.Find("rate_bias")->unit, "volts");
  EXPECT_EQ(fit.Find("rate_scale")->unit, "volts s/rad");
}

TEST(FitRecording, FindsRadiusAndAxisOfAnAccelerometerAcrossTheRod) {
  const SyntheticOptions options =
      Seen(Quantity::kAcceleration, SensorKind::kAcceleration, {0.1, 1.005, 0.02, 0.3}, 0.05);
  ExpectTruth(options, Fit(options));
}

TEST(FitRecording, FindsRadiusAndAxisOfAnAccelerometerAlongTheRod) {
  for (const double upright : {1.0, -1.0}) {
    const SyntheticOptions options =
        Seen(Quantity::kAcceleration, SensorKind::kAcceleration, {0.1, 1.005, upright * (kPi / 2 + 0.02), 0.3}, 0.05);
    ExpectTruth(options, Fit(options));
  }
}

TEST(FitRecording, FindsThePivotOfAHorizontalCoordinate) {
  const SyntheticOptions options = Seen(Quantity::kPosition, SensorKind::kCoordinate, {0.01, 640, 400}, 0.5);
  const FitReport fit = Fit(options);
  ExpectTruth(options, fit);
  EXPECT_EQ(fit.Find("radius")->unit, "m");
}

TEST(FitRecording, FindsThePivotOfBothCoordinates) {
  const SyntheticOptions options = Seen(Quantity::kAngle, SensorKind::kArc, {0.01, 640, 120, 400}, 0.5);
  ExpectTruth(options, Fit(options));
}

/// Small swings are those of a linear pendulum: no scale can be told, and none is.
TEST(FitRecording, SaysWhatSmallSwingsDoNotTell) {
  SyntheticOptions options = Seen(Quantity::kRate, SensorKind::kScaledRate, {1.65, 0.115}, 0.002);
  options.initial_angle = 0.05;
  options.parameters[2] = 0;
  const FitReport fit = Fit(options);
  const ParameterEstimate& scale = *fit.Find("rate_scale");
  const bool is_told = fit.termination == Termination::kConverged && scale.std_error && *scale.std_error < 0.2 * 0.115;
  EXPECT_FALSE(is_told) << fit.reason;
  // What is known of it beforehand makes it a fit again.
  FitOptions known;
  known.priors["rate_scale"] = {0.115, 0.001};
  const FitReport with_prior = Fit(options, known);
  ASSERT_EQ(with_prior.termination, Termination::kConverged) << with_prior.reason;
  EXPECT_THAT(std::abs(with_prior.Find("rate_scale")->estimate - 0.115), Le(0.003));
}

TEST(FitRecording, FitsAnyReadingByTheLinearModel) {
  FitOptions linear;
  linear.model = "linear";
  for (const SyntheticOptions& options :
       {Seen(Quantity::kRate, SensorKind::kScaledRate, {1.65, 0.115}, 0.002),
        Seen(Quantity::kAcceleration, SensorKind::kAcceleration, {0, 1, 0, 0.3}, 0.02),
        Seen(Quantity::kPosition, SensorKind::kCoordinate, {0, 640, 400}, 0.5)}) {
    SyntheticOptions small = options;
    small.initial_angle = 0.05;
    small.parameters[2] = 0;
    const FitReport fit = Fit(small, linear);
    ASSERT_EQ(fit.termination, Termination::kConverged) << fit.reason;
    EXPECT_NEAR(fit.Find("inertia")->estimate, 1 / 22.0, 2e-4);
  }
}

TEST(FitRecording, RefusesWhatAnAccelerationCannotTell) {
  const Recording along =
      SimulateRecording(Seen(Quantity::kAcceleration, SensorKind::kAcceleration, {0, 1, kPi / 2, 0.3}, 0.05)).value();
  FitOptions options;
  options.model = "linear";
  const auto linear = FitRecording(along, options);
  ASSERT_FALSE(linear);
  EXPECT_THAT(linear.error().message, HasSubstr("swings twice as fast"));
  options.model = "coulomb";
  options.start = StartChoice::kRelease;
  const auto released = FitRecording(along, options);
  ASSERT_FALSE(released);
  EXPECT_THAT(released.error().message, HasSubstr("jumps at the release"));
}

}  // namespace
}  // namespace pendulum::sensor_start_test
