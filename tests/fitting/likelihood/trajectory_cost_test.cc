// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/likelihood/trajectory_cost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "tests/fitting/trajectory_cost_examples.h"

namespace pendulum::trajectory_cost_test {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::Le;
using testing::SizeIs;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// ---- Sums and the compressed residuals ---------------------------------------------------------------------------

/// [J'J, J'r; r'J, r'r] of r = (value - reading) / scale, computed from Readings.
Eigen::MatrixXd ExpectedSums(const TrajectoryCost& cost, const TrajectoryData& data, const std::vector<double>& p) {
  Eigen::VectorXd readings;
  Eigen::MatrixXd jacobian;
  EXPECT_TRUE(cost.Readings(p, &readings, &jacobian));
  const Eigen::Map<const Eigen::VectorXd> value(data.value.data(), readings.size());
  Eigen::MatrixXd all(jacobian.rows(), jacobian.cols() + 1);
  all << -jacobian, value - readings;
  all /= data.scale;
  return all.transpose() * all;
}

/// |actual_ij - expected_ij| <= relative · sqrt(expected_ii expected_jj).
void ExpectSums(const Eigen::MatrixXd& actual, const Eigen::MatrixXd& expected, double relative) {
  ASSERT_EQ(actual.rows(), expected.rows());
  ASSERT_EQ(actual.cols(), expected.cols());
  for (Eigen::Index i = 0; i < expected.rows(); ++i) {
    for (Eigen::Index j = 0; j < expected.cols(); ++j) {
      EXPECT_THAT(actual(i, j), DoubleNear(expected(i, j), relative * std::sqrt(expected(i, i) * expected(j, j))))
          << i << ", " << j;
    }
  }
}

TEST(Sums, MatchReadingsAndJacobian) {
  ForEachCase([](const MotionModel& model, StartKind start, Quantity quantity) {
    const CostExample example(model, start, quantity);
    const Eigen::MatrixXd expected = ExpectedSums(*example.cost, example.data, example.trial);
    Eigen::MatrixXd sums;
    ASSERT_TRUE(example.cost->Sums(example.trial, &sums));
    ExpectSums(sums, expected, 1e-12);
    double sum = 0;
    ASSERT_TRUE(example.cost->SumOfSquares(example.trial, &sum));
    EXPECT_THAT(sum / expected(expected.rows() - 1, expected.rows() - 1), DoubleNear(1, 1e-12));
  });
}

/// Result of Evaluate: P + 1 residuals and the requested Jacobian columns.
struct Evaluation {
  bool valid = false;
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
};

Evaluation Evaluate(const TrajectoryCost& cost, const std::vector<double>& p, const std::vector<bool>& asked) {
  const auto size = static_cast<Eigen::Index>(p.size());
  Evaluation result;
  result.residuals.setConstant(size + 1, kNan);
  result.jacobian.setConstant(size + 1, size, kNan);
  std::vector<const double*> blocks;
  std::vector<double*> columns;
  for (std::size_t i = 0; i < p.size(); ++i) {
    blocks.push_back(&p[i]);
    columns.push_back(asked[i] ? result.jacobian.col(static_cast<Eigen::Index>(i)).data() : nullptr);
  }
  result.valid = cost.Evaluate(blocks.data(), result.residuals.data(), columns.data());
  return result;
}

TEST(Evaluate, GivesTheCostGradientAndGaussNewtonMatrixOfAllSamples) {
  ForEachCase([](const MotionModel& model, StartKind start, Quantity quantity) {
    const CostExample example(model, start, quantity);
    const Evaluation result = Evaluate(*example.cost, example.trial, std::vector<bool>(example.trial.size(), true));
    ASSERT_TRUE(result.valid);
    EXPECT_EQ(example.cost->num_residuals(), static_cast<int>(example.trial.size()) + 1);
    EXPECT_THAT(example.cost->parameter_block_sizes(), testing::AllOf(SizeIs(example.trial.size()), Each(1)));
    Eigen::MatrixXd all(result.jacobian.rows(), result.jacobian.cols() + 1);
    all << result.jacobian, result.residuals;
    ExpectSums(all.transpose() * all, ExpectedSums(*example.cost, example.data, example.trial), 1e-10);
  });
}

TEST(Evaluate, SkipsJacobiansThatAreNotRequested) {
  const CostExample example(FindMotionModel("drag").value(), StartKind::kRelease, Quantity::kAngle);
  const std::size_t size = example.trial.size();
  const Evaluation whole = Evaluate(*example.cost, example.trial, std::vector<bool>(size, true));
  for (unsigned mask = 0; mask < (1U << size); mask += 5) {
    std::vector<bool> asked;
    for (std::size_t i = 0; i < size; ++i) asked.push_back((mask >> i) % 2 == 1);
    const Evaluation some = Evaluate(*example.cost, example.trial, asked);
    ASSERT_TRUE(some.valid);
    EXPECT_EQ(some.residuals, whole.residuals);
    for (std::size_t i = 0; i < size; ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      if (!asked[i]) continue;
      EXPECT_EQ(some.jacobian.col(column), whole.jacobian.col(column));
    }
  }
}

TEST(Evaluate, GivesTheNormOfResidualsWithoutJacobians) {
  const CostExample example(FindMotionModel("coulomb").value(), StartKind::kMoving, Quantity::kRate);
  std::vector<const double*> blocks;
  for (const double& p : example.trial) blocks.push_back(&p);
  Eigen::VectorXd residuals = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(blocks.size()) + 1, kNan);
  ASSERT_TRUE(example.cost->Evaluate(blocks.data(), residuals.data(), nullptr));
  double sum = 0;
  ASSERT_TRUE(example.cost->SumOfSquares(example.trial, &sum));
  EXPECT_EQ(residuals.head(residuals.size() - 1).norm(), 0);
  EXPECT_DOUBLE_EQ(residuals[residuals.size() - 1], std::sqrt(sum));
  const Evaluation whole = Evaluate(*example.cost, example.trial, std::vector<bool>(blocks.size(), true));
  EXPECT_THAT(whole.residuals.norm() / std::sqrt(sum), DoubleNear(1, 1e-12));
}

/// Expects that many nonzero rows of the Jacobian for data of the coulomb model: 50 samples during the hold and, unless
/// `moving` is 0, one sample `moving` seconds after the release.
void ExpectRank(double moving, Eigen::Index rank) {
  const MotionModel model = FindMotionModel("coulomb").value();
  const std::vector<double> p = TypicalParameters(model, StartKind::kRelease);
  TrajectoryData data = Simulated(model, StartKind::kRelease, Quantity::kAngle, 50, p, 0.003);
  if (moving > 0) {
    data.time.push_back(p[p.size() - 2] + moving);
    data.value.push_back(data.value[0] - 0.003);
  }
  const auto cost = MakeTrajectoryCost(model, StartKind::kRelease, data);
  const Evaluation result = Evaluate(*cost, p, std::vector<bool>(p.size(), true));
  ASSERT_TRUE(result.valid);
  ASSERT_TRUE(result.jacobian.allFinite() && result.residuals.allFinite());
  EXPECT_EQ((result.jacobian.rowwise().norm().array() > 0).count(), rank) << moving;
  const Eigen::MatrixXd expected = ExpectedSums(*cost, data, p);
  Eigen::MatrixXd all(result.jacobian.rows(), result.jacobian.cols() + 1);
  all << result.jacobian, result.residuals;
  EXPECT_THAT((all.transpose() * all - expected).lpNorm<Eigen::Infinity>(), Le(1e-12 * expected.norm())) << moving;
}

// During the hold only the sum of release angle and zero is determined. One later sample determines one combination of
// all other parameters.
TEST(Evaluate, GivesAZeroRowForAnUndeterminedDirection) {
  ExpectRank(0, 1);
  for (int i = 1; i <= 30; ++i) ExpectRank(0.003 * i, 2);
}

// ---- Refused trials ----------------------------------------------------------------------------------------------

/// The number of evaluation methods that accept the trial: all five or none.
int Acceptances(const TrajectoryCost& cost, const std::vector<double>& p) {
  double sum = 0;
  Eigen::MatrixXd matrix;
  Eigen::VectorXd readings;
  int accepted = cost.SumOfSquares(p, &sum) ? 1 : 0;
  accepted += cost.Sums(p, &matrix) ? 1 : 0;
  accepted += cost.Readings(p, &readings, nullptr) ? 1 : 0;
  accepted += cost.Readings(p, &readings, &matrix) ? 1 : 0;
  accepted += Evaluate(cost, p, std::vector<bool>(p.size(), true)).valid ? 1 : 0;
  return accepted;
}

/// Acceptances for a trial of the coulomb model: inertia, viscous, coulomb, release angle and time, zero.
int AcceptancesOfARelease(const std::vector<double>& p, Quantity quantity = Quantity::kAngle) {
  const TrajectoryData data = Samples(quantity, 300);
  return Acceptances(*MakeTrajectoryCost(FindMotionModel("coulomb").value(), StartKind::kRelease, data), p);
}

TEST(TrajectoryCost, RefusesANonPositiveInertia) {
  EXPECT_EQ(AcceptancesOfARelease({0.04, 0.001, 0.01, 0.4, 0.5, 0}), 5);
  for (const double inertia : {0.0, -0.04, kNan}) {
    EXPECT_EQ(AcceptancesOfARelease({inertia, 0.001, 0.01, 0.4, 0.5, 0}), 0) << inertia;
  }
}

TEST(TrajectoryCost, RefusesATrialThatNeverMoves) {
  const double limit = std::sin(0.4);
  for (const double sign : {1.0, -1.0}) {
    EXPECT_EQ(AcceptancesOfARelease({0.04, 0.001, limit * (1 - 1e-9), sign * 0.4, 0.5, 0}), 5);
    EXPECT_EQ(AcceptancesOfARelease({0.04, 0.001, limit, sign * 0.4, 0.5, 0}), 0);
    EXPECT_EQ(AcceptancesOfARelease({0.04, 0.001, 3, sign * 0.4, 0.5, 0}), 0);
  }
  EXPECT_EQ(AcceptancesOfARelease({0.04, 0.001, 0, 0, 0.5, 0}), 0);
  const TrajectoryData data = Samples(Quantity::kAngle, 300);
  const auto moving = MakeTrajectoryCost(FindMotionModel("coulomb").value(), StartKind::kMoving, data);
  EXPECT_EQ(Acceptances(*moving, {0.04, 0.001, 0.5, 0.4, 0, 0}), 0);
  EXPECT_EQ(Acceptances(*moving, {0.04, 0.001, 0.5, 0.4, 1, 0}), 5);
}

TEST(TrajectoryCost, RefusesAReleaseOutsideTheGivenTimes) {
  for (const double time : {0.0, 0.5, 2.0}) {  // latest_release is 2
    EXPECT_EQ(AcceptancesOfARelease({0.04, 0.001, 0.01, 0.4, time, 0}), 5) << time;
  }
  for (const double time : {-1e-9, 2.0 + 1e-9, -30.0, 30.0, kNan}) {
    EXPECT_EQ(AcceptancesOfARelease({0.04, 0.001, 0.01, 0.4, time, 0}), 0) << time;
  }
}

TEST(TrajectoryCost, RefusesNonFiniteNumbers) {
  for (const Quantity quantity : kQuantities) {
    EXPECT_EQ(AcceptancesOfARelease({0.04, 1e300, 0.01, 0.4, 0.5, 0}, quantity), 0);
    EXPECT_EQ(AcceptancesOfARelease({0.04, kNan, 0.01, 0.4, 0.5, 0}, quantity), 0);
  }
}

// ---- Samples in use ----------------------------------------------------------------------------------------------

TEST(TrajectoryCost, UsesOnlyTheFirstSamplesOnRequest) {
  CostExample example(FindMotionModel("coulomb").value(), StartKind::kRelease, Quantity::kAngle);
  Eigen::MatrixXd whole, part, again;
  ASSERT_TRUE(example.cost->Sums(example.trial, &whole));
  for (const std::size_t count : {8, 161, 1000, 1001}) {
    example.cost->set_used_samples(count);
    ASSERT_TRUE(example.cost->Sums(example.trial, &part));
    TrajectoryData first = example.data;
    first.time.resize(count);
    first.value.resize(count);
    const auto cost = MakeTrajectoryCost(FindMotionModel("coulomb").value(), StartKind::kRelease, first);
    Eigen::MatrixXd expected;
    ASSERT_TRUE(cost->Sums(example.trial, &expected));
    EXPECT_EQ(part, expected) << count;
    EXPECT_EQ(example.cost->Trace(example.trial).steps, cost->Trace(example.trial).steps) << count;
    EXPECT_EQ(ReadingsOf(*example.cost, example.trial).size(), static_cast<Eigen::Index>(count));
  }
  example.cost->set_used_samples(example.data.time.size());
  ASSERT_TRUE(example.cost->Sums(example.trial, &again));
  EXPECT_EQ(whole, again);
}

// A sample may coincide with the release, and several samples may lie at one step boundary of the trace.
TEST(TrajectoryCost, AcceptsSamplesAtAnyTime) {
  TrajectoryData data = Samples(Quantity::kAngle, 0);
  data.time = {0, 0.2, 0.5, std::nextafter(0.5, 1.0), 0.50001, 0.7, 3, 3.5, 3.50001, 20};
  data.value.assign(data.time.size(), 0);
  const auto cost = MakeTrajectoryCost({"linear", "viscous", Gravity::kLinear}, StartKind::kRelease, data);
  cost->set_tolerance(1e-16);
  const Eigen::VectorXd readings = ReadingsOf(*cost, {0.04, 0, 0.3, 0.5, 0.125});
  for (Eigen::Index i = 0; i < readings.size(); ++i) {
    const double t = std::max(data.time[static_cast<std::size_t>(i)] - 0.5, 0.0);
    EXPECT_THAT(readings[i], DoubleNear(0.125 + 0.3 * std::cos(5 * t), 1e-13)) << i;
  }
}

TEST(TrajectoryCost, ReturnsTheTraceOfItsParameters) {
  const TrajectoryData data = Samples(Quantity::kAngle, 1000);
  const auto cost = MakeTrajectoryCost({"coulomb", "coulomb", Gravity::kLinear}, StartKind::kRelease, data);
  // Amplitudes 0.43, 0.37, ..., 0.01 < τ_c = 0.03, half swings of π/5 s.
  const TraceSummary summary = cost->Trace(std::array{0.04, 0.0, 0.03, 0.43, 0.5, 0.0});
  EXPECT_EQ(summary.reversals, 7);
  EXPECT_THAT(summary.stop_time, DoubleNear(0.5 + 7 * kPi / 5, 1e-9));
}

// ---- Across a change in the number of half swings before the stop ------------------------------------------------

/// A recording that ends at rest: inertia, viscous, coulomb, release angle and time, zero.
std::vector<double> ToRest(double coulomb) { return {kReferenceInertia, 0.003 / 1.803, coulomb, 0.423, 0.5, 0.013}; }

constexpr int kCoulombIndex = 2;

/// Two adjacent floating-point values of τ_c near 0.006 between which the number of reversals changes.
std::pair<double, double> ChangeOfHalfSwings(const TrajectoryCost& cost) {
  double low = 0.006, high = 0.0064;
  const int reversals = cost.Trace(ToRest(low)).reversals;
  EXPECT_NE(cost.Trace(ToRest(high)).reversals, reversals);
  while (std::nextafter(low, high) < high) {
    const double middle = std::midpoint(low, high);
    (cost.Trace(ToRest(middle)).reversals == reversals ? low : high) = middle;
  }
  return {low, high};
}

TEST(TrajectoryCost, IsContinuousWhereTheNumberOfHalfSwingsChanges) {
  const MotionModel model = FindMotionModel("coulomb").value();
  const TrajectoryData data = Simulated(model, StartKind::kRelease, Quantity::kAngle, 2500, ToRest(0.0058), 0.003);
  const auto cost = MakeTrajectoryCost(model, StartKind::kRelease, data);
  cost->set_tolerance(1e-15);
  const auto [low, high] = ChangeOfHalfSwings(*cost);
  EXPECT_LT(cost->Trace(ToRest(low)).stop_time, data.time.back());
  EXPECT_THAT((ReadingsOf(*cost, ToRest(low)) - ReadingsOf(*cost, ToRest(high))).lpNorm<Eigen::Infinity>(), Le(1e-12));
  for (const double step : {1e-5, 1e-7, 1e-9}) {  // of τ_c; the change lies between the two middle points
    std::array<double, 8> costs;
    for (int i = 0; i < 8; ++i) ASSERT_TRUE(cost->SumOfSquares(ToRest(low + (i - 3.5) * step * low), &costs[i]));
    std::array<double, 7> jumps;
    for (int i = 0; i < 7; ++i) jumps[i] = std::abs(costs[i + 1] - costs[i]);
    EXPECT_THAT(jumps[3], Le(1.5 * std::max(jumps[2], jumps[4]))) << "step " << step;
  }
}

/// τ_c [units of the restoring torque G] fitted by Ceres, with all other parameters known.
double FittedCoulomb(TrajectoryCost& cost, double from) {
  std::vector<double> p = ToRest(from);
  std::vector<double*> blocks;
  for (double& value : p) blocks.push_back(&value);
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(options);
  problem.AddResidualBlock(&cost, nullptr, blocks);
  for (int i = 0; i < static_cast<int>(p.size()); ++i) {
    if (i != kCoulombIndex) problem.SetParameterBlockConstant(blocks[i]);
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.function_tolerance = 1e-16;
  solver.parameter_tolerance = 1e-14;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  EXPECT_TRUE(summary.IsSolutionUsable()) << summary.BriefReport();
  return p[kCoulombIndex];
}

/// τ_c fitted to a noise-free recording of `samples` samples. `truth`, the start `from` and the result are relative
/// distances from the τ_c at which the number of half swings changes.
double FitAcrossTheChange(std::size_t samples, double truth, double from) {
  const MotionModel model = FindMotionModel("coulomb").value();
  TrajectoryData data = Samples(Quantity::kAngle, 2500);
  const double change = ChangeOfHalfSwings(*MakeTrajectoryCost(model, StartKind::kRelease, data)).first;
  data = Simulated(model, StartKind::kRelease, Quantity::kAngle, samples, ToRest(change * (1 + truth)), 0);
  const auto cost = MakeTrajectoryCost(model, StartKind::kRelease, data);
  cost->set_tolerance(1e-14);
  return FittedCoulomb(*cost, change * (1 + from)) / change - 1;
}

TEST(TrajectoryCost, LeadsToTheTruthFromBothSidesOfAChangeOfTheNumberOfHalfSwings) {
  for (const double truth : {-3e-4, 3e-4}) {
    for (const double from : {-2e-3, 2e-3}) {
      EXPECT_THAT(FitAcrossTheChange(1980, truth, from), DoubleNear(truth, 1e-8)) << from;  // stop after 1962 samples
    }
  }
}

// This is the reason for Search in search.h. The recording ends with 5 s at rest. With a wrong number of half swings
// the model rests at a wrong angle, so a solve from the wrong side ends at another local minimum.
TEST(TrajectoryCost, HasAMinimumForEachNumberOfHalfSwings) {
  for (const double side : {-1.0, 1.0}) {
    EXPECT_THAT(side * FitAcrossTheChange(2500, side * 3e-4, side * 2e-3), DoubleNear(3e-4, 1e-8));
    EXPECT_THAT(side * FitAcrossTheChange(2500, side * 3e-4, -side * 2e-3), Le(0));
  }
}

}  // namespace
}  // namespace pendulum::trajectory_cost_test
