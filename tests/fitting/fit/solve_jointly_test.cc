// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/solve_jointly.h"

#include <cmath>
#include <cstddef>
#include <optional>

#include <gtest/gtest.h>

#include "pendulum/fitting/solve/optimum.h"
#include "tests/fitting/joint_recordings.h"

namespace pendulum::solve_jointly_test {
namespace {

TEST(SolveJointly, EndsWithANegligibleStep) {
  const TwoRuns runs;
  JointProblem joint = runs.Problem();
  const Solution solution = SolveJointly(joint);
  ASSERT_TRUE(solution.usable) << solution.message;
  const std::optional<Optimum> optimum = Linearize(joint.solve, *joint.cost, solution);
  ASSERT_TRUE(optimum);
  EXPECT_LT(RemainingShift(*optimum), 0.01);
  EXPECT_EQ(optimum->free.size(), 9);
}

TEST(SolveJointly, GivesEachRecordingTheSharedParametersAndItsOwnNoise) {
  const TwoRuns runs;
  JointProblem joint = runs.Problem();
  const Solution solution = SolveJointly(joint);
  for (const JointMember& member : joint.members) {
    ASSERT_EQ(member.solution.parameters.size(), 6);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(member.solution.parameters[i], solution.parameters[i]) << i;
    EXPECT_NEAR(member.solution.noise.sigma, 0.002, 4 * 0.002 / std::sqrt(2 * 1000));  // σ's error is σ / sqrt(2 N)
    const double rss = (member.recording->value - member.solution.readings).squaredNorm();
    EXPECT_NEAR(std::sqrt(rss / 1000), member.solution.noise.sigma, 0.01 * member.solution.noise.sigma);
  }
}

}  // namespace
}  // namespace pendulum::solve_jointly_test
