// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/readings_at.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stop_token>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/likelihood/edge_noise.h"
#include "tests/analysis/checked_run.h"
#include "tests/analysis/fitted_run.h"
#include "tests/fitting/joint_recordings.h"

namespace pendulum::readings_at_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

double RangeOf(const Eigen::VectorXd& readings) { return readings.maxCoeff() - readings.minCoeff(); }

/// Expects the fitted readings at the estimates, but for the errors of the two trajectories.
void ExpectFitted(const FitOfRun& run, const std::string& what) {
  ASSERT_NE(run.fit.termination, Termination::kFailed) << what << ": " << run.fit.reason;
  const Eigen::VectorXd readings = Must(ReadingsAt(run.recording, run.fit, run.rig, {}));
  EXPECT_LT((readings - run.fit.fitted).cwiseAbs().maxCoeff(), 3e-9 * RangeOf(run.fit.fitted)) << what;
}

Recording Simulated(const SyntheticOptions& run) { return Must(SimulateRecording(run)); }

/// The clock starts at 1000 s and is 2 % slow.
Recording OnSlowClock(SyntheticOptions run) {
  run.start_time = 1000;
  run.release_time += 1000;
  Recording recording = Simulated(run);
  recording.clock_scale = 1.02;
  return recording;
}

// ---- At the estimates ----------------------------------------------------------------------------------------------

TEST(ReadingsAt, AreTheFittedReadingsForEveryLaw) {
  for (const MotionModel& model : MotionModels()) {
    const std::string name(model.name);
    ExpectFitted(FitTo(NoisyRun(name), name, {}), name);
    ExpectFitted(FitTo(MovingRun(name), name, TextbookRig()), name + ", rig");
  }
}

TEST(ReadingsAt, AreTheFittedReadingsForEverySensor) {
  SyntheticOptions rate = NoisyRun();
  rate.quantity = Quantity::kRate;
  rate.zero = 0.07;
  ExpectFitted(FitTo(rate, "coulomb", {}), "rate");
  const std::vector<SyntheticOptions> sensors = {
      MeasuredSwing(Quantity::kRate, SensorKind::kScaledRate, {1.65, 0.115}, 0.002),
      MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0.1, 1.005, 0.02, 0.3}, 0.05),
      MeasuredSwing(Quantity::kPosition, SensorKind::kCoordinate, {0.01, 640, 400}, 0.5)};
  for (const SyntheticOptions& run : sensors) {
    ExpectFitted(FitTo(run, "coulomb", {}), std::to_string(static_cast<int>(run.sensor.kind)));
  }
  Recording counts = Simulated(NoisyRun("linear"));
  counts.unit = "counts";
  counts.value = 512 + 300 * counts.value.array();
  ExpectFitted(FitTo(counts, ModelOptions("linear")), "counts");
}

TEST(ReadingsAt, AreTheFittedReadingsOnAnyClock) {
  for (const char* model : {"viscous", "coulomb"}) {
    for (const SyntheticOptions& run : {NoisyRun(model), MovingRun(model)}) {
      for (const std::optional<Rig>& rig : {std::optional<Rig>(), std::optional(TextbookRig())}) {
        FitOptions options = ModelOptions(model);
        options.rig = rig;
        ExpectFitted(FitTo(OnSlowClock(run), options), std::string(model) + (rig ? ", rig" : ", no rig"));
      }
    }
  }
}

TEST(ReadingsAt, IncludeADriftingZero) {
  Recording recording = OnSlowClock(NoisyRun());
  recording.value.array() += 0.001 * (recording.time.array() - 1000);
  FitOptions options = ModelOptions("coulomb");
  options.initial["zero_drift"] = 0;
  const FitOfRun run = FitTo(recording, options);
  ASSERT_NE(run.fit.Find("zero_drift"), nullptr);
  ExpectFitted(run, "zero_drift");
}

TEST(ReadingsAt, IncludeTheHysteresisOfEvents) {
  SyntheticOptions options = TextbookRun("coulomb");
  options.rows = RowTiming::kEvents;
  options.resolution = 0.02;
  options.hysteresis = 0.003;
  options.noise = 0.0002;
  const FitOfRun run = FitTo(WithEdges(Simulated(options), {}), ModelOptions("coulomb"));
  ASSERT_NE(run.fit.Find("hysteresis"), nullptr);
  ExpectFitted(run, "hysteresis");
}

// Readings that are 2 % too large contradict how the period depends on the amplitude, and the fit corrects them.
TEST(ReadingsAt, IncludeTheCorrectionOfTheReadings) {
  SyntheticOptions options = NoisyTextbookRun("coulomb");
  options.duration = 30;
  Recording recording = Simulated(options);
  recording.value *= 1.02;
  recording.sensor_errors.Of(SensorEffect::kGain) = {0.01, "assumed"};
  const FitOfRun run = FitTo(recording, ModelOptions("coulomb"));
  ASSERT_GT(run.fit.correction.size(), 0);
  ExpectFitted(run, "correction");
}

TEST(ReadingsAt, AreTheFittedReadingsOfEachOfSeveralRecordings) {
  SyntheticOptions gyro = MovingRun("coulomb");
  gyro.quantity = Quantity::kRate;
  gyro.noise = 0.002;
  const Recordings recordings = {OnSlowClock(Released(0.5, 1)), Simulated(Released(1.0, 2)), Simulated(gyro)};
  const JointFit fit = FitAllJointly(recordings, RigOptions());
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    ExpectFitted({recordings[k], fit.runs[k], RigOptions().rig}, "recording " + std::to_string(k));
  }
}

// ---- At other values -----------------------------------------------------------------------------------------------

/// Expects the readings that `other` has without noise, from the fit to `run`, at the true values of `other`. The
/// simulator is exact to 1e-12 rad, a trajectory to some 1e-10 rad for each of its steps.
void ExpectSimulated(const SyntheticOptions& run, SyntheticOptions other, double torque,
                     const std::optional<Rig>& rig) {
  const FitOfRun fitted = FitTo(run, run.model.name, rig);
  const std::vector<double> truth = TrueParameters(other);
  ParameterValues values;
  for (std::size_t i = 0; i < fitted.fit.parameters.size(); ++i) {
    const ParameterInfo& info = fitted.fit.parameters[i].info;
    values.emplace(info.name, truth[i] * (info.scales_with_gravity() ? torque : 1.0));
  }
  other.noise = 0;
  const Eigen::VectorXd readings = Must(ReadingsAt(fitted.recording, fitted.fit, rig, values));
  const Eigen::VectorXd expected = Simulated(other).value;
  EXPECT_LT((readings - expected).cwiseAbs().maxCoeff(), 3e-8 * RangeOf(expected)) << run.model.name;
}

TEST(ReadingsAt, OtherValuesAreThoseOfTheSimulatorForEveryLaw) {
  for (const MotionModel& model : MotionModels()) {
    const SyntheticOptions run = NoisyRun(model.name);
    SyntheticOptions other = run;
    for (double& parameter : other.parameters) parameter *= 1.1;
    other.release_angle = 0.5;
    other.release_time = 1.7;
    other.zero = -0.02;
    ExpectSimulated(run, other, 1, {});
    ExpectSimulated(run, other, TextbookRig().gravity_torque.value, TextbookRig());
  }
}

TEST(ReadingsAt, OtherValuesAreThoseOfTheSimulatorForEverySensor) {
  const std::vector<SyntheticOptions> sensors = {
      MeasuredSwing(Quantity::kRate, SensorKind::kScaledRate, {1.65, 0.115}, 0.002),
      MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0.1, 1.005, 0.02, 0.3}, 0.05),
      MeasuredSwing(Quantity::kPosition, SensorKind::kCoordinate, {0.01, 640, 400}, 0.5)};
  for (const SyntheticOptions& run : sensors) {
    SyntheticOptions other = run;
    other.parameters[0] *= 1.1;
    other.initial_rate = 0.4;
    other.sensor_parameters.back() *= 1.2;
    ExpectSimulated(run, other, 1, {});
  }
}

TEST(ReadingsAt, ParametersWithoutAValueKeepTheirEstimates) {
  const FitOfRun run = FitTo(NoisyRun(), "coulomb", TextbookRig());
  const double shift = 0.1;
  const Eigen::VectorXd shifted =
      Must(ReadingsAt(run.recording, run.fit, run.rig, {{"zero_angle", run.fit.Find("zero_angle")->estimate + shift}}));
  const Eigen::VectorXd at_estimates = Must(ReadingsAt(run.recording, run.fit, run.rig, {}));
  EXPECT_LT((shifted - at_estimates).cwiseAbs().maxCoeff() - shift, 1e-12);
  EXPECT_GT((shifted - at_estimates).minCoeff(), shift - 1e-12);
}

// ---- Values without a motion ---------------------------------------------------------------------------------------

TEST(ReadingsAt, RefuseValuesWithoutAMotion) {
  const FitOfRun run = FitTo(NoisyRun(), "coulomb", TextbookRig());
  const auto message = [&](const std::string& name, double value) {
    const auto readings = ReadingsAt(run.recording, run.fit, run.rig, {{name, value}});
    if (readings) return name + " is accepted";
    EXPECT_EQ(readings.error().code, StatusCode::kInvalidArgument);
    return readings.error().message();
  };
  EXPECT_THAT(message("inertia", 0), StartsWith("inertia is 0 kg m^2; it must be at least 0.0007"));
  EXPECT_THAT(message("inertia", -0.1), StartsWith("inertia is -0.1 kg m^2; it must be at least"));
  EXPECT_THAT(message("inertia", std::nan("")), StartsWith("inertia is nan kg m^2; it must be at least"));
  EXPECT_EQ(message("release_angle", std::numeric_limits<double>::infinity()),
            "release_angle is inf rad; it must be finite");
  EXPECT_EQ(message("viscous", -0.001), "viscous is -0.001 N m s/rad; it must be at least 0 N m s/rad");
  EXPECT_EQ(message("release_time", -0.5), "release_time is -0.5 s; it must be from 0 to 9.99 s");
  EXPECT_THAT(message("release_time", 10), HasSubstr("from 0 to 9.99 s"));
  EXPECT_THAT(message("coulomb", 10), HasSubstr("friction holds the pendulum at its start"));
  EXPECT_EQ(message("drag", 0.1),
            "this fit of model coulomb has no parameter 'drag'; it has inertia, viscous, coulomb, release_angle, "
            "release_time, zero_angle");
}

// 1e5 rad/s over 10 s is some 160 000 turns.
TEST(ReadingsAt, EndAtAStop) {
  const FitOfRun run = FitTo(MovingRun("coulomb"), "coulomb", {});
  std::stop_source stop;
  stop.request_stop();
  const auto readings = ReadingsAt(run.recording, run.fit, run.rig, {{"initial_rate", 1e5}}, stop.get_token());
  ASSERT_FALSE(readings);
  EXPECT_EQ(readings.error().code, StatusCode::kTryAgain);
  EXPECT_EQ(readings.error().message(), "the readings were stopped before the motion was computed");
}

TEST(ReadingsAt, NeedEstimates) {
  FitOfRun run = FitTo(NoisyRun(), "coulomb", {});
  run.fit.termination = Termination::kFailed;
  run.fit.reason = "friction holds it";
  const auto readings = ReadingsAt(run.recording, run.fit, run.rig, {});
  ASSERT_FALSE(readings);
  EXPECT_EQ(readings.error().code, StatusCode::kFailedPrecondition);
  EXPECT_EQ(readings.error().message(), "the fit of model coulomb has no estimates: friction holds it");
}

}  // namespace
}  // namespace pendulum::readings_at_test
