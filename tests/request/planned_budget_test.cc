// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/planned_budget.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/model/rig.h"
#include "pendulum/recording/sensor_statement.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::planned_budget_test {
namespace {

using testing::DoubleNear;
using testing::IsEmpty;
using testing::Not;

/// 40 s at 50 Hz, 32 periods, from 0.4 rad with a hold of 1 s.
SimulationFlags ViscousRun() {
  SimulationFlags flags;
  flags.model = "viscous";
  flags.set = "inertia=0.04,viscous=0.001,release_angle=0.4,release_time=1";
  flags.unit = "rad";
  flags.duration = 40;
  flags.rate = 50;
  flags.noise = 1e-3;
  return flags;
}

Plan PlanOf(const SimulationFlags& flags, const std::optional<SensorStatement>& sensor,
            const std::optional<Rig>& rig = std::nullopt) {
  const Simulation simulation = Must(MakeSimulation(flags, rig));
  Plan plan = Must(MakePlan(simulation.synthetic));
  AddTotalErrors(simulation, rig, sensor, plan);
  return plan;
}

Plan PlanWith(const std::string& sensor, const std::optional<Rig>& rig = std::nullopt) {
  return PlanOf(ViscousRun(), Must(ParseSensorStatement(sensor, "sensor", "given")), rig);
}

const PlanRow& BaseOf(const Plan& plan) { return *std::ranges::find_if(plan.rows, &PlanRow::is_base); }

double RelativeTotal(const Plan& plan, std::size_t i) { return BaseOf(plan).total_errors[i].value() / plan.truth[i]; }

TEST(AddTotalErrors, AddsNothingToNoiseWhereAllIsExact) {
  const Plan plan = PlanWith(R"({"kind": "ideal", "clock": 0})");
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

// G is a factor of inertia and friction, but not of angles.
TEST(AddTotalErrors, AddsTheErrorOfTheRigToEachTorque) {
  const Rig rig = Must(ParseRig(R"({"gravity_torque": {"value": 2, "std_dev": 0.02}})", "rig"));
  SimulationFlags flags = ViscousRun();
  flags.set = "inertia=0.08,viscous=0.002,release_angle=0.4,release_time=1";
  const Plan plan =
      PlanOf(flags, Must(ParseSensorStatement(R"({"kind": "ideal", "clock": 0})", "sensor", "given")), rig);
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

TEST(AddTotalErrors, AssumesASensorAndAClock) {
  const Plan plan = PlanOf(ViscousRun(), std::nullopt);
  EXPECT_EQ(plan.sensor.kind, "angle sensor");
  EXPECT_TRUE(plan.sensor.is_kind_assumed);
  EXPECT_TRUE(plan.sensor.Of(SensorEffect::kClock).is_assumed);
  EXPECT_GT(BaseOf(plan).total_errors[0].value(), 2 * BaseOf(plan).std_errors[0].value());
}

// No Cramér-Rao bound is known for means of readings. The error of a mean of 4 is half of that of one reading.
TEST(AddTotalErrors, UsesTheErrorsOfTheFitWhereNoBoundIsKnown) {
  SimulationFlags flags = ViscousRun();
  const std::optional<SensorStatement> exact = Must(ParseSensorStatement(R"({"kind": "ideal", "clock": 0})", "s", "s"));
  const double single = BaseOf(PlanOf(flags, exact)).total_errors[0].value();
  flags.resolution = 1e-3;
  flags.oversample = 4;
  flags.window_s = 0.01;
  const Plan plan = PlanOf(flags, exact);
  EXPECT_FALSE(BaseOf(plan).std_errors[0]);
  EXPECT_THAT(BaseOf(plan).total_errors[0].value() / single, DoubleNear(0.5, 0.1));
}

// Noise of a hundred times the swing hides the swing.
TEST(AddTotalErrors, SaysWhyThereIsNone) {
  SimulationFlags flags = ViscousRun();
  flags.noise = 40;
  const Plan plan = PlanOf(flags, std::nullopt);
  EXPECT_FALSE(plan.fit);
  EXPECT_THAT(plan.without_totals, Not(IsEmpty()));
}

}  // namespace
}  // namespace pendulum::planned_budget_test
