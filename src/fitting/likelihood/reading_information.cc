// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/likelihood/reading_information.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pendulum/base/physics.h"
#include "pendulum/fitting/likelihood/noise.h"

namespace pendulum {
namespace {

/// Edge of a level, with values of the normal distribution there.
struct Edge {
  explicit Edge(double at)
      : z(at),
        upper_tail(0.5 * std::erfc(std::abs(at) / std::sqrt(2.0))),
        density(std::exp(-0.5 * at * at) / std::sqrt(2 * kPi)),
        moment(std::isinf(at) ? 0.0 : at * density) {}

  double z;           ///< (edge - x) / σ
  double upper_tail;  ///< 1 - Φ(|z|)
  double density;     ///< φ(z)
  double moment;      ///< z φ(z)
};

/// Φ(b) - Φ(a) without cancellation in either tail.
double Probability(const Edge& a, const Edge& b) {
  if (a.z >= 0) return a.upper_tail - b.upper_tail;
  if (b.z <= 0) return b.upper_tail - a.upper_tail;
  return 1 - a.upper_tail - b.upper_tail;
}

}  // namespace

/// Level k has the probability p_k = Φ(b_k) - Φ(a_k); a_k and b_k are (edge - x) / σ of its two edges. The information
/// is Σ_k ∇p_k ∇p_kᵀ / p_k, summed exactly.
Eigen::Matrix2d ReadingInformation(double x, double sigma, double resolution, const std::optional<SensorRange>& range) {
  if (resolution == 0) return Eigen::Vector2d(1 / (sigma * sigma), 2).asDiagonal();
  constexpr double kReach = 9;        // standard deviations; levels beyond them have less than 1e-16 of the information
  constexpr double kRounding = 1e-6;  // as in SensorReading: a range of a whole number of levels includes all of them
  const double low = range ? range->low : 0.0;
  const double first = range ? 0.0 : -kInfinity;
  const double last = range ? std::floor((range->high - low) / resolution + kRounding) : kInfinity;
  const auto level_at = [&](double value) { return std::clamp(std::round((value - low) / resolution), first, last); };
  const auto edge_above = [&](double level) {
    if (level < first) return Edge(-kInfinity);
    return Edge(level >= last ? kInfinity : (low + resolution * (level + 0.5) - x) / sigma);
  };
  const double end = level_at(x + kReach * sigma);
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Edge a = edge_above(level_at(x - kReach * sigma) - 1);
  for (double level = level_at(x - kReach * sigma); level <= end; ++level) {
    const Edge b = edge_above(level);
    const double probability = Probability(a, b);
    const Eigen::Vector2d slope((a.density - b.density) / sigma, a.moment - b.moment);
    if (probability > std::numeric_limits<double>::min()) information += slope * slope.transpose() / probability;
    a = b;
  }
  return information;
}

}  // namespace pendulum
