// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/solved_fit.h"

#include <vector>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"

namespace pendulum::solved_fit_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Parameters 0 and 1 are shared; the recording has 3 and 4 for itself. Among all, 1 is at a bound and 2 is another's.
const std::vector<int> kAt = {0, 1, 3, 4};

TEST(OwnIndices, AreThoseOfTheRecordingInItsOrder) {
  EXPECT_THAT(OwnIndices(kAt, {0, 2, 4}), ElementsAre(0, 3));
  EXPECT_THAT(OwnIndices(kAt, {2, 5}), IsEmpty());
}

TEST(RowsAmong, FindTheOwnParametersInAListOfAll) { EXPECT_THAT(RowsAmong(kAt, {0, 2, 4}, {0, 3}), ElementsAre(0, 2)); }

TEST(OwnOptimum, HasTheRowsAndColumnsOfTheRecording) {
  Optimum all;
  all.information = Eigen::VectorXd::LinSpaced(5, 1, 5) * Eigen::RowVectorXd::LinSpaced(5, 1, 5);
  all.gradient = Eigen::VectorXd::LinSpaced(5, 10, 50);
  all.free = {0, 2, 3, 4};
  all.at_bound = {1};
  all.inverse.identifiable = true;
  all.inverse.matrix = Eigen::Vector4d(1, 2, 3, 4) * Eigen::RowVector4d(1, 2, 3, 4);
  const Optimum own = OwnOptimum(kAt, all);
  EXPECT_THAT(own.free, ElementsAre(0, 2, 3));
  EXPECT_THAT(own.at_bound, ElementsAre(1));
  EXPECT_EQ(own.information, Eigen::Vector4d(1, 2, 4, 5) * Eigen::RowVector4d(1, 2, 4, 5));
  EXPECT_EQ(own.gradient, Eigen::Vector4d(10, 20, 40, 50));
  EXPECT_TRUE(own.inverse.identifiable);
  EXPECT_EQ(own.inverse.matrix, Eigen::Vector3d(1, 3, 4) * Eigen::RowVector3d(1, 3, 4));
}

TEST(OwnOptimum, NamesTheOwnParametersThatAreNotDetermined) {
  Optimum all;
  all.information = Eigen::MatrixXd::Zero(5, 5);
  all.gradient = Eigen::VectorXd::Zero(5);
  all.free = {0, 1, 2, 3, 4};
  all.inverse.direction = {2, 3};
  const Optimum own = OwnOptimum(kAt, all);
  EXPECT_FALSE(own.inverse.identifiable);
  EXPECT_THAT(own.inverse.direction, ElementsAre(2));
}

TEST(SolvedFitOf, SharesAllParametersOfTheOnlyRecording) {
  const Recording recording = Must(SimulateRecording(NoisyRun()));
  const FitOptions options = ModelOptions("coulomb");
  const FitProblem problem = Must(MakeFitProblem(recording, options));
  const auto cost = MakeTrajectoryCost(problem.model, problem.start.start, problem.data);
  Solution solution;
  const SolvedFit fit = SolvedFitOf({recording, options, problem, *cost, solution});
  EXPECT_EQ(fit.shared, 6);
  EXPECT_THAT(fit.runs.front().at, ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_EQ(fit.samples(), static_cast<double>(recording.size()));
  EXPECT_EQ(fit.NameOf(5), "zero_angle");
}

}  // namespace
}  // namespace pendulum::solved_fit_test
