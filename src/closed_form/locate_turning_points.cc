// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/locate_turning_points.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>

#include "pendulum/base/median.h"
#include "pendulum/base/physics.h"

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
  if (samples_per_period < 14) return {2, period / 4};  // a sixth of a period has too few samples
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
  TurningPoint point;  // without covariance
  double sum_of_squares = 0;
  Index freedom = 0;
};

class TurningPointFitter {
 public:
  TurningPointFitter(const Recording& recording, const TurningPointTable& found, const Kink& kink)
      : recording_(recording), kink_(kink), half_period_(found.half_period) {
    std::vector<double> middles;
    for (std::size_t i = 1; i < found.points.size(); ++i) {
      middles.push_back(0.5 * (found.points[i].value + found.points[i - 1].value));
    }
    zero_ = Median(std::move(middles));
    std::vector<double> steps;
    for (Index i = 1; i < recording.size(); ++i) steps.push_back(recording.time[i] - recording.time[i - 1]);
    shape_ = ShapeFor(2 * half_period_ / Median(std::move(steps)), 2 * half_period_);
  }

  /// Returns std::nullopt if samples are missing, saturated or too few.
  std::optional<LocalFit> Fit(const TurningPoint& found) const {
    LocalFit fit;
    fit.point.sample = found.sample;
    double centre = found.time;
    double value = found.value;
    constexpr int kRounds = 2;  // the kink is at the turning point, so its position is iterated
    for (int round = 0; round < kRounds; ++round) {
      if (!FitAbout(centre, value, fit)) return std::nullopt;
      centre = fit.point.time;
      value = fit.point.value;
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
    if (!FindVertex(c, centre, fit.point, gradient)) return false;
    fit.point.first = first;
    fit.point.influence = gradient * solver;
    return true;
  }

  /// Finds the extremum of the polynomial nearest to the centre.
  bool FindVertex(const VectorXd& c, double centre, TurningPoint& point, MatrixXd& gradient) const {
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
    point.time = centre + x * shape_.half_width;
    point.value = at.dot(c);
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
bool Follows(const TurningPoint& before, const TurningPoint& point, double half_period, double zero) {
  constexpr double kLongest = 1.6;
  return (before.value > zero) != (point.value > zero) && point.time - before.time < kLongest * half_period;
}

void EstimateZero(TurningPointTable& table) {
  const VectorXd weights = table.ZeroWeights();
  double variance = 0;
  table.zero.value = 0;
  for (Index i = 0; i < weights.size(); ++i) {
    const TurningPoint& point = table.points[static_cast<std::size_t>(i)];
    table.zero.value += weights[i] * point.value;
    variance += weights[i] * weights[i] * point.covariance(1, 1);
  }
  table.zero.std_error = std::sqrt(variance);
}

tl::unexpected<Status> TooFewLocated(std::size_t found, std::size_t located) {
  return Error(StatusCode::kFailedPrecondition,
               "only " + std::to_string(located) + " of " + std::to_string(found) +
                   " turning points can be located, but three successive ones are needed. Turning points are left out "
                   "at the ends of the recording or of the sensor's range, in a gap, and with fewer than four samples "
                   "within a third of a period; record for longer, or with more samples per second");
}

}  // namespace

MatrixXd CovarianceOf(const TurningPointTable& table, const MatrixXd& gradient) {
  MatrixXd covariance = MatrixXd::Zero(gradient.rows(), gradient.rows());
  for (std::size_t i = 0; i < table.points.size(); ++i) {
    const auto part = gradient.middleCols<2>(2 * static_cast<Index>(i));
    covariance += part * table.points[i].covariance * part.transpose();
  }
  return covariance;
}

MatrixXd InfluenceOf(const TurningPointTable& table, const MatrixXd& gradient, Index samples) {
  MatrixXd influence = MatrixXd::Zero(samples, gradient.rows());
  for (std::size_t i = 0; i < table.points.size(); ++i) {
    const TurningPoint& point = table.points[i];
    influence.middleRows(point.first, point.influence.cols()) +=
        (gradient.middleCols<2>(2 * static_cast<Index>(i)) * point.influence).transpose();
  }
  return influence;
}

Result<TurningPointTable> LocateTurningPoints(const Recording& recording, const Kink& kink) {
  Result<TurningPointTable> found = FindTurningPoints(recording);
  if (!found) return found;
  const TurningPointFitter fitter(recording, *found, kink);
  TurningPointTable table = *found;
  table.kink = kink;
  table.points.clear();
  double sum_of_squares = 0;
  Index freedom = 0;
  for (const TurningPoint& point : found->points) {
    const std::optional<LocalFit> fit = fitter.Fit(point);
    if (!fit) continue;
    sum_of_squares += fit->sum_of_squares;
    freedom += fit->freedom;
    table.points.push_back(fit->point);
  }
  if (table.points.size() < 3) return TooFewLocated(found->points.size(), table.points.size());
  constexpr double kRounding = 1e-12;  // of the range: least noise assumed for noise-free readings
  const double range = recording.value.maxCoeff() - recording.value.minCoeff();
  table.noise = std::max(std::sqrt(sum_of_squares / static_cast<double>(freedom)), kRounding * range);
  const double middle = 0.5 * (table.points[0].value + table.points[1].value);
  for (std::size_t i = 0; i < table.points.size(); ++i) {
    TurningPoint& point = table.points[i];
    point.covariance = table.noise * table.noise * point.influence * point.influence.transpose();
    if (i > 0) point.continues = Follows(table.points[i - 1], point, table.half_period, middle);
  }
  EstimateZero(table);
  if (table.ZeroWeights().isZero()) return TooFewLocated(found->points.size(), table.points.size());
  return table;
}

}  // namespace pendulum
