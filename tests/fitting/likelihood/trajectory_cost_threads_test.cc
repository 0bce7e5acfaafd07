// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/trajectory/synthetic.h"
#include "tests/fitting/fit_support.h"
#include "tests/fitting/trajectory_cost_examples.h"

namespace pendulum::trajectory_cost_threads_test {
namespace {

/// More blocks than one thread takes at a time; the last one is not full.
constexpr std::size_t kSamples = 100'001;

/// All results of a cost for a trajectory of 40 s.
struct Evaluated {
  Eigen::MatrixXd sums;
  double sum = 0;
  Eigen::VectorXd readings;
  Eigen::MatrixXd jacobian;
};

class Recorded {
 public:
  Recorded(const NoiseModel& noise, StartKind start, Quantity quantity)
      : start_(start), data_(Samples(quantity, kSamples)), noise_(noise), p_(TypicalParameters(model_, start)) {
    for (double& time : data_.time) time *= 40 / data_.time.back();
    const auto cost = MakeTrajectoryCost(model_, start_, data_);
    const Eigen::VectorXd readings = ReadingsOf(*cost, p_);
    for (std::size_t i = 0; i < kSamples; ++i) {
      data_.value[i] = readings[static_cast<Eigen::Index>(i)] + 0.003 * std::sin(17.0 * static_cast<double>(i));
    }
  }

  Evaluated On(int threads) const {
    const auto cost = MakeTrajectoryCost(model_, start_, data_);
    cost->set_threads(threads);
    cost->set_noise(noise_);
    Evaluated all;
    EXPECT_TRUE(cost->Sums(p_, &all.sums));
    EXPECT_TRUE(cost->SumOfSquares(p_, &all.sum));
    EXPECT_TRUE(cost->Readings(p_, &all.readings, &all.jacobian));
    return all;
  }

 private:
  MotionModel model_{"coulomb", "coulomb", Gravity::kSine};
  StartKind start_;
  TrajectoryData data_;
  NoiseModel noise_;
  std::vector<double> p_;
};

void ExpectSameOnAnyNumberOfThreads(const NoiseModel& noise, StartKind start = StartKind::kRelease,
                                    Quantity quantity = Quantity::kAngle) {
  const Recorded recorded(noise, start, quantity);
  const Evaluated one = recorded.On(1);
  ASSERT_GT(one.sum, 0);
  for (const int threads : {2, 3, 8, 0}) {
    const Evaluated other = recorded.On(threads);
    EXPECT_EQ(other.sums, one.sums) << threads;
    EXPECT_EQ(other.sum, one.sum) << threads;
    EXPECT_EQ(other.readings, one.readings) << threads;
    EXPECT_EQ(other.jacobian, one.jacobian) << threads;
  }
}

TEST(Threads, ChangeNoBitOfLeastSquares) {
  NoiseModel noise;
  noise.sigma = 0.002;
  ExpectSameOnAnyNumberOfThreads(noise);
}

TEST(Threads, ChangeNoBitForARateInMotion) {
  NoiseModel noise;
  noise.sigma = 0.002;
  ExpectSameOnAnyNumberOfThreads(noise, StartKind::kMoving, Quantity::kRate);
}

TEST(Threads, ChangeNoBitOfTheLikelihoodOfLevels) {
  NoiseModel noise;
  noise.family = NoiseFamily::kQuantized;
  noise.sigma = 0.002;
  noise.resolution = 0.0035;
  ExpectSameOnAnyNumberOfThreads(noise);
}

TEST(Threads, ChangeNoBitOfAFit) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.sample_rate = 5000;
  run.noise = 0.003;
  const Recording recording = Must(SimulateRecording(run));
  FitOptions options = ModelOptions("coulomb");
  options.threads = 1;
  const FitReport one = Fit(recording, options);
  options.threads = 2;
  const FitReport two = Fit(recording, options);
  ASSERT_EQ(one.termination, Termination::kConverged);
  for (std::size_t i = 0; i < one.parameters.size(); ++i) {
    EXPECT_EQ(one.parameters[i].estimate, two.parameters[i].estimate) << one.parameters[i].info.name;
    EXPECT_EQ(one.parameters[i].std_error, two.parameters[i].std_error) << one.parameters[i].info.name;
  }
  EXPECT_EQ(one.fitted, two.fitted);
}

}  // namespace
}  // namespace pendulum::trajectory_cost_threads_test
