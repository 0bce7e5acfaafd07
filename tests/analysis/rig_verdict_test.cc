// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/rig_verdict.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/fitted_run.h"

namespace pendulum::rig_verdict_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kFitted = 0.080, kError = 0.0002;  // kg m²

/// A converged fit with the inertia kFitted ± kError.
FitReport FitWithInertia() {
  FitReport fit;
  fit.termination = Termination::kConverged;
  ParameterEstimate inertia;
  inertia.info = kInertia;
  inertia.unit = "kg m^2";
  inertia.estimate = kFitted;
  inertia.std_error = kError;
  fit.parameters.push_back(inertia);
  return fit;
}

/// A rig of known torque 1.8 N m ± 1 % with an inertia.
std::optional<Rig> RigWithInertia(const std::string& inertia) {
  return Must(ParseRig(R"({"gravity_torque": {"value": 1.8, "std_dev": 0.018}, "inertia": )" + inertia + "}", "rig"));
}

// The torque's error of 1 % moves the fitted inertia by 0.0008; the other errors are 0.0002 and that of the rig's own.
TEST(JudgeInertia, DividesTheDifferenceByAllErrors) {
  const auto verdict = JudgeInertia(RigWithInertia(R"({"value": 0.079, "std_dev": 0.0006})"), FitWithInertia());
  ASSERT_TRUE(verdict && verdict->z);
  EXPECT_NEAR(*verdict->z, 0.001 / std::sqrt(8e-4 * 8e-4 + 6e-4 * 6e-4 + 2e-4 * 2e-4), 2e-3);
  EXPECT_NEAR(verdict->excess, 0.080 / 0.079 - 1, 1e-12);
  EXPECT_FALSE(verdict->differs());
  EXPECT_THAT(verdict->text(), HasSubstr("agrees with the rig's: 1.3 % larger (z 0.98)"));
  EXPECT_THAT(verdict->brief, IsEmpty());
}

TEST(JudgeInertia, AddsTheFitsOtherSystematicErrors) {
  FitReport fit = FitWithInertia();
  fit.parameters[0].systematic.Add(ErrorSource::kClock, 0.003);
  fit.parameters[0].systematic.Add(ErrorSource::kRig, 0.1);  // that of the torque counts already
  const auto verdict = JudgeInertia(RigWithInertia(R"({"value": 0.079, "std_dev": 0.0006})"), fit);
  EXPECT_NEAR(*verdict->z, 0.001 / std::sqrt(8e-4 * 8e-4 + 6e-4 * 6e-4 + 2e-4 * 2e-4 + 9e-6), 2e-3);
}

TEST(JudgeInertia, NamesCausesAndTheExperimentIfTheyDiffer) {
  const auto larger = JudgeInertia(RigWithInertia(R"({"value": 0.070, "std_dev": 0.0006})"), FitWithInertia());
  ASSERT_TRUE(larger);
  EXPECT_TRUE(larger->differs());
  EXPECT_THAT(larger->text(), AllOf(HasSubstr("14 % larger than the rig's (z 9.8)"), HasSubstr("a support that yields"),
                                    HasSubstr("another bob mass")));
  EXPECT_THAT(larger->brief, HasSubstr("The rig disagrees"));
  const auto smaller = JudgeInertia(RigWithInertia(R"({"value": 0.090, "std_dev": 0.0006})"), FitWithInertia());
  ASSERT_TRUE(smaller);
  EXPECT_TRUE(smaller->differs());
  EXPECT_THAT(smaller->text(), AllOf(HasSubstr("11 % smaller"), HasSubstr("spring, cable")));
}

TEST(JudgeInertia, TakesAnExactRigAtItsWord) {
  const auto rig = Must(ParseRig(
      R"({"gravity_torque": {"value": 1.8, "std_dev": 0}, "inertia": {"value": 0.079, "std_dev": 0}})", "rig"));
  const auto verdict = JudgeInertia(rig, FitWithInertia());
  ASSERT_TRUE(verdict && verdict->z);
  EXPECT_NEAR(*verdict->z, 5, 1e-9);  // 0.001 / 0.0002
}

TEST(JudgeInertia, IsNoVerdictWithoutAnErrorOfTheFit) {
  const auto rig = Must(ParseRig(R"({"gravity_torque": 1.8, "inertia": 0.070})", "rig"));
  FitReport fit = FitWithInertia();
  fit.parameters[0].std_error.reset();
  const auto verdict = JudgeInertia(rig, fit);
  ASSERT_TRUE(verdict);
  EXPECT_FALSE(verdict->z);
  EXPECT_FALSE(verdict->differs());
  EXPECT_THAT(verdict->text(), HasSubstr("14 % larger than the rig's; the fit gives no standard deviation"));
}

TEST(JudgeInertia, NeedsAnInertiaAndAResult) {
  EXPECT_FALSE(JudgeInertia({}, FitWithInertia()));
  EXPECT_FALSE(JudgeInertia(Must(ParseRig(R"({"gravity_torque": 1.8})", "rig")), FitWithInertia()));
  FitReport fit = FitWithInertia();
  fit.termination = Termination::kNotConverged;
  EXPECT_FALSE(JudgeInertia(TextbookRig(), fit));
  fit = FitWithInertia();
  fit.parameters[0].fixed = true;
  EXPECT_FALSE(JudgeInertia(TextbookRig(), fit));
}

}  // namespace
}  // namespace pendulum::rig_verdict_test
