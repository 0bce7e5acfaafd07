// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/peaks.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>

#include "pendulum/base/median.h"
#include "pendulum/base/physics.h"
#include "pendulum/closed_form/extrema.h"

namespace pendulum {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// How a turning point is fitted, depending on the number of samples.
struct Shape {
  int degree;
  double half_width;  // s
};

Shape ShapeFor(double samples_per_period, double period) {
  if (samples_per_period < 14) return {2, period / 4};  // a sixth of a period has too few
  return {samples_per_period >= 36 ? 6 : samples_per_period >= 24 ? 4 : 2, period / 6};
}

/// cos x minus its Taylor polynomial of degree `degree`.
ArrayXd CosineBeyond(int degree, const ArrayXd& x) {
  ArrayXd rest = x.cos();
  ArrayXd term = ArrayXd::Ones(x.size());
  for (int k = 0; k <= degree; k += 2) {
    rest -= term;
    term *= -x.square() / ((k + 1) * (k + 2));
  }
  return rest;
}

/// A polynomial fitted about a turning point, before the noise is known.
struct LocalFit {
  Peak peak;  // without covariance
  double sum_of_squares = 0;
  Index freedom = 0;
};

class PeakFitter {
 public:
  PeakFitter(const Recording& recording, const std::vector<Extremum>& extrema, const Kink& kink)
      : recording_(recording), kink_(kink) {
    std::vector<double> intervals;
    std::vector<double> middles;
    for (std::size_t i = 1; i < extrema.size(); ++i) {
      intervals.push_back(extrema[i].time - extrema[i - 1].time);
      middles.push_back(0.5 * (extrema[i].value + extrema[i - 1].value));
    }
    half_period_ = Median(std::move(intervals));
    zero_ = Median(std::move(middles));
    std::vector<double> steps;
    for (Index i = 1; i < recording.size(); ++i) steps.push_back(recording.time[i] - recording.time[i - 1]);
    shape_ = ShapeFor(2 * half_period_ / Median(std::move(steps)), 2 * half_period_);
  }

  double half_period() const { return half_period_; }

  /// Returns std::nullopt if samples are missing, saturated or too few.
  std::optional<LocalFit> Fit(const Extremum& extremum) const {
    LocalFit fit;
    double centre = extremum.time;
    double value = extremum.value;
    constexpr int kRounds = 2;  // the kink is at the peak, so its position is iterated
    for (int round = 0; round < kRounds; ++round) {
      if (!FitAbout(centre, value, fit)) return std::nullopt;
      centre = fit.peak.time;
      value = fit.peak.value;
    }
    return fit;
  }

 private:
  /// The part of the readings that is not a polynomial: higher terms of the swing, and the kink of an angle.
  ArrayXd NonPolynomialPart(const ArrayXd& delay, double distance) const {
    ArrayXd known = distance * CosineBeyond(shape_.degree, kPi / half_period_ * delay);
    if (recording_.quantity == Quantity::kAngle && kink_.sticking_angle != 0) {
      const double side = distance > 0 ? 1 : -1;
      known += side * kink_.sticking_angle * delay.sign() * (1 - (kink_.natural_frequency * delay).cos());
    }
    return known;
  }

  bool Saturates(const VectorXd& values) const {
    if (!recording_.range) return false;
    const double margin = 0.5 * recording_.resolution;
    return values.minCoeff() <= recording_.range->low + margin || values.maxCoeff() >= recording_.range->high - margin;
  }

  bool FitAbout(double centre, double value, LocalFit& fit) const {
    const VectorXd& time = recording_.time;
    const Index first = std::lower_bound(time.begin(), time.end(), centre - shape_.half_width) - time.begin();
    const Index last = std::upper_bound(time.begin(), time.end(), centre + shape_.half_width) - time.begin();
    const Index count = last - first;
    fit.freedom = count - shape_.degree - 1;
    const bool inside = centre - shape_.half_width >= time[0] && centre + shape_.half_width <= time[time.size() - 1];
    if (!inside || fit.freedom < 1 || Saturates(recording_.value.segment(first, count))) return false;
    const ArrayXd delay = time.segment(first, count).array() - centre;
    const VectorXd rest = recording_.value.segment(first, count) - NonPolynomialPart(delay, value - zero_).matrix();
    MatrixXd powers(count, shape_.degree + 1);
    powers.col(0).setOnes();
    for (int k = 1; k <= shape_.degree; ++k) powers.col(k) = powers.col(k - 1).array() * delay / shape_.half_width;
    // The powers are well conditioned, so the normal equations are too. The influence needs (XᵀX)⁻¹ Xᵀ anyway.
    const MatrixXd solver = (powers.transpose() * powers).ldlt().solve(powers.transpose());
    const VectorXd c = solver * rest;
    fit.sum_of_squares = (rest - powers * c).squaredNorm();
    MatrixXd gradient;  // of (time, value) with respect to c
    if (!FindVertex(c, centre, fit.peak, gradient)) return false;
    fit.peak.first = first;
    fit.peak.influence = gradient * solver;
    return true;
  }

  /// Finds the extremum of the polynomial nearest to the centre.
  bool FindVertex(const VectorXd& c, double centre, Peak& peak, MatrixXd& gradient) const {
    constexpr int kMaxSteps = 20;
    double x = 0;
    VectorXd at(c.size()), slope(c.size()), curvature(c.size());
    for (int step = 0; step < kMaxSteps; ++step) {
      at[0] = 1, slope[0] = 0, curvature[0] = 0;
      for (Index k = 1; k < c.size(); ++k) {
        at[k] = at[k - 1] * x;
        slope[k] = static_cast<double>(k) * at[k - 1];
        curvature[k] = static_cast<double>(k) * slope[k - 1];
      }
      const double change = -slope.dot(c) / curvature.dot(c);
      if (!std::isfinite(change)) return false;
      x += change;
      if (!(std::abs(x) < 0.8)) return false;
      if (std::abs(change) < 1e-12) break;
    }
    peak.time = centre + x * shape_.half_width;
    peak.value = at.dot(c);
    gradient.resize(2, c.size());
    gradient.row(0) = -slope.transpose() * (shape_.half_width / curvature.dot(c));
    gradient.row(1) = at.transpose();
    return true;
  }

  const Recording& recording_;
  Kink kink_;
  double half_period_ = 0, zero_ = 0;
  Shape shape_{};
};

/// Two turning points follow each other if they lie on different sides of the zero and about half a period apart.
bool Follows(const Peak& before, const Peak& peak, double half_period, double zero) {
  constexpr double kLongest = 1.6;
  return (before.value > zero) != (peak.value > zero) && peak.time - before.time < kLongest * half_period;
}

void EstimateZero(PeakTable& table) {
  const VectorXd weights = table.ZeroWeights();
  double variance = 0;
  table.zero.value = 0;
  for (Index i = 0; i < weights.size(); ++i) {
    const Peak& peak = table.peaks[static_cast<std::size_t>(i)];
    table.zero.value += weights[i] * peak.value;
    variance += weights[i] * weights[i] * peak.covariance(1, 1);
  }
  table.zero.std_error = std::sqrt(variance);
}

tl::unexpected<Status> TooFew(std::size_t found, std::size_t located) {
  return Error(StatusCode::kFailedPrecondition,
               "of " + std::to_string(found) + " turning points " + std::to_string(located) +
                   " can be located, and three that follow each other are needed: those at the ends of the recording "
                   "or of the sensor's range, amid a gap, or with fewer than four samples in the third of a period "
                   "around them cannot; record for longer or more samples a second");
}

}  // namespace

VectorXd PeakTable::ZeroWeights() const {
  VectorXd weights = VectorXd::Zero(static_cast<Index>(peaks.size()));
  for (std::size_t i = 1; i + 1 < peaks.size(); ++i) {
    if (!peaks[i].continues || !peaks[i + 1].continues) continue;
    weights.segment<3>(static_cast<Index>(i) - 1) += Eigen::Vector3d(0.25, 0.5, 0.25);
  }
  const double sum = weights.sum();
  return sum > 0 ? VectorXd(weights / sum) : weights;
}

MatrixXd CovarianceOf(const PeakTable& table, const MatrixXd& gradient) {
  MatrixXd covariance = MatrixXd::Zero(gradient.rows(), gradient.rows());
  for (std::size_t i = 0; i < table.peaks.size(); ++i) {
    const auto part = gradient.middleCols<2>(2 * static_cast<Index>(i));
    covariance += part * table.peaks[i].covariance * part.transpose();
  }
  return covariance;
}

MatrixXd InfluenceOf(const PeakTable& table, const MatrixXd& gradient, Index samples) {
  MatrixXd influence = MatrixXd::Zero(samples, gradient.rows());
  for (std::size_t i = 0; i < table.peaks.size(); ++i) {
    const Peak& peak = table.peaks[i];
    influence.middleRows(peak.first, peak.influence.cols()) +=
        (gradient.middleCols<2>(2 * static_cast<Index>(i)) * peak.influence).transpose();
  }
  return influence;
}

Result<PeakTable> LocatePeaks(const Recording& recording, const Kink& kink) {
  const Result<std::vector<Extremum>> extrema = FindExtrema(recording);
  if (!extrema) return tl::unexpected(extrema.error());
  const PeakFitter fitter(recording, *extrema, kink);
  PeakTable table;
  table.quantity = recording.quantity;
  table.half_period = fitter.half_period();
  table.kink = kink;
  double sum_of_squares = 0;
  Index freedom = 0;
  for (const Extremum& extremum : *extrema) {
    const std::optional<LocalFit> fit = fitter.Fit(extremum);
    if (!fit) continue;
    sum_of_squares += fit->sum_of_squares;
    freedom += fit->freedom;
    table.peaks.push_back(fit->peak);
  }
  if (table.peaks.size() < 3) return TooFew(extrema->size(), table.peaks.size());
  constexpr double kRounding = 1e-12;  // of the range: least noise assumed for noise-free readings
  const double range = recording.value.maxCoeff() - recording.value.minCoeff();
  table.noise = std::max(std::sqrt(sum_of_squares / static_cast<double>(freedom)), kRounding * range);
  const double middle = 0.5 * (table.peaks[0].value + table.peaks[1].value);
  for (std::size_t i = 0; i < table.peaks.size(); ++i) {
    Peak& peak = table.peaks[i];
    peak.covariance = table.noise * table.noise * peak.influence * peak.influence.transpose();
    if (i > 0) peak.continues = Follows(table.peaks[i - 1], peak, table.half_period, middle);
  }
  EstimateZero(table);
  if (table.ZeroWeights().isZero()) return TooFew(extrema->size(), table.peaks.size());
  return table;
}

}  // namespace pendulum
