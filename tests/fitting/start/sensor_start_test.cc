// SPDX-License-Identifier: Apache-2.0
// Fits of readings that are neither an angle nor a rate recover the true values within their errors.
#include "pendulum/fitting/start/sensor_start.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/fitting/swing/fit_swing.h"
#include "pendulum/trajectory/synthetic.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::sensor_start_test {
namespace {

using testing::AllOf;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;

FitReport Fit(const SyntheticOptions& options, const FitOptions& fit = {}) {
  const Result<Recording> recording = SimulateRecording(options);
  EXPECT_TRUE(recording) << recording.error().message();
  const Result<FitReport> report = FitRecording(*recording, fit);
  EXPECT_TRUE(report) << report.error().message();
  return report.value_or(FitReport{});
}

TEST(FitRecording, FindsTheScaleOfAGyroInVolts) {
  const SyntheticOptions options = MeasuredSwing(Quantity::kRate, SensorKind::kScaledRate, {1.65, 0.115}, 0.002);
  const FitReport fit = Fit(options);
  ExpectTruth(options, fit);
  EXPECT_EQ(fit.Find("rate_bias")->unit, "volts");
  EXPECT_EQ(fit.Find("rate_scale")->unit, "volts s/rad");
}

TEST(FitRecording, FindsRadiusAndAxisOfAnAccelerometerAcrossTheRod) {
  const SyntheticOptions options =
      MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0.1, 1.005, 0.02, 0.3}, 0.05);
  ExpectTruth(options, Fit(options));
}

TEST(FitRecording, FindsRadiusAndAxisOfAnAccelerometerAlongTheRod) {
  for (const double upright : {1.0, -1.0}) {
    const SyntheticOptions options = MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration,
                                                   {0.1, 1.005, upright * (kPi / 2 + 0.02), 0.3}, 0.05);
    ExpectTruth(options, Fit(options));
  }
}

/// An acceleration sample cannot show the release: the window begins after the hold, regardless of its length.
TEST(FitSwing, StartsTheWindowOfAnAccelerationAfterTheHold) {
  for (const double axis : {0.02, kPi / 2 + 0.02}) {
    for (const double release : {0.5, 2.0}) {
      SCOPED_TRACE(std::to_string(axis) + " rad, held for " + std::to_string(release) + " s");
      SyntheticOptions options =
          MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0.1, 1.005, axis, 0.3}, 0.03);
      options.start = StartKind::kRelease;
      options.release_angle = 0.8;
      options.release_time = release;
      const Recording recording = Must(SimulateRecording(options));
      const ChosenSwings swings = Must(ChooseSwings(recording, {}));
      const SwingFit result = Must(FitSwing(recording, swings.found.at(0), {}));
      EXPECT_EQ(result.fit.termination, Termination::kConverged) << result.fit.reason;
      EXPECT_EQ(Sentence(result.swing.begins), "after the release, at which an acceleration jumps");
      EXPECT_THAT(result.swing.from - release, AllOf(Ge(0.0), Le(0.3)));
      for (const std::string_view name : {"inertia", "viscous", "coulomb", "radius", "axis"}) {
        const ParameterEstimate& parameter = *result.fit.Find(name);
        const double truth = name == "inertia"   ? options.parameters[0]
                             : name == "viscous" ? options.parameters[1]
                             : name == "coulomb" ? options.parameters[2]
                             : name == "axis"    ? axis
                                                 : 0.3;
        EXPECT_THAT(std::abs(parameter.estimate - truth), Le(4.5 * parameter.std_error.value())) << name;
      }
    }
  }
}

/// With jumps of 0.13 m/s², six times the noise, a third of the searches end next to a jump.
TEST(FitRecording, ReportsADiscontinuityThatStoppedTheSearch) {
  int stopped = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 6U, 8U, 9U, 10U}) {
    SyntheticOptions options =
        MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0, 1, 0.02, 0.3}, 0.02);
    options.parameters = {1 / 22.0, 0.0005, 0.01};
    options.duration = 15;
    options.seed = seed;
    const FitReport fit = Fit(options);
    EXPECT_EQ(fit.termination, Termination::kConverged) << fit.reason;
    const bool at_discontinuity = fit.reason.starts_with("the search stopped at a jump in the sum of squares");
    EXPECT_TRUE(at_discontinuity || fit.reason == "the estimates are within 0.1 standard errors of the minimum")
        << fit.reason;
    stopped += at_discontinuity ? 1 : 0;
  }
  EXPECT_GE(stopped, 1);
}

/// Without gravity, recorded until the pendulum rests: k r ω² along the rod and k r α across it.
TEST(FitRecording, FindsTheRadiusWithoutGravityInTheReadings) {
  for (const auto& [axis, duration] :
       {std::pair(0.02, 150.0), std::pair(kPi / 2 + 0.02, 30.0), std::pair(-kPi / 2 - 0.02, 150.0)}) {
    SCOPED_TRACE(std::to_string(axis) + " rad, " + std::to_string(duration) + " s");
    SyntheticOptions options =
        MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0.05, 1.005, axis, 0.3}, 0.02);
    options.sensor.gravity = 0;
    options.duration = duration;
    options.sample_rate = 50;
    ExpectTruth(options, Fit(options));
  }
}

TEST(FitRecording, RefusesAZeroScaleOrRadiusOfASensor) {
  const auto message = [](const SyntheticOptions& options, const std::string& name) {
    FitOptions fit;
    fit.initial[name] = 0;
    const auto begun = FitRecording(SimulateRecording(options).value(), fit);
    std::swap(fit.initial, fit.fixed);
    const auto fixed = FitRecording(SimulateRecording(options).value(), fit);
    EXPECT_FALSE(begun || fixed);
    if (begun || fixed) return std::string();
    EXPECT_EQ(begun.error().code, StatusCode::kInvalidArgument);
    EXPECT_EQ(fixed.error().message(), begun.error().message());
    return begun.error().message();
  };
  EXPECT_EQ(message(MeasuredSwing(Quantity::kRate, SensorKind::kScaledRate, {1.65, 0.115}, 0.002), "rate_scale"),
            "rate_scale cannot be 0, because the sensor would then show no motion; it must be other than 0");
  EXPECT_EQ(message(MeasuredSwing(Quantity::kPosition, SensorKind::kCoordinate, {0.01, 640, 400}, 0.5), "radius"),
            "radius cannot be 0, because the sensor would then show no motion; it must be greater than 0");
  EXPECT_EQ(message(MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0, 1, 0, 0.3}, 0.05),
                    "acceleration_scale"),
            "acceleration_scale cannot be 0, because the sensor would then show no motion; it must be greater than 0");
}

TEST(FitRecording, FindsThePivotOfAHorizontalCoordinate) {
  const SyntheticOptions options = MeasuredSwing(Quantity::kPosition, SensorKind::kCoordinate, {0.01, 640, 400}, 0.5);
  const FitReport fit = Fit(options);
  ExpectTruth(options, fit);
  EXPECT_EQ(fit.Find("radius")->unit, "m");
}

TEST(FitRecording, FindsThePivotOfBothCoordinates) {
  const SyntheticOptions options = MeasuredSwing(Quantity::kAngle, SensorKind::kArc, {0.01, 640, 120, 400}, 0.5);
  ExpectTruth(options, Fit(options));
}

/// Small swings are those of a linear pendulum: the scale cannot be determined, and the fit reports no scale.
TEST(FitRecording, ReportsParametersSmallSwingsCannotDetermine) {
  SyntheticOptions options = MeasuredSwing(Quantity::kRate, SensorKind::kScaledRate, {1.65, 0.115}, 0.002);
  options.initial_angle = 0.05;
  options.parameters[2] = 0;
  const FitReport fit = Fit(options);
  const ParameterEstimate& scale = *fit.Find("rate_scale");
  const bool has_identifiability =
      fit.termination == Termination::kConverged && scale.std_error && *scale.std_error < 0.2 * 0.115;
  EXPECT_FALSE(has_identifiability) << fit.reason;
  // A prior on the scale makes the fit possible again.
  FitOptions known;
  known.priors["rate_scale"] = {0.115, 0.001};
  const FitReport with_prior = Fit(options, known);
  ASSERT_EQ(with_prior.termination, Termination::kConverged) << with_prior.reason;
  EXPECT_THAT(std::abs(with_prior.Find("rate_scale")->estimate - 0.115), Le(0.003));
}

TEST(FitRecording, FitsUncalibratedReadingsWithTheLinearModel) {
  FitOptions linear;
  linear.model = "linear";
  for (const SyntheticOptions& options :
       {MeasuredSwing(Quantity::kRate, SensorKind::kScaledRate, {1.65, 0.115}, 0.002),
        MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0, 1, 0, 0.3}, 0.02),
        MeasuredSwing(Quantity::kPosition, SensorKind::kCoordinate, {0, 640, 400}, 0.5)}) {
    SyntheticOptions small = options;
    small.initial_angle = 0.05;
    small.parameters[2] = 0;
    const FitReport fit = Fit(small, linear);
    ASSERT_EQ(fit.termination, Termination::kConverged) << fit.reason;
    EXPECT_NEAR(fit.Find("inertia")->estimate, 1 / 22.0, 2e-4);
  }
}

TEST(FitRecording, RefusesParametersAnAccelerationCannotDetermine) {
  const Recording along =
      SimulateRecording(MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0, 1, kPi / 2, 0.3}, 0.05))
          .value();
  FitOptions options;
  options.model = "linear";
  const auto linear = FitRecording(along, options);
  ASSERT_FALSE(linear);
  EXPECT_THAT(linear.error().message(), HasSubstr("swings twice as fast"));
  options.model = "coulomb";
  options.start = StartKind::kRelease;
  const auto released = FitRecording(along, options);
  ASSERT_FALSE(released);
  EXPECT_THAT(released.error().message(), HasSubstr("jumps at the release"));
}

}  // namespace
}  // namespace pendulum::sensor_start_test
