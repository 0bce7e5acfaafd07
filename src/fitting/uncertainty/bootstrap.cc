// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <random>
#include <vector>

#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_int_distribution.hpp>

#include "pendulum/base/parallel.h"
#include "pendulum/fitting/solve/covariance.h"
#include "pendulum/fitting/solve/maximum_likelihood.h"
#include "pendulum/fitting/solve/trace_error.h"
#include "pendulum/trajectory/tolerance.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Samples per block: a few times the variance inflation of a mean; 1 for white residuals.
Index BlockLength(const Autocorrelation& correlation, Index samples) {
  if (correlation.kind == Autocorrelation::Kind::kWhite) return 1;
  constexpr double kInflationsPerBlock = 5;
  const auto length = static_cast<Index>(std::ceil(kInflationsPerBlock * correlation.VarianceInflation()));
  return std::clamp<Index>(length, 2, std::max<Index>(samples / 8, 2));
}

class Replicas {
 public:
  Replicas(const FitProblem& problem, const FitOptions& options, const Solution& solution,
           const Eigen::VectorXd& quantile_residuals, const Autocorrelation& correlation)
      : problem_(problem),
        options_(options),
        solution_(solution),
        residuals_(quantile_residuals.size()),
        block_(BlockLength(correlation, residuals_.size())),
        parametric_(block_ == 1 && !solution.noise.IsRobust()),
        tolerance_(TraceTolerance(MaxTraceError(problem, options), problem.start.amplitude)) {
    for (Index i = 0; i < residuals_.size(); ++i) {
      const double value = problem.data.value[static_cast<std::size_t>(i)];
      const bool by_quantile = problem.noise.IsCensored(value) || solution.noise.family == NoiseFamily::kEdges;
      residuals_[i] = by_quantile ? solution.noise.sigma * quantile_residuals[i] : value - solution.readings[i];
    }
    Differentiate();
  }

  /// Estimates of replica number `index`. Empty if it cannot be solved, a stop is requested, or memory is exhausted.
  std::vector<double> Estimate(std::uint64_t index) const {
    if (options_.stop.stop_requested()) return {};
    try {
      return Refit(index);
    } catch (const std::exception&) {
      return {};
    }
  }

 private:
  std::vector<double> Refit(std::uint64_t index) const {
    FitProblem replica = problem_;
    std::seed_seq seeds{options_.seed & 0xffffffffU, options_.seed >> 32U, index};
    std::mt19937_64 generator(seeds);
    const Eigen::VectorXd spread = solution_.noise.Deviations(residuals_.size()) / solution_.noise.sigma;
    const Eigen::VectorXd noise = Draw(generator).cwiseProduct(spread);
    for (Index i = 0; i < noise.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      replica.data.value[at] = DrawsMeans()
                                   ? MeanReading(i, generator)
                                   : QuantizedReading(solution_.readings[i] + noise[i], problem_.data.value[at]);
    }
    const auto cost = MakeTrajectoryCost(replica.model, replica.start.start, replica.data);
    cost->set_tolerance(tolerance_);
    cost->set_priors(replica.priors);
    cost->set_noise(replica.noise);
    Solution solution = Solve(*cost, FirstStep(replica), replica.solve);
    if (!solution.usable) solution = Solve(*cost, solution_.parameters, replica.solve);
    // If least squares is the exact likelihood, σ does not change the estimates.
    if (!solution_.noise.IsUncensoredGaussian() || !replica.priors.empty()) {
      MaximizeLikelihood(*cost, replica, options_, solution);
    }
    return solution.usable ? solution.parameters : std::vector<double>{};
  }

  /// Computes the derivatives of the readings with respect to the free parameters at the solution, once for all
  /// replicas.
  void Differentiate() {
    const auto cost = MakeTrajectoryCost(problem_.model, problem_.start.start, problem_.data);
    cost->set_tolerance(tolerance_);
    cost->set_priors(problem_.priors);
    Eigen::VectorXd readings;
    Eigen::MatrixXd jacobian;
    Eigen::MatrixXd sums;
    if (!cost->Readings(solution_.parameters, &readings, &jacobian) || !cost->Sums(solution_.parameters, &sums)) return;
    for (int i = 0; i < static_cast<int>(solution_.parameters.size()); ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (!problem_.solve.fixed[at] && BoundSide(problem_.solve, at, solution_.parameters[at]) == 0) free_.push_back(i);
    }
    const auto size = static_cast<Index>(solution_.parameters.size());
    const InformationInverse inverse = InvertInformation(sums.topLeftCorner(size, size), free_);
    if (!inverse.identifiable) return;
    const double scale = problem_.data.scale;
    to_step_ = inverse.matrix * jacobian(Eigen::all, free_).transpose() / (scale * scale);
  }

  /// The solution plus the least-squares step for a replica's noise. It needs no trajectory.
  std::vector<double> FirstStep(const FitProblem& replica) const {
    std::vector<double> parameters = solution_.parameters;
    if (to_step_.size() == 0) return parameters;
    const Eigen::VectorXd step = to_step_ * (replica.data.values() - solution_.readings);
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const auto i = static_cast<std::size_t>(free_[k]);
      parameters[i] =
          std::clamp(parameters[i] + step[static_cast<Index>(k)], replica.solve.lower[i], replica.solve.upper[i]);
    }
    return parameters;
  }

  /// Noise of N samples: drawn from the noise model (parametric bootstrap), or circular blocks of the residuals, which
  /// keep outliers, rounding and autocorrelation (D. N. Politis and J. P. Romano, "A circular block-resampling
  /// procedure", 1992).
  Eigen::VectorXd Draw(std::mt19937_64& generator) const {
    const Index samples = residuals_.size();
    Eigen::VectorXd noise(samples);
    if (parametric_) {
      boost::random::normal_distribution<double> normal;
      for (double& x : noise) x = solution_.noise.sigma * normal(generator);
      return noise;
    }
    boost::random::uniform_int_distribution<Index> any(0, samples - 1);
    for (Index i = 0; i < samples;) {
      const Index first = any(generator);
      for (Index k = 0; k < block_ && i < samples; ++k, ++i) noise[i] = residuals_[(first + k) % samples];
    }
    return noise;
  }

  bool DrawsMeans() const { return parametric_ && solution_.noise.family == NoiseFamily::kAveraged; }

  /// The mean of rounded readings at sample i.
  double MeanReading(Index i, std::mt19937_64& generator) const {
    const NoiseModel noise = solution_.noise.ForSample(i);
    const auto& [n, count, level, motions, motion] = noise.averaging;
    boost::random::normal_distribution<double> normal;
    double sum = 0;
    for (int k = 0; k < n; ++k) {
      const double s = (k + 0.5) / n - 0.5;
      const double value =
          solution_.readings[i] + s * (motion.slope + s * motion.bend) + noise.sigma * normal(generator);
      sum += std::round((value - level) / count);
    }
    return level + count * sum / n;
  }

  /// The reading that the sensor shows for a value: rounded to its levels, of which `other` is one, and within its
  /// range.
  double QuantizedReading(double value, double other) const {
    const double q = problem_.resolution;
    const bool edges = solution_.noise.family == NoiseFamily::kEdges;
    if (q > 0 && (edges ? solution_.noise.IsSilence(other) : parametric_))
      value = other + q * std::round((value - other) / q);
    const double half = problem_.resolution > 0 ? 0.5 * q : 0.0;
    return std::clamp(value, problem_.noise.low - half, problem_.noise.high + half);
  }

  const FitProblem& problem_;
  const FitOptions& options_;
  const Solution& solution_;
  Eigen::VectorXd residuals_;
  Index block_;
  bool parametric_;
  double tolerance_;         // of the trajectories
  std::vector<int> free_;    // F parameters
  Eigen::MatrixXd to_step_;  // F x N, maps residuals to a step; empty if the data do not determine all parameters
};

}  // namespace

double Bootstrap::Quantile(int k, double probability) const {
  std::vector<double> sorted(estimates.col(k).begin(), estimates.col(k).end());
  std::ranges::sort(sorted);
  const double position = probability * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - std::floor(position)) * (sorted[above] - sorted[below]);
}

Bootstrap RunBootstrap(const FitProblem& problem, const FitOptions& options, const Solution& solution,
                       const Eigen::VectorXd& quantile_residuals, const Autocorrelation& correlation) {
  const Replicas replicas(problem, options, solution, quantile_residuals, correlation);
  std::vector<std::vector<double>> estimates(kBootstrapFits);
  std::mutex reporting;
  int done = 0;
  ParallelFor(kBootstrapFits, options.threads, [&](int i) {
    estimates[static_cast<std::size_t>(i)] = replicas.Estimate(static_cast<std::uint64_t>(i));
    const std::lock_guard lock(reporting);
    ++done;
    ReportProgress(options.progress, "bootstrap of " + options.model, done, kBootstrapFits);
  });
  std::erase_if(estimates, [](const std::vector<double>& estimate) { return estimate.empty(); });
  Bootstrap bootstrap;
  bootstrap.failed = kBootstrapFits - static_cast<int>(estimates.size());
  bootstrap.estimates.resize(static_cast<Index>(estimates.size()), static_cast<Index>(problem.infos.size()));
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    bootstrap.estimates.row(static_cast<Index>(i)) =
        Eigen::Map<const Eigen::RowVectorXd>(estimates[i].data(), bootstrap.estimates.cols());
  }
  return bootstrap;
}

}  // namespace pendulum
