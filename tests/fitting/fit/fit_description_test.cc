// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/fit_description.h"

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/uncertainty/standard_errors.h"
#include "tests/fitting/fitted.h"

namespace pendulum::fit_description_test {
namespace {

using testing::ElementsAre;

Description DescriptionOf(Fitted& fitted) {
  return Describe(fitted.Run(), static_cast<int>(fitted.optimum.free.size()));
}

Fitted FitShortSwing() { return FitWithInternals(Must(SimulateRecording(ShortSwing())), ModelOptions("coulomb")); }

// ---- Describe ------------------------------------------------------------------------------------------------------

TEST(Describe, HasResidualsAndTheirStatistics) {
  Fitted fitted = FitShortSwing();
  const FitReport report = DescriptionOf(fitted).report;
  ASSERT_EQ(report.fitted.size(), 400);  // 8 s at 50 Hz
  EXPECT_EQ(report.residual, fitted.recording.value - report.fitted);
  const FitStatistics& statistics = report.statistics;
  // The sums are taken in a different order.
  EXPECT_NEAR(statistics.rms_residual, std::sqrt(report.residual.squaredNorm() / 400), 1e-16);
  EXPECT_EQ(statistics.log_likelihood, fitted.solution.log_likelihood);
  EXPECT_NEAR(statistics.aic, 2 * 7 - 2 * statistics.log_likelihood, 1e-9);  // six parameters and σ
  EXPECT_NEAR(statistics.bic, 7 * std::log(400) - 2 * statistics.log_likelihood, 1e-9);
  EXPECT_NEAR(report.noise.sigma, 0.002, 4 * 0.002 / std::sqrt(2 * 394));  // σ's error is σ / sqrt(2 (N - P))
}

TEST(Describe, ReportsModelAndStart) {
  Fitted fitted = FitShortSwing();
  const FitReport report = DescriptionOf(fitted).report;
  EXPECT_EQ(report.model.name, "coulomb");
  EXPECT_EQ(report.start, StartKind::kRelease);
  EXPECT_EQ(report.reading_unit, "rad");
  EXPECT_EQ(report.start_values.parameters, fitted.problem->start.parameters);
  EXPECT_GT(report.solver.evaluations, 0);
}

TEST(Describe, DetectsAutocorrelatedResiduals) {
  Fitted white = FitShortSwing();
  EXPECT_FALSE(DescriptionOf(white).correlated);
  SyntheticOptions silent = ShortSwing();
  silent.noise = 0;
  Fitted autocorrelated = FitWithInternals(
      WithNoise(Must(SimulateRecording(silent)), 1, AutocorrelatedNoise(0.8, 0.002)), ModelOptions("coulomb"));
  EXPECT_TRUE(DescriptionOf(autocorrelated).correlated);
}

// ---- SetParameters -------------------------------------------------------------------------------------------------

/// The parameters of a fit with viscous fixed and coulomb marked as at its bound.
std::vector<ParameterEstimate> ParametersOf(Termination termination, const std::string& unit, bool rig) {
  FitOptions options = ModelOptions("coulomb");
  if (rig) options.rig = Rig{{kTextbookTorque, 0}, {}, {}};
  Recording recording = Must(SimulateRecording(ShortSwing()));
  FitProblem problem = Must(MakeFitProblem(recording, options));
  problem.solve.fixed[1] = true;
  recording.unit = unit;
  Solution solution;
  solution.parameters = Truth(ShortSwing());
  Optimum optimum;
  optimum.at_bound = {2};
  FitReport report;
  report.termination = termination;
  const auto cost = MakeTrajectoryCost(problem.model, problem.start.start, problem.data);
  SetParameters({recording, options, problem, *cost, solution}, optimum, report);
  return report.parameters;
}

TEST(SetParameters, MarksFixedAndBoundedParameters) {
  const auto parameters = ParametersOf(Termination::kConverged, "rad", false);
  ASSERT_EQ(parameters.size(), 6);
  EXPECT_TRUE(parameters[1].fixed);
  EXPECT_EQ(parameters[1].reason, "fixed");
  EXPECT_FALSE(parameters[1].closed_form);
  EXPECT_TRUE(parameters[2].at_bound);
  EXPECT_EQ(parameters[2].reason, "at its bound");
  EXPECT_FALSE(parameters[0].fixed || parameters[0].at_bound);
  EXPECT_EQ(parameters[0].reason, "");
  EXPECT_TRUE(parameters[0].closed_form);
}

TEST(SetParameters, GivesTheTerminationAsReasonForMissingErrors) {
  const auto parameters = ParametersOf(Termination::kNotConverged, "rad", false);
  EXPECT_EQ(parameters[0].reason, "the fit is not_converged");
  EXPECT_EQ(parameters[1].reason, "fixed");
}

TEST(SetParameters, HasTheUnitsOfRigAndReadings) {
  const auto relative = ParametersOf(Termination::kConverged, "rad", false);
  EXPECT_EQ(relative[0].unit, "s^2");
  EXPECT_DOUBLE_EQ(relative[0].estimate, 0.079 / kTextbookTorque);
  const auto absolute = ParametersOf(Termination::kConverged, "counts", true);
  EXPECT_EQ(absolute[0].unit, "kg m^2");
  EXPECT_DOUBLE_EQ(absolute[0].estimate, 0.079);
  EXPECT_EQ(absolute[3].unit, "counts");  // release_angle
}

// ---- Covariances ---------------------------------------------------------------------------------------------------

/// Three parameters whose internal units are 2, 1 and 10 times the SI unit.
struct ByHand {
  FitProblem problem;
  FitReport report;
  ByHand() {
    problem.infos = {kInertia, kReleaseAngle, kReleaseTime};
    problem.si_per_internal = {2, 1, 10};
    problem.offset = {0, 0, 5};
    for (const ParameterInfo& info : problem.infos) report.parameters.emplace_back().info = info;
  }
};

TEST(SetCovariance, ScalesWithTheUnitsOfFreeParameters) {
  ByHand fit;
  Optimum optimum;
  optimum.free = {0, 2};
  const Errors errors = {Eigen::Matrix2d{{4, 1}, {1, 9}}, Eigen::Vector2d(1.96, 2.5), {{{}, 100, "by hand"}}};
  SetCovariance(fit.problem, optimum, errors, fit.report);
  EXPECT_THAT(fit.report.covariance_names, ElementsAre("inertia", "release_time"));
  EXPECT_TRUE(fit.report.covariance.isApprox(Eigen::Matrix2d{{16, 20}, {20, 900}}, 1e-15)) << fit.report.covariance;
  EXPECT_DOUBLE_EQ(fit.report.parameters[0].std_error.value(), 4);  // 2 · sqrt(4)
  EXPECT_DOUBLE_EQ(fit.report.parameters[2].std_error.value(), 30);
  EXPECT_EQ(fit.report.parameters[2].t95, 2.5);
  EXPECT_FALSE(fit.report.parameters[1].std_error);
  EXPECT_EQ(fit.report.std_error_method, "by hand");
}

TEST(SetSystematicErrors, ListsAffectedParametersOnly) {
  ByHand fit;
  const Eigen::Matrix3d clock{{1, 0, 1}, {0, 0, 0}, {1, 0, 9}};
  const Eigen::Matrix3d rig{{3, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  SetSystematicErrors(fit.problem, {{ErrorSource::kClock, clock, {}}, {ErrorSource::kRig, rig, {}}}, fit.report);
  EXPECT_THAT(fit.report.systematic_names, ElementsAre("inertia", "release_time"));
  EXPECT_TRUE(fit.report.systematic_covariance.isApprox(Eigen::Matrix2d{{16, 20}, {20, 900}}, 1e-15));
  EXPECT_DOUBLE_EQ(fit.report.parameters[0].systematic.Total().value(), 4);
  EXPECT_DOUBLE_EQ(fit.report.parameters[0].systematic.Of(ErrorSource::kClock), 2);
  EXPECT_DOUBLE_EQ(fit.report.parameters[0].systematic.Of(ErrorSource::kRig), 2 * std::sqrt(3.0));
  EXPECT_FALSE(fit.report.parameters[1].systematic.Total());
}

}  // namespace
}  // namespace pendulum::fit_description_test
