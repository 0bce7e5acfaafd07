// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pendulum/fitting/likelihood/noise.h"

namespace pendulum {

/// Table of the log-probability of a level, or of a censored reading. Its argument is the depth: how far the modelled
/// value lies inside the nearer edge, in units of the resolution. Interpolates with quintics between nodes σ/4 apart,
/// at which value, slope and curvature are exact. The logarithm is accurate to 2e-8. The derivatives are exactly the
/// derivatives of the interpolated curve.
class DepthTable {
 public:
  /// A log-probability and its first two derivatives with respect to the depth.
  struct Curve {
    double log = 0;
    double slope = 0;
    double curvature = 0;
  };

  /// width: 1 for a level, infinite for a censored reading.
  explicit DepthTable(double width) : width_(width) {}

  /// Costs some 60 evaluations of the exact probability. σ > 0.
  void Build(double sigma);

  /// depth <= width / 2, negative outside the interval.
  double operator()(double depth) const {
    if (depth >= last_) return end_.log;
    if (!(depth >= first_)) return Exactly(depth).log;
    const auto [c, s] = Find(depth);
    return c.f + s * (c.d + s * (c.e + s * (c.third + s * (c.fourth + s * c.fifth))));
  }

  Curve At(double depth) const {
    if (depth >= last_) return end_;
    if (!(depth >= first_)) return Exactly(depth);
    const auto [c, s] = Find(depth);
    const double slope = c.d + s * (2 * c.e + s * (3 * c.third + s * (4 * c.fourth + s * 5 * c.fifth)));
    const double curvature = 2 * c.e + s * (6 * c.third + s * (12 * c.fourth + s * 20 * c.fifth));
    return {c.f + s * (c.d + s * (c.e + s * (c.third + s * (c.fourth + s * c.fifth)))), slope * cells_per_length_,
            curvature * cells_per_length_ * cells_per_length_};
  }

  /// The largest log-probability, at the greatest depth.
  double best() const { return end_.log; }

 private:
  /// Coefficients of s⁰ to s⁵, s from 0 to 1 within a cell.
  struct Quintic {
    double f, d, e, third, fourth, fifth;
  };
  struct Place {
    const Quintic& cell;
    double s;
  };

  Place Find(double depth) const {
    const double position = (depth - first_) * cells_per_length_;
    const auto cell = static_cast<int>(position);
    return {cells_[static_cast<std::size_t>(cell)], position - static_cast<double>(cell)};
  }

  Curve Exactly(double depth) const;

  /// Hermite polynomial between two nodes a step apart.
  static Quintic Between(const Curve& from, const Curve& to, double step);

  double width_;
  double sigma_ = 1;
  double first_ = 0;
  double last_ = 0;
  Curve end_;
  double cells_per_length_ = 0;
  std::vector<Quintic> cells_;
};

// ---------------------------------------------------------------------------------------------------------------------

inline DepthTable::Curve DepthTable::Exactly(double depth) const {
  const double a = -depth / sigma_;
  const double b = (width_ - depth) / sigma_;
  const IntervalProbability p = GaussianInterval(a, b);
  const double slope = p.lower - p.upper;
  const double first = a * p.lower - (std::isinf(b) ? 0.0 : b * p.upper);
  return {p.log, slope / sigma_, -std::max(slope * slope - first, 0.0) / (sigma_ * sigma_)};
}

inline DepthTable::Quintic DepthTable::Between(const Curve& from, const Curve& to, double step) {
  const double slope = from.slope * step;
  const double curvature = from.curvature * step * step;
  const double f = to.log - from.log - slope - 0.5 * curvature;
  const double d = to.slope * step - slope - curvature;
  const double e = to.curvature * step * step - curvature;
  return {from.log, slope, 0.5 * curvature, 10 * f - 4 * d + 0.5 * e, -15 * f + 7 * d - e, 6 * f - 3 * d + 0.5 * e};
}

inline void DepthTable::Build(double sigma) {
  constexpr double kCertain = 8.5;   // in σ inside the edge: the probability is 1 to rounding
  constexpr double kImprobable = 6;  // in σ outside: such values are rare
  constexpr double kCellsPerSigma = 4;
  sigma_ = sigma;
  first_ = -kImprobable * sigma;
  last_ = std::min(0.5 * width_, kCertain * sigma);
  const double length = last_ - first_;
  const auto cells = static_cast<std::size_t>(std::ceil(length / sigma * kCellsPerSigma));
  cells_per_length_ = static_cast<double>(cells) / length;
  cells_.resize(cells + 1);
  const double step = 1 / cells_per_length_;
  Curve before = Exactly(first_);
  for (std::size_t i = 0; i < cells; ++i) {
    const Curve next = Exactly(first_ + static_cast<double>(i + 1) * step);
    cells_[i] = Between(before, next, step);
    before = next;
  }
  cells_[cells] = {before.log, 0, 0, 0, 0, 0};  // for a depth that rounding puts just below the last node
  end_ = before;
}

}  // namespace pendulum
