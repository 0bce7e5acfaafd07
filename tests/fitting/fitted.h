// SPDX-License-Identifier: Apache-2.0
// A fit together with its problem, cost and solution, for tests of internals.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <boost/random/normal_distribution.hpp>

#include "pendulum/fitting/residuals/estimate_autocorrelation.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/maximum_likelihood.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/solve/search.h"
#include "pendulum/fitting/uncertainty/standard_errors.h"
#include "tests/fitting/fit_support.h"

namespace pendulum {

/// 8 s at 50 Hz of a swing of 1 rad. Friction is four times the textbook's, tens of standard errors from its bound.
inline SyntheticOptions ShortSwing(std::string_view model = "coulomb") {
  SyntheticOptions run = TextbookRun(model);
  run.release_angle = 1.0;
  run.release_time = 0.707;  // between two samples
  run.duration = 8;
  run.sample_rate = 50;
  run.noise = 0.002;
  for (std::size_t i = 1; i < run.parameters.size(); ++i) run.parameters[i] *= 4;
  return run;
}

/// A recording, its problem, cost and solution, and the likelihood around it. The cost refers to the problem.
struct Fitted {
  Recording recording;
  FitOptions options;
  std::unique_ptr<FitProblem> problem;
  std::unique_ptr<TrajectoryCost> cost;
  Solution solution;
  Optimum optimum;
  Autocorrelation correlation;  ///< Of the quantile residuals; white unless requested.
  Eigen::VectorXd residuals;    ///< N x 1, quantile residuals.

  double At(int i) const { return solution.parameters[static_cast<std::size_t>(i)]; }
  FittedRun Run() { return {recording, options, *problem, *cost, solution, {}, correlation}; }
  Errors StandardErrors() { return ComputeErrors(SolvedFitOf(Run()), optimum); }
};

/// Fits like FitRecording, from Search to the maximum likelihood. If `with_autocorrelation`, estimates the residuals'
/// autocorrelation.
inline Fitted FitWithInternals(Recording recording, FitOptions options, bool with_autocorrelation = false) {
  Fitted fitted;
  fitted.recording = std::move(recording);
  fitted.options = std::move(options);
  fitted.problem = std::make_unique<FitProblem>(Must(MakeFitProblem(fitted.recording, fitted.options)));
  const FitProblem& problem = *fitted.problem;
  fitted.cost = MakeTrajectoryCost(problem.model, problem.start.start, problem.data);
  fitted.cost->set_priors(problem.priors);
  fitted.cost->set_noise(problem.noise);
  const auto guess = [&](const std::vector<bool>& fixed) { return FirstGuess(problem, fixed); };
  fitted.solution = Search(*fitted.cost, problem.data, guess, problem.solve);
  MaximizeLikelihood(*fitted.cost, problem, fitted.options, fitted.solution);
  const std::optional<Optimum> optimum = Linearize(problem.solve, *fitted.cost, fitted.solution);
  if (!optimum) throw std::runtime_error("the trajectory cannot be computed at the solution");
  fitted.optimum = *optimum;
  fitted.residuals = QuantileResiduals(fitted.solution.noise, fitted.recording.value, fitted.solution.readings);
  if (with_autocorrelation) {
    Eigen::VectorXd readings;
    Eigen::MatrixXd jacobian;
    fitted.cost->Readings(fitted.solution.parameters, &readings, &jacobian);
    fitted.correlation = EstimateAutocorrelation(fitted.recording.time, fitted.residuals, jacobian);
  }
  return fitted;
}

/// Adds noise(generator) to every reading in turn.
template <typename Noise>
Recording WithNoise(Recording recording, std::uint64_t seed, Noise noise) {
  std::mt19937_64 generator(seed);
  for (double& value : recording.value) value += noise(generator);
  return recording;
}

/// Stationary AR(1) noise with the given lag-1 correlation and standard deviation, one sample per call.
class AutocorrelatedNoise {
 public:
  AutocorrelatedNoise(double correlation, double deviation) : correlation_(correlation), deviation_(deviation) {}

  double operator()(std::mt19937_64& generator) {
    const double fresh = started_ ? std::sqrt(1 - correlation_ * correlation_) : 1.0;
    started_ = true;
    state_ = correlation_ * state_ + fresh * normal_(generator);
    return deviation_ * state_;
  }

 private:
  double correlation_;
  double deviation_;
  double state_ = 0;
  bool started_ = false;
  boost::random::normal_distribution<double> normal_;
};

}  // namespace pendulum
