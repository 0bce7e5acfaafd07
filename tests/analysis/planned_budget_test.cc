// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/planned_budget.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/sensor_statement.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::planned_budget_test {
namespace {

using testing::DoubleNear;
using testing::IsEmpty;
using testing::Not;

/// 40 s at 50 Hz, 32 periods, from 0.4 rad with a hold of 1 s.
SyntheticOptions ViscousRun() {
  SyntheticOptions run;
  run.model = Must(FindMotionModel("viscous"));
  run.parameters = {0.04, 0.001};
  run.release_angle = 0.4;
  run.release_time = 1;
  run.duration = 40;
  run.sample_rate = 50;
  run.noise = 1e-3;
  return run;
}

Plan PlanWith(const std::string& sensor, const std::optional<Rig>& rig = std::nullopt) {
  Plan plan = Must(MakePlan(ViscousRun()));
  AddTotalErrors(rig, Must(ParseSensorStatement(sensor, "sensor", "given")), plan);
  return plan;
}

const PlanRow& BaseOf(const Plan& plan) { return *std::ranges::find_if(plan.rows, &PlanRow::is_base); }

double RelativeTotal(const Plan& plan, std::size_t i) { return BaseOf(plan).total_errors[i].value() / plan.truth[i]; }

TEST(AddTotalErrors, AddsNothingToNoiseWhereAllIsExact) {
  const Plan plan = PlanWith("ideal");
  for (const PlanRow& row : plan.rows) EXPECT_EQ(row.total_errors, row.std_errors) << row.factor << " " << row.value;
}

// A period is measured with the relative error c of the clock, and inertia is in proportion to its square.
TEST(AddTotalErrors, DoublesTheErrorOfTheClockInInertia) {
  const Plan plan = PlanWith(R"({"kind": "ideal", "clock": 0.003})");
  for (const PlanRow& row : plan.rows) {
    const double noise = row.std_errors[0].value() / plan.truth[0];
    EXPECT_THAT(row.total_errors[0].value() / plan.truth[0], DoubleNear(std::hypot(0.006, noise), 1e-5)) << row.factor;
  }
}

// Without a rig the parameters are over G, which is a factor of all of them.
TEST(AddTotalErrors, AddsTheErrorOfTheRigToEachTorque) {
  Rig rig;
  rig.gravity_torque = {2, 0.02};
  const Plan plan = PlanWith("ideal", rig);
  const PlanRow& base = BaseOf(plan);
  for (const std::size_t i : {0, 1}) {
    EXPECT_THAT(RelativeTotal(plan, i), DoubleNear(std::hypot(0.01, base.std_errors[i].value() / plan.truth[i]), 1e-6));
  }
  EXPECT_EQ(base.total_errors[2], base.std_errors[2]);
}

TEST(AddTotalErrors, KeepsTheBudgetOfTheBase) {
  const Plan plan = PlanWith(R"({"kind": "ideal", "clock": 0.003})");
  ASSERT_TRUE(plan.fit);
  EXPECT_EQ(plan.fit->parameters[0].estimate, plan.truth[0]);
  EXPECT_EQ(plan.fit->parameters[0].std_error, BaseOf(plan).std_errors[0]);
  ASSERT_EQ(plan.fit->budget.size(), 1);
  EXPECT_EQ(plan.fit->budget[0].name, "clock");
}

TEST(AddTotalErrors, AssumesASensor) {
  Plan plan = Must(MakePlan(ViscousRun()));
  AddTotalErrors(std::nullopt, std::nullopt, plan);
  EXPECT_EQ(plan.sensor.kind, "angle sensor");
  EXPECT_TRUE(plan.sensor.is_kind_assumed);
  EXPECT_GT(BaseOf(plan).total_errors[0].value(), 2 * BaseOf(plan).std_errors[0].value());
}

// Noise of a hundred times the swing hides the swing.
TEST(AddTotalErrors, SaysWhyThereIsNone) {
  SyntheticOptions run = ViscousRun();
  run.noise = 40;
  Plan plan = Must(MakePlan(run));
  AddTotalErrors(std::nullopt, std::nullopt, plan);
  EXPECT_FALSE(plan.fit);
  EXPECT_THAT(plan.without_totals, Not(IsEmpty()));
}

}  // namespace
}  // namespace pendulum::planned_budget_test
