// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/fit_report.h"

#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::fit_report_test {
namespace {

using testing::ElementsAre;

TEST(OptionsLike, CopiesStartAndNoiseFamily) {
  FitReport fit;
  fit.start = StartKind::kMoving;
  fit.noise.family = NoiseFamily::kQuantized;
  EXPECT_EQ(OptionsLike(fit, {}).start, StartKind::kMoving);
  EXPECT_EQ(OptionsLike(fit, {}).noise, NoiseFamily::kQuantized);
  fit.start = StartKind::kRelease;
  fit.noise.family = NoiseFamily::kHuber;
  EXPECT_EQ(OptionsLike(fit, {}).start, StartKind::kRelease);
  EXPECT_EQ(OptionsLike(fit, {}).noise, NoiseFamily::kHuber);
  EXPECT_TRUE(FitOptions().search.may_correct);
  EXPECT_FALSE(OptionsLike(fit, {}).search.may_correct);
  FitOptions with_losses;
  with_losses.with_losses = true;
  EXPECT_FALSE(OptionsLike(fit, with_losses).with_losses);
}

TEST(Termination, HasANameAndAnExitCode) {
  EXPECT_THAT((std::vector<std::string_view>{
                  TerminationName(Termination::kConverged), TerminationName(Termination::kNotConverged),
                  TerminationName(Termination::kNotIdentifiable), TerminationName(Termination::kFailed)}),
              ElementsAre("converged", "not_converged", "not_identifiable", "failed"));
  EXPECT_EQ(ExitCode(Termination::kConverged), 0);
  EXPECT_EQ(ExitCode(Termination::kNotConverged), 1);
  EXPECT_EQ(ExitCode(Termination::kNotIdentifiable), 1);
  EXPECT_EQ(ExitCode(Termination::kFailed), 1);
}

TEST(WithdrawErrors, KeepsEstimatesAndGivesAReasonForMissingErrors) {
  FitReport fit;
  fit.parameters.resize(2);
  ParameterEstimate& inertia = fit.parameters[0];
  inertia.info = kInertia;
  inertia.estimate = 0.04;
  inertia.std_error = 0.001;
  inertia.lower95 = 0.038;
  inertia.upper95 = 0.042;
  ParameterEstimate& zero = fit.parameters[1];
  zero.info = kZeroAngle;
  zero.fixed = true;
  zero.reason = "fixed";
  fit.covariance_names = {"inertia"};
  fit.covariance = Eigen::MatrixXd::Constant(1, 1, 1e-6);
  WithdrawErrors("two minima", fit);
  EXPECT_EQ(fit.Find("inertia")->estimate, 0.04);
  EXPECT_EQ(fit.Find("inertia")->std_error, std::nullopt);
  EXPECT_EQ(fit.Find("inertia")->upper95, std::nullopt);
  EXPECT_EQ(fit.Find("inertia")->reason, "two minima");
  EXPECT_EQ(fit.Find("zero_angle")->reason, "fixed");
  EXPECT_EQ(fit.Find("viscous"), nullptr);
  EXPECT_EQ(fit.covariance.size(), 0);
}

TEST(RejectFor, SaysWhyInReasonAndWarning) {
  FitReport fit;
  fit.termination = Termination::kConverged;
  fit.parameters.resize(1);
  fit.parameters[0].std_error = 0.001;
  EXPECT_EQ(fit.ReasonWarning(), nullptr);
  fit.warnings.push_back({"saturated", "2 readings are at an end"});
  RejectFor(Termination::kNotConverged, {"offset_jumps", "the zero jumps at 3 s"}, "the zero jumps", fit);
  EXPECT_EQ(fit.termination, Termination::kNotConverged);
  EXPECT_EQ(fit.reason, "the zero jumps at 3 s");
  ASSERT_NE(fit.ReasonWarning(), nullptr);
  EXPECT_EQ(fit.ReasonWarning()->code, "offset_jumps");
  EXPECT_EQ(fit.parameters[0].std_error, std::nullopt);
  EXPECT_EQ(fit.parameters[0].reason, "the zero jumps");
  Reject(Termination::kNotIdentifiable, "the law has another order", "not identifiable", fit);
  EXPECT_EQ(fit.reason, "the law has another order");
  EXPECT_EQ(fit.ReasonWarning(), nullptr);
}

// Standard errors 2 and 4, covariance 4: 4 / (2 · 4).
TEST(Correlation, IsTheCovarianceOverTheProductOfTheStandardErrors) {
  FitReport fit;
  fit.covariance.resize(3, 3);
  fit.covariance << 4, 4, 0, 4, 16, 0, 0, 0, 1;
  EXPECT_DOUBLE_EQ(Correlation(fit, 0, 1), 0.5);
  EXPECT_EQ(Correlation(fit, 2, 2), 1);
  EXPECT_EQ(Correlation(fit, 0, 2), 0);
}

TEST(FitReport, FindsWarningsByCode) {
  FitReport fit;
  fit.warnings.push_back({"lack_of_fit", "the residuals are not noise"});
  EXPECT_TRUE(fit.HasWarning("lack_of_fit"));
  EXPECT_FALSE(fit.HasWarning("lost_counts"));
}

}  // namespace
}  // namespace pendulum::fit_report_test
