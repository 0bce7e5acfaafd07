// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/fit.h"

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/model/nesting.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::fit_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Gt;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Le;
using testing::Not;

/// The kind of run, for messages.
std::string Describe(const SyntheticOptions& run) {
  return std::string(run.model.name) + (run.start == StartKind::kRelease ? ", released" : ", moving") +
         (run.quantity == Quantity::kRate ? ", rate" : ", angle") + ", seed " + std::to_string(run.seed);
}

/// Every registered model with both starts and both quantities.
std::vector<SyntheticOptions> EveryKindOfRun() {
  std::vector<SyntheticOptions> runs;
  for (const MotionModel& model : MotionModels()) {
    for (const auto& make : {TextbookRun, MovingRun}) {
      for (const Quantity quantity : {Quantity::kAngle, Quantity::kRate}) {
        runs.push_back(make(model.name));
        runs.back().quantity = quantity;
      }
    }
  }
  return runs;
}

void ExpectConverged(const FitReport& report) {
  EXPECT_EQ(report.termination, Termination::kConverged) << report.reason;
  EXPECT_FALSE(report.reason.empty());
}

/// Relative tolerance for a noise-free fit. It is larger for a law with a Stribeck rate, which is hardly
/// distinguishable from other friction.
double RelativeTolerance(const MotionModel& model) { return FindOrderedPair(model).larger < 0 ? 1e-7 : 1e-4; }

void ExpectTruth(const FitReport& report, const std::vector<double>& truth, double relative) {
  ASSERT_EQ(report.parameters.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(report.parameters[i].estimate, truth[i], relative * std::abs(truth[i]))
        << report.parameters[i].info.name;
  }
}

// ---- Recovery ------------------------------------------------------------------------------------------------------

TEST(FitRecording, RecoversTheTruthOfEveryModelFromNoiseFreeData) {
  for (const SyntheticOptions& run : EveryKindOfRun()) {
    SCOPED_TRACE(Describe(run));
    const FitReport report = FitOwnModel(run);
    ExpectConverged(report);
    EXPECT_EQ(report.start, run.start);
    ExpectTruth(report, Truth(run), RelativeTolerance(run.model));
  }
}

TEST(FitRecording, RecoversTheTruthAtLargeAmplitudes) {
  for (SyntheticOptions run : EveryKindOfRun()) {
    if (run.model.gravity == Gravity::kLinear) continue;
    if (FindOrderedPair(run.model).larger >= 0) continue;  // friction of slow motion: large swings hardly determine it
    for (const double degrees : {90.0, 150.0}) {
      SCOPED_TRACE(Describe(run) + ", " + std::to_string(degrees) + " deg");
      run.release_angle = run.initial_angle = degrees * kRadFromDeg;
      run.initial_rate = -0.3;
      const FitReport report = FitOwnModel(run);
      ExpectConverged(report);
      ExpectTruth(report, Truth(run), 1e-6);
    }
  }
}

TEST(FitRecording, IsWithinFourStandardErrorsForNoisyData) {
  for (SyntheticOptions run : EveryKindOfRun()) {
    if (IsHardlyDetermined(run.model)) continue;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      run.seed = seed;
      run.release_angle = run.initial_angle = 1.0;
      run.noise = run.quantity == Quantity::kAngle ? 0.003 : 0.02;
      SCOPED_TRACE(Describe(run));
      const FitReport report = FitOwnModel(run);
      ExpectConverged(report);
      const std::vector<double> deviations = Deviations(report, Truth(run));
      for (std::size_t i = 0; i < deviations.size(); ++i) {
        EXPECT_LT(std::abs(deviations[i]), 4) << report.parameters[i].info.name;
      }
    }
  }
}

TEST(FitRecording, ConvergesForAReleaseAtTheInstantOfASample) {
  // With rate readings, the cost has a kink where the release time passes a sample. The minimum may lie at this kink.
  SyntheticOptions run = TextbookRun("coulomb");
  run.quantity = Quantity::kRate;
  run.parameters[2] *= 3;
  run.release_angle = 1;
  run.release_time = 0.7;
  run.duration = 8;
  run.sample_rate = 50;
  run.noise = 0.02;
  for (const std::uint64_t seed : {1, 2, 3, 78, 120, 131, 139, 203}) {
    run.seed = seed;
    const FitReport report = FitOwnModel(run);
    EXPECT_EQ(report.termination, Termination::kConverged) << "seed " << seed << ": " << report.reason;
  }
}

TEST(FitRecording, FitsASwingWithALongGapInTheData) {
  const SyntheticOptions run = NoisyRun();
  Recording recording = Must(SimulateRecording(run));
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    if (recording.time[i] < 5.1 || recording.time[i] > 7.3) kept.push_back(i);
  }
  recording.time = recording.time(kept).eval();
  recording.value = recording.value(kept).eval();
  const FitReport report = Fit(recording, ModelOptions("coulomb"));
  ExpectConverged(report);
  for (const double deviation : Deviations(report, Truth(run))) EXPECT_LT(std::abs(deviation), 4);
}

// ---- Clock and units -----------------------------------------------------------------------------------------------

TEST(FitRecording, ReportsTheReleaseTimeOnTheFilesClock) {
  const Recording recording = Must(SimulateRecording(NoisyRun()));
  const FitReport at_zero = Fit(recording, ModelOptions("coulomb"));
  const std::map<double, double> clocks = {
      {1000.0, 1e-10}, {-3600.0, 1e-10}, {1.6e9, 2e-6}};  // first sample, tolerance
  for (const auto& [first, tolerance] : clocks) {
    SCOPED_TRACE(first);
    Recording shifted = recording;
    shifted.time.array() += first;
    const FitReport report = Fit(shifted, ModelOptions("coulomb"));
    ExpectConverged(report);
    EXPECT_NEAR(report.Find("release_time")->estimate, at_zero.Find("release_time")->estimate + first, tolerance);
    EXPECT_NEAR(*report.Find("release_time")->lower95, *at_zero.Find("release_time")->lower95 + first, tolerance);
    EXPECT_NEAR(report.Find("release_angle")->estimate, at_zero.Find("release_angle")->estimate, tolerance);
    EXPECT_NEAR(report.Find("inertia")->estimate, at_zero.Find("inertia")->estimate, 1e-3 * tolerance + 1e-10);
  }
}

TEST(FitRecording, ScalesOnlyTorquesWithARig) {
  const Recording recording = Must(SimulateRecording(NoisyRun()));
  FitOptions options = ModelOptions("coulomb");
  const FitReport relative = Fit(recording, options);
  options.rig = Must(ParseRig(R"({"gravity_torque": {"value": 2.5, "std_dev": 0.02}})", "rig.json"));
  const FitReport si = Fit(recording, options);
  for (std::size_t i = 0; i < si.parameters.size(); ++i) {
    const ParameterEstimate& with = si.parameters[i];
    const ParameterEstimate& without = relative.parameters[i];
    SCOPED_TRACE(with.info.name);
    const double factor = i < 3 ? 2.5 : 1.0;  // inertia, viscous, coulomb
    EXPECT_DOUBLE_EQ(with.estimate, factor * without.estimate);
    EXPECT_DOUBLE_EQ(*with.std_error, factor * *without.std_error);
    EXPECT_DOUBLE_EQ(*with.upper95, factor * *without.upper95);
    EXPECT_DOUBLE_EQ(*with.closed_form, factor * *without.closed_form);
    EXPECT_FALSE(without.systematic.Total());
    ASSERT_EQ(with.systematic.Total().has_value(), i < 3);
    EXPECT_DOUBLE_EQ(with.systematic.Total().value_or(0), i < 3 ? with.estimate * 0.02 / 2.5 : 0);
  }
  EXPECT_EQ(si.Find("inertia")->unit, "kg m^2");
  EXPECT_EQ(relative.Find("inertia")->unit, "s^2");
  EXPECT_EQ(si.Find("viscous")->unit, "N m s/rad");
  EXPECT_EQ(relative.Find("coulomb")->unit, "1");
  EXPECT_DOUBLE_EQ(si.covariance(0, 1), 6.25 * relative.covariance(0, 1));
  EXPECT_DOUBLE_EQ(si.covariance(2, 3), 2.5 * relative.covariance(2, 3));
  EXPECT_EQ(si.residual, relative.residual);
  for (std::size_t i = 0; i < si.derived.size(); ++i) {
    EXPECT_EQ(si.derived[i].estimate, relative.derived[i].estimate) << si.derived[i].name;
  }
}

TEST(FitRecording, GivesNoSystematicErrorWithoutRigErrors) {
  FitOptions options = ModelOptions("coulomb");
  options.rig = Must(ParseRig(R"({"gravity_torque": {"value": 2.5, "std_dev": 0}})", "rig.json"));
  for (const ParameterEstimate& p : Fit(Must(SimulateRecording(NoisyRun())), options).parameters) {
    EXPECT_FALSE(p.systematic.Total()) << p.info.name;
  }
}

// ---- Contents of the report ----------------------------------------------------------------------------------------

TEST(FitRecording, ReportsSeriesAndStatisticsOfTheSameResiduals) {
  const Recording recording = Must(SimulateRecording(NoisyRun()));
  const FitReport report = Fit(recording, ModelOptions("coulomb"));
  EXPECT_LT((report.fitted + report.residual - recording.value).cwiseAbs().maxCoeff(), 1e-15);
  const double sum = report.residual.squaredNorm();
  EXPECT_THAT(report.noise.sigma, DoubleNear(std::sqrt(sum / (1000 - 6)), 1e-9));
  EXPECT_THAT(report.noise.sigma, DoubleNear(0.002, 2e-4));
  EXPECT_THAT(report.statistics.rms_residual, DoubleNear(std::sqrt(sum / 1000), 1e-15));
  // Six parameters and sigma.
  EXPECT_THAT(report.statistics.aic + 2 * report.statistics.log_likelihood, DoubleNear(14, 1e-9));
  EXPECT_THAT(report.solver.evaluations, Gt(report.solver.iterations));
  EXPECT_FALSE(report.solver.termination.empty());
  EXPECT_EQ(report.quantity, Quantity::kAngle);
  EXPECT_EQ(report.Find("drag"), nullptr);
}

TEST(FitRecording, GivesReadingsOfTheEstimatedTrajectory) {
  const FitReport report = FitOwnModel(NoisyRun());
  SyntheticOptions fitted = NoisyRun();
  for (int k = 0; k < 3; ++k) fitted.parameters[k] = report.parameters[k].estimate;
  fitted.release_angle = report.parameters[3].estimate;
  fitted.release_time = report.parameters[4].estimate;
  fitted.zero = report.parameters[5].estimate;
  fitted.noise = 0;
  EXPECT_LT((Must(SimulateRecording(fitted)).value - report.fitted).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(FitRecording, TracesToTheRequestedAccuracy) {
  FitOptions options = ModelOptions("coulomb");
  SyntheticOptions run = NoisyRun();
  run.release_angle = 150 * kRadFromDeg;
  for (const double error : {1e-8, 1e-11}) {
    options.search.max_trace_error = error;
    EXPECT_THAT(Fit(Must(SimulateRecording(run)), options).trace_error, Le(error));
  }
}

TEST(FitRecording, ReportsClosedFormStartValues) {
  const FitReport report = FitOwnModel(NoisyRun());
  EXPECT_NEAR(*report.Find("inertia")->closed_form, 0.079 / kTextbookTorque, 2e-4);
  EXPECT_NEAR(*report.Find("release_time")->closed_form, 1.9, 0.02);
  SyntheticOptions moving = MovingRun("coulomb");
  // A parabola through samples is not a closed form.
  EXPECT_FALSE(FitOwnModel(moving).Find("initial_rate")->closed_form);
}

TEST(FitRecording, DoesNotTreatATurningPointAsARelease) {
  // The recording begins just before a turning point and is sampled slowly, so the reading hardly changes for a sixth
  // of a period.
  SyntheticOptions run;
  run.parameters = {0.48493, 0.069953, 0.003533};
  run.start = StartKind::kMoving;
  run.initial_angle = 1.25;
  run.initial_rate = 0.8031;
  run.duration = 17.09;
  run.sample_rate = 9.393;
  run.noise = 0.005;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    run.seed = seed;
    const FitReport report = FitOwnModel(run);
    ASSERT_EQ(report.start, StartKind::kMoving) << seed;
    for (const double deviation : Deviations(report, Truth(run))) EXPECT_LT(std::abs(deviation), 4.5) << seed;
  }
}

TEST(FitRecording, GivesTheZeroWithoutWholeTurns) {
  SyntheticOptions run;  // released near the top, where a search may go over the top
  run.parameters = {0.39112, 0.0056959, 0.01155};
  run.release_angle = -3.017;
  run.duration = 29.04;
  run.sample_rate = 31.03;
  run.noise = 0.05;
  int converged = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    run.seed = seed;
    const FitReport report = FitOwnModel(run);
    if (report.termination != Termination::kConverged) continue;
    ++converged;
    EXPECT_THAT(report.Find("zero_angle")->estimate, DoubleNear(0, 0.1)) << seed;
  }
  EXPECT_GE(converged, 8);
}

TEST(FitRecording, RefusesAnUnknownModel) {
  const auto refused = FitRecording(Must(SimulateRecording(NoisyRun())), ModelOptions("columb"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, StatusCode::kInvalidArgument);
  EXPECT_EQ(refused.error().message(), "there is no model 'columb'; the models are " + MotionModelNames());
}

TEST(FitRecording, NamesTheFileWithoutASwing) {
  Recording constant = Must(SimulateRecording(NoisyRun()));
  constant.path = "run.csv";
  constant.value.setConstant(0.3);
  const auto refused = FitRecording(constant, ModelOptions("coulomb"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, StatusCode::kFailedPrecondition);
  EXPECT_EQ(refused.error().message(),
            "run.csv: the reading is constant, so there is no swing; check the sensor, or choose another column");
}

}  // namespace
}  // namespace pendulum::fit_test
