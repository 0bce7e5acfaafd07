// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/coverage_scenarios.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/model/rig.h"

namespace pendulum::coverage_scenarios_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;

constexpr double kDegree = kPi / 180;  // rad

CoverageScenario Scenario(const std::string& name) {
  const auto found = FindCoverageScenarios(name);
  EXPECT_TRUE(found) << found.error().message();
  return found->front();
}

/// The motion at the samples, without noise and levels.
Eigen::VectorXd Motion(SyntheticOptions run) {
  run.noise = run.time_noise = run.resolution = run.zero = run.averaging_window = 0;
  run.oversample = 1;
  run.rows = RowTiming::kEven;
  run.range.reset();
  const Result<Recording> recording = SimulateRecording(run);
  EXPECT_TRUE(recording) << recording.error().message();
  return recording->value;
}

TEST(CoverageScenarios, HaveUniqueNamesAndCanBeSimulated) {
  std::set<std::string> names;
  for (const CoverageScenario& scenario : CoverageScenarios()) {
    EXPECT_TRUE(names.insert(scenario.name).second) << scenario.name;
    EXPECT_THAT(scenario.name, testing::MatchesRegex("[a-z0-9_.]+"));
    EXPECT_FALSE(scenario.description.empty());
    const Result<Recording> recording = SimulateRecording(ScenarioRun(scenario, 1));
    EXPECT_TRUE(recording) << recording.error().message();
  }
  EXPECT_THAT(names.size(), Ge(15));
}

TEST(CoverageScenarios, UseTheRigOfTheDatasets) {
  const Result<Rig> rig = ReadRig("datasets/textbook_rig.json");
  ASSERT_TRUE(rig) << rig.error().message();
  for (const CoverageScenario& scenario : CoverageScenarios()) {
    ASSERT_TRUE(scenario.fit.rig);
    EXPECT_DOUBLE_EQ(scenario.fit.rig->gravity_torque.value, rig->gravity_torque.value) << scenario.name;
    EXPECT_DOUBLE_EQ(scenario.run.parameters[0] * rig->gravity_torque.value, 0.079) << scenario.name;
  }
}

TEST(CoverageScenarios, ReachStandstillOnlyInTheScenarioToRest) {
  for (const CoverageScenario& scenario : CoverageScenarios()) {
    const Eigen::VectorXd motion = Motion(scenario.run);
    const bool rests = motion.tail(50).maxCoeff() - motion.tail(50).minCoeff() < 1e-9;  // half a second
    EXPECT_EQ(rests, scenario.name.ends_with("to_rest")) << scenario.name;
  }
}

TEST(CoverageScenarios, MoveForMostOfTheRecordingInTheScenarioToRest) {
  const Eigen::VectorXd motion = Motion(Scenario("to_rest").run);
  EXPECT_GT(motion.segment(3500, 200).maxCoeff() - motion.segment(3500, 200).minCoeff(), kDegree);
}

TEST(CoverageScenarios, CutPeaksButNotTheHoldOrLastSwingsInTheScenarioSaturated) {
  const CoverageScenario scenario = Scenario("saturated");
  const Result<Recording> recording = SimulateRecording(ScenarioRun(scenario, 1));
  ASSERT_TRUE(recording) << recording.error().message();
  const auto at_the_end = [&](Eigen::Index first, Eigen::Index count) {
    int cut = 0;
    for (const double value : recording->value.segment(first, count)) {
      cut += std::abs(value - recording->range->low) < 1e-9 || value > recording->range->high - 1e-9 ? 1 : 0;
    }
    return cut;
  };
  EXPECT_EQ(at_the_end(0, 200), 0);
  EXPECT_EQ(at_the_end(1000, 1000), 0);
  EXPECT_THAT(at_the_end(200, 800), AllOf(Ge(60), Le(250)));
}

TEST(CoverageScenarios, HaveLaxerRulesOnlyWhereIntended) {
  for (const CoverageScenario& scenario : CoverageScenarios()) {
    const bool strong = scenario.name.starts_with("ar_0.9");
    const bool compared = scenario.name.ends_with("_1khz");
    EXPECT_EQ(scenario.rule.lowest, compared ? 0 : strong ? 0.91 : 0.93) << scenario.name;
    const bool quiet =
        scenario.name == "no_noise" || scenario.name == "white_0.05" || scenario.name == "white_0.02" || compared;
    const bool of_sensor = scenario.name.starts_with("sensor_");
    EXPECT_EQ(scenario.rule.highest, quiet ? 1 : of_sensor ? 0.99 : 0.97) << scenario.name;
    const bool systematic =
        of_sensor || scenario.name.find("_error") != std::string::npos;  // the bound knows only noise
    EXPECT_EQ(scenario.rule.largest_error, systematic ? kUnbounded : 1.1) << scenario.name;
  }
}

TEST(FindCoverageScenarios, GivesTheNamedScenariosInOrderOrAll) {
  const auto found = FindCoverageScenarios("to_rest,white_0.5");
  ASSERT_TRUE(found) << found.error().message();
  ASSERT_EQ(found->size(), 2);
  EXPECT_EQ(found->front().name, "to_rest");
  EXPECT_EQ(found->back().name, "white_0.5");
  EXPECT_EQ(FindCoverageScenarios("all")->size(), CoverageScenarios().size());
}

TEST(FindCoverageScenarios, RefusesUnknownAndRepeatedNames) {
  for (const std::string names : {"", "white", "white_0.5,", "white_0.5,all"}) {
    const auto found = FindCoverageScenarios(names);
    ASSERT_FALSE(found) << names;
    EXPECT_EQ(found.error().code, StatusCode::kInvalidArgument);
    EXPECT_THAT(found.error().message(), AllOf(HasSubstr("there is no scenario '"), HasSubstr("white_2.5, white_0.5")));
  }
  EXPECT_EQ(FindCoverageScenarios("moving,moving").error().message(), "scenario moving is named twice");
}

TEST(ScenarioRun, DrawsZeroAndReleaseUniformly) {
  const CoverageScenario scenario = Scenario("white_0.25");
  constexpr int kRuns = 1000;
  double zero = 0, zero_square = 0, release = 0, release_square = 0;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const SyntheticOptions run = ScenarioRun(scenario, static_cast<std::uint64_t>(seed));
    EXPECT_EQ(run.seed, static_cast<std::uint64_t>(seed));
    const double z = (run.zero - scenario.run.zero) / (0.1985 * kDegree);
    const double t = (run.release_time - scenario.run.release_time) * 100;
    EXPECT_THAT(z, AllOf(Ge(-0.5), Le(0.5)));
    EXPECT_THAT(t, AllOf(Ge(-0.5), Le(0.5)));
    zero += z / kRuns;
    release += t / kRuns;
    zero_square += z * z / kRuns;
    release_square += t * t / kRuns;
  }
  // A uniform variable has mean 0 ± 1/sqrt(12 n) and mean square 1/12 ± 1/sqrt(180 n); the tolerance is five standard
  // deviations.
  EXPECT_THAT(zero, DoubleNear(0, 5 / std::sqrt(12.0 * kRuns)));
  EXPECT_THAT(release, DoubleNear(0, 5 / std::sqrt(12.0 * kRuns)));
  EXPECT_THAT(zero_square, DoubleNear(1.0 / 12, 5 / std::sqrt(180.0 * kRuns)));
  EXPECT_THAT(release_square, DoubleNear(1.0 / 12, 5 / std::sqrt(180.0 * kRuns)));
}

TEST(ScenarioRun, IsReproducibleForASeed) {
  const CoverageScenario scenario = Scenario("moving");
  EXPECT_EQ(ScenarioRun(scenario, 7).zero, ScenarioRun(scenario, 7).zero);
  EXPECT_NE(ScenarioRun(scenario, 7).zero, ScenarioRun(scenario, 8).zero);
}

}  // namespace
}  // namespace pendulum::coverage_scenarios_test
