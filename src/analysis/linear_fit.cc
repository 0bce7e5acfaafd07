// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/linear_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "pendulum/analysis/fitted_motion.h"
#include "pendulum/fitting/residuals/residual_diagnostics.h"
#include "pendulum/fitting/solve/covariance.h"
#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

ReadingTerms TermsOf(const NoiseModel& noise, const VectorXd& value, const VectorXd& readings) {
  ReadingTerms terms{VectorXd(value.size()), VectorXd(value.size())};
  for (Index i = 0; i < value.size(); ++i) {
    const NoiseLikelihood l = noise.ForSample(i).LikelihoodAt(value[i], readings[i]);
    terms.score[i] = l.score;
    terms.information[i] = l.information;
  }
  if (noise.IsRobust()) terms.information.setConstant(terms.information.mean());
  return terms;
}

MatrixXd ScoreCovariance(const NoiseModel& noise, const Autocorrelation& autocorrelation, const ReadingTerms& terms,
                         const VectorXd& time, const MatrixXd& weights) {
  if (noise.family == NoiseFamily::kEdges || noise.family == NoiseFamily::kAveraged)
    return CorrelatedSum(autocorrelation, time, terms.information.cwiseMax(0).cwiseSqrt().asDiagonal() * weights);
  const MatrixXd correlated = CorrelatedSum(autocorrelation, time, weights);
  if (noise.IsRobust()) return terms.score.squaredNorm() / static_cast<double>(time.size()) * correlated;
  const double variance = noise.sigma * noise.sigma;
  const VectorXd lost = 1 - variance * terms.information.array();
  return (correlated - weights.transpose() * lost.asDiagonal() * weights) / variance;
}

std::optional<LinearFit> LinearizeFit(const Recording& recording, const FitReport& fit, const std::optional<Rig>& rig,
                                      const ReadingTerms& terms, const ParameterPriors& priors, bool with_bounds,
                                      const std::stop_token& stop) {
  LinearFit linear;
  const FittedMotion motion(recording, fit, rig, stop);
  if (!motion.Readings(motion.instants(), &linear.jacobian)) return std::nullopt;
  const MatrixXd weighted = terms.information.asDiagonal() * linear.jacobian;
  MatrixXd information = linear.jacobian.transpose() * weighted;
  std::vector<int> free;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const ParameterEstimate& parameter = fit.parameters[i];
    const auto k = static_cast<Index>(i);
    if (const auto prior = priors.find(parameter.info.name); prior != priors.end())
      information(k, k) += 1 / (prior->second.std_dev * prior->second.std_dev);
    // Comparisons of parts hold the sensor's parameters fixed, because these may rest on priors alone.
    if (parameter.fixed || IsSensorParameter(parameter.info.name) || (with_bounds && parameter.at_bound)) continue;
    linear.free.push_back(k);
    free.push_back(static_cast<int>(i));
  }
  const InformationInverse inverse = InvertInformation(information, free);
  if (!inverse.identifiable) return std::nullopt;
  linear.inverse = inverse.matrix;
  linear.influence = linear.jacobian(Eigen::all, linear.free) * linear.inverse;
  return linear;
}

NoiseModel NoiseOfFit(const FitReport& fit, double low, double high) {
  const NoiseEstimate& noise = fit.noise;
  return {noise.family, noise.sigma,       noise.resolution, low,          high,
          noise.edge,   noise.stamp_ratio, noise.lag,        noise.spread, noise.averaging};
}

NoiseModel NoiseOfFit(const Recording& used, const FitReport& fit, const FitOptions& options) {
  NoiseModel noise = NoiseOfFit(fit, -kInfinity, kInfinity);
  if (fit.noise.censored == 0) return noise;
  if (const Result<FitProblem> problem = MakeFitProblem(used, options)) {
    noise.low = problem->noise.low;
    noise.high = problem->noise.high;
  }
  return noise;
}

Autocorrelation AutocorrelationOf(const NoiseModel& noise, const VectorXd& time, const VectorXd& value,
                                  const VectorXd& readings, const MatrixXd& jacobian, const std::stop_token& stop,
                                  Whiteness whiteness) {
  const VectorXd z = QuantileResiduals(noise, value, readings);
  if (whiteness == Whiteness::kPossible && !MayBeCorrelated(z)) return {};
  return EstimateAutocorrelation(noise, time, z, jacobian, stop, whiteness);
}

double Inflation(const NoiseModel& noise, Index samples, Index free, double lost) {
  const auto count = static_cast<double>(samples);
  const double known = noise.IsUncensoredGaussian() ? static_cast<double>(free) : 0;  // already corrected in σ
  return (count - known) / std::max(count - lost, 1.0);
}

namespace {

/// The covariance of all free parameters, with the residuals' own variance and autocorrelation (MODEL.md eq. (7.7)).
MatrixXd CovarianceOf(const Recording& part, const LinearFit& linear, const NoiseModel& noise,
                      const ReadingTerms& terms, const Autocorrelation& autocorrelation) {
  const VectorXd time = part.clock_scale * part.time;
  const MatrixXd covariance = ScoreCovariance(noise, autocorrelation, terms, time, linear.influence);
  const double lost = linear.inverse.ldlt().solve(covariance).trace();
  return covariance * Inflation(noise, time.size(), linear.influence.cols(), lost);
}

}  // namespace

std::optional<UnboundedEstimate> EstimateUnbounded(const Recording& part, const FitReport& fit, const NoiseModel& noise,
                                                   const std::optional<Rig>& rig, const std::stop_token& stop) {
  const ReadingTerms terms = TermsOf(noise, part.value, fit.fitted);
  const std::optional<LinearFit> linear = LinearizeFit(part, fit, rig, terms, {}, false, stop);
  if (!linear) return std::nullopt;
  const bool converged = fit.termination == Termination::kConverged;
  return EstimateUnbounded(part, fit, noise, terms, *linear,
                           converged ? fit.noise.autocorrelation
                                     : AutocorrelationOf(noise, part.clock_scale * part.time, part.value, fit.fitted,
                                                         linear->jacobian(Eigen::all, linear->free), stop));
}

/// One step to the maximum of the likelihood without bounds. An estimate cut off at a bound is not normally
/// distributed, and the other estimates depend on it.
UnboundedEstimate EstimateUnbounded(const Recording& part, const FitReport& fit, const NoiseModel& noise,
                                    const ReadingTerms& terms, const LinearFit& linear,
                                    const Autocorrelation& autocorrelation) {
  const VectorXd step = linear.influence.transpose() * terms.score;
  const MatrixXd covariance = CovarianceOf(part, linear, noise, terms, autocorrelation);
  UnboundedEstimate estimate;
  const auto physical = static_cast<Index>(PhysicalParameters(fit.model).size());
  std::vector<double> values;
  for (std::size_t i = 0; i < linear.free.size() && linear.free[i] < physical; ++i) {
    const ParameterEstimate& parameter = fit.parameters[static_cast<std::size_t>(linear.free[i])];
    estimate.names.push_back(parameter.info.name);
    values.push_back(parameter.estimate + step[static_cast<Index>(i)]);
  }
  const auto size = static_cast<Index>(values.size());
  estimate.value = Eigen::Map<const VectorXd>(values.data(), size);
  estimate.covariance = covariance.topLeftCorner(size, size);
  const VectorXd gradient = linear.jacobian(Eigen::all, linear.free).transpose() * terms.score;
  estimate.gain = gradient.dot(step);
  estimate.likelihood_covariance = linear.inverse.topLeftCorner(size, size);
  return estimate;
}

double SquaredLength(const VectorXd& difference, const MatrixXd& covariance) {
  const VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const VectorXd scaled = scale.asDiagonal() * difference;
  const MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  const auto factors = correlation.ldlt();
  return factors.isPositive() ? scaled.dot(factors.solve(scaled)) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace pendulum
