// SPDX-License-Identifier: Apache-2.0
// Compares the joint cost with the stacked residuals of all recordings.
#include "pendulum/fitting/likelihood/joint_cost.h"

#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <ceres/problem.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"
#include "tests/fitting/trajectory_cost_examples.h"

namespace pendulum::joint_cost_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

constexpr int kParameters = 10;
constexpr int kOwnRelease = 5;  // release_time of the first recording

/// A release measured as an angle and a moving start measured as a rate. They share inertia (0) and dry friction (1) of
/// ten parameters.
struct Case {
  CostExample released{Must(FindMotionModel("coulomb")), StartKind::kRelease, Quantity::kAngle, 900};
  CostExample moving{Must(FindMotionModel("coulomb")), StartKind::kMoving, Quantity::kRate, 700};
  std::vector<JointTerm> terms = {{released.cost.get(), {0, 2, 1, 4, kOwnRelease, 3}},
                                  {moving.cost.get(), {0, 6, 1, 7, 8, 9}}};
  std::vector<PriorTerm> priors = {{0, 0.04, 900}, {6, 0.001, 2e4}};
  JointCost cost{terms, kParameters, priors};
  std::vector<double> trial = Trial();

  /// The trial values of both examples, with common values for the shared parameters.
  std::vector<double> Trial() const {
    std::vector<double> all(kParameters);
    for (std::size_t i = 0; i < released.trial.size(); ++i) {
      all[static_cast<std::size_t>(terms[1].at[i])] = moving.trial[i];
      all[static_cast<std::size_t>(terms[0].at[i])] = released.trial[i];
    }
    all[0] *= 1.0003;
    return all;
  }
};

/// Weighted residuals of a recording and their derivatives with respect to all P parameters, N x (P + 1).
Eigen::MatrixXd RowsOf(const CostExample& example, const std::vector<int>& at, const std::vector<double>& all) {
  std::vector<double> own;
  for (const int i : at) own.push_back(all[static_cast<std::size_t>(i)]);
  Eigen::VectorXd readings;
  Eigen::MatrixXd jacobian;
  EXPECT_TRUE(example.cost->Readings(own, &readings, &jacobian));
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(readings.size(), kParameters + 1);
  rows(Eigen::all, at) = -jacobian;
  rows.col(kParameters) = example.data.values() - readings;
  return rows / example.data.scale;
}

/// [J'J, J'r; r'J, r'r] of all residuals; each prior counts once.
Eigen::MatrixXd ExpectedSums(const Case& joint, const std::vector<double>& all) {
  const Eigen::MatrixXd first = RowsOf(joint.released, joint.terms[0].at, all);
  const Eigen::MatrixXd second = RowsOf(joint.moving, joint.terms[1].at, all);
  Eigen::MatrixXd sums = first.transpose() * first + second.transpose() * second;
  for (const PriorTerm& prior : joint.priors) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(kParameters + 1);
    row[prior.parameter] = prior.weight;
    row[kParameters] = prior.weight * (all[static_cast<std::size_t>(prior.parameter)] - prior.mean);
    sums += row.transpose() * row;
  }
  return sums;
}

/// |actual_ij - expected_ij| <= relative · sqrt(expected_ii expected_jj).
void ExpectSums(const Eigen::MatrixXd& actual, const Eigen::MatrixXd& expected, double relative) {
  ASSERT_EQ(actual.rows(), expected.rows());
  ASSERT_EQ(actual.cols(), expected.cols());
  const Eigen::VectorXd size = expected.diagonal().cwiseSqrt();
  const Eigen::MatrixXd error = (actual - expected).cwiseQuotient(size * size.transpose());
  EXPECT_LT(error.cwiseAbs().maxCoeff(), relative) << error;
}

TEST(JointCost, SumsAllResidualsAndEachPriorOnce) {
  const Case joint;
  const Eigen::MatrixXd expected = ExpectedSums(joint, joint.trial);
  Eigen::MatrixXd sums;
  ASSERT_TRUE(joint.cost.Sums(joint.trial, &sums));
  ExpectSums(sums, expected, 1e-12);
  double sum = 0;
  ASSERT_TRUE(joint.cost.SumOfSquares(joint.trial, &sum));
  EXPECT_THAT(sum / expected(kParameters, kParameters), DoubleNear(1, 1e-12));
}

// No residual depends on unshared parameters of two different recordings.
TEST(JointCost, HasNoTermsBetweenParametersOfDifferentRecordings) {
  const Case joint;
  Eigen::MatrixXd sums;
  ASSERT_TRUE(joint.cost.Sums(joint.trial, &sums));
  for (const int i : {2, 3, 4, kOwnRelease}) {
    for (const int j : {6, 7, 8, 9}) EXPECT_EQ(sums(i, j), 0) << i << ", " << j;
  }
}

// Ceres' cost is half the sum of squares, its gradient J'r.
TEST(JointCost, GivesCeresTheSameCostAndGradient) {
  Case joint;
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(options);
  std::vector<double*> blocks;
  for (double& parameter : joint.trial) {
    blocks.push_back(&parameter);
    problem.AddParameterBlock(&parameter, 1);
  }
  joint.cost.AddTo(problem, blocks);
  EXPECT_EQ(problem.NumResidualBlocks(), 4);  // two recordings, two priors
  ceres::Problem::EvaluateOptions evaluate;
  evaluate.parameter_blocks = blocks;
  double cost = 0;
  std::vector<double> gradient;
  ASSERT_TRUE(problem.Evaluate(evaluate, &cost, nullptr, &gradient, nullptr));
  const Eigen::MatrixXd expected = ExpectedSums(joint, joint.trial);
  EXPECT_THAT(2 * cost / expected(kParameters, kParameters), DoubleNear(1, 1e-12));
  ASSERT_EQ(gradient.size(), kParameters);
  for (int i = 0; i < kParameters; ++i) {
    const double size = std::sqrt(expected(i, i) * expected(kParameters, kParameters));
    EXPECT_THAT(gradient[static_cast<std::size_t>(i)] / size, DoubleNear(expected(i, kParameters) / size, 1e-12)) << i;
  }
}

// The gradient with respect to the shared inertia is half the slope of the total sum, by finite differences.
TEST(JointCost, ChangesAllRecordingsWithSharedParameters) {
  const Case joint;
  Eigen::MatrixXd sums;
  ASSERT_TRUE(joint.cost.Sums(joint.trial, &sums));
  const double step = 1e-6 * joint.trial[0];
  double above = 0, below = 0;
  std::vector<double> moved = joint.trial;
  moved[0] += step;
  ASSERT_TRUE(joint.cost.SumOfSquares(moved, &above));
  moved[0] -= 2 * step;
  ASSERT_TRUE(joint.cost.SumOfSquares(moved, &below));
  EXPECT_THAT((above - below) / (2 * step) / (2 * sums(0, kParameters)), DoubleNear(1, 1e-4));
}

TEST(JointCost, FailsIfAMotionCannotBeTraced) {
  Case joint;
  joint.trial[kOwnRelease] = 1e3;  // released after the first recording's last sample
  double sum = 0;
  Eigen::MatrixXd sums;
  EXPECT_FALSE(joint.cost.SumOfSquares(joint.trial, &sum));
  EXPECT_FALSE(joint.cost.Sums(joint.trial, &sums));
  joint.trial = joint.Trial();
  joint.trial[6] = -1e3;  // negative friction drives the second pendulum
  EXPECT_FALSE(joint.cost.SumOfSquares(joint.trial, &sum));
  EXPECT_FALSE(joint.cost.Sums(joint.trial, &sums));
}

TEST(JointCost, GivesEachRecordingItsOwnParameters) {
  const Case joint;
  std::vector<double> numbers;
  for (int i = 0; i < kParameters; ++i) numbers.push_back(i);
  EXPECT_THAT(joint.cost.OwnParameters(0, numbers), ElementsAre(0, 2, 1, 4, 5, 3));
  EXPECT_THAT(joint.cost.OwnParameters(1, numbers), ElementsAre(0, 6, 1, 7, 8, 9));
}

TEST(JointCost, CountsRecordingsAndAllTheirReversalsAndTraces) {
  const Case joint;
  const int first = joint.released.cost->Reversals(joint.cost.OwnParameters(0, joint.trial));
  const int second = joint.moving.cost->Reversals(joint.cost.OwnParameters(1, joint.trial));
  EXPECT_GT(first, 5);
  EXPECT_GT(second, 5);
  EXPECT_EQ(joint.cost.Reversals(joint.trial), first + second);
  EXPECT_EQ(joint.cost.runs(), 2);
  const int before = joint.cost.traces();
  EXPECT_EQ(before, joint.released.cost->traces() + joint.moving.cost->traces());
  double sum = 0;
  ASSERT_TRUE(joint.cost.SumOfSquares(joint.trial, &sum));
  EXPECT_EQ(joint.cost.traces(), before + 2);
}

// Dry friction τ reduces the amplitude by 4 τ / G per swing, so a swing of 0.01 rad soon stops, a swing of 1 rad does
// not.
TEST(JointCost, ReachesRestIfAnyRecordingDoes) {
  const Case joint;
  EXPECT_FALSE(joint.cost.ComesToRest(joint.trial, 0));
  std::vector<double> short_swing = joint.trial;
  short_swing[7] = 0.01;  // the moving start: 0.01 rad at 0.01 rad/s
  short_swing[8] = 0.01;
  EXPECT_TRUE(joint.cost.ComesToRest(short_swing, 0));
}

}  // namespace
}  // namespace pendulum::joint_cost_test
