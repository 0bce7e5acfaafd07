// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/intervals.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fitted.h"

namespace pendulum::intervals_test {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
using testing::UnorderedElementsAre;

using Verdict = Identifiability::Verdict;

// ---- The method ----------------------------------------------------------------------------------------------------

TEST(SetIntervals, UsesTheCovarianceFarFromBounds) {
  const FitReport report = FitOwnModel(ShortSwing());
  EXPECT_EQ(report.interval_method, "estimate ± 1.966 standard errors");  // Student's t, 394 degrees of freedom
  for (const ParameterEstimate& parameter : report.parameters) {
    EXPECT_NEAR((*parameter.upper95 - parameter.estimate) / *parameter.std_error, 1.966, 1e-3) << parameter.info.name;
    EXPECT_NEAR((parameter.estimate - *parameter.lower95) / *parameter.std_error, 1.966, 1e-3) << parameter.info.name;
  }
}

/// Fits a simulation without dry friction. Uses the first seed for which the estimate of dry friction is at its bound
/// (`at_bound`) or is not.
FitReport FitWithoutDryFriction(bool at_bound, const FitOptions& options) {
  for (std::uint64_t seed = 1; seed < 50; ++seed) {
    FitReport report = Fit(Must(SimulateRecording(NoisyRun("viscous", seed))), options);
    if (report.Find("coulomb")->at_bound == at_bound) return report;
  }
  throw std::runtime_error("there is no such seed");
}

TEST(SetIntervals, UsesProfilesForAllParametersIfOneIsNearABound) {
  for (const bool at_bound : {false, true}) {
    const FitReport report = FitWithoutDryFriction(at_bound, ModelOptions("coulomb"));
    EXPECT_EQ(report.interval_method, "profile likelihood");
    for (const ParameterEstimate& parameter : report.parameters) {
      EXPECT_TRUE(parameter.lower95 && parameter.upper95) << parameter.info.name;
      EXPECT_LE(*parameter.lower95, parameter.estimate) << parameter.info.name;
      EXPECT_GT(*parameter.upper95, parameter.estimate) << parameter.info.name;
    }
    EXPECT_EQ(*report.Find("coulomb")->lower95, 0);
  }
}

TEST(SetIntervals, ReportsProfilesInTheParametersUnitsAndOrder) {
  FitOptions options = ModelOptions("coulomb");
  options.interval = IntervalMethod::kProfile;
  options.rig = Must(ParseRig(R"({"gravity_torque": 2})", "rig"));
  options.fixed["zero_angle"] = 0.012;
  const FitReport report = Fit(Must(SimulateRecording(ShortSwing())), options);
  ASSERT_EQ(report.profiles.size(), 5);
  for (std::size_t i = 0; i < report.profiles.size(); ++i) {
    const ProfileCurve& curve = report.profiles[i];
    const ParameterEstimate& parameter = report.parameters[i];
    EXPECT_EQ(curve.name, parameter.info.name);
    ASSERT_EQ(curve.value.size(), curve.statistic.size());
    EXPECT_GE(curve.value.size(), 9) << curve.name;
    EXPECT_TRUE(std::ranges::is_sorted(curve.value)) << curve.name;
    // Near the optimum the likelihood of an accurate recording is a parabola.
    for (std::size_t k = 0; k < curve.value.size(); ++k) {
      const double distance = (curve.value[k] - parameter.estimate) / *parameter.std_error;
      EXPECT_NEAR(curve.statistic[k], distance * distance, 0.05 * curve.threshold) << curve.name;
    }
  }
  EXPECT_THAT(FitOwnModel(ShortSwing()).profiles, IsEmpty());
}

TEST(SetIntervals, LeavesTheUpperEndOpenForAParameterAtItsLowerBound) {
  FitOptions options = ModelOptions("coulomb");
  options.interval = IntervalMethod::kCovariance;
  const FitReport report = FitWithoutDryFriction(true, options);
  const ParameterEstimate& coulomb = *report.Find("coulomb");
  EXPECT_EQ(*coulomb.lower95, 0);
  EXPECT_FALSE(coulomb.upper95);
  EXPECT_EQ(coulomb.open_interval, OpenInterval::kAtBound);
  EXPECT_THAT(report.interval_method, StartsWith("estimate ± "));
}

/// The short swing in counts, released slightly differently in each take. The main error is the rounding to counts.
SyntheticOptions Counted(int take, double noise) {
  SyntheticOptions run = ShortSwing();
  run.resolution = kCount;
  run.noise = noise * kCount;
  run.seed = static_cast<std::uint64_t>(take);
  run.release_angle = 1.0 + 0.00137 * take;
  run.release_time = 0.701 + 0.0017 * take;
  return run;
}

TEST(UsePosterior, AppliesToCountsWithLittleScatter) {
  for (int take = 1; take <= 10; ++take) {
    SCOPED_TRACE(take);
    const SyntheticOptions run = Counted(take, 0);
    const FitReport report = FitOwnModel(run);
    ASSERT_EQ(report.interval_method, "quantiles of the posterior");
    EXPECT_THAT(report.std_error_method, StartsWith("posterior of the quantized likelihood"));
    EXPECT_THAT(Deviations(report, Truth(run)), Each(testing::DoubleNear(0, 4)));
    EXPECT_LT(report.noise.sigma, kSmallSigma * kCount);
  }
}

TEST(UsePosterior, DoesNotApplyToScatteredCountsOrAnotherMethod) {
  EXPECT_THAT(FitOwnModel(Counted(1, 0.4)).interval_method, StartsWith("estimate ± "));
  FitOptions options = ModelOptions("coulomb");
  options.interval = IntervalMethod::kProfile;
  const FitReport report = Fit(Must(SimulateRecording(Counted(1, 0.05))), options);
  EXPECT_EQ(report.interval_method, "profile likelihood");
}

// ---- Identifiability -----------------------------------------------------------------------------------------------

TEST(SetIdentifiability, CallsAllParametersOfTheTextbookRigIdentifiable) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.noise = 0.002;
  const FitReport report = FitOwnModel(run);
  EXPECT_EQ(report.identifiability.size(), 6);
  EXPECT_THAT(report.identifiability, Each(Field(&Identifiability::verdict, Verdict::kIdentifiable)));
  EXPECT_THAT(report.identifiability, Each(Field(&Identifiability::advice, IsEmpty())));
}

TEST(SetIdentifiability, CallsAParameterWithAnIntervalAtABoundWeaklyIdentifiable) {
  for (const bool at_bound : {false, true}) {
    const FitReport report = FitWithoutDryFriction(at_bound, ModelOptions("coulomb"));
    for (const Identifiability& known : report.identifiability) {
      const bool is_weak = known.parameter == "coulomb";
      if (known.parameter == "viscous") continue;  // partly interchangeable with dry friction
      EXPECT_EQ(known.verdict, is_weak ? Verdict::kWeakly : Verdict::kIdentifiable) << known.parameter;
      EXPECT_EQ(known.advice.empty(), !is_weak) << known.parameter;
    }
  }
}

TEST(SetIdentifiability, CallsAParameterWithAnIntervalAtTheUsersUpperBoundWeaklyIdentifiable) {
  const FitReport free = FitOwnModel(ShortSwing());
  FitOptions options = ModelOptions("coulomb");
  options.bounds["zero_angle"] = {-1, free.Find("zero_angle")->estimate + *free.Find("zero_angle")->std_error};
  const FitReport report = Fit(Must(SimulateRecording(ShortSwing())), options);
  EXPECT_DOUBLE_EQ(*report.Find("zero_angle")->upper95, options.bounds["zero_angle"].upper);
  EXPECT_EQ(report.identifiability.back().parameter, "zero_angle");
  EXPECT_EQ(report.identifiability.back().verdict, Verdict::kWeakly);
}

/// Verdicts on the six parameters if the information of viscous and coulomb has this correlation and the standard
/// errors are a fifth of the estimates.
std::vector<Identifiability> VerdictsAt(double correlation) {
  const Fitted fitted = FitWithInternals(Must(SimulateRecording(ShortSwing())), ModelOptions("coulomb"));
  Optimum optimum;
  optimum.information = Eigen::MatrixXd::Identity(6, 6);
  optimum.information(1, 2) = optimum.information(2, 1) = correlation;
  optimum.free = {0, 1, 2, 3, 4, 5};
  optimum.inverse = InvertInformation(optimum.information, optimum.free);
  FitReport report = FitOwnModel(ShortSwing());
  for (ParameterEstimate& parameter : report.parameters) parameter.std_error = 0.2 * std::abs(parameter.estimate);
  SetIdentifiability(*fitted.problem, optimum, report);
  return {report.identifiability.end() - 6, report.identifiability.end()};
}

TEST(SetIdentifiability, NamesAnUndeterminedCombination) {
  const std::vector<Identifiability> verdicts = VerdictsAt(1);
  for (const int i : {1, 2}) {
    EXPECT_EQ(verdicts[i].verdict, Verdict::kNotIdentifiable);
    EXPECT_THAT(verdicts[i].direction, UnorderedElementsAre("viscous", "coulomb"));
    EXPECT_THAT(verdicts[i].advice, HasSubstr("release from a larger angle"));
  }
  EXPECT_EQ(verdicts[0].verdict, Verdict::kIdentifiable);
}

/// Correlation multiplies the variance by 1 / (1 - ρ²): 100 at ρ = .995.
TEST(SetIdentifiability, CallsStronglyCorrelatedParametersWeaklyIdentifiable) {
  for (const double correlation : {0.996, -0.999}) {
    const std::vector<Identifiability> verdicts = VerdictsAt(correlation);
    EXPECT_EQ(verdicts[1].verdict, Verdict::kWeakly) << correlation;
    EXPECT_THAT(verdicts[1].direction, ElementsAre("viscous", "coulomb")) << correlation;
  }
  EXPECT_EQ(VerdictsAt(0.994)[1].verdict, Verdict::kIdentifiable);
}

TEST(Identifiability, HasWordsForEveryVerdictAndParameter) {
  EXPECT_EQ(VerdictName(Verdict::kIdentifiable), "identifiable");
  EXPECT_EQ(VerdictName(Verdict::kWeakly), "weakly identifiable");
  EXPECT_EQ(VerdictName(Verdict::kNotIdentifiable), "not identifiable");
  for (const ParameterInfo& info : {kInertia, kReleaseAngle, kReleaseTime, kInitialAngle, kInitialRate, kZeroAngle,
                                    kRateBias, kZeroDrift, kBiasDrift}) {
    EXPECT_THAT(MeasurementFor(info.name), StartsWith("record ")) << info.name;
  }
  EXPECT_THAT(MeasurementFor("drag"), HasSubstr("fix it"));
}

}  // namespace
}  // namespace pendulum::intervals_test
