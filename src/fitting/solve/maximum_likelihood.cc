// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/maximum_likelihood.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/likelihood/edge_noise.h"
#include "pendulum/fitting/solve/averaged_noise.h"

namespace pendulum {
namespace {

/// Number of parameters that are neither fixed nor at a bound.
double FreeParameters(const FitProblem& problem, const Solution& solution) {
  double free = 0;
  for (std::size_t i = 0; i < solution.parameters.size(); ++i) {
    if (!problem.solve.fixed[i] && BoundSide(problem.solve, i, solution.parameters[i]) == 0) ++free;
  }
  return free;
}

/// σ² = RSS / (N - free parameters), where RSS follows from the deviance under the cost's noise.
double GaussianSigma(const TrajectoryCost& cost, const FitProblem& problem, const Solution& solution) {
  const auto samples = static_cast<double>(problem.data.time.size());
  const double freedom = std::max(samples - FreeParameters(problem, solution), 1.0);
  const double sum = std::max(solution.sum - cost.PriorSum(solution.parameters), 0.0);
  return std::max(solution.noise.sigma * std::sqrt(sum / freedom), problem.negligible_sigma());
}

/// Estimates σ of Gaussian noise, which has a closed form.
void SetGaussianSigma(TrajectoryCost& cost, const FitProblem& problem, Solution& solution) {
  constexpr int kMaxRounds = 20;
  constexpr double kSame = 1e-4;
  for (int round = 0; round < kMaxRounds && solution.usable; ++round) {
    const double before = std::exchange(solution.noise.sigma, GaussianSigma(cost, problem, solution));
    const double ratio = before / solution.noise.sigma;
    cost.set_noise(solution.noise);
    const double prior = cost.PriorSum(solution.parameters);
    solution.sum = (solution.sum - prior) * ratio * ratio + prior;
    for (Minimum& minimum : solution.other_minima) {
      const double known = cost.PriorSum(minimum.parameters);
      minimum.sum = (minimum.sum - known) * ratio * ratio + known;
    }
    if (problem.priors.empty() || std::abs(ratio - 1) <= kSame) break;
    solution = Continue(cost, solution, problem.solve);
  }
}

/// Alternates between estimating σ and solving for the parameters. `window`: length of the averaging window [s], for
/// kAveraged.
void AlternateSigmaAndParameters(TrajectoryCost& cost, const FitProblem& problem, double window, Solution& solution) {
  constexpr int kMaxRounds = 15;
  constexpr int kSpreadRounds = 3;         // rounds that estimate the errors of the time stamps
  constexpr double kMaxNegativeLag = 0.4;  // in counts: below 0.5, so that the interval of a silence is not empty
  constexpr double kSame = 3e-3;           // of σ: at most some tenths of its standard error
  const auto value = problem.data.values();
  const bool edges = solution.noise.family == NoiseFamily::kEdges;
  const bool averaged = solution.noise.family == NoiseFamily::kAveraged;
  const bool lags = problem.zero_motion == ZeroMotion::kLags;
  const double level_spacing = averaged ? solution.noise.averaging.count : problem.resolution;
  const double smallest = std::max(edges ? 0 : kSmallestSigma * level_spacing, problem.negligible_sigma());
  for (int round = 0; round < kMaxRounds; ++round) {
    if (!cost.Readings(solution.parameters, &solution.readings, nullptr)) break;
    if (edges && round < kSpreadRounds) SetSpread(problem.data.times(), value, solution.readings, solution.noise);
    if (averaged && round < kSpreadRounds) SetWindowMotions(cost, problem, solution, window, solution.noise);
    const double lag = lags ? std::max(solution.parameters.back(), -kMaxNegativeLag * problem.resolution) : 0.0;
    const bool same_lag = std::abs(lag - solution.noise.lag) <= kSame * solution.noise.sigma;
    if (!same_lag) solution.noise.lag = lag;
    const double sigma = MostLikelySigma(solution.noise, value, solution.readings, smallest);
    const double change = std::abs(std::log(sigma / solution.noise.sigma));
    solution.noise.sigma = sigma;
    if (round > 0 && change < kSame && same_lag) break;
    cost.set_noise(solution.noise);
    solution = Continue(cost, solution, problem.solve);
    if (!solution.usable) return;
  }
}

/// Solves from the nearly equal local minima with the same noise, and keeps the likeliest.
void CompareMinima(TrajectoryCost& cost, const FitProblem& problem, const std::vector<Minimum>& others,
                   Solution& solution) {
  for (const Minimum& minimum : others) {
    Solution other = solution;
    other.parameters = minimum.parameters;
    other = Continue(cost, other, problem.solve);
    if (!other.usable) continue;
    if (other.sum < solution.sum) std::swap(other, solution);
    solution.iterations = std::max(solution.iterations, other.iterations);
    solution.other_minima.push_back({other.parameters, other.sum});
  }
}

/// Local minima of least squares that may have the largest likelihood.
std::vector<Minimum> NearMinima(const Solution& solution, double samples) {
  // Largest difference in -2 log L by least squares. It is large because, for small noise, the likelihood of quantized
  // readings differs from least squares.
  constexpr double kNear = 60;
  constexpr std::size_t kMaxMinima = 4;
  std::vector<Minimum> near;
  for (const Minimum& minimum : solution.other_minima) {
    if (samples * std::log(minimum.sum / solution.sum) < kNear) near.push_back(minimum);
  }
  std::ranges::sort(near, {}, &Minimum::sum);
  if (near.size() > kMaxMinima) near.resize(kMaxMinima);
  return near;
}

/// Recomputes the deviances of all minima under the final noise, so that they are comparable.
void RecomputeDeviances(TrajectoryCost& cost, Solution& solution) {
  cost.set_noise(solution.noise);
  // Sums, not SumOfSquares: the cost caches the sums, and the fit report needs them next.
  Eigen::MatrixXd sums;
  solution.usable = cost.Sums(solution.parameters, &sums);
  if (solution.usable) solution.sum = sums(sums.rows() - 1, sums.cols() - 1);
  for (Minimum& minimum : solution.other_minima) {
    if (!cost.SumOfSquares(minimum.parameters, &minimum.sum)) minimum.sum = std::numeric_limits<double>::infinity();
  }
}

/// Noise of a reading [counts] from which on means are treated as normal variables.
constexpr double kContinuousNoise = 0.55;

double DensityUnit(double resolution) { return resolution > 0 ? resolution : 1.0; }

/// Log-likelihood of Gaussian noise with the likeliest σ, whose square is RSS / N.
double GaussianLogLikelihood(double rss, double samples) {
  return -0.5 * samples * (std::log(2 * kPi * std::max(rss, std::numeric_limits<double>::min()) / samples) + 1);
}

}  // namespace

double LogLikelihoodOf(const FitProblem& problem, const Solution& solution) {
  const auto value = problem.data.values();
  const auto samples = static_cast<double>(value.size());
  if (solution.noise.IsUncensoredGaussian()) {
    return GaussianLogLikelihood((value - solution.readings).squaredNorm(), samples) +
           samples * std::log(DensityUnit(problem.resolution));
  }
  const auto intervals = std::ranges::count_if(value, [&](double y) { return solution.noise.IsInterval(y); });
  const double densities = samples - static_cast<double>(intervals);
  return LogLikelihood(solution.noise, value, solution.readings) +
         densities * std::log(DensityUnit(problem.resolution));
}

/// If the residuals are smaller than one resolution, rounding errors are not white noise (Widrow & Kollár, Quantization
/// Noise, Cambridge 2008, section 5.1).
ChosenNoise ChooseNoise(const FitOptions& options, double resolution, double residual_std_dev) {
  constexpr double kMaxQuantizedSigma = 1;  // in resolutions
  if (options.noise) return {*options.noise, IsRobust(options.noise) ? "asked for by --loss" : "asked for by --noise"};
  if (!(resolution > 0)) return {NoiseFamily::kGaussian, "the readings show no discrete levels"};
  const double ratio = residual_std_dev / resolution;
  if (ratio < kMaxQuantizedSigma) {
    return {NoiseFamily::kQuantized,
            "the residuals are " + NumberText(ratio, 2) +
                " resolutions: rounding is not small, so each reading is treated as an interval of one level"};
  }
  return {NoiseFamily::kGaussian,
          "the residuals are " + NumberText(ratio, 2) +
              " resolutions: the noise is larger than the resolution, so the readings are treated as continuous"};
}

namespace {

ChosenNoise ChooseNoiseOf(const FitProblem& problem, const FitOptions& options, double residual_std_dev) {
  if (!options.noise && HasMeans(problem) && MayShowRounding(problem, residual_std_dev)) {
    return {NoiseFamily::kAveraged, "each row is the mean of " + std::to_string(problem.oversampling.readings) +
                                        " readings, whose rounding to whole counts does not average out"};
  }
  if (!options.noise && problem.noise.edge) {
    return {NoiseFamily::kEdges,
            "rows exist only where the count changes, so the readings are treated as edges between counts"};
  }
  return ChooseNoise(options, problem.resolution, residual_std_dev);
}

/// The average over the window differs from the value at its middle by θ'' T²/24, so it shows an amplitude that is too
/// small by the relative (ω T)²/24 (MODEL.md eq. (7.11)).
bool IsWindowShort(const FitProblem& problem, double window) {
  constexpr double kNegligible = 1e-6;
  const double phase = problem.start.natural_frequency * window;
  return phase * phase / 24 < kNegligible;
}

/// Sets σ, levels and motions of means. If the noise of a reading exceeds half a count and the window is short, the
/// means are normal variables, and the family becomes kGaussian unless the user asked for means.
void StartAveraging(const TrajectoryCost& cost, const FitProblem& problem, const FitOptions& options,
                    Solution& solution, double* window) {
  NoiseModel likeliest = LikeliestAveraging(cost, problem, solution, window);
  const double counts = likeliest.sigma / likeliest.averaging.count;
  if (options.noise || counts < kContinuousNoise || !IsWindowShort(problem, *window)) {
    solution.noise = std::move(likeliest);
    return;
  }
  solution.noise.family = NoiseFamily::kGaussian;
  solution.noise.resolution = 0;
  solution.noise_reason = "each row is the mean of " + std::to_string(problem.oversampling.readings) +
                          " readings with noise of " + NumberText(counts, 2) +
                          " counts: their rounding averages out, so the means are treated as continuous";
}

}  // namespace

/// Estimates parameters (Solve) and σ in turn until σ is constant. Solves from the nearly equal local minima as well
/// and keeps the likeliest. Gaussian noise needs no further solve unless there are priors. Below kSmallestSigma the
/// likelihood has no maximum inside the range; SamplePosterior then gives estimates and intervals.
void MaximizeLikelihood(TrajectoryCost& cost, const FitProblem& problem, const FitOptions& options,
                        Solution& solution) {
  solution.noise = problem.noise;
  if (!solution.usable) return;
  const auto samples = static_cast<double>(problem.data.time.size());
  const bool traced = cost.Readings(solution.parameters, &solution.readings, nullptr);
  const double rms = traced ? problem.RmsResidual(solution.readings) : problem.data.scale;
  ChosenNoise chosen = ChooseNoiseOf(problem, options, rms);
  solution.noise.family = chosen.family;
  solution.noise_reason = std::move(chosen.why);
  const bool quantized = solution.noise.family == NoiseFamily::kQuantized;
  const bool edges = solution.noise.family == NoiseFamily::kEdges;
  const bool averaged = solution.noise.family == NoiseFamily::kAveraged;
  solution.noise.resolution = quantized || edges || averaged ? problem.resolution : 0;
  double window = 0;
  if (averaged) StartAveraging(cost, problem, options, solution, &window);
  if (solution.noise.IsUncensoredGaussian()) {
    SetGaussianSigma(cost, problem, solution);
  } else {
    const std::vector<Minimum> near = NearMinima(solution, samples);
    if (solution.noise.family != NoiseFamily::kAveraged) {
      const double rounding = quantized ? solution.noise.resolution / std::sqrt(12.0) : 0;
      solution.noise.sigma = std::sqrt(std::max(rms * rms - rounding * rounding, 0.04 * rounding * rounding));
    }
    solution.noise.sigma = std::max(solution.noise.sigma, problem.negligible_sigma());
    cost.set_noise(solution.noise);
    solution.other_minima.clear();
    AlternateSigmaAndParameters(cost, problem, window, solution);
    CompareMinima(cost, problem, near, solution);
    if (!near.empty()) AlternateSigmaAndParameters(cost, problem, window, solution);
    RecomputeDeviances(cost, solution);
  }
  // The cost has these readings cached, unless the trajectory cannot be computed.
  solution.usable = solution.usable && cost.Readings(solution.parameters, &solution.readings, nullptr);
  if (solution.usable) solution.log_likelihood = LogLikelihoodOf(problem, solution);
}

}  // namespace pendulum
