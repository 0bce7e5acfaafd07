// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/joint_problem.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/joint_recordings.h"

namespace pendulum::joint_problem_test {
namespace {

using testing::ElementsAre;
using testing::UnorderedElementsAre;

TEST(MakeJointProblem, PlacesSharedParametersOnceAndFirst) {
  const TwoRuns runs;
  JointProblem joint = runs.Problem({"coulomb", "viscous", "inertia"});
  EXPECT_EQ(joint.shared, kPhysical);  // in the model's order
  ASSERT_EQ(joint.members.size(), 2);
  EXPECT_THAT(joint.members[0].at, ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(joint.members[1].at, ElementsAre(0, 1, 2, 6, 7, 8));
  EXPECT_EQ(joint.solve.fixed.size(), 9);
  Solution solution;
  EXPECT_EQ(joint.SolvedAt(solution).samples(), 2000);  // 10 s at 100 Hz, twice
}

TEST(MakeJointProblem, KeepsUnsharedParametersPerRecording) {
  const TwoRuns runs;
  const JointProblem joint = runs.Problem({"coulomb"});
  EXPECT_THAT(joint.members[0].at, ElementsAre(1, 2, 0, 3, 4, 5));
  EXPECT_THAT(joint.members[1].at, ElementsAre(6, 7, 0, 8, 9, 10));
}

TEST(MakeJointProblem, CountsAPriorOnASharedParameterOnce) {
  FitOptions options = RigOptions();
  options.priors["inertia"] = {0.079, 0.001};
  options.priors["zero_angle"] = {0.012, 0.01};
  const TwoRuns runs(options);
  const JointProblem joint = runs.Problem();
  std::vector<int> places;
  for (const PriorTerm& prior : joint.cost->priors()) places.push_back(prior.parameter);
  EXPECT_THAT(places, UnorderedElementsAre(0, 5, 8));
}

TEST(MakeJointProblem, RefusesASingleRecordingAndAFitWithoutSharedParameters) {
  const TwoRuns runs;
  const std::vector<JointRun> one = {{runs.recordings[0], runs.alone[0], runs.options}};
  const auto single = MakeJointProblem(one, kPhysical);
  ASSERT_FALSE(single);
  EXPECT_EQ(single.error().code, StatusCode::kInvalidArgument);
  EXPECT_EQ(single.error().message(), "a joint fit needs two recordings or more; there is one");
  const std::vector<JointRun> two = {one[0], {runs.recordings[1], runs.alone[1], runs.options}};
  const auto nothing = MakeJointProblem(two, {"stiction"});
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().message(), "model coulomb has none of the shared parameters");
}

TEST(JointProblem, NamesTheRecordingOfAnUnsharedParameter) {
  const TwoRuns runs;
  JointProblem joint = runs.Problem();
  Solution solution;
  const SolvedFit fit = joint.SolvedAt(solution);
  EXPECT_EQ(fit.NameOf(0), "inertia");
  EXPECT_EQ(fit.NameOf(3), "release_angle of recording 1");
  EXPECT_EQ(fit.NameOf(8), "zero_angle of recording 2");
  EXPECT_THAT(OwnIndices(fit.runs[1].at, {2, 4, 7}), ElementsAre(2, 4));
}

}  // namespace
}  // namespace pendulum::joint_problem_test
