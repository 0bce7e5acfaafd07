// SPDX-License-Identifier: Apache-2.0
// Compares the standard errors with the scatter of estimates over seeds, and with ceres::Covariance.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <ceres/covariance.h>
#include <ceres/dynamic_cost_function.h>
#include <ceres/problem.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/solve/fit_problem.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::error_bars_test {
namespace {

using testing::DoubleNear;

/// 8 s at 50 Hz of a swing of 1 rad with white noise; all friction is tens of standard errors from its bound.
SyntheticOptions ShortRun(std::string_view model, StartKind start, Quantity quantity) {
  SyntheticOptions run = start == StartKind::kRelease ? TextbookRun(model) : MovingRun(model);
  run.quantity = quantity;
  run.release_angle = run.initial_angle = 1.0;
  run.release_time = 0.707;  // between two samples
  run.duration = 8;
  run.sample_rate = 50;
  run.noise = quantity == Quantity::kAngle ? 0.001 : 0.005;
  for (std::size_t i = 1; i < run.parameters.size(); ++i) run.parameters[i] *= 4;
  return run;
}

// ---- Monte Carlo ---------------------------------------------------------------------------------------------------

/// Sums over seeds for one parameter.
struct Scatter {
  double mean_error = 0;   // of the estimate
  double mean_square = 0;  // of the estimate's error
  double mean_std_error = 0;
  int covered = 0;
};

std::vector<Scatter> ScatterOf(SyntheticOptions run, int seeds) {
  const std::vector<double> truth = Truth(run);
  std::vector<Scatter> scatter(truth.size());
  for (int seed = 1; seed <= seeds; ++seed) {
    run.seed = static_cast<std::uint64_t>(seed);
    const FitReport report = FitOwnModel(run);
    EXPECT_EQ(report.termination, Termination::kConverged) << "seed " << seed;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const ParameterEstimate& parameter = report.parameters[i];
      EXPECT_TRUE(parameter.std_error) << "seed " << seed << ", " << parameter.info.name;
      const double error = parameter.estimate - truth[i];
      scatter[i].mean_error += error / seeds;
      scatter[i].mean_square += error * error / seeds;
      scatter[i].mean_std_error += parameter.std_error.value_or(0) / seeds;
      scatter[i].covered += parameter.lower95 <= truth[i] && truth[i] <= parameter.upper95;
    }
  }
  return scatter;
}

void ExpectTrueErrors(const SyntheticOptions& run) {
  constexpr int kSeeds = 300;
  const std::vector<Scatter> scatter = ScatterOf(run, kSeeds);
  const std::vector<ParameterInfo> infos = FitParameters(run.model, run.start, run.quantity);
  for (std::size_t i = 0; i < scatter.size(); ++i) {
    SCOPED_TRACE(infos[i].name);
    const double deviation = std::sqrt(scatter[i].mean_square);
    EXPECT_NEAR(deviation / scatter[i].mean_std_error, 1, 4 / std::sqrt(2.0 * kSeeds));  // 4 σ of a deviation's scatter
    EXPECT_LT(std::abs(scatter[i].mean_error), 4 * deviation / std::sqrt(kSeeds));       // no bias
    EXPECT_NEAR(scatter[i].covered, 0.95 * kSeeds, 4 * std::sqrt(kSeeds * 0.95 * 0.05));
  }
}

TEST(StandardErrors, MatchTheScatterForAHeldSwing) {
  ExpectTrueErrors(ShortRun("coulomb", StartKind::kRelease, Quantity::kAngle));
}

TEST(StandardErrors, MatchTheScatterForAMovingStart) {
  ExpectTrueErrors(ShortRun("coulomb", StartKind::kMoving, Quantity::kAngle));
}

TEST(StandardErrors, MatchTheScatterForARateSensor) {
  ExpectTrueErrors(ShortRun("coulomb", StartKind::kRelease, Quantity::kRate));
}

// ---- ceres::Covariance ---------------------------------------------------------------------------------------------

/// The N residuals of a fit as separate residuals, as a user of Ceres would write them.
class PlainResiduals : public ceres::DynamicCostFunction {
 public:
  PlainResiduals(const TrajectoryCost& cost, const TrajectoryData& data, int parameters) : cost_(cost), data_(data) {
    for (int i = 0; i < parameters; ++i) AddParameterBlock(1);
    SetNumResiduals(static_cast<int>(data.time.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    std::vector<double> values;
    for (std::size_t i = 0; i < parameter_block_sizes().size(); ++i) values.push_back(*parameters[i]);
    Eigen::VectorXd readings;
    Eigen::MatrixXd jacobian;
    if (!cost_.Readings(values, &readings, &jacobian)) return false;
    for (Eigen::Index n = 0; n < readings.size(); ++n) residuals[n] = data_.value[n] - readings[n];
    if (jacobians == nullptr) return true;
    for (Eigen::Index i = 0; i < jacobian.cols(); ++i) {
      if (jacobians[i] != nullptr) Eigen::Map<Eigen::VectorXd>(jacobians[i], readings.size()) = -jacobian.col(i);
    }
    return true;
  }

 private:
  const TrajectoryCost& cost_;
  const TrajectoryData& data_;
};

/// σ² (J'J)^-1 at these parameters by ceres::Covariance.
Eigen::MatrixXd CovarianceOfCeres(PlainResiduals& residuals, std::vector<double> parameters, double sigma) {
  ceres::Problem::Options problem_options;
  problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  std::vector<double*> blocks;
  std::vector<const double*> const_blocks;
  for (double& parameter : parameters) {
    blocks.push_back(&parameter);
    const_blocks.push_back(&parameter);
  }
  problem.AddResidualBlock(&residuals, nullptr, blocks);
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;
  ceres::Covariance covariance(options);
  EXPECT_TRUE(covariance.Compute(const_blocks, &problem));
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> matrix(blocks.size(), blocks.size());
  EXPECT_TRUE(covariance.GetCovarianceMatrix(const_blocks, matrix.data()));
  return sigma * sigma * matrix;
}

TEST(StandardErrors, MatchCeresForTheSameResiduals) {
  for (const MotionModel& model : MotionModels()) {
    if (IsHardlyDetermined(model)) continue;
    for (const StartKind start : {StartKind::kRelease, StartKind::kMoving}) {
      SCOPED_TRACE(std::string(model.name) + (start == StartKind::kRelease ? ", released" : ", moving"));
      const SyntheticOptions run = ShortRun(model.name, start, Quantity::kAngle);
      const Recording recording = Must(SimulateRecording(run));
      const FitReport report = Fit(recording, ModelOptions(model.name));
      const FitProblem problem = Must(MakeFitProblem(recording, ModelOptions(model.name)));
      const std::unique_ptr<TrajectoryCost> cost = MakeTrajectoryCost(problem.model, start, problem.data);
      std::vector<double> estimates;
      for (const ParameterEstimate& parameter : report.parameters) estimates.push_back(parameter.estimate);
      const int parameters = static_cast<int>(estimates.size());
      PlainResiduals residuals(*cost, problem.data, parameters);
      const Eigen::MatrixXd expected = CovarianceOfCeres(residuals, estimates, report.noise.sigma);
      ASSERT_EQ(report.covariance.rows(), parameters);
      for (int i = 0; i < parameters; ++i) {
        EXPECT_THAT(*report.parameters[i].std_error / std::sqrt(expected(i, i)), DoubleNear(1, 1e-6)) << i;
        for (int j = 0; j < parameters; ++j) {
          const double size = std::sqrt(expected(i, i) * expected(j, j));
          EXPECT_THAT(report.covariance(i, j) / size, DoubleNear(expected(i, j) / size, 1e-6)) << i << ", " << j;
        }
      }
    }
  }
}

}  // namespace
}  // namespace pendulum::error_bars_test
