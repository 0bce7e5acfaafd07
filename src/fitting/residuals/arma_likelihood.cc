// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/residuals/arma_likelihood.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "fitting/residuals/arma_family.h"
#include "fitting/residuals/arma_filter.h"
#include "fitting/residuals/burg.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/residuals/bounded_least_squares.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Kind = Autocorrelation::Kind;

// ---- Likelihood and its slope --------------------------------------------------------------------------------------

/// The log-likelihood of residuals at a place, with its gradient and expected information.
struct LikelihoodDerivatives {
  double log_likelihood = -std::numeric_limits<double>::infinity();
  double mean_square = 0;  // of the standardized innovations
  Eigen::VectorXd gradient;
  Eigen::MatrixXd information;
};

/// Filters for several places in parallel, and their results for one series, block by block.
class FilterRow {
 public:
  FilterRow(const ArmaFamily& family, const std::vector<Eigen::VectorXd>& places) {
    std::vector<FilteredProcess> processes;
    processes.reserve(places.size());
    for (const Eigen::VectorXd& place : places) processes.push_back(FilteredAt(family, place));
    for (std::size_t i = 0; i < processes.size(); i += kLanes) {
      const std::size_t end = std::min(i + kLanes, processes.size());
      filters_.emplace_back(std::vector<FilteredProcess>(processes.begin() + i, processes.begin() + end));
    }
    innovation.resize(static_cast<Index>(kLanes * filters_.size()), kBlock);
    variance.resize(innovation.rows(), kBlock);
  }

  static constexpr Index kBlock = 256;
  Eigen::MatrixXd innovation, variance;                            // filters x kBlock
  std::vector<double> log_variance = std::vector<double>(kBlock);  // of the first filter

  void Run(const Eigen::VectorXd& time, const Eigen::VectorXd& residual, Index begin, Index size) {
    for (std::size_t f = 0; f < filters_.size(); ++f) {
      const auto row = static_cast<Index>(kLanes * f);
      for (Index i = 0; i < size; ++i) {
        const Index t = begin + i;
        if (t > 0) filters_[f].Advance(time[t] - time[t - 1]);
        Lanes value;
        value.fill(residual[t]);
        filters_[f].Update(value);
        std::copy_n(filters_[f].innovation().data(), kLanes, &innovation(row, i));
        std::copy_n(filters_[f].variance().data(), kLanes, &variance(row, i));
        if (f == 0) SetLogVariance(i, filters_[f].variance()[0]);
      }
    }
  }

 private:
  void SetLogVariance(Index i, double now) {
    if (now != last_variance_) last_log_ = std::log(now);
    last_variance_ = now;
    log_variance[i] = last_log_;
  }

  std::vector<ArmaFilter> filters_;
  double last_variance_ = 1, last_log_ = 0;
};

/// Gradient Σ u v'/√F + (1 - u²) F'/2F and information Σ v'v'/F + F'F'/2F² of innovations v = u √F (Harvey, section
/// 3.4.5), with derivatives by finite differences. If `step` is 0, computes only the likelihood.
LikelihoodDerivatives DerivativesAt(const ArmaFamily& family, const Eigen::VectorXd& place, const Eigen::VectorXd& time,
                                    const Eigen::VectorXd& residual, double step) {
  const Index size = step > 0 ? place.size() : 0;
  std::vector<Eigen::VectorXd> places(static_cast<std::size_t>(size + 1), place);
  for (Index k = 0; k < size; ++k) places[k + 1][k] += step;
  FilterRow row(family, places);
  LikelihoodDerivatives slope{0, 0, Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
  double squares = 0;
  for (Index begin = 0; begin < residual.size(); begin += FilterRow::kBlock) {
    const Index count = std::min(FilterRow::kBlock, residual.size() - begin);
    row.Run(time, residual, begin, count);
    const Eigen::ArrayXXd v = row.innovation.topLeftCorner(size + 1, count);
    const Eigen::ArrayXXd f = row.variance.topLeftCorner(size + 1, count);
    const Eigen::ArrayXd scale = f.row(0).rsqrt().transpose();
    const Eigen::ArrayXd u = v.row(0).transpose() * scale;
    for (Index i = 0; i < count; ++i) slope.log_likelihood -= row.log_variance[i] / 2;
    squares += u.square().sum();
    if (size == 0) continue;
    Eigen::MatrixXd moved(size, count), spread(size, count);
    for (Index i = 0; i < count; ++i) {
      moved.col(i) = (v.col(i).tail(size) - v(0, i)) * (scale[i] / step);
      spread.col(i) = (f.col(i).tail(size) - f(0, i)) * (scale[i] * scale[i] / step);
    }
    slope.gradient -= moved * u.matrix() + spread * (0.5 - 0.5 * u.square()).matrix();
    slope.information += moved * moved.transpose() + 0.5 * spread * spread.transpose();
  }
  const auto samples = static_cast<double>(residual.size());
  slope.log_likelihood -= 0.5 * (squares + samples * std::log(2 * kPi));
  slope.mean_square = squares / samples;
  return slope;
}

/// Fisher scoring, damped as in the Levenberg-Marquardt method.
class FisherScoring {
 public:
  FisherScoring(const ArmaFamily& family, const Eigen::VectorXd& time, const Eigen::VectorXd& residual,
                const std::stop_token& stop)
      : family_(family), time_(time), residual_(residual), stop_(stop) {}

  /// After a stop request: a log-likelihood of -infinity.
  LikelihoodDerivatives At(const Eigen::VectorXd& place) const {
    return is_stopped() ? LikelihoodDerivatives{} : DerivativesAt(family_, place, time_, residual_, 0);
  }

  bool is_stopped() const { return stop_.stop_requested(); }

  Eigen::VectorXd Maximize(Eigen::VectorXd place) const {
    constexpr int kMaxSteps = 30;
    constexpr double kMinGain = 1e-7;  // gain in log-likelihood
    constexpr double kLongest = 1;     // step
    if (is_stopped()) return place;
    LikelihoodDerivatives here = DerivativesAt(family_, place, time_, residual_, kDifference);
    double damping = 1e-4;
    for (int i = 0; i < kMaxSteps && damping < 1e6 && !is_stopped(); ++i) {
      Eigen::VectorXd step = StepOf(here, damping);
      if (!(step.dot(here.gradient) > kMinGain)) break;
      step /= std::max(1.0, step.cwiseAbs().maxCoeff() / kLongest);
      const LikelihoodDerivatives next = DerivativesAt(family_, place + step, time_, residual_, kDifference);
      const bool higher = next.log_likelihood > here.log_likelihood;
      damping *= higher ? 0.1 : 10;
      if (!higher) continue;
      place += step;
      here = next;
    }
    return place;
  }

 private:
  static constexpr double kDifference = 1e-5;  // step of forward differences; shifts the maximum by half a step

  static Eigen::VectorXd StepOf(const LikelihoodDerivatives& slope, double damping) {
    Eigen::MatrixXd damped = slope.information;
    const double least = 1e-10 * slope.information.diagonal().maxCoeff();  // for parameters without influence
    damped.diagonal() += damping * slope.information.diagonal() + Eigen::VectorXd::Constant(damped.rows(), least);
    return damped.ldlt().solve(slope.gradient);
  }

  const ArmaFamily& family_;
  const Eigen::VectorXd& time_;
  const Eigen::VectorXd& residual_;
  const std::stop_token& stop_;
};

// ---- Start places --------------------------------------------------------------------------------------------------

using Places = std::vector<Eigen::VectorXd>;

std::vector<GapFreeSpan> GapFreeSpansOf(const Eigen::VectorXd& time, double interval) {
  std::vector<GapFreeSpan> spans = {{0, 1}};
  for (Index i = 1; i < time.size(); ++i) {
    if (time[i] - time[i - 1] > kGapIntervals * interval) {
      spans.push_back({i, 1});
    } else {
      ++spans.back().size;
    }
  }
  return spans;
}

void AddAutoregressive(const Autocorrelation& like, const Eigen::VectorXd& time, const Eigen::VectorXd& residual,
                       Places* places) {
  const auto order = like.autoregressive.size();
  const auto longest = static_cast<int>(order);
  for (std::vector<double> reflection :
       {ReflectionOf(like.autoregressive),
        ReflectionCoefficients(residual, GapFreeSpansOf(time, like.interval), longest)}) {
    reflection.resize(order, 0);
    Eigen::VectorXd place = Eigen::VectorXd::Zero(longest + 1);
    for (Index i = 0; i < longest; ++i) place[i + 1] = UnboundedFromPartial(reflection[i]);
    places->push_back(place);
  }
}

void AddMixed(const Autocorrelation& like, Places* places) {
  using Pair = std::array<double, 2>;
  for (const auto [phi, theta] :
       {Pair{like.autoregressive[0], like.moving_average}, Pair{0.5, 0.3}, Pair{0.5, -0.2}, Pair{-0.5, 0.2},
        Pair{0.8, -0.4}, Pair{0.95, -0.6}, Pair{0.99, -0.8}, Pair{0.998, -0.95}}) {
    places->emplace_back(Eigen::Vector3d(0, UnboundedFromPartial(phi), UnboundedFromPartial(theta)));
  }
}

void AddContinuous(const Autocorrelation& like, const Eigen::VectorXd& time, Places* places) {
  const auto steps = static_cast<double>(std::max<Index>(time.size() - 1, 1));
  const double interval = (time[time.size() - 1] - time[0]) / steps;
  const double share = std::clamp(like.white_share, 0.001, 0.999);
  std::vector<double> decay_times = {like.decay_time};
  for (const double intervals : {0.5, 3.0, 20.0, 150.0}) decay_times.push_back(intervals * interval);
  for (const double decay_time : decay_times) {
    if (!(decay_time > 0)) continue;
    places->emplace_back(Eigen::Vector3d(0, std::log(decay_time), std::log(share / (1 - share))));
    if (!(like.white_share > 0)) places->back().conservativeResize(2);
  }
}

/// The likeliest of the places suggested by `like` and by the moments of the residuals, each at its own scale.
Eigen::VectorXd MostLikelyStart(const ArmaFamily& family, const Autocorrelation& like, const Eigen::VectorXd& time,
                                const Eigen::VectorXd& residual, const FisherScoring& scoring) {
  Places places;
  if (family.kind == Kind::kAutoregressive) AddAutoregressive(like, time, residual, &places);
  if (family.kind == Kind::kMixed) AddMixed(like, &places);
  if (family.kind == Kind::kContinuous) AddContinuous(like, time, &places);
  const double square = residual.squaredNorm() / static_cast<double>(residual.size());
  const double variance = std::max(square - family.rounding_variance, 0.01 * (square + family.rounding_variance));
  Eigen::VectorXd best;
  double highest = -std::numeric_limits<double>::infinity();
  for (Eigen::VectorXd& place : places) {
    place[0] = std::log(variance / ProcessAt(family, place).variance) / 2;
    for (int look = 0; look < 2; ++look) {
      const LikelihoodDerivatives slope = scoring.At(place);
      if (slope.log_likelihood > highest) {
        highest = slope.log_likelihood;
        best = place;
      }
      place[0] += std::log(std::clamp(slope.mean_square, 1e-4, 1e4)) / 2;
    }
  }
  return best;
}

// ---- Shift ---------------------------------------------------------------------------------------------------------

/// Converts columns (N x C) to innovations of variance 1.
Eigen::MatrixXd Whitened(const FilteredProcess& process, const Eigen::VectorXd& time, const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd white(columns.rows(), columns.cols());
  for (Index first = 0; first < columns.cols(); first += kLanes) {
    const Index count = std::min<Index>(kLanes, columns.cols() - first);
    ArmaFilter filter({process});
    Lanes value{};
    for (Index t = 0; t < columns.rows(); ++t) {
      if (t > 0) filter.Advance(time[t] - time[t - 1]);
      for (Index c = 0; c < count; ++c) value[c] = columns(t, first + c);
      filter.Update(value);
      const double scale = 1 / std::sqrt(filter.variance()[0]);
      for (Index c = 0; c < count; ++c) white(t, first + c) = scale * filter.innovation()[c];
    }
  }
  return white;
}

/// The maximum likelihood shift for a given process.
Eigen::VectorXd MostLikelyShift(const FilteredProcess& process, const CorrelatedResiduals& data) {
  const Index size = data.jacobian.cols();
  Eigen::MatrixXd columns(data.time.size(), size + 1);
  columns << data.jacobian, data.residual;
  const Eigen::MatrixXd white = Whitened(process, data.time, columns);
  return BoundedLeastSquares(white.leftCols(size), white.col(size), data.lowest, data.highest);
}

// ---- Shift and autocorrelation -------------------------------------------------------------------------------------

bool HasUsableData(const CorrelatedResiduals& data, const Autocorrelation& like) {
  const Index size = data.jacobian.cols();
  const bool has_shapes = data.time.size() == data.residual.size() && data.jacobian.rows() == data.residual.size() &&
                          data.lowest.size() == size && data.highest.size() == size && data.residual.size() > 0;
  const bool needs_clock = like.kind == Kind::kAutoregressive || like.kind == Kind::kMixed;
  return has_shapes && data.time.allFinite() && data.residual.allFinite() && data.jacobian.allFinite() &&
         std::isfinite(data.rounding_variance) && data.rounding_variance >= 0 &&
         (like.kind != Kind::kMixed || like.autoregressive.size() == 1) && (!needs_clock || like.interval > 0);
}

CorrelatedLikelihood White(const CorrelatedResiduals& data, Eigen::VectorXd shift) {
  const auto samples = static_cast<double>(data.residual.size());
  const double squares = (data.residual - data.jacobian * shift).squaredNorm();
  const double variance = std::max(squares / samples, data.rounding_variance);
  const double log_likelihood = -0.5 * (samples * std::log(2 * kPi * variance) + squares / variance);
  const double sigma = std::sqrt(variance - data.rounding_variance);
  return {log_likelihood, {}, sigma, std::move(shift), 1, data.jacobian.transpose() * data.jacobian / variance};
}

CorrelatedLikelihood AlternateShiftAndAutocorrelation(const ArmaFamily& family, const Autocorrelation& like,
                                                      const CorrelatedResiduals& data, Eigen::VectorXd shift,
                                                      const std::stop_token& stop) {
  constexpr int kMaxRounds = 6;
  // Gain in log-likelihood by the shift; the gain by the autocorrelation that follows is smaller.
  constexpr double kMinGain = 1e-3;
  Eigen::VectorXd left = data.residual - data.jacobian * shift;
  const FisherScoring scoring(family, data.time, left, stop);
  Eigen::VectorXd place = MostLikelyStart(family, like, data.time, left, scoring);
  if (place.size() == 0) return {std::numeric_limits<double>::quiet_NaN(), {}, 0, shift, 0, {}};
  place = scoring.Maximize(place);
  double log_likelihood = scoring.At(place).log_likelihood;
  for (int round = 0; round < kMaxRounds && data.jacobian.cols() > 0 && !scoring.is_stopped(); ++round) {
    const Eigen::VectorXd next = MostLikelyShift(FilteredAt(family, place), data);
    left = data.residual - data.jacobian * next;
    const double gain = scoring.At(place).log_likelihood - log_likelihood;
    shift = next;
    place = scoring.Maximize(place);
    log_likelihood = scoring.At(place).log_likelihood;
    if (!(gain > kMinGain)) break;
  }
  const ArmaProcess process = ProcessAt(family, place);
  const Eigen::MatrixXd white = Whitened(FilteredAt(family, place), data.time, data.jacobian);
  return {log_likelihood,
          process.autocorrelation,
          std::sqrt(process.variance),
          shift,
          static_cast<int>(family.parameters),
          white.transpose() * white};
}

}  // namespace

std::optional<CorrelatedLikelihood> MaximizeCorrelatedLikelihood(const CorrelatedResiduals& data,
                                                                 const Autocorrelation& like,
                                                                 const std::stop_token& stop) {
  constexpr double kNothing = 1e-20;  // relative to the residuals' sum of squares: rounding error
  if (!HasUsableData(data, like)) return std::nullopt;
  Eigen::VectorXd shift = BoundedLeastSquares(data.jacobian, data.residual, data.lowest, data.highest);
  const double squares = (data.residual - data.jacobian * shift).squaredNorm();
  if (data.rounding_variance == 0 && !(squares > kNothing * data.residual.squaredNorm())) return std::nullopt;
  const ArmaFamily family = FamilyOf(like, data.rounding_variance);
  CorrelatedLikelihood best = family.kind == Kind::kWhite
                                  ? White(data, std::move(shift))
                                  : AlternateShiftAndAutocorrelation(family, like, data, std::move(shift), stop);
  if (stop.stop_requested()) return std::nullopt;
  if (!std::isfinite(best.log_likelihood) || !best.shift.allFinite() || !std::isfinite(best.sigma)) return std::nullopt;
  return best;
}

}  // namespace pendulum
