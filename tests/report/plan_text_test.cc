// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/plan_text.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::plan_text_test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

constexpr ParameterInfo kViscousInfo = {"viscous", "b", "N m s/rad", "s", 0, kUnbounded, ""};

Rig ExampleRig(double std_dev = 0) {
  Rig rig;
  rig.gravity_torque = {2, std_dev};
  return rig;
}

/// Inertia and viscous friction from a release angle, for 20 s and 40 s.
Plan ExamplePlan() {
  Plan plan;
  plan.parameters = {kInertia, kViscousInfo, kReleaseAngle, kReleaseTime, kZeroAngle};
  plan.truth = {0.04, 0.0015, -0.423, 1.9, 0};
  plan.physical = 2;
  plan.rows = {{"release_angle", "rad", 0.2115, false, {1e-6, 3e-5, 9.2e-5, 1.1e-4, 3e-5}, 2.1e-3, {}},
               {"release_angle", "rad", 0.423, true, {5.2e-7, 1.5e-5, 9e-5, 5.2e-5, 3e-5}, 0.0123, {}},
               {"duration", "s", 20, true, {5.2e-7, 1.5e-5, 9e-5, 5.2e-5, 3e-5}, 0.0123, {}},
               {"duration", "s", 40, false, {2e-7, 2e-6, 7.5e-5, 4.4e-5, 2.1e-5}, 6e-14, {}}};
  plan.amplitude_of_equal_bias = 0.01134;
  return plan;
}

// 5.2e-7 s² · 2 N m of 0.08 kg m², 1.5e-5 of 0.0015 s; rounded by the rules of the Particle Data Group.
TEST(PlanText, ShowsTheBaseInSiAndRowsInPercent) {
  EXPECT_EQ(
      PlanText(ExamplePlan(), ExampleRig()),
      "[[Predicted standard errors]] (Cramér-Rao bound)\n"
      "    inertia        0.0800000  ± 0.0000010 kg m^2     0.0013 %\n"
      "    viscous        0.003000   ± 0.000030  N m s/rad  1 %\n"
      "    release_angle  -0.42300   ± 0.00009   rad\n"
      "    release_time   1.90000    ± 0.00005   s\n"
      "    zero_angle     (0.0       ± 3.0)e-05  rad\n"
      "\n"
      "[[One setting changed at a time]] (* the recording as given)\n"
      "    factor         value                    inertia  viscous  release_angle  release_time  zero_angle  linear "
      "bias\n"
      "                                                  %        %            rad             s         rad           "
      " %\n"
      "\n"
      "    release_angle  0.2115 rad (12.1 deg)     0.0025        2        9.2e-05       0.00011       3e-05         "
      "0.21\n"
      "    release_angle  0.423 rad (24.2 deg)  *   0.0013        1          9e-05       5.2e-05       3e-05          "
      "1.2\n"
      "\n"
      "    duration       20 s                  *   0.0013        1          9e-05       5.2e-05       3e-05          "
      "1.2\n"
      "    duration       40 s                      0.0005     0.13        7.5e-05       4.4e-05     2.1e-05           "
      " 0\n"
      "\n"
      "[[How to read it]]\n"
      "    The linear formulas (inertia from damped period and logarithmic decrement,\n"
      "    sin θ = θ; all whole periods, turning points without error) have an error\n"
      "    above the standard error of inertia beyond an amplitude of 0.0113 rad (0.65\n"
      "    deg): there, fit the full equation.\n"
      "    To know inertia to 0.1 %, choose a line with at most 0.1 under inertia; the\n"
      "    last column gives the error of the linear formulas without any noise. The\n"
      "    error of the rig's gravity torque G adds to those of inertia and torques.\n");
}

/// The example with a clock that is known to 0.3 %: inertia ± 0.6 %, as what is in proportion to the square of a time.
Plan PlanWithTotals() {
  Plan plan = ExamplePlan();
  plan.fit.emplace();
  plan.fit->termination = Termination::kConverged;
  plan.fit->model = {"viscous", "viscous", Gravity::kSine};
  BudgetLine clock{ErrorSource::kClock, EvaluationType::kB, "clock", "assumed", true, 0.003, "1", {}};
  clock.parts = Eigen::VectorXd::Zero(5);
  clock.parts[0] = 4.8e-4;
  plan.fit->budget = {clock};
  for (std::size_t i = 0; i < plan.parameters.size(); ++i) {
    ParameterEstimate& parameter = plan.fit->parameters.emplace_back();
    parameter.info = plan.parameters[i];
    parameter.estimate = (i < 2 ? 2 : 1) * plan.truth[i];
    parameter.std_error = (i < 2 ? 2 : 1) * *plan.rows[1].std_errors[i];
  }
  plan.fit->parameters[0].systematic.Add(ErrorSource::kClock, 4.8e-4);
  for (PlanRow& row : plan.rows) {
    row.total_errors = row.std_errors;
    row.total_errors[0] = 2.4e-4;
  }
  plan.sensor.Of(SensorEffect::kClock) = {0.003, "a ceramic resonator", true};
  return plan;
}

TEST(PlanText, SaysWhereErrorsComeFromAndWhatMakesThemSmaller) {
  EXPECT_EQ(PlanText(PlanWithTotals(), ExampleRig(), TextExtent::kSummary),
            "[[Predicted errors]] (noise: Cramér-Rao bound)\n"
            "                   value     ± total    unit       %    noise %  error from\n"
            "    inertia        0.0800    ± 0.0005   kg m^2     0.6  0.0013   clock\n"
            "    viscous        0.003000  ± 0.000030 N m s/rad  1    1        noise\n"
            "    release_angle  -0.42300  ± 0.00009  rad                      noise\n"
            "    release_time   1.90000   ± 0.00005  s                        noise\n"
            "    zero_angle     (0.0      ± 3.0)e-05 rad                      noise\n"
            "    Improve first: clock; compare the recorder's clock with a watch (--sensor):\n"
            "    inertia ±\u00a00.6\u00a0%, at best ±\u00a00.0013\u00a0%. The recording that helps most: duration\n"
            "    40 s: viscous ±\u00a00.13\u00a0% instead of ±\u00a01\u00a0%. Assumed: clock ±0.3 % for a ceramic\n"
            "    resonator (--sensor).\n"
            "    The linear formulas (inertia from damped period and logarithmic decrement,\n"
            "    sin θ = θ; all whole periods, turning points without error) have an error\n"
            "    above the standard error of inertia beyond an amplitude of 0.0113 rad (0.65\n"
            "    deg): there, fit the full equation.\n"
            "    More: --details (what another amplitude, duration, rate or resolution would\n"
            "    give).\n");
}

TEST(PlanText, HasATableOfTotalErrorsInItsDetails) {
  const std::string text = PlanText(PlanWithTotals(), ExampleRig());
  EXPECT_THAT(text, HasSubstr("\n[[One setting changed at a time: total errors]]"));
  EXPECT_THAT(text, HasSubstr("\n[[One setting changed at a time: noise alone]]"));
  EXPECT_THAT(text, ContainsRegex("\n    duration +40 s +0.6 +0.13 "));
  EXPECT_THAT(text, Not(HasSubstr("rig's gravity torque")));
}

TEST(PlanText, SaysWhyThereAreNoTotalErrors) {
  Plan plan = ExamplePlan();
  plan.without_totals = "the fit did not converge";
  EXPECT_THAT(PlanText(plan, {}), HasSubstr("Without sensor, clock and rig: the fit did not converge.\n"));
}

TEST(PlanText, UsesUnitsOfGravityTorqueWithoutARig) {
  const std::string text = PlanText(ExamplePlan(), {});
  EXPECT_THAT(text, HasSubstr("\n    inertia        0.0400000  ± 0.0000005 s^2  0.0013 %\n"));
  EXPECT_THAT(text, HasSubstr("\n    viscous        0.001500   ± 0.000015  s    1 %\n"));
  EXPECT_THAT(text, ContainsRegex("Torques and inertia are in units of the[ \n]+gravity torque G"));
}

TEST(PlanText, MentionsTheRigsOwnError) {
  EXPECT_THAT(PlanText(ExamplePlan(), ExampleRig(0.005)),
              ContainsRegex("rig's gravity torque G,[ \n]+0.25 %, adds to"));
}

TEST(PlanText, ShowsTheErrorOfAZeroParameterInItsUnit) {
  Plan plan = ExamplePlan();
  plan.truth[1] = 0;
  const std::string text = PlanText(plan, ExampleRig());
  EXPECT_THAT(text, ContainsRegex("\n    viscous +\\(0.0 +± 3.0\\)e-05 +N m s/rad\n"));
  EXPECT_THAT(text, ContainsRegex("% +N m s/rad +rad +s +rad +%\n"));
  EXPECT_THAT(text, ContainsRegex("40 s +0.0005 +4e-06 "));
}

TEST(PlanText, WritesLargePercentagesWithoutPowersOfTen) {
  Plan plan = ExamplePlan();
  plan.rows[3].std_errors[1] = 0.00333;
  EXPECT_THAT(PlanText(plan, {}), ContainsRegex("40 s +0.0005 +222 "));
}

TEST(PlanText, ExplainsAMissingRecording) {
  Plan plan = ExamplePlan();
  plan.rows[3] = {"duration", "s", 0.5, false, std::vector<std::optional<double>>(5), {}, "too few samples"};
  const std::string text = PlanText(plan, {});
  EXPECT_THAT(text, ContainsRegex("\n    duration +0.5 s +- +- +- +- +- +-\n"));
  EXPECT_THAT(text, HasSubstr("\n\n    - duration 0.5 s: too few samples.\n\n[[How to read it]]"));
  EXPECT_THAT(text, Not(HasSubstr("no bound is known")));
}

TEST(PlanText, ExplainsADash) {
  Plan plan = ExamplePlan();
  plan.rows[0].std_errors[4].reset();
  EXPECT_THAT(PlanText(plan, {}), HasSubstr("\n    - no bound is known for this noise and sensor, or the readings"));
  EXPECT_THAT(PlanText(ExamplePlan(), {}), Not(HasSubstr("no bound is known")));
  plan = ExamplePlan();
  plan.rows[0].linear_bias.reset();
  EXPECT_THAT(PlanText(plan, {}), ContainsRegex("less than one[ \n]+whole[ \n]+period"));
}

TEST(PlanText, MakesNoComparisonWithoutAnError) {
  Plan plan = ExamplePlan();
  for (PlanRow& row : plan.rows) row.std_errors.assign(5, std::nullopt);
  plan.amplitude_of_equal_bias.reset();
  const std::string text = PlanText(plan, ExampleRig());
  EXPECT_THAT(text, HasSubstr("\n    inertia        0.08    ± - kg m^2\n"));
  EXPECT_THAT(text, ContainsRegex("cannot[ \n]+be[ \n]+compared,[ \n]+because[ \n]+the[ \n]+standard[ \n]+error[ "
                                  "\n]+is[ \n]+not[ \n]+known"));
}

TEST(PlanText, ReportsAccurateLinearFormulas) {
  Plan plan = ExamplePlan();
  plan.amplitude_of_equal_bias.reset();
  EXPECT_THAT(PlanText(plan, {}), ContainsRegex("are[ \n]+accurate[ \n]+up[ \n]+to[ \n]+2.5[ \n]+rad"));
}

TEST(PlanText, ExplainsLevelsWithoutNoise) {
  Plan plan = ExamplePlan();
  plan.noise_of_levels = 0.001;
  const std::string text = PlanText(plan, {});
  EXPECT_THAT(text, testing::StartsWith("[[Predicted standard errors]] (least squares)\n"));
  EXPECT_THAT(text, HasSubstr("0.001 rad (their spacing"));
  plan.parameters.back() = kRateBias;
  EXPECT_THAT(PlanText(plan, {}), HasSubstr("0.001 rad/s (their spacing"));
}

TEST(PlanText, ShowsTheLevelsOfARateInDegreesPerSecond) {
  Plan plan = ExamplePlan();
  plan.rows[3].factor = "resolution";
  plan.rows[3].unit = "rad/s";
  plan.rows[3].value = 0.01;
  EXPECT_THAT(PlanText(plan, {}), HasSubstr("    resolution     0.01 rad/s (0.573 deg/s)     0.0005"));
}

}  // namespace
}  // namespace pendulum::plan_text_test
