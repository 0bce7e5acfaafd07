// SPDX-License-Identifier: Apache-2.0
// Tests of the derivatives of the readings for every model, start and quantity.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "tests/fitting/quiet_samples.h"
#include "tests/fitting/trajectory_cost_examples.h"

namespace pendulum::trajectory_cost_jacobian_test {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::Ge;
using testing::Le;
using testing::SizeIs;

void ExpectColumnOfDifferences(const MotionModel& model, StartKind start, const TrajectoryCost& cost,
                               const TrajectoryData& data, const std::vector<double>& p, int column,
                               const Eigen::MatrixXd& jacobian) {
  const auto [above, below, step] = Beside(model, p, column);
  const std::vector<Eigen::Index> quiet = SamplesAwayFromEvents(model, start, data, {p, above, below});
  const Eigen::VectorXd difference = (ReadingsOf(cost, above) - ReadingsOf(cost, below)) / (2 * step);
  const double scale = jacobian.col(column).lpNorm<Eigen::Infinity>();
  EXPECT_GT(scale, 0);
  const double error = (jacobian.col(column) - difference)(quiet).lpNorm<Eigen::Infinity>();
  EXPECT_THAT(error, Le(1e-6 * scale)) << "column " << column;
}

TEST(Readings, HaveTheJacobianOfCentralDifferences) {
  ForEachCase([](const MotionModel& model, StartKind start, Quantity quantity) {
    const TrajectoryData data = Samples(quantity, 5000);
    const std::unique_ptr<TrajectoryCost> cost = MakeTrajectoryCost(model, start, data);
    cost->set_tolerance(1e-14);
    const std::vector<double> p = TypicalParameters(model, start);
    FrictionModels::Visit(model.friction, [&]<typename F>() {
      EXPECT_EQ(cost->Trace(p).stop_time < data.time.back(), HasDryFriction<F>());
    });
    Eigen::VectorXd readings;
    Eigen::MatrixXd jacobian;
    ASSERT_TRUE(cost->Readings(p, &readings, &jacobian));
    ASSERT_EQ(readings.size(), 5000);
    ASSERT_EQ(jacobian.rows(), 5000);
    ASSERT_EQ(jacobian.cols(), static_cast<Eigen::Index>(p.size()));
    EXPECT_THAT((readings - ReadingsOf(*cost, p)).lpNorm<Eigen::Infinity>(), Le(1e-12));
    for (int i = 0; i < static_cast<int>(p.size()); ++i) {
      ExpectColumnOfDifferences(model, start, *cost, data, p, i, jacobian);
    }
  });
}

TEST(Readings, HaveTheJacobianForADriftingZero) {
  ForEachCase([](const MotionModel& model, StartKind start, Quantity quantity) {
    TrajectoryData data = Samples(quantity, 500);
    const auto steady = MakeTrajectoryCost(model, start, data);
    TrajectoryData drifting = data;
    drifting.zero_motion_factors = drifting.time;
    const auto cost = MakeTrajectoryCost(model, start, drifting);
    std::vector<double> p = TypicalParameters(model, start);
    Eigen::VectorXd readings;
    Eigen::MatrixXd of_steady, jacobian;
    ASSERT_TRUE(steady->Readings(p, &readings, &of_steady));
    p.push_back(0.02);
    ASSERT_TRUE(cost->Readings(p, &readings, &jacobian));
    const Eigen::Index last = of_steady.cols();
    ASSERT_EQ(jacobian.cols(), last + 1);
    EXPECT_EQ(jacobian.leftCols(last), of_steady);
    std::vector<double> above = p, below = p;
    above.back() += 0.5;
    below.back() -= 0.5;
    const Eigen::VectorXd difference = ReadingsOf(*cost, above) - ReadingsOf(*cost, below);
    EXPECT_THAT((jacobian.col(last) - difference).lpNorm<Eigen::Infinity>(), Le(1e-12));
    Eigen::MatrixXd sums;
    ASSERT_TRUE(cost->Sums(p, &sums));
    const Eigen::MatrixXd expected = jacobian.transpose() * jacobian;
    const double error = (sums.topLeftCorner(last + 1, last + 1) - expected).lpNorm<Eigen::Infinity>();
    EXPECT_THAT(error, Le(1e-9 * expected.lpNorm<Eigen::Infinity>()));
  });
}

// Undamped and linear: A cos(ω0 (t - t_r)) + zero, and its derivatives, calculated by hand.
TEST(Readings, MatchTheUndampedLinearPendulum) {
  for (const Quantity quantity : kQuantities) {
    const TrajectoryData data = Samples(quantity, 1001);
    const auto cost = MakeTrajectoryCost({"linear", "viscous", Gravity::kLinear}, StartKind::kRelease, data);
    cost->set_tolerance(1e-16);
    constexpr double kAngle = 0.5, kRelease = 0.7, kZero = 0.25, kOmega = 5;
    Eigen::VectorXd readings;
    Eigen::MatrixXd jacobian;
    ASSERT_TRUE(cost->Readings(std::array{0.04, 0.0, kAngle, kRelease, kZero}, &readings, &jacobian));
    for (Eigen::Index i = 0; i < readings.size(); ++i) {
      const double t = std::max(data.time[static_cast<std::size_t>(i)] - kRelease, 0.0);
      const double s = std::sin(kOmega * t), c = std::cos(kOmega * t);
      const bool rate = quantity == Quantity::kRate;
      const double acceleration = t > 0 ? -kAngle * kOmega * kOmega * c : 0.0;
      ASSERT_THAT(readings[i], DoubleNear(kZero + (rate ? -kAngle * kOmega * s : kAngle * c), 1e-12)) << i;
      ASSERT_THAT(jacobian(i, 2), DoubleNear(rate ? -kOmega * s : c, 1e-12)) << i;
      ASSERT_THAT(jacobian(i, 3), DoubleNear(rate ? -acceleration : kAngle * kOmega * s, 1e-11)) << i;
      ASSERT_EQ(jacobian(i, 4), 1) << i;
    }
  }
}

}  // namespace
}  // namespace pendulum::trajectory_cost_jacobian_test
