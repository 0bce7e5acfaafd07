// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/maximum_likelihood.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <boost/math/distributions/normal.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/solve/search.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::maximum_likelihood_test {
namespace {

using testing::DoubleNear;
using testing::IsEmpty;
using testing::Not;

// ---- Choice of the noise family ------------------------------------------------------------------------------------

void ExpectChoice(const FitOptions& options, double resolution, double residual_std_dev, NoiseFamily family,
                  const std::string& why) {
  SCOPED_TRACE(why);
  const ChosenNoise chosen = ChooseNoise(options, resolution, residual_std_dev);
  EXPECT_EQ(chosen.family, family);
  EXPECT_EQ(chosen.why, why);
}

TEST(ChooseNoise, UsesTheRequestedFamily) {
  FitOptions options;
  options.noise = NoiseFamily::kQuantized;
  ExpectChoice(options, 0.01, 1, NoiseFamily::kQuantized, "asked for by --noise");
  options.noise = NoiseFamily::kGaussian;
  ExpectChoice(options, 0.01, 0.001, NoiseFamily::kGaussian, "asked for by --noise");
  options.noise = NoiseFamily::kHuber;
  ExpectChoice(options, 0.01, 0.001, NoiseFamily::kHuber, "asked for by --loss");
  options.noise = NoiseFamily::kStudent;
  ExpectChoice(options, 0, 0.001, NoiseFamily::kStudent, "asked for by --loss");
}

TEST(ChooseNoise, ChoosesQuantizedNoiseForResidualsBelowOneResolution) {
  const FitOptions options;
  ExpectChoice(options, 0.01, 0.0029, NoiseFamily::kQuantized,
               "the residuals are 0.29 resolutions: rounding is not small, so each reading is treated as an interval "
               "of one level");
  ExpectChoice(options, 0.01, 0.0099, NoiseFamily::kQuantized,
               "the residuals are 0.99 resolutions: rounding is not small, so each reading is treated as an interval "
               "of one level");
  ExpectChoice(
      options, 0.01, 0.025, NoiseFamily::kGaussian,
      "the residuals are 2.5 resolutions: the noise is larger than the resolution, so the readings are treated "
      "as continuous");
  ExpectChoice(options, 0, 0.025, NoiseFamily::kGaussian, "the readings show no discrete levels");
}

// ---- Gaussian noise ------------------------------------------------------------------------------------------------

/// A recording, the least-squares solution of its search, and the maximum likelihood.
struct LikelihoodCase {
  explicit LikelihoodCase(Recording made, FitOptions with = ModelOptions("coulomb"))
      : recording(std::move(made)),
        options(std::move(with)),
        problem(Must(MakeFitProblem(recording, options))),
        cost(MakeTrajectoryCost(problem.model, problem.start.start, problem.data)) {
    cost->set_tolerance(1e-12);
    cost->set_priors(problem.priors);
    cost->set_noise(problem.noise);
    const auto guess = [this](const std::vector<bool>& fixed) { return FirstGuess(problem, fixed); };
    least_squares = Search(*cost, problem.data, guess, problem.solve);
    solution = least_squares;
    MaximizeLikelihood(*cost, problem, options, solution);
    EXPECT_TRUE(solution.usable);
  }
  LikelihoodCase(const LikelihoodCase&) = delete;

  Eigen::VectorXd Residual() const { return recording.value - solution.readings; }

  double LogLikelihoodAt(const std::vector<double>& parameters, double sigma) const {
    Eigen::VectorXd readings;
    EXPECT_TRUE(cost->Readings(parameters, &readings, nullptr));
    NoiseModel noise = solution.noise;
    noise.sigma = sigma;
    return LogLikelihood(noise, recording.value, readings);
  }

  Recording recording;
  FitOptions options;
  FitProblem problem;
  std::unique_ptr<TrajectoryCost> cost;
  Solution least_squares, solution;
};

TEST(MaximizeLikelihood, KeepsLeastSquaresAndFindsSigmaForGaussianNoise) {
  const LikelihoodCase fit(Must(SimulateRecording(NoisyRun())));
  EXPECT_EQ(fit.solution.noise.family, NoiseFamily::kGaussian);
  EXPECT_EQ(fit.solution.parameters, fit.least_squares.parameters);
  // Six parameters; with that sigma the deviance is N - 6.
  const double expected = std::sqrt(fit.Residual().squaredNorm() / (1000 - 6));
  ASSERT_EQ(fit.recording.size(), 1000);
  EXPECT_THAT(fit.solution.noise.sigma, DoubleNear(expected, 1e-12));
  EXPECT_THAT(fit.solution.sum, DoubleNear(994, 1e-6));
  double sum = 0;
  EXPECT_TRUE(fit.cost->SumOfSquares(fit.solution.parameters, &sum));
  EXPECT_THAT(sum, DoubleNear(994, 1e-6));  // the cost keeps the noise
}

TEST(MaximizeLikelihood, IsTheSumOfNormalLogDensities) {
  const LikelihoodCase fit(Must(SimulateRecording(NoisyRun())));
  const Eigen::VectorXd residual = fit.Residual();
  const boost::math::normal normal(0, std::sqrt(residual.squaredNorm() / static_cast<double>(residual.size())));
  double expected = 0;
  for (const double r : residual) expected += std::log(boost::math::pdf(normal, r));
  EXPECT_THAT(fit.solution.log_likelihood, DoubleNear(expected, 1e-8));
}

TEST(MaximizeLikelihood, MultipliesADensityByTheResolution) {
  Recording recording = Must(SimulateRecording(NoisyRun()));
  const LikelihoodCase density(recording);
  recording.resolution = 3e-4;
  const LikelihoodCase probability(recording);
  ASSERT_EQ(probability.solution.noise.family, NoiseFamily::kGaussian);
  EXPECT_THAT(probability.solution.log_likelihood - density.solution.log_likelihood,
              DoubleNear(static_cast<double>(recording.size()) * std::log(3e-4), 1e-6));
}

TEST(MaximizeLikelihood, StaysFiniteForAPerfectFit) {
  SyntheticOptions run = NoisyRun();
  run.noise = 0;
  const LikelihoodCase fit(Must(SimulateRecording(run)));
  EXPECT_TRUE(std::isfinite(fit.solution.log_likelihood));
  EXPECT_GT(fit.solution.noise.sigma, 0);
}

TEST(MaximizeLikelihood, WeighsAPriorByTheFinalNoise) {
  // The resolution q is 20 σ, so the search begins at q / sqrt(12), about 6 σ.
  Recording recording = Must(SimulateRecording(NoisyRun()));
  recording.resolution = 20 * 0.002;
  FitOptions options = ModelOptions("coulomb");
  options.noise = NoiseFamily::kGaussian;
  const ParameterEstimate viscous = *Fit(recording, options).Find("viscous");
  options.priors = {{"viscous", {viscous.estimate + 2 * *viscous.std_error, *viscous.std_error}}};
  const LikelihoodCase fit(recording, options);
  EXPECT_GT(fit.problem.data.scale, 5 * fit.solution.noise.sigma);
  // Prior and recording are equally precise: the estimate lies half way, and each adds 1 to the sum of squares. Sigma
  // grows by 0.05 %.
  const double error = *viscous.std_error;
  EXPECT_THAT((fit.solution.parameters[1] - viscous.estimate) / error, DoubleNear(1, 0.005));
  EXPECT_THAT(fit.cost->PriorSum(fit.solution.parameters), DoubleNear(1, 0.01));
  EXPECT_THAT(fit.solution.sum, DoubleNear(994 + 1, 0.01));
}

// ---- Rounded readings ----------------------------------------------------------------------------------------------

/// The textbook rig with noise of `noise_counts` counts, rounded to counts.
SyntheticOptions CountsRun(double noise_counts, std::uint64_t seed) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.resolution = kCount;
  run.noise = noise_counts * kCount;
  run.seed = seed;
  return run;
}

/// (f(x + h) - f(x - h)) / 2h
template <typename F>
double Slope(const F& f, double x, double step) {
  return (f(x + step) - f(x - step)) / (2 * step);
}

TEST(MaximizeLikelihood, FindsAStationaryPointForRoundedReadings) {
  for (const double counts : {0.25, 0.5}) {
    SCOPED_TRACE(counts);
    const LikelihoodCase fit(Must(SimulateRecording(CountsRun(counts, 1))));
    ASSERT_EQ(fit.solution.noise.family, NoiseFamily::kQuantized);
    EXPECT_EQ(fit.solution.noise.resolution, kCount);
    const FitReport report = Fit(fit.recording, fit.options);
    // Slope of log L per standard error: if the maximum were one standard error away, it would be 1 or more.
    for (std::size_t i = 0; i < report.parameters.size(); ++i) {
      const double error = report.parameters[i].std_error.value();
      const auto along = [&](double shift) {
        std::vector<double> moved = fit.solution.parameters;
        moved[i] += shift * error;
        return fit.LogLikelihoodAt(moved, fit.solution.noise.sigma);
      };
      EXPECT_THAT(Slope(along, 0, 1e-3), DoubleNear(0, 0.1)) << report.parameters[i].info.name;
    }
    const auto of_sigma = [&](double sigma) { return fit.LogLikelihoodAt(fit.solution.parameters, sigma); };
    const double sigma = fit.solution.noise.sigma;
    EXPECT_THAT(Slope(of_sigma, sigma, 1e-4 * sigma) * report.noise.sigma_std_error.value(), DoubleNear(0, 0.1));
    EXPECT_THAT(fit.solution.log_likelihood, DoubleNear(of_sigma(sigma), 1e-6));  // probabilities need no unit
  }
}

TEST(MaximizeLikelihood, FindsParametersAndSigmaOfRoundedReadings) {
  for (const double counts : {0.25, 0.5}) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      SCOPED_TRACE(std::to_string(counts) + " counts, seed " + std::to_string(seed));
      const SyntheticOptions run = CountsRun(counts, seed);
      FitOptions options = ModelOptions("coulomb");
      options.interval = IntervalMethod::kCovariance;
      const FitReport report = Fit(Must(SimulateRecording(run)), options);
      ASSERT_EQ(report.termination, Termination::kConverged) << report.reason;
      EXPECT_EQ(report.noise.family, NoiseFamily::kQuantized);
      // 7 numbers for each of 12 recordings: one deviation beyond four standard errors has p = 0.005.
      for (const double deviation : Deviations(report, Truth(run))) EXPECT_THAT(deviation, DoubleNear(0, 4));
      EXPECT_THAT((report.noise.sigma - run.noise) / report.noise.sigma_std_error.value(), DoubleNear(0, 4));
      // N normal readings determine sigma to 1 / sqrt(2 N); quantized readings less accurately, but by less than a
      // factor five.
      EXPECT_GT(*report.noise.sigma_std_error / run.noise, 1 / std::sqrt(2 * 2000.0));
      EXPECT_LT(*report.noise.sigma_std_error / run.noise, 5 / std::sqrt(2 * 2000.0));
    }
  }
}

TEST(MaximizeLikelihood, HasTheSmallestSigmaWithoutNoise) {
  const LikelihoodCase fit(Must(SimulateRecording(CountsRun(0, 1))));
  EXPECT_EQ(fit.solution.noise.family, NoiseFamily::kQuantized);
  EXPECT_THAT(fit.solution.noise.sigma, DoubleNear(kSmallestSigma * kCount, 1e-3 * kCount));
}

// ---- Saturated readings --------------------------------------------------------------------------------------------

/// The hold and the first turning points are at an end of the range; readings with or without quantization.
SyntheticOptions SaturatedRun(double resolution, std::uint64_t seed) {
  SyntheticOptions run = NoisyRun("coulomb", seed);
  run.duration = 20;
  run.resolution = resolution;
  run.range = SensorRange{-0.32, 0.32};
  return run;
}

/// The largest deviation among parameters with a standard error.
double LargestDeviation(const FitReport& report, const SyntheticOptions& run) {
  double largest = 0;
  for (const double deviation : Deviations(report, Truth(run))) {
    if (std::isfinite(deviation)) largest = std::max(largest, std::abs(deviation));
  }
  return largest;
}

TEST(MaximizeLikelihood, UsesSaturatedReadingsAsBounds) {
  for (const double resolution : {0.0, kCount}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(std::to_string(resolution) + " rad, seed " + std::to_string(seed));
      const SyntheticOptions run = SaturatedRun(resolution, seed);
      Recording recording = Must(SimulateRecording(run));
      FitOptions options = ModelOptions("coulomb");
      options.interval = IntervalMethod::kCovariance;
      const FitReport censored = Fit(recording, options);
      ASSERT_EQ(censored.termination, Termination::kConverged) << censored.reason;
      EXPECT_GT(censored.noise.censored, 200);
      EXPECT_EQ(censored.covariance_names.size(), 6);
      EXPECT_LT(LargestDeviation(censored, run), 4);
      recording.range.reset();
      const FitReport as_measured = Fit(recording, options);
      EXPECT_EQ(as_measured.noise.censored, 0);
      EXPECT_GT(LargestDeviation(as_measured, run), 10);
    }
  }
}

// ---- Several minima ------------------------------------------------------------------------------------------------

TEST(MaximizeLikelihood, EvaluatesOtherMinimaUnderTheFinalNoise) {
  // At 0.5 and 0.9 counts the neighbouring minimum is higher by 43 and 3.6 in -2 log L.
  for (const double counts : {0.5, 0.9}) {
    SCOPED_TRACE(counts);
    SyntheticOptions run = CountsRun(counts, 4);
    run.parameters[1] = 0.002 / kTextbookTorque;
    run.parameters[2] = 0.005 / kTextbookTorque;
    run.duration = 60;  // it stops after 40 s
    const LikelihoodCase fit(Must(SimulateRecording(run)));
    ASSERT_EQ(fit.solution.noise.family, NoiseFamily::kQuantized);
    EXPECT_LT(fit.cost->Trace(fit.solution.parameters).stop_time, 55);
    ASSERT_THAT(fit.solution.other_minima, Not(IsEmpty()));
    for (const Minimum& minimum : fit.solution.other_minima) {
      double sum = 0;
      ASSERT_TRUE(fit.cost->SumOfSquares(minimum.parameters, &sum));
      EXPECT_THAT(minimum.sum, DoubleNear(sum, 1e-6));
      EXPECT_GE(minimum.sum, fit.solution.sum);
      EXPECT_LT(minimum.sum, fit.solution.sum + (counts < 0.7 ? 60 : 9));
      EXPECT_NE(fit.cost->Trace(minimum.parameters).reversals, fit.cost->Trace(fit.solution.parameters).reversals);
    }
  }
}

TEST(MaximizeLikelihood, KeepsASolutionThatCannotBeTraced) {
  const Recording recording = Must(SimulateRecording(NoisyRun()));
  const FitOptions options = ModelOptions("coulomb");
  const FitProblem problem = Must(MakeFitProblem(recording, options));
  const std::unique_ptr<TrajectoryCost> cost = MakeTrajectoryCost(problem.model, problem.start.start, problem.data);
  Solution solution;
  solution.parameters = Truth(NoisyRun());
  MaximizeLikelihood(*cost, problem, options, solution);
  EXPECT_FALSE(solution.usable);
  EXPECT_EQ(solution.parameters, Truth(NoisyRun()));
  EXPECT_EQ(solution.noise.sigma, problem.noise.sigma);
}

}  // namespace
}  // namespace pendulum::maximum_likelihood_test
