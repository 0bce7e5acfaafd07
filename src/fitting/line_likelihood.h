// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/noise.h"

namespace pendulum {

/// Log-probability of a level, or of a censored reading, by how deep within its nearer edge the modelled value lies.
/// Lengths in units of the resolution. Cubic between nodes σ/4 apart: to 1e-5.
class DepthTable {
 public:
  /// width: 1 of a level, infinite of a censored reading.
  explicit DepthTable(double width) : width_(width) {}

  /// Some 60 evaluations of the exact probability. σ > 0.
  void Build(double sigma);

  /// depth <= width / 2, negative outside the interval.
  double operator()(double depth) const {
    if (depth >= last_) return end_;
    if (depth < first_) return Exactly(depth);
    const double position = (depth - first_) * cells_per_length_;
    const auto cell = static_cast<int>(position);
    const double s = position - static_cast<double>(cell);
    const Cubic& c = cells_[static_cast<std::size_t>(cell)];
    return c.constant + s * (c.linear + s * (c.quadratic + s * c.cubic));
  }

 private:
  struct Cubic {
    double constant;
    double linear;
    double quadratic;
    double cubic;
  };

  double Exactly(double depth) const;

  double width_;
  double sigma_ = 1;
  double first_ = 0;
  double last_ = 0;
  double end_ = 0;
  double cells_per_length_ = 0;
  std::vector<Cubic> cells_;
};

/// Samples of rounded readings as a linear model sees them, in units of the resolution: position + slope · w. Equal
/// samples are one, counted.
struct LevelSamples {
  Eigen::VectorXd position;  ///< n x 1, modelled less measured; of censored readings the depth within the interval.
  Eigen::MatrixXd slope;     ///< n x F
  Eigen::VectorXd count;     ///< n x 1
  Eigen::Index levels = 0;   ///< As many levels come first, then the censored readings.

  Eigen::Index size() const { return position.size(); }

  /// Those that come closer than `depth` to an edge, or leave their interval, within `reach` times the norm of their
  /// slope: the closest first, whose branches in a sum are then foreseen, and which soonest tell that it is small.
  LevelSamples Near(double depth, double reach) const;
};

/// From N values and readings and an N x F Jacobian. Equal samples are found where they follow one another, as those
/// of a hold and of a rest do.
LevelSamples MergeSamples(const NoiseModel& noise, const Eigen::VectorXd& value, const Eigen::VectorXd& readings,
                          const Eigen::MatrixXd& jacobian);

/// Their log-likelihood at one σ, along lines.
class LineLikelihood {
 public:
  /// σ in units of the resolution.
  void SetSigma(double sigma);

  /// Σ l where each position is start + step · direction (n x 1 each); or, once it is sure to be less than `floor`,
  /// some number less than that. Adds the samples it looked at to `work`.
  double Sum(const LevelSamples& samples, const Eigen::VectorXd& start, const Eigen::VectorXd& direction, double step,
             double floor);

  double work() const { return work_; }

 private:
  DepthTable level_{1};
  DepthTable censored_{std::numeric_limits<double>::infinity()};
  double sigma_ = 0;
  bool has_censored_table_ = false;
  double work_ = 0;
};

}  // namespace pendulum
