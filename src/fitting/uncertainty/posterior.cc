// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/posterior.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>

#include "fitting/likelihood/line_likelihood.h"
#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/fitting/solve/covariance.h"
#include "pendulum/fitting/start/fit_options.h"

namespace pendulum {
namespace {

tl::unexpected<Status> Invalid(std::string message) { return Error(StatusCode::kInvalidArgument, std::move(message)); }

Result<void> CheckSizes(const LinearizedFit& fit) {
  const Eigen::Index samples = fit.value.size();
  const Eigen::Index parameters = fit.jacobian.cols();
  if (samples == 0 || parameters == 0) return Invalid("a posterior needs samples and parameters; there are none");
  if (fit.readings.size() != samples || fit.jacobian.rows() != samples) {
    return Invalid("there are " + std::to_string(samples) + " values, " + std::to_string(fit.readings.size()) +
                   " readings and " + std::to_string(fit.jacobian.rows()) + " rows of the Jacobian; they must agree");
  }
  for (const Eigen::VectorXd* vector : {&fit.lower, &fit.upper, &fit.prior_mean, &fit.prior_weight}) {
    if (vector->size() == parameters) continue;
    return Invalid("bounds and priors must be given for each of " + std::to_string(parameters) + " parameters, not " +
                   std::to_string(vector->size()));
  }
  return {};
}

/// The spacing of the sensor's levels; for means, that of one reading.
double LevelSpacing(const NoiseModel& noise) {
  return noise.family == NoiseFamily::kAveraged ? noise.averaging.count : noise.resolution;
}

Result<void> CheckValues(const LinearizedFit& fit) {
  if (!fit.value.allFinite() || !fit.readings.allFinite() || !fit.jacobian.allFinite() || !fit.prior_mean.allFinite() ||
      !fit.prior_weight.allFinite()) {
    return Invalid("values, readings, Jacobian and priors must be finite numbers");
  }
  const NoiseModel& noise = fit.noise;
  const double spacing = LevelSpacing(noise);
  const bool has_levels = noise.family == NoiseFamily::kQuantized || noise.family == NoiseFamily::kAveraged;
  if (!has_levels || !(spacing > 0) || !std::isfinite(spacing)) {
    return Invalid("the noise is " + std::string(NoiseFamilyName(noise.family)) + " with resolution " +
                   NumberText(spacing) + "; it must be quantized or averaged with a resolution greater than 0");
  }
  if (!(noise.sigma >= 0)) return Invalid("sigma is " + NumberText(noise.sigma) + "; it must be 0 or more");
  for (Eigen::Index j = 0; j < fit.lower.size(); ++j) {
    if (fit.lower[j] <= 0 && fit.upper[j] >= 0 && fit.lower[j] < fit.upper[j]) continue;
    return Invalid("the bounds of parameter " + std::to_string(j) + ", minus its fitted value, are " +
                   NumberText(fit.lower[j]) + " and " + NumberText(fit.upper[j]) + "; 0 must lie between them");
  }
  return {};
}

/// Coordinates w in which the posterior is approximately white: δ = centre + root · w.
struct Frame {
  Eigen::VectorXd centre;
  Eigen::MatrixXd root;  // F x F
};

/// Computes the frame from the information of the readings at a σ of at least a tenth of a count. At the fitted values
/// the information may be almost zero, so a small weight is added for every level.
Result<Frame> FirstFrame(const LinearizedFit& fit) {
  constexpr double kMinSigma = 0.1;
  constexpr double kMinWeight = 0.01;
  NoiseModel noise = fit.noise;
  const double spacing = LevelSpacing(noise);
  noise.sigma = std::max(noise.sigma, kMinSigma * spacing);
  Eigen::VectorXd weight(fit.value.size());
  for (Eigen::Index i = 0; i < weight.size(); ++i) {
    const double least = noise.IsCensored(fit.value[i]) ? 0 : kMinWeight / (spacing * spacing);
    weight[i] = std::max(noise.ForSample(i).LikelihoodAt(fit.value[i], fit.readings[i]).information, 0.0) + least;
  }
  Eigen::MatrixXd information = fit.jacobian.transpose() * weight.asDiagonal() * fit.jacobian;
  information.diagonal() += fit.prior_weight.cwiseAbs2();
  std::vector<int> all(static_cast<std::size_t>(fit.jacobian.cols()));
  std::iota(all.begin(), all.end(), 0);
  const InformationInverse inverse = InvertInformation(information, all);
  if (!inverse.identifiable) {
    std::string names;
    for (const int j : inverse.direction) names.append(" ").append(std::to_string(j));
    return Error(StatusCode::kFailedPrecondition,
                 "some combination of the parameters" + names + " has no effect on the readings; fix one of them");
  }
  return Frame{Eigen::VectorXd::Zero(fit.lower.size()), inverse.matrix.llt().matrixL()};
}

/// An interval of a line, and the start point in it.
struct LineSpan {
  double from = -kInfinity;
  double to = kInfinity;
  double start = 0;
  double width = 1;  // typical width of a slice
};

using Generator = std::mt19937_64;

/// A position on a line, and the log-density there.
struct Point {
  double x, log;
};

/// One step of slice sampling. For a density below `floor`, density(x, floor) may return any value below `floor`.
template <typename LogDensity>
Point Slice(const LineSpan& span, double log_here, Generator& generator, LogDensity density) {
  constexpr int kMaxSteps = 40;
  boost::random::uniform_01<double> uniform;
  const double level = log_here - boost::random::exponential_distribution<double>()(generator);
  double left = span.start - uniform(generator) * span.width;
  double right = left + span.width;
  int steps_left = static_cast<int>(kMaxSteps * uniform(generator));
  int steps_right = kMaxSteps - 1 - steps_left;
  while (left > span.from && steps_left-- > 0 && density(left, level) >= level) left -= span.width;
  while (right < span.to && steps_right-- > 0 && density(right, level) >= level) right += span.width;
  left = std::max(left, span.from);
  right = std::min(right, span.to);
  constexpr int kMaxHalvings = 200;  // rounding may hide the slice
  for (int k = 0; k < kMaxHalvings; ++k) {
    const double x = left + uniform(generator) * (right - left);
    const double log = density(x, level);
    if (log >= level) return {x, log};
    (x < span.start ? left : right) = x;
  }
  return {span.start, log_here};
}

/// R x (F + 1): draws of δ and of σ, σ in units of the resolution.
using Draws = Eigen::MatrixXd;

constexpr double kMaxSigma = 2;  // prior: flat up to here, in units of the resolution

/// The Markov chain. It uses slice sampling along orthogonal directions, which are rotated at random before every
/// round, and then along log σ. The coordinates are those in which earlier draws are white: without noise the posterior
/// is uniform on a polytope, whose shape the information does not describe. Readings are in units of the resolution.
class Chain {
 public:
  Chain(const LinearizedFit& fit, Frame frame, std::uint64_t seed, const std::stop_token& stop);
  Draws Run(int rounds);  ///< Undefined after a stop request.

  /// Changes to coordinates in which these draws are white.
  void Whiten(const Draws& draws);

  double work() const { return likelihood_.work(); }
  bool is_stopped() const { return stop_.stop_requested(); }

 private:
  void Round();
  void MoveAlong(const Eigen::VectorXd& direction);
  void MoveSigma();
  LineSpan WithinBounds(const Eigen::VectorXd& step) const;
  Eigen::VectorXd Delta() const { return frame_.centre + frame_.root * w_; }
  double LogPrior(const Eigen::VectorXd& delta) const;
  double LogEverywhere(const Eigen::VectorXd& w, double floor);
  void EnterFrame(Frame frame, const Eigen::VectorXd& delta);

  const LinearizedFit& fit_;
  const std::stop_token& stop_;
  Generator generator_;
  LevelSamples samples_;  // derivatives with respect to δ
  Frame frame_;
  LevelSamples whitened_;      // derivatives with respect to w
  LevelSamples active_;        // the samples that may leave their level within these limits:
  double max_distance_ = 1e9;  // norm of w
  double max_sigma_ = kMaxSigma;
  LineLikelihood likelihood_;
  Eigen::VectorXd w_;
  double log_sigma_;
  double log_ = 0;             // likelihood and prior of δ
  Eigen::VectorXd positions_;  // of the active samples
};

Chain::Chain(const LinearizedFit& fit, Frame frame, std::uint64_t seed, const std::stop_token& stop)
    : fit_(fit),
      stop_(stop),
      generator_(seed),
      samples_(MergeSamples(fit.noise, fit.value, fit.readings, fit.jacobian)) {
  constexpr double kMinStart = 0.05;  // from a smaller one, the chain would hardly move
  log_sigma_ = std::log(std::clamp(fit.noise.sigma / LevelSpacing(fit.noise), kMinStart, kMaxSigma));
  EnterFrame(std::move(frame), Eigen::VectorXd::Zero(fit.jacobian.cols()));
}

void Chain::EnterFrame(Frame frame, const Eigen::VectorXd& delta) {
  frame_ = std::move(frame);
  w_ = frame_.root.triangularView<Eigen::Lower>().solve(delta - frame_.centre);
  whitened_ = samples_;
  whitened_.position += samples_.slope * frame_.centre;
  whitened_.slope = samples_.slope * frame_.root;
  constexpr double kCertain = 8.5;  // in σ inside the edge: the probability is 1 to rounding
  active_ = whitened_.Near(kCertain * max_sigma_, max_distance_);
  likelihood_.SetSigma(std::exp(log_sigma_));
  log_ = LogEverywhere(w_, -kInfinity);
}

double Chain::LogPrior(const Eigen::VectorXd& delta) const {
  return -0.5 * (delta - fit_.prior_mean).cwiseProduct(fit_.prior_weight).squaredNorm();
}

double Chain::LogEverywhere(const Eigen::VectorXd& w, double floor) {
  const double prior = LogPrior(frame_.centre + frame_.root * w);
  const Eigen::VectorXd positions = whitened_.position + whitened_.slope * w;
  return prior + likelihood_.Sum(whitened_, positions, positions, 0, floor - prior);
}

LineSpan Chain::WithinBounds(const Eigen::VectorXd& step) const {
  constexpr double kWidth = 3;  // standard deviations
  LineSpan span;
  span.width = kWidth;
  const Eigen::VectorXd delta = Delta();
  for (Eigen::Index j = 0; j < step.size(); ++j) {
    if (step[j] == 0) continue;
    const double to_lower = (fit_.lower[j] - delta[j]) / step[j];
    const double to_upper = (fit_.upper[j] - delta[j]) / step[j];
    span.from = std::max(span.from, std::min(to_lower, to_upper));
    span.to = std::min(span.to, std::max(to_lower, to_upper));
  }
  span.from = std::min(span.from, 0.0);  // rounding may put δ past its bound
  span.to = std::max(span.to, 0.0);
  return span;
}

void Chain::MoveAlong(const Eigen::VectorXd& direction) {
  const Eigen::VectorXd step = frame_.root * direction;
  const Eigen::VectorXd delta = Delta();
  const Eigen::VectorXd slope = active_.slope * direction;
  const bool quiet = std::exp(log_sigma_) <= max_sigma_;
  const auto density = [&](double x, double floor) {
    const Eigen::VectorXd w = w_ + x * direction;
    if (!quiet || w.norm() > max_distance_) return LogEverywhere(w, floor);
    const double prior = LogPrior(delta + x * step);
    return prior + likelihood_.Sum(active_, positions_, slope, x, floor - prior);
  };
  const Point next = Slice(WithinBounds(step), log_, generator_, density);
  w_ += next.x * direction;
  positions_ += next.x * slope;
  log_ = next.log;
}

void Chain::MoveSigma() {
  const double prior = LogPrior(Delta());
  const bool near = w_.norm() <= max_distance_;
  double log = log_;
  const auto density = [&](double log_sigma, double floor) {
    const double sigma = std::exp(log_sigma);
    likelihood_.SetSigma(sigma);
    floor -= log_sigma;  // a flat prior in σ has density σ in log σ
    log = near && sigma <= max_sigma_ ? prior + likelihood_.Sum(active_, positions_, positions_, 0, floor - prior)
                                      : LogEverywhere(w_, floor);
    return log + log_sigma;
  };
  LineSpan span{-kInfinity, std::log(kMaxSigma), log_sigma_, 1};
  const Point next = Slice(span, log_ + log_sigma_, generator_, density);
  log_sigma_ = next.x;
  log_ = next.log - next.x;
  likelihood_.SetSigma(std::exp(log_sigma_));
}

void Chain::Round() {
  const Eigen::Index parameters = w_.size();
  boost::random::normal_distribution<double> normal;
  Eigen::MatrixXd random(parameters, parameters);
  for (double& entry : random.reshaped()) entry = normal(generator_);
  const Eigen::MatrixXd directions = Eigen::HouseholderQR<Eigen::MatrixXd>(random).householderQ();
  positions_ = active_.position + active_.slope * w_;
  for (Eigen::Index k = 0; k < parameters && !is_stopped(); ++k) MoveAlong(directions.col(k));
  MoveSigma();
}

Draws Chain::Run(int rounds) {
  Draws draws(rounds, w_.size() + 1);
  for (Eigen::Index k = 0; k < rounds && !is_stopped(); ++k) {
    Round();
    draws.row(k) << Delta().transpose(), std::exp(log_sigma_);
  }
  return draws;
}

void Chain::Whiten(const Draws& draws) {
  constexpr double kAsDraws = 2;  // weight of the old coordinates, in draws
  const Eigen::Index parameters = w_.size();
  const Eigen::MatrixXd deltas = draws.leftCols(parameters);
  const Eigen::VectorXd mean = deltas.colwise().mean().transpose();
  const Eigen::MatrixXd centred = (deltas.rowwise() - mean.transpose()).transpose();
  const Eigen::MatrixXd w = frame_.root.triangularView<Eigen::Lower>().solve(centred);
  Eigen::MatrixXd covariance = w * w.transpose();
  const double scale = covariance.trace() / static_cast<double>(parameters * draws.rows());
  covariance.diagonal().array() += kAsDraws * scale;
  covariance /= static_cast<double>(draws.rows()) + kAsDraws;
  max_distance_ = 4 * std::sqrt(static_cast<double>(parameters));
  max_sigma_ = 1.5 * draws.col(parameters).maxCoeff();
  const Eigen::MatrixXd turn = covariance.llt().matrixL();
  const Eigen::MatrixXd root = frame_.root * turn;
  EnterFrame({mean, root}, Delta());
}

/// Effective number of draws of one quantity, by the initial monotone sequence (C. J. Geyer, Stat. Sci. 7:473, 1992).
double EffectiveDraws(const Eigen::VectorXd& draws) {
  const Eigen::Index n = draws.size();
  const Eigen::VectorXd centred = draws.array() - draws.mean();
  const auto covariance = [&](Eigen::Index lag) {
    return centred.head(n - lag).dot(centred.tail(n - lag)) / static_cast<double>(n);
  };
  const double variance = covariance(0);
  if (!(variance > 0)) return 0;
  double sum = -variance;
  double pair = kInfinity;
  for (Eigen::Index lag = 0; lag + 1 < n; lag += 2) {
    pair = std::min(pair, covariance(lag) + covariance(lag + 1));
    if (pair <= 0) break;
    sum += 2 * pair;
  }
  return static_cast<double>(n) * std::min(1.0, variance / sum);
}

double LeastEffectiveDraws(const Draws& draws) {
  double least = kInfinity;
  for (const auto& column : draws.colwise()) least = std::min(least, EffectiveDraws(column));
  return least;
}

/// Quantile by interpolation between sorted values: the next of n independent draws is below it with probability p.
double Quantile(const std::vector<double>& values, double p) {
  const auto n = static_cast<double>(values.size());
  const double rank = std::clamp(p * (n + 1) - 1, 0.0, n - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (rank - static_cast<double>(below)) * (values[above] - values[below]);
}

Posterior Summarize(Draws draws, double resolution) {
  const Eigen::Index parameters = draws.cols() - 1;
  const auto n = static_cast<double>(draws.rows());
  draws.col(parameters) *= resolution;
  const Eigen::VectorXd mean = draws.colwise().mean().transpose();
  const Eigen::MatrixXd centred = draws.rowwise() - mean.transpose();
  Posterior posterior;
  posterior.mean = mean.head(parameters);
  posterior.covariance = centred.leftCols(parameters).transpose() * centred.leftCols(parameters) / (n - 1);
  posterior.lower95.resize(parameters);
  posterior.upper95.resize(parameters);
  for (Eigen::Index j = 0; j < parameters; ++j) {
    std::vector<double> values(draws.col(j).begin(), draws.col(j).end());
    std::sort(values.begin(), values.end());
    posterior.lower95[j] = Quantile(values, 0.025);
    posterior.upper95[j] = Quantile(values, 0.975);
  }
  posterior.sigma = mean[parameters];
  posterior.sigma_std_dev = std::sqrt(centred.col(parameters).squaredNorm() / (n - 1));
  posterior.effective_draws = LeastEffectiveDraws(draws);
  posterior.draws = std::move(draws);
  return posterior;
}

// Maximum number of evaluations of a sample. It allows only few draws for 1e5 samples that are mostly near the edge of
// their level, but then the posterior is nearly normal and needs no sampling.
constexpr double kMaxWork = 1e9;

/// Runs of increasing length, each followed by whitening, until the coordinates fit. These draws are discarded.
void WarmUp(Chain& chain) {
  for (const int rounds : {10, 20, 40, 80, 160}) {
    const Draws draws = chain.Run(rounds);
    if (chain.is_stopped()) return;
    chain.Whiten(draws.bottomRows(rounds * 3 / 4));
    if (chain.work() > kMaxWork / 8) break;  // with so many samples, the first coordinates are good
  }
}

Draws RunUntilEnough(Chain& chain) {
  constexpr int kRounds = 150;
  constexpr double kEnoughDraws = 500;
  Draws draws = chain.Run(kRounds);
  while (!chain.is_stopped() && LeastEffectiveDraws(draws) < kEnoughDraws && chain.work() < kMaxWork) {
    draws.conservativeResize(draws.rows() + kRounds, Eigen::NoChange);
    draws.bottomRows(kRounds) = chain.Run(kRounds);
  }
  return draws;
}

}  // namespace

Result<Posterior> SamplePosterior(const LinearizedFit& fit, std::uint64_t seed, const std::stop_token& stop) {
  for (const auto check : {CheckSizes, CheckValues}) {
    RETURN_IF_ERROR(check(fit));
  }
  ASSIGN_OR_RETURN(Frame frame, FirstFrame(fit));
  Chain chain(fit, std::move(frame), seed, stop);
  WarmUp(chain);
  Draws draws = RunUntilEnough(chain);
  if (chain.is_stopped()) return FitStopped();
  return Summarize(std::move(draws), LevelSpacing(fit.noise));
}

}  // namespace pendulum
