// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/escape_discontinuities.h"

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/fitting/fit/fit_description.h"
#include "pendulum/fitting/solve/maximum_likelihood.h"
#include "pendulum/fitting/solve/search.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::escape_discontinuities_test {
namespace {

using testing::ElementsAre;
using testing::Ge;
using testing::Le;
using testing::Lt;

// ---- Along a line --------------------------------------------------------------------------------------------------

/// (p - 1)² + 1, plus `height` from `jump` on. Its Newton step from 0 leads to 1.
class JumpingCost final : public LeastSquares {
 public:
  JumpingCost(double jump, double height) : jump_(jump), height_(height) {}

  bool SumOfSquares(std::span<const double> p, double* sum) const override {
    *sum = std::pow(p[0] - 1, 2) + 1 + (p[0] >= jump_ ? height_ : 0);
    largest_ = std::max(largest_, p[0]);
    return true;
  }
  bool Sums(std::span<const double>, Eigen::MatrixXd*) const override { return false; }
  void AddTo(ceres::Problem&, const std::vector<double*>&) override {}
  int Reversals(std::span<const double>) const override { return 0; }
  bool ComesToRest(std::span<const double>, double) const override { return false; }
  int traces() const override { return 0; }

  double largest() const { return largest_; }

 private:
  double jump_, height_;
  mutable double largest_ = -std::numeric_limits<double>::infinity();
};

/// Starts at 0. The standard error is such that the step to 1 is `shift` standard errors long.
std::optional<std::vector<double>> LowerFrom0(const JumpingCost& cost, double shift, double upper) {
  Optimum optimum;
  const double information = shift * shift;
  optimum.information = Eigen::MatrixXd::Constant(1, 1, information);
  optimum.gradient = Eigen::VectorXd::Constant(1, -information);
  optimum.free = {0};
  optimum.inverse = InvertInformation(optimum.information, optimum.free);
  SolveOptions options;
  options.lower = {-kUnbounded};
  options.upper = {upper};
  options.fixed = {false};
  Solution solution;
  solution.parameters = {0};
  return FindLowerAlongNewtonStep(optimum, options, cost, solution);
}

TEST(FindLowerAlongNewtonStep, TakesTheWholeStepIfPossible) {
  const JumpingCost cost(2, 5);
  EXPECT_THAT(LowerFrom0(cost, 4, kUnbounded).value(), ElementsAre(1));
}

TEST(FindLowerAlongNewtonStep, HalvesTheStepBeforeADiscontinuityDownToATenthOfAStandardError) {
  // The sum is smaller only before the jump: a step of 4 standard errors is halved six times until it is below 0.1.
  EXPECT_THAT(LowerFrom0(JumpingCost(0.02, 5), 4, kUnbounded).value(), ElementsAre(1.0 / 64));
  EXPECT_FALSE(LowerFrom0(JumpingCost(1.0 / 64, 5), 4, kUnbounded));
  // A point beyond the jump is accepted if the jump is smaller than the descent.
  EXPECT_THAT(LowerFrom0(JumpingCost(0.001, 0.5), 4, kUnbounded).value(), ElementsAre(1));
}

TEST(FindLowerAlongNewtonStep, RespectsBounds) {
  const JumpingCost cost(2, 5);
  EXPECT_THAT(LowerFrom0(cost, 4, 0.3).value(), ElementsAre(0.3));
  EXPECT_THAT(cost.largest(), Le(0.3));
}

// ---- A swing -------------------------------------------------------------------------------------------------------

/// An accelerometer across the rod, with enough dry friction for jumps above the noise.
Recording Swing(std::uint64_t seed) {
  SyntheticOptions run =
      MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0.1, 1.005, 0.02, 0.3}, 0.02);
  run.parameters = {1 / 22.0, 0.0005, 0.01};
  run.duration = 15;
  run.seed = seed;
  return Must(SimulateRecording(run));
}

/// A cost in which Sums fails from a given call on.
class FailingCost final : public TrajectoryCost {
 public:
  FailingCost(TrajectoryCost& cost, std::size_t parameters)
      : TrajectoryCost(static_cast<int>(parameters)), cost_(cost) {}

  void FailAfter(int calls) { left_ = calls; }

  bool Sums(std::span<const double> p, Eigen::MatrixXd* sums) const override {
    if (left_-- <= 0 || !cost_.Sums(p, sums)) return false;
    AddPriors(priors(), p, sums);
    return true;
  }
  bool SumOfSquares(std::span<const double> p, double* sum) const override {
    if (left_ <= 0 || !cost_.SumOfSquares(p, sum)) return false;
    *sum += PriorSum(p);
    return true;
  }
  bool Readings(std::span<const double> p, Eigen::VectorXd* readings, Eigen::MatrixXd* jacobian) const override {
    return cost_.Readings(p, readings, jacobian);
  }
  TraceSummary Trace(std::span<const double> p) const override { return cost_.Trace(p); }
  bool ComesToRest(std::span<const double> p, double change) const override { return cost_.ComesToRest(p, change); }
  bool Motion(std::span<const double>, bool, MotionStates*) const override { return false; }
  void set_tolerance(double tolerance) override { cost_.set_tolerance(tolerance); }
  void set_used_samples(std::size_t count) override { cost_.set_used_samples(count); }
  void set_threads(int) override {}
  void set_noise(const NoiseModel& noise) override { cost_.set_noise(noise); }

 private:
  TrajectoryCost& cost_;
  mutable int left_ = std::numeric_limits<int>::max();
};

/// A solution whose viscous friction is 5 % too large, as if a solver had stopped there.
struct Stopped {
  explicit Stopped(std::uint64_t seed) : recording(Swing(seed)), problem(Must(MakeFitProblem(recording, Near()))) {
    cost = MakeTrajectoryCost(problem.model, problem.start.start, problem.data);
    cost->set_priors(problem.priors);
    cost->set_noise(problem.noise);
    const auto guess = [&](const std::vector<bool>& fixed) { return FirstGuess(problem, fixed); };
    solution = Search(*cost, problem.data, guess, problem.solve);
    MaximizeLikelihood(*cost, problem, options, solution);
    best = solution;
    solution.parameters[1] *= 1.05;
    EXPECT_TRUE(cost->SumOfSquares(solution.parameters, &solution.sum));
    EXPECT_TRUE(cost->Readings(solution.parameters, &solution.readings, nullptr));
    solution.log_likelihood = LogLikelihoodOf(problem, solution);
  }
  Stopped(const Stopped&) = delete;  // the cost refers to the problem here
  Stopped& operator=(const Stopped&) = delete;

  static FitOptions Near() {
    FitOptions options;
    options.initial["radius"] = 0.3;
    return options;
  }

  FitOptions options = Near();
  Recording recording;
  FitProblem problem;
  std::unique_ptr<TrajectoryCost> cost;
  Solution solution, best;
};

TEST(EscapeDiscontinuities, FindsABetterSolutionAndItsNoise) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Stopped stopped(seed);
    Solution solution = stopped.solution;
    EscapeDiscontinuities(*stopped.cost, stopped.problem, stopped.options, solution);
    ASSERT_TRUE(solution.usable);
    EXPECT_THAT(solution.log_likelihood, Ge(stopped.best.log_likelihood - 1)) << seed;
    EXPECT_THAT(std::abs(solution.noise.sigma / 0.02 - 1), Lt(0.1));
    double sum = 0;
    ASSERT_TRUE(stopped.cost->SumOfSquares(solution.parameters, &sum));
    EXPECT_NEAR(sum, solution.sum, 1e-9 * sum);
    // Divided by σ² = RSS / (N - free), the sum of squares equals the degrees of freedom.
    const double freedom = 1500 - static_cast<double>(solution.parameters.size());
    EXPECT_NEAR(sum - stopped.cost->PriorSum(solution.parameters), freedom, 3);
  }
}

TEST(EscapeDiscontinuities, RespectsBounds) {
  Stopped stopped(1);
  stopped.problem.solve.upper[2] = 0.9999 * stopped.best.parameters[2];
  Solution solution = stopped.solution;
  solution.parameters[2] = 0.999 * stopped.best.parameters[2];
  EXPECT_TRUE(stopped.cost->SumOfSquares(solution.parameters, &solution.sum));
  EscapeDiscontinuities(*stopped.cost, stopped.problem, stopped.options, solution);
  EXPECT_TRUE(solution.usable);
  EXPECT_THAT(solution.parameters[2], Le(stopped.problem.solve.upper[2]));
}

TEST(EscapeDiscontinuities, ReplacesASolutionOnlyByABetterSolution) {
  Stopped stopped(1);
  const auto squares = [&](const Solution& solution) {
    Eigen::VectorXd readings;
    EXPECT_TRUE(stopped.cost->Readings(solution.parameters, &readings, nullptr));
    return (stopped.recording.value - readings).squaredNorm();
  };
  for (int calls = 0; calls < 40; ++calls) {
    FailingCost failing(*stopped.cost, stopped.solution.parameters.size());
    failing.FailAfter(calls);
    Solution solution = stopped.solution;
    EscapeDiscontinuities(failing, stopped.problem, stopped.options, solution);
    EXPECT_TRUE(solution.usable) << calls;
    EXPECT_THAT(squares(solution), Le(squares(stopped.solution))) << calls;
    if (calls < 2) {
      EXPECT_EQ(solution.parameters, stopped.solution.parameters) << calls;
    }
  }
}

TEST(HasDiscontinuities, IsTrueForAccelerationsWithDryFrictionOnly) {
  const Recording recording = Swing(1);
  FitOptions options;
  EXPECT_TRUE(HasDiscontinuities(Must(MakeFitProblem(recording, options))));
  options.model = "viscous";
  EXPECT_FALSE(HasDiscontinuities(Must(MakeFitProblem(recording, options))));
  EXPECT_FALSE(HasDiscontinuities(Must(MakeFitProblem(Must(SimulateRecording(TextbookRun("coulomb"))), {}))));
}

}  // namespace
}  // namespace pendulum::escape_discontinuities_test
