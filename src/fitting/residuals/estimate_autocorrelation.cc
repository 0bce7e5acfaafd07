// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/residuals/estimate_autocorrelation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <boost/math/tools/minima.hpp>

#include "fitting/residuals/burg.h"
#include "pendulum/base/median.h"
#include "pendulum/fitting/likelihood/reading_information.h"
#include "pendulum/fitting/residuals/residual_diagnostics.h"

namespace pendulum {
namespace {

using Kind = Autocorrelation::Kind;

// ---- Time stamps ---------------------------------------------------------------------------------------------------

struct Clock {
  bool even = false;
  double interval = 0;  // s, the median one
  std::vector<GapFreeSpan> spans;
};

Clock FindClock(const Eigen::VectorXd& time) {
  constexpr double kJitter = 0.1;   // mean, in intervals
  constexpr double kShortest = 50;  // samples per span, on average
  const Eigen::Index count = time.size();
  const Eigen::VectorXd steps = time.tail(count - 1) - time.head(count - 1);
  Clock clock;
  clock.interval = Median({steps.begin(), steps.end()});
  clock.spans.push_back({0, 1});
  double jitter = 0;
  for (Eigen::Index i = 1; i < count; ++i) {
    const double step = steps[i - 1] / clock.interval;
    if (step > kGapIntervals) {
      clock.spans.push_back({i, 1});
    } else {
      ++clock.spans.back().size;
      jitter += std::abs(step - 1);
    }
  }
  const auto samples = static_cast<double>(count);
  const auto gaps = static_cast<double>(clock.spans.size() - 1);
  clock.even = jitter < kJitter * samples && samples >= kShortest * gaps;
  return clock;
}

// ---- AR(p) ---------------------------------------------------------------------------------------------------------

int LongestOrder(double samples) { return static_cast<int>(std::min({30.0, samples / 20, 10 * std::log10(samples)})); }

/// Schwarz's criterion N ln σ_e² + p ln N of white residuals (G. Schwarz, Annals of Statistics 6:461, 1978).
double WhiteCriterion(const Eigen::VectorXd& residual) {
  const auto samples = static_cast<double>(residual.size());
  return samples * std::log(residual.squaredNorm() / samples);
}

/// An autoregression and its Schwarz criterion relative to that of white residuals.
struct Autoregression {
  std::vector<double> reflection;
  double criterion = std::numeric_limits<double>::infinity();
};

/// The best of AR(1), AR(2), ... (J. P. Burg, Maximum entropy spectral analysis, 1975).
Autoregression BestAutoregression(const Clock& clock, const Eigen::VectorXd& residual) {
  const auto samples = static_cast<double>(residual.size());
  const auto spans = static_cast<double>(clock.spans.size());
  const std::vector<double> reflection = ReflectionCoefficients(residual, clock.spans, LongestOrder(samples));
  constexpr double kRounding = 1e-8;  // smallest share of the variance in innovations: a smoother curve is not noise
  Autoregression best;
  double criterion = 0;
  double left = 1;
  for (std::size_t order = 1; order <= reflection.size(); ++order) {
    left *= 1 - reflection[order - 1] * reflection[order - 1];
    if (left < kRounding) break;
    // The first `order` samples of each span have no sample `order` places before them, so they are not predicted.
    const double predicted = samples - spans * static_cast<double>(order);
    criterion += predicted * std::log1p(-reflection[order - 1] * reflection[order - 1]) + std::log(samples);
    if (criterion < best.criterion) best = {{reflection.begin(), reflection.begin() + order}, criterion};
  }
  return best;
}

Autocorrelation FromBurg(const Clock& clock, const std::vector<double>& reflection) {
  Autocorrelation correlation;
  correlation.kind = Kind::kAutoregressive;
  correlation.interval = clock.interval;
  correlation.autoregressive = CoefficientsFromReflection(reflection);
  for (const double last : reflection) correlation.innovation_variance *= 1 - last * last;
  return correlation;
}

// ---- Likelihood of two parameters ----------------------------------------------------------------------------------

/// Coefficients that convert N residuals to independent innovations e_i = z_i - m_i. The prediction is m_i = keep_i
/// m_{i-1} + gain_i e_{i-1}. variance_i is the variance of e_i divided by the variance of an innovation predicted from
/// the whole past (PredictMixed), or divided by the variance of z (PredictContinuous).
struct Innovations {
  explicit Innovations(Eigen::Index samples) : keep(samples), gain(samples), variance(samples) {}
  Eigen::VectorXd keep, gain, variance;
  double log_determinant = 0;  // Σ ln variance_i
};

/// Innovations of ARMA(1,1), exact from the first sample of each span on (P. J. Brockwell and R. A. Davis, Time Series:
/// Theory and Methods, section 5.3, 1991).
void PredictMixed(const Clock& clock, double phi, double theta, Innovations* innovations) {
  constexpr double kSettled = 1e-12;
  innovations->keep.setConstant(phi);
  innovations->gain.setConstant(phi + theta);
  innovations->variance.setOnes();
  innovations->log_determinant = 0;
  for (const GapFreeSpan& span : clock.spans) {
    innovations->keep[span.begin] = innovations->gain[span.begin] = 0;
    double variance = (1 + 2 * phi * theta + theta * theta) / (1 - phi * phi);
    const Eigen::Index end = span.begin + span.size;
    for (Eigen::Index i = span.begin; i < end && std::abs(variance - 1) > kSettled; ++i) {
      innovations->variance[i] = variance;
      innovations->log_determinant += std::log(variance);
      if (i + 1 < end) innovations->gain[i + 1] = phi + theta / variance;
      variance = 1 + theta * theta * (1 - 1 / variance);
    }
  }
}

/// Innovations of the continuous AR(1) with white noise, by a Kalman filter of one state. age: N x 1, s, since the
/// previous sample.
void PredictContinuous(const Eigen::VectorXd& age, double decay_time, double white_share, Innovations* innovations) {
  innovations->keep = (age.array() / -decay_time).exp();
  innovations->keep[0] = 0;
  double known = 0;  // part of the state's variance that the previous samples explain
  double gain = 0;
  for (Eigen::Index i = 0; i < age.size(); ++i) {
    const double kept = innovations->keep[i];
    const double spread = (1 - white_share) - kept * kept * known;
    innovations->gain[i] = kept * gain;
    innovations->variance[i] = spread + white_share;
    gain = spread / innovations->variance[i];
    known = (1 - white_share) - spread * (1 - gain);
  }
  innovations->log_determinant = innovations->variance.array().log().sum();
}

/// Converts `Columns` columns from number `first` on into their innovations. The recursions of several columns run in
/// parallel.
template <int Columns>
void Whiten(const Innovations& innovations, Eigen::Index first, Eigen::MatrixXd* columns) {
  Eigen::Array<double, 1, Columns> predicted = Eigen::Array<double, 1, Columns>::Zero();
  Eigen::Array<double, 1, Columns> innovation = predicted;
  for (Eigen::Index i = 0; i < columns->rows(); ++i) {
    predicted = innovations.keep[i] * predicted + innovations.gain[i] * innovation;
    innovation = columns->row(i).segment<Columns>(first).array() - predicted;
    columns->row(i).segment<Columns>(first) = innovation;
  }
}

/// -2 log likelihood, up to a constant and at the best scale, of the last of M columns (N x M) after the first M - 1
/// are regressed out.
double Deviance(const Innovations& innovations, const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd white = columns;
  Eigen::Index done = 0;
  for (; done + 4 <= columns.cols(); done += 4) Whiten<4>(innovations, done, &white);
  for (; done < columns.cols(); ++done) Whiten<1>(innovations, done, &white);
  white.array().colwise() *= innovations.variance.array().rsqrt();
  const Eigen::Index taken = columns.cols() - 1;
  const auto left = static_cast<double>(columns.rows() - taken);
  const Eigen::LLT<Eigen::MatrixXd> root(white.transpose() * white);
  if (root.info() != Eigen::Success) return std::numeric_limits<double>::max();
  const Eigen::ArrayXd diagonal = root.matrixLLT().diagonal().array();
  return 2 * left * std::log(diagonal[taken]) - left * std::log(left) + 2 * diagonal.head(taken).log().sum() +
         innovations.log_determinant;
}

/// The largest squared score of z_t = δ (z_{t-1} + φ z_{t-2} + φ² z_{t-3} + ...) + e_t at δ = 0, over several φ. For
/// white residuals each score is χ² with one degree of freedom. It approximates the gain in likelihood by ARMA(1,1).
double LargestScore(const Eigen::VectorXd& residual) {
  using Scores = Eigen::Array<double, 8, 1>;
  const Scores autocorrelation{{-0.9, -0.5, 0.0, 0.5, 0.8, 0.95, 0.99, 0.998}};
  Scores past = Scores::Zero();
  Scores product = Scores::Zero();
  Scores energy = Scores::Constant(std::numeric_limits<double>::min());
  for (const double now : residual) {
    product += now * past;
    energy += past.square();
    past = autocorrelation * past + now;
  }
  return (product.square() / energy).maxCoeff() * static_cast<double>(residual.size()) / residual.squaredNorm();
}

/// Whether a model with more parameters than white residuals cannot gain as much likelihood as Schwarz's criterion
/// requires. Half of the required gain is used, as a margin for the error of the scores.
bool LooksWhite(const Eigen::VectorXd& residual, int parameters) {
  return LargestScore(residual) < 0.5 * parameters * std::log(static_cast<double>(residual.size()));
}

/// Deviance as a function of two parameters.
using Surface = std::function<double(const Eigen::Vector2d&)>;

/// Value of every Surface after a stop request: it is constant, so the search ends.
constexpr double kStopped = 0;

struct Vertex {
  Eigen::Vector2d place;
  double height = 0;
};

/// Nelder and Mead's simplex (Computer Journal 7:308, 1965), to 1e-3 in height: some hundredths of a standard error.
Vertex Lowest(const Surface& surface, const Eigen::Vector2d& start, double size) {
  constexpr int kMaxSteps = 150;
  constexpr double kFlat = 1e-3;
  const auto at = [&](const Eigen::Vector2d& place) { return Vertex{place, surface(place)}; };
  const auto lower = [](const Vertex& a, const Vertex& b) { return a.height < b.height; };
  std::array<Vertex, 3> simplex = {at(start), at(start + Eigen::Vector2d(size, 0)),
                                   at(start + Eigen::Vector2d(0, size))};
  for (int step = 0; step < kMaxSteps; ++step) {
    std::sort(simplex.begin(), simplex.end(), lower);
    if (simplex[2].height - simplex[0].height < kFlat) break;
    const Eigen::Vector2d middle = (simplex[0].place + simplex[1].place) / 2;
    const Eigen::Vector2d away = middle - simplex[2].place;
    Vertex next = at(middle + away);
    if (next.height < simplex[0].height) {
      next = std::min(next, at(middle + 2 * away), lower);
    } else if (next.height >= simplex[1].height) {
      next = at(middle + (next.height < simplex[2].height ? 0.5 : -0.5) * away);
    }
    if (next.height < simplex[2].height) {
      simplex[2] = next;
    } else {
      for (int i = 1; i < 3; ++i) simplex[i] = at((simplex[0].place + simplex[i].place) / 2);
    }
  }
  return *std::min_element(simplex.begin(), simplex.end(), lower);
}

/// The minimum on a line, to a few millionths of its length.
Vertex LowestOnLine(const std::function<double(double)>& height, double from, double to) {
  constexpr int kBits = 20;
  std::uintmax_t steps = 60;
  const auto [place, lowest] = boost::math::tools::brent_find_minima(height, from, to, kBits, steps);
  return {{place, 0}, lowest};
}

/// Orthonormal columns that span the weights, then the residual. A fit removes from the residuals all that its
/// parameters can follow, including the slowest part of the autocorrelation. The likelihood of the remaining
/// combinations corrects for this (H. D. Patterson and R. Thompson, Biometrika 58:545, 1971).
Eigen::MatrixXd RestrictedColumns(const Eigen::VectorXd& residual, const Eigen::MatrixXd& weights) {
  constexpr Eigen::Index kMaxCorrected = 100'000;  // beyond this, the part removed by the parameters is negligible
  if (weights.cols() == 0 || residual.size() > kMaxCorrected) return residual;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(weights);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Identity(residual.size(), qr.rank() + 1);
  columns.applyOnTheLeft(qr.householderQ());
  columns.rightCols(1) = residual;
  return columns;
}

// ---- ARMA(1,1) -----------------------------------------------------------------------------------------------------

/// The two coordinates are artanh of φ and θ: every point is a stationary and invertible process.
constexpr double kMaxCoefficient = 0.99999;

double CoefficientFromUnbounded(double place) { return kMaxCoefficient * std::tanh(place); }

Surface MixedSurface(const Clock& clock, const Eigen::MatrixXd& columns, const std::stop_token& stop) {
  return [&clock, &columns, &stop, innovations = Innovations(columns.rows())](const Eigen::Vector2d& place) mutable {
    if (stop.stop_requested()) return kStopped;
    PredictMixed(clock, CoefficientFromUnbounded(place[0]), CoefficientFromUnbounded(place[1]), &innovations);
    return Deviance(innovations, columns);
  };
}

Autocorrelation Mixed(const Clock& clock, const Eigen::Vector2d& place) {
  Autocorrelation mixed;
  const double phi = CoefficientFromUnbounded(place[0]);
  const double theta = CoefficientFromUnbounded(place[1]);
  mixed.kind = Kind::kMixed;
  mixed.interval = clock.interval;
  mixed.autoregressive = {phi};
  mixed.moving_average = theta;
  mixed.innovation_variance = (1 - phi * phi) / (1 + 2 * phi * theta + theta * theta);
  return mixed;
}

Vertex BestMixed(const Surface& surface) {
  using Pair = std::array<double, 2>;
  constexpr std::array kStarts = {Pair{0.5, 0.3},   Pair{0.5, -0.2},  Pair{-0.5, 0.2},   Pair{0.8, -0.4},
                                  Pair{0.95, -0.6}, Pair{0.99, -0.8}, Pair{0.998, -0.95}};
  Vertex best{Eigen::Vector2d::Zero(), std::numeric_limits<double>::infinity()};
  for (const auto& start : kStarts) {
    const Eigen::Vector2d place(std::atanh(start[0]), std::atanh(start[1]));
    const double height = surface(place);
    if (height < best.height) best = {place, height};
  }
  return Lowest(surface, best.place, 0.3);
}

/// The coordinates of an AR(1) with coefficient tanh(place) that has a share of the variance, the rest being
/// white.
Eigen::Vector2d DilutedPlace(double place, double share) {
  const double phi = CoefficientFromUnbounded(place);
  const double at_0 = share * (1 - phi * phi) + (1 - share) * (1 + phi * phi);  // autocovariances of z_t - φ z_{t-1}
  const double at_1 = -(1 - share) * phi;
  const double theta = 2 * at_1 / (at_0 + std::sqrt(at_0 * at_0 - 4 * at_1 * at_1));
  return {place, std::atanh(theta)};
}

/// The likeliest AR(1) with this share; its `place` is that of `surface`.
Vertex BestDiluted(const Surface& surface, double share, double from, double to) {
  const Vertex best = LowestOnLine([&](double place) { return surface(DilutedPlace(place, share)); }, from, to);
  return {DilutedPlace(best.place[0], share), best.height};
}

Autocorrelation EstimateEven(const Clock& clock, const Eigen::VectorXd& residual, const Eigen::MatrixXd& weights,
                             double visible_share, Whiteness whiteness, const std::stop_token& stop) {
  constexpr double kRounded = 0.95;
  const double penalty = std::log(static_cast<double>(residual.size()));
  const double white = WhiteCriterion(residual);
  const Autoregression burg = BestAutoregression(clock, residual);
  const bool is_rounded = visible_share < kRounded;
  const bool may_be_white = whiteness == Whiteness::kPossible;
  if (may_be_white && burg.criterion >= 0 && LooksWhite(residual, is_rounded ? 1 : 2)) return {};
  const Eigen::MatrixXd column = residual;
  const Surface plain = MixedSurface(clock, column, stop);
  const Vertex mixed = BestMixed(plain);
  const double gain = mixed.height + 2 * penalty - white;
  constexpr double kSteepest = 4;  // artanh of φ: 0.9993
  Vertex diluted{Eigen::Vector2d::Zero(), std::numeric_limits<double>::infinity()};
  if (is_rounded) diluted = BestDiluted(plain, visible_share, -kSteepest, kSteepest);
  const double diluted_gain = diluted.height + penalty - white;
  if (may_be_white && std::min({burg.criterion, gain, diluted_gain}) >= 0) return {};
  if (stop.stop_requested()) return {};
  const bool is_diluted = diluted_gain < std::min(gain, burg.criterion);
  const bool is_mixed = gain < burg.criterion;
  if (!is_diluted && !is_mixed && burg.reflection.size() > 1) return FromBurg(clock, burg.reflection);
  const Eigen::MatrixXd columns = RestrictedColumns(residual, weights);
  const Surface restricted = MixedSurface(clock, columns, stop);
  if (is_diluted) {
    const double place = diluted.place[0];
    return Mixed(clock, BestDiluted(restricted, visible_share, place - 1, place + 1).place);
  }
  if (is_mixed) return Mixed(clock, Lowest(restricted, mixed.place, 0.1).place);
  const double place = std::atanh(burg.reflection[0]);
  const auto along = [&](double p) { return restricted({p, 0}); };
  Autocorrelation first_order = Mixed(clock, LowestOnLine(along, place - 1, place + 1).place);
  first_order.kind = Kind::kAutoregressive;
  return first_order;
}

// ---- Continuous AR(1) ----------------------------------------------------------------------------------------------

/// Coordinates are (ln τ, logit s).
Autocorrelation Continuous(const Eigen::VectorXd& time, const Eigen::Vector2d& place) {
  Autocorrelation continuous;
  continuous.kind = Kind::kContinuous;
  continuous.interval = (time[time.size() - 1] - time[0]) / static_cast<double>(time.size() - 1);
  continuous.decay_time = std::exp(place[0]);
  continuous.white_share = 1 / (1 + std::exp(-place[1]));
  return continuous;
}

Surface ContinuousSurface(const Eigen::VectorXd& time, const Eigen::MatrixXd& columns, const std::stop_token& stop) {
  Eigen::VectorXd age = Eigen::VectorXd::Zero(time.size());
  age.tail(time.size() - 1) = time.tail(time.size() - 1) - time.head(time.size() - 1);
  return
      [&time, &columns, &stop, age, innovations = Innovations(columns.rows())](const Eigen::Vector2d& place) mutable {
        if (stop.stop_requested()) return kStopped;
        const Autocorrelation continuous = Continuous(time, place);
        PredictContinuous(age, continuous.decay_time, continuous.white_share, &innovations);
        return Deviance(innovations, columns);
      };
}

Vertex LowestWithoutWhite(const Surface& surface, double from, double to) {
  constexpr double kNone = -INFINITY;
  Vertex lowest = LowestOnLine([&](double place) { return surface({place, kNone}); }, from, to);
  lowest.place[1] = kNone;
  return lowest;
}

Vertex BestWithWhite(const Surface& surface, double interval) {
  Vertex best{Eigen::Vector2d::Zero(), std::numeric_limits<double>::infinity()};
  for (const double intervals : {3.0, 10.0, 50.0, 250.0}) {
    const Eigen::Vector2d place(std::log(intervals * interval), 0);
    const double height = surface(place);
    if (height < best.height) best = {place, height};
  }
  return Lowest(surface, best.place, 0.5);
}

Autocorrelation EstimateUneven(const Eigen::VectorXd& time, const Eigen::VectorXd& residual,
                               const Eigen::MatrixXd& weights, Whiteness whiteness, const std::stop_token& stop) {
  const bool may_be_white = whiteness == Whiteness::kPossible;
  if (may_be_white && LooksWhite(residual, 2)) return {};
  const double penalty = std::log(static_cast<double>(residual.size()));
  const Eigen::MatrixXd column = residual;
  const Surface plain = ContinuousSurface(time, column, stop);
  const double interval = Continuous(time, {0, 0}).interval;
  const Vertex pure = LowestWithoutWhite(plain, std::log(interval / 10), std::log(time[time.size() - 1] - time[0]));
  const Vertex with_white = BestWithWhite(plain, interval);
  const double least = std::min(pure.height + penalty, with_white.height + 2 * penalty);
  if ((may_be_white && WhiteCriterion(residual) <= least) || stop.stop_requested()) return {};
  const Eigen::MatrixXd columns = RestrictedColumns(residual, weights);
  const Surface restricted = ContinuousSurface(time, columns, stop);
  if (least < pure.height + penalty) return Continuous(time, Lowest(restricted, with_white.place, 0.1).place);
  return Continuous(time, LowestWithoutWhite(restricted, pure.place[0] - 1, pure.place[0] + 1).place);
}

/// visible_share: of the autocorrelation of the noise, that which the residuals have.
Autocorrelation EstimateAtAnyStamps(const Eigen::VectorXd& time, const Eigen::VectorXd& residual,
                                    const Eigen::MatrixXd& weights, double visible_share, Whiteness whiteness,
                                    const std::stop_token& stop) {
  constexpr Eigen::Index kMinSamples = 30;
  if (residual.size() < kMinSamples || !(residual.squaredNorm() > 0)) return {};
  const Clock clock = FindClock(time);
  return clock.even ? EstimateEven(clock, residual, weights, visible_share, whiteness, stop)
                    : EstimateUneven(time, residual, weights, whiteness, stop);
}

/// The share of the autocorrelation of rounded noise that its quantile residuals have (MODEL.md section 7,
/// Autocorrelated residuals), on average over the place between two levels.
double VisibleShare(const NoiseModel& noise) {
  if (noise.family != NoiseFamily::kQuantized) return 1;
  constexpr int kPlaces = 20;
  double information = 0;
  for (int k = 0; k < kPlaces; ++k) {
    const double place = noise.resolution * (k + 0.5) / kPlaces;
    information += ReadingInformation(place, noise.sigma, noise.resolution, std::nullopt)(0, 0) / kPlaces;
  }
  return std::pow(noise.sigma * noise.sigma * information, 2);
}

}  // namespace

Autocorrelation EstimateAutocorrelation(const Eigen::VectorXd& time, const Eigen::VectorXd& residual,
                                        const Eigen::MatrixXd& weights, const std::stop_token& stop) {
  return EstimateAtAnyStamps(time, residual, weights, 1, Whiteness::kPossible, stop);
}

Autocorrelation EstimateAutocorrelation(const NoiseModel& noise, const Eigen::VectorXd& time, const Eigen::VectorXd& z,
                                        const Eigen::MatrixXd& jacobian, const std::stop_token& stop,
                                        Whiteness whiteness) {
  const Eigen::VectorXd weight = noise.Deviations(jacobian.rows()).cwiseInverse();
  return EstimateAtAnyStamps(time, z, weight.asDiagonal() * jacobian, VisibleShare(noise), whiteness, stop);
}

bool MayBeCorrelated(const Eigen::VectorXd& z) {
  constexpr double kDoubtful = 0.05;
  return !(LjungBoxP(z) > kDoubtful);
}

}  // namespace pendulum
