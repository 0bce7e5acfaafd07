// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pendulum/fitting/likelihood/noise.h"

namespace pendulum {

/// Fast NoiseModel::LikelihoodAt for many quantized readings. The likelihood is a smooth function of the distance
/// between modelled value and level; it is interpolated cubically between exact values σ/32 apart. The error of the
/// logarithm is 1e-6. The error of its derivatives, with respect to λ = ln σ and to the value in units of σ, is 1e-5.
/// Other noise and distant values are evaluated exactly. (DepthTable, for the solver's inner loop, has no derivatives
/// with respect to λ.)
class LevelLikelihoods {
 public:
  /// `samples`: number of readings; a table is made only if it has far fewer entries.
  LevelLikelihoods(const NoiseModel& noise, Eigen::Index samples) : noise_(noise) {
    constexpr double kImprobable = 6;  // in σ beyond the edge: such values are rare
    if (noise.family != NoiseFamily::kQuantized) return;
    const double cells = (0.5 * noise.resolution / noise.sigma + kImprobable) * kCellsPerSigma;
    if (!(cells < 0.3 * static_cast<double>(samples))) return;
    cells_ = std::floor(cells);
    per_length_ = kCellsPerSigma / noise.sigma;
    table_.reserve(static_cast<std::size_t>(cells_) + 3);
    // The table is for a level at 0 and a sensor without a limited range. Interpolation in the first and last cell
    // needs one more node beyond each end.
    NoiseModel endless = noise;
    endless.low = -kInfinity;
    endless.high = kInfinity;
    for (int i = -1; i <= static_cast<int>(cells_) + 1; ++i) table_.push_back(endless.LikelihoodAt(0, i / per_length_));
  }

  NoiseLikelihood At(double y, double m, Eigen::Index sample = 0) const {
    const double position = std::abs(m - y) * per_length_;
    if (!(position < cells_) || noise_.IsCensored(y)) return noise_.ForSample(sample).LikelihoodAt(y, m);
    const auto cell = static_cast<std::size_t>(position);
    const double s = position - static_cast<double>(cell);
    // Lagrange interpolation for values at -1, 0, 1 and 2.
    const std::array<double, 4> w = {-s * (s - 1) * (s - 2) / 6, (s + 1) * (s - 1) * (s - 2) / 2,
                                     -(s + 1) * s * (s - 2) / 2, (s + 1) * s * (s - 1) / 6};
    const double side = m < y ? -1 : 1;
    NoiseLikelihood l;
    for (std::size_t k = 0; k < w.size(); ++k) {
      const NoiseLikelihood& at = table_[cell + k];
      l.log += w[k] * at.log;
      l.score += side * w[k] * at.score;
      l.information += w[k] * at.information;
      l.sigma_score += w[k] * at.sigma_score;
      l.sigma_information += w[k] * at.sigma_information;
      l.mixed += side * w[k] * at.mixed;
    }
    return l;
  }

 private:
  static constexpr double kCellsPerSigma = 32;

  NoiseModel noise_;
  double cells_ = 0;  // 0: no table
  double per_length_ = 0;
  std::vector<NoiseLikelihood> table_;
};

}  // namespace pendulum
