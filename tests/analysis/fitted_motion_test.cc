// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/fitted_motion.h"

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/closed_form/period.h"
#include "pendulum/fitting/likelihood/fit_parameters.h"
#include "tests/analysis/fitted_run.h"

namespace pendulum::fitted_motion_test {
namespace {

using testing::DoubleNear;

// The fit's trajectory has an error of 1e-8 rad, the motion's 1e-10 per step.
constexpr double kTraceError = 3e-8;

/// θ of small swings with viscous friction, released at rest (units of the restoring torque G).
double ViscousSwing(double time, double inertia, double viscous, double angle) {
  const double decay = viscous / (2 * inertia);
  const double frequency = std::sqrt(1 / inertia - decay * decay);
  const double phase = frequency * std::max(time, 0.0);
  return angle * std::exp(-decay * std::max(time, 0.0)) * (std::cos(phase) + decay / frequency * std::sin(phase));
}

/// The report of a fit that found the true values of a recording.
FitReport TrueReport(const SyntheticOptions& run) {
  FitReport fit;
  fit.model = run.model;
  fit.start = run.start;
  fit.quantity = run.quantity;
  const std::vector<double> truth = Truth(run);
  const std::vector<ParameterInfo> infos = FitParameters(run.model, run.start, run.quantity);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    fit.parameters.push_back({});
    fit.parameters.back().info = infos[i];
    fit.parameters.back().estimate = truth[i];
  }
  return fit;
}

double MaxDifference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return (a - b).cwiseAbs().maxCoeff(); }

/// d readings / d estimate by central differences of reports.
Eigen::VectorXd Difference(const FitOfRun& run, std::size_t parameter, double step) {
  const auto readings = [&](double change) {
    FitReport moved = run.fit;
    moved.parameters[parameter].estimate += change;
    const FittedMotion motion(run.recording, moved, run.rig);
    return motion.Readings(motion.instants()).value();
  };
  return (readings(step) - readings(-step)) / (2 * step);
}

void ExpectJacobianOfDifferences(const FitOfRun& run) {
  const FittedMotion motion(run.recording, run.fit, run.rig);
  Eigen::MatrixXd jacobian;
  ASSERT_TRUE(motion.Readings(motion.instants(), &jacobian));
  ASSERT_EQ(jacobian.cols(), static_cast<Eigen::Index>(run.fit.parameters.size()));
  for (std::size_t i = 0; i < run.fit.parameters.size(); ++i) {
    const double estimate = run.fit.parameters[i].estimate;
    const Eigen::VectorXd expected = Difference(run, i, 1e-5 * std::max(std::abs(estimate), 1e-3));
    const Eigen::VectorXd column = jacobian.col(static_cast<Eigen::Index>(i));
    // If a reversal or the release passes a sample, a difference is off by about 1e-4 of the column.
    EXPECT_LT((column - expected).norm(), 2e-3 * expected.norm()) << run.fit.parameters[i].info.name;
  }
}

TEST(FittedMotion, ReproducesTheFitsReadings) {
  for (const char* model : {"linear", "viscous", "coulomb", "drag"}) {
    for (const SyntheticOptions& options : {NoisyRun(model), MovingRun(model)}) {
      const FitOfRun run = FitTo(options, model, TextbookRig());
      const FittedMotion motion(run.recording, run.fit, run.rig);
      EXPECT_LT(MaxDifference(motion.Readings(motion.instants()).value(), run.fit.fitted), kTraceError) << model;
    }
  }
}

TEST(FittedMotion, FollowsARateWithItsBias) {
  SyntheticOptions options = NoisyRun();
  options.quantity = Quantity::kRate;
  options.zero = 0.07;
  const FitOfRun run = FitTo(options, "coulomb", {});
  const FittedMotion motion(run.recording, run.fit, {});
  EXPECT_LT(MaxDifference(motion.Readings(motion.instants()).value(), run.fit.fitted), 10 * kTraceError);
}

// The file's clock starts at 1000 s and is 2 % slow.
TEST(FittedMotion, MeasuresInstantsInTrueSecondsFromTheFirstSample) {
  SyntheticOptions options = NoisyRun();
  options.start_time = 1000;
  options.release_time += 1000;
  Recording recording = Must(SimulateRecording(options));
  recording.clock_scale = 1.02;
  const FitOfRun run = FitTo(recording, ModelOptions("coulomb"));
  const FittedMotion motion(run.recording, run.fit, {});
  EXPECT_EQ(motion.instants()[0], 0);
  EXPECT_THAT(motion.instants()[100], DoubleNear(1.02, 1e-9));  // 1 s on the file's clock
  EXPECT_LT(MaxDifference(motion.Readings(motion.instants()).value(), run.fit.fitted), kTraceError);
  ExpectJacobianOfDifferences(run);
}

TEST(FittedMotion, MatchesDifferencesInTheReportsUnits) {
  for (const std::optional<Rig>& rig : {std::optional<Rig>(), std::optional(TextbookRig())}) {
    for (const char* model : {"viscous", "drag"}) {
      SCOPED_TRACE(std::string(model) + (rig ? ", rig" : ", no rig"));
      ExpectJacobianOfDifferences(FitTo(NoisyRun(model), model, rig));
      ExpectJacobianOfDifferences(FitTo(MovingRun(model), model, rig));
    }
  }
}

TEST(FittedMotion, KeepsADriftingZero) {
  SyntheticOptions options = NoisyRun();
  Recording recording = Must(SimulateRecording(options));
  recording.value.array() += 0.001 * recording.time.array();
  FitOptions fit = ModelOptions("coulomb");
  fit.initial["zero_drift"] = 0;
  const FitOfRun run = FitTo(recording, fit);
  ASSERT_NE(run.fit.Find("zero_drift"), nullptr);
  const FittedMotion motion(run.recording, run.fit, {});
  EXPECT_LT(MaxDifference(motion.Readings(motion.instants()).value(), run.fit.fitted), kTraceError);
  ExpectJacobianOfDifferences(run);
}

TEST(FittedMotion, CanBeEvaluatedAtOtherInstants) {
  SyntheticOptions options = TextbookRun("coulomb");
  const FitReport fit = TrueReport(options);
  const FittedMotion motion(Must(SimulateRecording(options)), fit, {});
  options.sample_rate = 37;
  const Recording other = Must(SimulateRecording(options));
  EXPECT_LT(MaxDifference(motion.Readings(other.time).value(), other.value), kTraceError);
}

TEST(FittedMotion, HasTheSmallAnglePeriodOfItsInertia) {
  const SyntheticOptions options = TextbookRun("viscous");
  const Recording recording = Must(SimulateRecording(options));
  FitReport fit = TrueReport(options);
  const double expected = 2 * kPi * std::sqrt(0.079 / kTextbookTorque);
  EXPECT_THAT(FittedMotion(recording, fit, {}).small_angle_period(), DoubleNear(expected, 1e-12));
  fit.parameters[0].estimate = 0.079;  // kg m², with a rig
  EXPECT_THAT(FittedMotion(recording, fit, TextbookRig()).small_angle_period(), DoubleNear(expected, 1e-12));
}

// With linear gravity the same start and zero give a motion in closed form.
TEST(FittedMotion, FollowsTheDampedCosineForLinearGravity) {
  const SyntheticOptions options = TextbookRun("viscous");
  const FittedMotion motion(Must(SimulateRecording(options)), TrueReport(options), {});
  const FittedMotion linear = motion.WithGravity(Gravity::kLinear);
  const Eigen::VectorXd readings = linear.Readings(linear.instants()).value();
  for (Eigen::Index i = 0; i < readings.size(); i += 37) {
    const double angle = ViscousSwing(linear.instants()[i] - options.release_time, options.parameters[0],
                                      options.parameters[1], options.release_angle);
    EXPECT_THAT(readings[i], DoubleNear(options.zero + angle, kTraceError)) << i;
  }
}

// Coulomb and quadratic friction are removed; start and zero stay; the report's units do not matter.
TEST(FittedMotion, UsesTheGivenInertiaAndViscousFriction) {
  const SyntheticOptions options = TextbookRun("drag");
  const Recording recording = Must(SimulateRecording(options));
  FitReport fit = TrueReport(options);
  for (std::size_t i = 0; i < 4; ++i) fit.parameters[i].estimate *= TextbookRig().gravity_torque.value;
  const double inertia = 0.05, viscous = 0.002;
  const FittedMotion viscous_motion = FittedMotion(recording, fit, TextbookRig()).WithViscous(inertia, viscous);
  EXPECT_THAT(viscous_motion.small_angle_period(), DoubleNear(2 * kPi * std::sqrt(inertia), 1e-12));
  const FittedMotion motion = viscous_motion.WithGravity(Gravity::kLinear);
  const Eigen::VectorXd readings = motion.Readings(motion.instants()).value();
  for (Eigen::Index i = 0; i < readings.size(); i += 37) {
    const double time = motion.instants()[i] - options.release_time;
    EXPECT_THAT(readings[i],
                DoubleNear(options.zero + ViscousSwing(time, inertia, viscous, options.release_angle), kTraceError));
  }
}

// With sine gravity the first period is longer by the ratio of the elliptic integral, to within 1e-3 because of
// damping.
TEST(FittedMotion, KeepsSineGravityWithOtherFriction) {
  SyntheticOptions options = TextbookRun("coulomb");
  options.release_angle = 1.5;
  options.release_time = 0.5;
  const FittedMotion motion =
      FittedMotion(Must(SimulateRecording(options)), TrueReport(options), {}).WithViscous(0.05, 1e-9);
  const double period = 2 * kPi * std::sqrt(0.05) * SineGravity::PeriodRatio(1.5);
  const Eigen::VectorXd turns = Eigen::Vector3d(0.5, 0.5 + period / 2, 0.5 + period);
  const Eigen::VectorXd readings = motion.Readings((Eigen::VectorXd(4) << 0.0, turns).finished()).value();
  EXPECT_THAT(readings[2] - options.zero, DoubleNear(-1.5, 1e-6));
  EXPECT_THAT(readings[3] - options.zero, DoubleNear(1.5, 1e-6));
}

TEST(FittedMotion, IsEmptyIfTheMotionCannotBeTraced) {
  const SyntheticOptions options = TextbookRun("coulomb");
  const Recording recording = Must(SimulateRecording(options));
  FitReport fit = TrueReport(options);
  fit.parameters[2].estimate = 1;  // dry friction holds the pendulum
  const FittedMotion motion(recording, fit, {});
  EXPECT_FALSE(motion.Readings(motion.instants()));
}

TEST(FittedMotion, TracesTheWholeRecording) {
  for (const SyntheticOptions& run : {TextbookRun("drag"), MovingRun("drag")}) {
    const Recording recording = Must(SimulateRecording(run));
    const FittedMotion motion(recording, TrueReport(run), std::nullopt);
    const std::optional<Trajectory> trace = motion.Trace();
    ASSERT_TRUE(trace.has_value());
    const Eigen::VectorXd readings = motion.Readings(motion.instants()).value();
    for (const Eigen::Index i : {Eigen::Index{0}, recording.size() / 2, recording.size() - 1}) {
      EXPECT_NEAR(trace->Angle(motion.instants()[i]), readings[i] - run.zero, kTraceError);
    }
  }
}

}  // namespace
}  // namespace pendulum::fitted_motion_test
