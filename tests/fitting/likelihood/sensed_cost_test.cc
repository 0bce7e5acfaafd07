// SPDX-License-Identifier: Apache-2.0
// Tests of the derivatives of a motion, and of the derivatives of each sensor's readings.
#include "fitting/likelihood/sensed_cost.h"

#include <array>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "tests/fitting/quiet_samples.h"
#include "tests/fitting/trajectory_cost_examples.h"

namespace pendulum::sensed_cost_test {
namespace {

using testing::Le;

constexpr std::size_t kSamples = 5000;

/// A sensor with nonzero parameters.
struct Example {
  SensorModel sensor;
  Quantity quantity;
  std::vector<double> parameters;  // S
};

std::vector<Example> Examples() {
  std::vector<Example> examples = {{{SensorKind::kScaledRate}, Quantity::kRate, {1.65, 0.115}},
                                   {{SensorKind::kAcceleration}, Quantity::kAcceleration, {0.1, 1.01, 0.7, 0.3}},
                                   {{SensorKind::kCoordinate}, Quantity::kPosition, {0.01, 640, 400}},
                                   {{SensorKind::kArc}, Quantity::kAngle, {0.01, 640, 120, 400}}};
  examples[1].sensor.gravity = kStandardGravity;
  examples[3].sensor.pivot_x = 639;
  examples[3].sensor.pivot_y = 122;
  examples[3].sensor.down = -1;
  return examples;
}

/// Largest difference between a column and its central difference, relative to the column's largest entry.
double ColumnError(const Eigen::VectorXd& column, const Eigen::VectorXd& difference,
                   const std::vector<Eigen::Index>& quiet) {
  EXPECT_FALSE(quiet.empty());
  EXPECT_GT(column.lpNorm<Eigen::Infinity>(), 0);
  return (column - difference)(quiet).lpNorm<Eigen::Infinity>() / column.lpNorm<Eigen::Infinity>();
}

TEST(Motion, MatchesCentralDifferencesForEveryModel) {
  ForEachCase([](const MotionModel& model, StartKind start, Quantity quantity) {
    if (quantity == Quantity::kRate) return;
    const TrajectoryData data = Samples(quantity, kSamples);
    const auto cost = MakeTrajectoryCost(model, start, data);
    cost->set_tolerance(1e-14);
    const std::vector<double> p = TypicalParameters(model, start);
    MotionStates states, more, less;
    ASSERT_TRUE(cost->Motion(p, true, &states));
    for (int column = 0; column + 1 < static_cast<int>(p.size()); ++column) {
      const auto [above, below, step] = Beside(model, p, column);
      const std::vector<Eigen::Index> quiet = SamplesAwayFromEvents(model, start, data, {p, above, below});
      ASSERT_TRUE(cost->Motion(above, false, &more));
      ASSERT_TRUE(cost->Motion(below, false, &less));
      for (std::size_t k = 0; k < states.value.size(); ++k) {
        ASSERT_EQ(states.jacobian[k].cols(), static_cast<Eigen::Index>(p.size()) - 1);
        const Eigen::VectorXd difference = (more.value[k] - less.value[k]) / (2 * step);
        EXPECT_THAT(ColumnError(states.jacobian[k].col(column), difference, quiet), Le(1e-6)) << column << ", " << k;
      }
    }
  });
}

TEST(SensedReadings, HaveTheJacobianOfCentralDifferencesForEverySensor) {
  for (const Example& example : Examples()) {
    ForEachCase([&](const MotionModel& model, StartKind start, Quantity quantity) {
      if (quantity == Quantity::kRate) return;
      SCOPED_TRACE(static_cast<int>(example.sensor.kind));
      TrajectoryData data = Samples(example.quantity, kSamples);
      data.sensor = example.sensor;
      const auto cost = MakeTrajectoryCost(model, start, data);
      cost->set_tolerance(1e-14);
      std::vector<double> p = TypicalParameters(model, start);
      const std::size_t motion_size = p.size() - 1;
      p.pop_back();
      p.insert(p.end(), example.parameters.begin(), example.parameters.end());
      const auto of_motion = [&](std::vector<double> parameters) {
        parameters.resize(motion_size + 1);
        return parameters;
      };
      Eigen::VectorXd readings;
      Eigen::MatrixXd jacobian;
      ASSERT_TRUE(cost->Readings(p, &readings, &jacobian));
      ASSERT_EQ(jacobian.cols(), static_cast<Eigen::Index>(p.size()));
      EXPECT_EQ(readings, ReadingsOf(*cost, p));
      for (int column = 0; column < static_cast<int>(p.size()); ++column) {
        const auto [above, below, step] = Beside(model, p, column);
        const std::vector<Eigen::Index> quiet =
            SamplesAwayFromEvents(model, start, data, {of_motion(p), of_motion(above), of_motion(below)});
        const Eigen::VectorXd difference = (ReadingsOf(*cost, above) - ReadingsOf(*cost, below)) / (2 * step);
        // The acceleration changes quickly where Dahl's bristles bend, so its differences are less accurate.
        EXPECT_THAT(ColumnError(jacobian.col(column), difference, quiet), Le(3e-6)) << "column " << column;
      }
    });
  }
}

/// J'J, minus J'r and r'r, computed from the readings and derivatives above and the noise's standard deviation.
TEST(SensedSums, MatchReadingsAndJacobian) {
  const MotionModel model = FindMotionModel("coulomb").value();
  for (const Example& example : Examples()) {
    TrajectoryData data = Samples(example.quantity, 500);
    data.sensor = example.sensor;
    data.scale = 0.5;
    data.value.assign(500, 0.2);
    const auto cost = MakeTrajectoryCost(model, StartKind::kMoving, data);
    std::vector<double> p = TypicalParameters(model, StartKind::kMoving);
    p.pop_back();
    p.insert(p.end(), example.parameters.begin(), example.parameters.end());
    const auto size = static_cast<Eigen::Index>(p.size());
    Eigen::VectorXd readings;
    Eigen::MatrixXd jacobian, sums;
    ASSERT_TRUE(cost->Readings(p, &readings, &jacobian));
    ASSERT_TRUE(cost->Sums(p, &sums));
    double sum = 0;
    ASSERT_TRUE(cost->SumOfSquares(p, &sum));
    Eigen::MatrixXd all(500, size + 1);
    all << -jacobian, data.values() - readings;
    const Eigen::MatrixXd expected = all.transpose() * all / (0.5 * 0.5);
    const Eigen::VectorXd scale = expected.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd error = scale.asDiagonal() * (sums - expected) * scale.asDiagonal();
    EXPECT_THAT(error.lpNorm<Eigen::Infinity>(), Le(1e-12));
    EXPECT_NEAR(sum, expected(size, size), 1e-9 * expected(size, size));
  }
}

}  // namespace
}  // namespace pendulum::sensed_cost_test
