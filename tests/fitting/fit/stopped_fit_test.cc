// SPDX-License-Identifier: Apache-2.0
// Stops computations at every evaluation of a trajectory in turn. This is deterministic, because the cost itself
// requests the stop.
#include <atomic>
#include <limits>
#include <memory>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/fit/fit_jointly.h"
#include "pendulum/fitting/fit/make_fit_report.h"
#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/fitting/residuals/arma_likelihood.h"
#include "pendulum/fitting/residuals/estimate_autocorrelation.h"
#include "pendulum/fitting/solve/maximum_likelihood.h"
#include "pendulum/fitting/solve/search.h"
#include "pendulum/fitting/start/frequency_scan.h"
#include "pendulum/fitting/uncertainty/posterior.h"
#include "tests/fitting/fit_support.h"
#include "tests/fitting/joint_recordings.h"

namespace pendulum::stopped_fit_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::stop_token Requested() {
  std::stop_source source;
  source.request_stop();
  return source.get_token();
}

/// The cost of a problem that requests a stop after `evaluations` evaluations.
class StoppingCost final : public TrajectoryCost {
 public:
  StoppingCost(const FitProblem& problem, std::stop_source stop, int evaluations)
      : StoppingCost(MakeTrajectoryCost(problem.model, problem.start.start, problem.data), std::move(stop),
                     evaluations) {}

  bool SumOfSquares(std::span<const double> p, double* sum) const override {
    Count();
    return cost_->SumOfSquares(p, sum);
  }
  bool Sums(std::span<const double> p, Eigen::MatrixXd* sums) const override {
    Count();
    return cost_->Sums(p, sums);
  }
  bool Readings(std::span<const double> p, Eigen::VectorXd* readings, Eigen::MatrixXd* jacobian) const override {
    Count();
    return cost_->Readings(p, readings, jacobian);
  }
  bool Motion(std::span<const double> p, bool with_jacobian, MotionStates* states) const override {
    Count();
    return cost_->Motion(p, with_jacobian, states);
  }
  TraceSummary Trace(std::span<const double> p) const override {
    Count();
    return cost_->Trace(p);
  }
  bool ComesToRest(std::span<const double> p, double torque_change) const override {
    Count();
    return cost_->ComesToRest(p, torque_change);
  }
  void set_tolerance(double tolerance) override { cost_->set_tolerance(tolerance); }
  void set_used_samples(std::size_t count) override { cost_->set_used_samples(count); }
  void set_noise(const NoiseModel& noise) override { cost_->set_noise(noise); }
  void set_threads(int threads) override { cost_->set_threads(threads); }
  int traces() const override { return cost_->traces(); }
  bool is_stopped() const override { return cost_->is_stopped(); }

  /// Number of evaluations requested.
  int evaluations() const { return evaluations_; }

 private:
  StoppingCost(std::unique_ptr<TrajectoryCost> cost, std::stop_source stop, int evaluations)
      : TrajectoryCost(static_cast<int>(cost->parameter_block_sizes().size())),
        cost_(std::move(cost)),
        stop_(std::move(stop)),
        left_(evaluations) {}

  void Count() const {
    ++evaluations_;
    if (left_-- == 0) stop_.request_stop();
  }

  std::unique_ptr<TrajectoryCost> cost_;
  mutable std::stop_source stop_;
  mutable int left_;
  mutable int evaluations_ = 0;
};

/// A fit with explicit steps from its problem to its report, stopped after `evaluations` evaluations.
struct HandmadeFit {
  HandmadeFit(const Recording& recording, FitOptions options, int evaluations) {
    std::stop_source stop;
    options.stop = stop.get_token();
    const FitProblem problem = Must(MakeFitProblem(recording, options));
    StoppingCost cost(problem, stop, evaluations);
    cost.set_noise(problem.noise);
    const auto guess = [&](const std::vector<bool>& fixed) { return FirstGuess(problem, fixed); };
    Solution solution = Search(cost, problem.data, guess, problem.solve);
    MaximizeLikelihood(cost, problem, options, solution);
    report = MakeFitReport({recording, options, problem, cost, solution});
    is_stopped = stop.stop_requested();
    evaluations_requested = cost.evaluations();
  }

  FitReport report;
  bool is_stopped = false;
  int evaluations_requested = 0;
};

/// Stops a fit at each of its evaluations, or at 300 of them. The stopped fit must end, and must not request many more
/// evaluations than the whole fit.
void StopEverywhere(const Recording& recording, const FitOptions& options) {
  const HandmadeFit whole(recording, options, std::numeric_limits<int>::max());
  ASSERT_FALSE(whole.is_stopped);
  ASSERT_EQ(whole.report.termination, Termination::kConverged) << whole.report.reason;
  constexpr int kMax = 300;
  const int step = whole.evaluations_requested / kMax + 1;
  for (int k = 0; k < whole.evaluations_requested; k += step) {
    const HandmadeFit fit(recording, options, k);
    EXPECT_TRUE(fit.is_stopped) << k;
    // Loops over restarts, neighbouring minima and points of profiles still run, but without work.
    EXPECT_LE(fit.evaluations_requested, 4 * whole.evaluations_requested + 1000) << k;
  }
}

TEST(StoppedFit, EndsAfterAStopAtAnyEvaluation) {
  StopEverywhere(Must(SimulateRecording(NoisyRun("coulomb"))), ModelOptions("coulomb"));
}

TEST(StoppedFit, EndsAfterAStopIfThePendulumComesToRest) {
  SyntheticOptions run = NoisyRun("coulomb");
  run.duration = 40;  // dry friction of 0.012 N m stops the pendulum after about 20 s
  run.parameters[2] *= 3;
  StopEverywhere(Must(SimulateRecording(run)), ModelOptions("coulomb"));
}

TEST(StoppedFit, EndsAfterAStopForCoarseLevelsWithoutNoise) {
  SyntheticOptions run = NoisyRun("viscous");
  run.noise = 0;
  run.resolution = kCount;
  StopEverywhere(Must(SimulateRecording(run)), ModelOptions("viscous"));
}

TEST(StoppedFit, EndsAfterAStopInAProfile) {
  FitOptions options = ModelOptions("viscous");
  options.interval = IntervalMethod::kProfile;
  StopEverywhere(Must(SimulateRecording(NoisyRun("viscous"))), options);
}

TEST(StoppedFit, EndsAfterAStopInARobustFit) {
  FitOptions options = ModelOptions("viscous");
  options.noise = NoiseFamily::kStudent;
  StopEverywhere(Must(SimulateRecording(NoisyRun("viscous"))), options);
}

TEST(StoppedFit, IsAnErrorWithAMessage) {
  FitOptions options = ModelOptions("coulomb");
  options.stop = Requested();
  const Result<FitReport> fit = FitRecording(Must(SimulateRecording(NoisyRun())), options);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, StatusCode::kTryAgain);
  EXPECT_THAT(fit.error().message(), HasSubstr("stopped before it was done"));
}

TEST(StoppedFit, IsAnErrorInABootstrapToo) {
  for (const int threads : {1, 2}) {
    FitOptions options = ModelOptions("viscous");
    std::stop_source stop;
    options.stop = stop.get_token();
    options.interval = IntervalMethod::kBootstrap;
    options.threads = threads;
    std::atomic<int> reports = 0;
    options.progress = [&](const ProgressStep&) {
      ++reports;
      stop.request_stop();
    };
    const Result<FitReport> fit = FitRecording(Must(SimulateRecording(NoisyRun("viscous"))), options);
    ASSERT_FALSE(fit);
    EXPECT_EQ(fit.error().code, StatusCode::kTryAgain);
    EXPECT_GE(reports, 1);
  }
}

TEST(StoppedFit, IsAnErrorForSeveralRecordings) {
  const TwoRuns two;
  FitOptions options = two.options;
  options.stop = Requested();
  const Result<JointFit> fit = TryJointly(two.recordings, two.alone, options);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, StatusCode::kTryAgain);
}

TEST(StoppedCost, ReturnsNoResultEvenIfCached) {
  FitOptions options = ModelOptions("coulomb");
  std::stop_source stop;
  options.stop = stop.get_token();
  const FitProblem problem = Must(MakeFitProblem(Must(SimulateRecording(NoisyRun())), options));
  const auto cost = MakeTrajectoryCost(problem.model, problem.start.start, problem.data);
  Eigen::MatrixXd sums, jacobian;
  Eigen::VectorXd readings;
  double sum = 0;
  ASSERT_TRUE(cost->Sums(problem.first_guess, &sums));
  ASSERT_TRUE(cost->Readings(problem.first_guess, &readings, nullptr));
  ASSERT_GT(cost->Trace(problem.first_guess).reversals, 5);
  const int traces = cost->traces();
  stop.request_stop();
  EXPECT_FALSE(cost->Sums(problem.first_guess, &sums));
  EXPECT_FALSE(cost->SumOfSquares(problem.first_guess, &sum));
  EXPECT_FALSE(cost->Readings(problem.first_guess, &readings, nullptr));
  EXPECT_FALSE(cost->Readings(problem.first_guess, &readings, &jacobian));
  EXPECT_EQ(cost->Trace(problem.first_guess).reversals, 0);
  EXPECT_EQ(cost->traces(), traces);
}

TEST(StoppedFunctions, ReturnNoResult) {
  SyntheticOptions slow = NoisyRun("viscous");
  slow.sample_rate = 2;
  const Recording recording = Must(SimulateRecording(slow));
  const MotionModel model = Must(FindMotionModel("viscous"));
  EXPECT_THAT(ScanFrequencies(recording, model, {1, 20}, Requested()), IsEmpty());
  EXPECT_THAT(ScanFrequencies(recording, model, {1, 20}), Not(IsEmpty()));

  LinearizedFit fit;
  fit.value = Eigen::VectorXd::LinSpaced(41, -20, 20);
  fit.readings = fit.value;
  fit.jacobian = Eigen::MatrixXd::Ones(41, 1);
  fit.noise = {NoiseFamily::kQuantized, 0.05, 1, -kInfinity, kInfinity};
  fit.lower = Eigen::VectorXd::Constant(1, -kInfinity);
  fit.upper = Eigen::VectorXd::Constant(1, kInfinity);
  fit.prior_mean = fit.prior_weight = Eigen::VectorXd::Zero(1);
  ASSERT_TRUE(SamplePosterior(fit, 1));
  const Result<Posterior> posterior = SamplePosterior(fit, 1, Requested());
  ASSERT_FALSE(posterior);
  EXPECT_EQ(posterior.error().code, StatusCode::kTryAgain);
}

TEST(StoppedFunctions, ReturnNoAutocorrelation) {
  Autocorrelation like;
  like.kind = Autocorrelation::Kind::kAutoregressive;
  like.interval = 1;
  like.autoregressive = {0.6};
  like.innovation_variance = 1 - 0.36;
  CorrelatedResiduals data;
  constexpr Eigen::Index kSamples = 400;
  data.time = Eigen::VectorXd::LinSpaced(kSamples, 0, kSamples - 1);
  data.residual = (0.37 * data.time.array()).sin() + (1.9 * data.time.array().square()).cos();
  data.jacobian = Eigen::MatrixXd::Ones(kSamples, 1);
  data.lowest = Eigen::VectorXd::Constant(1, -kUnbounded);
  data.highest = Eigen::VectorXd::Constant(1, kUnbounded);
  EXPECT_TRUE(MaximizeCorrelatedLikelihood(data, like));
  EXPECT_FALSE(MaximizeCorrelatedLikelihood(data, like, Requested()));
  ASSERT_NE(EstimateAutocorrelation(data.time, data.residual, data.jacobian).kind, Autocorrelation::Kind::kWhite);
  EXPECT_EQ(EstimateAutocorrelation(data.time, data.residual, data.jacobian, Requested()).kind,
            Autocorrelation::Kind::kWhite);
}

}  // namespace
}  // namespace pendulum::stopped_fit_test
