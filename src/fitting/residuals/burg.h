// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace pendulum {

/// Samples begin..begin + size - 1 of a recording, with no gap between them: one for each interval of its clock.
struct GapFreeSpan {
  Eigen::Index begin = 0;
  Eigen::Index size = 0;
};

/// Reflection coefficients of orders 1, 2, ... of the autoregression that best predicts the samples of all spans, both
/// from earlier and from later samples (Burg, Maximum entropy spectral analysis, Stanford, 1975).
///
/// value      N x 1, of mean 0.
/// spans      within 0..N - 1; no sample predicts a sample of another span.
/// Returns at most `longest` coefficients, each in (-1, 1), so the process is stationary. Returns fewer if the
/// prediction is exact with fewer coefficients. Costs O(N longest).
std::vector<double> ReflectionCoefficients(const Eigen::VectorXd& value, const std::vector<GapFreeSpan>& spans,
                                           int longest);

/// The coefficients φ of the autoregression with these reflection coefficients (Levinson 1947, Durbin 1960).
std::vector<double> CoefficientsFromReflection(const std::vector<double>& reflection);

// -----------------------------------------------------------------------------------------------------------------

/// Prediction errors of Burg's lattice for all spans in sequence. Order p predicts sample t from the p samples before
/// it, with error forward[t]. It predicts sample t - p from the p samples after it, with error backward[t - p].
struct Lattice {
  Eigen::VectorXd forward, backward;
};

/// Returns the reflection coefficient of this order, and advances the lattice to it.
inline double Reflect(const std::vector<GapFreeSpan>& spans, Eigen::Index order, Lattice* lattice) {
  double product = 0;
  double energy = 0;
  for (const GapFreeSpan& span : spans) {
    const Eigen::Index size = std::max<Eigen::Index>(span.size - order, 0);
    const auto forward = lattice->forward.segment(span.begin + span.size - size, size);
    const auto backward = lattice->backward.segment(span.begin, size);
    product += 2 * forward.dot(backward);
    energy += forward.squaredNorm() + backward.squaredNorm();
  }
  const double reflection = energy > 0 ? product / energy : 0;
  for (const GapFreeSpan& span : spans) {
    for (Eigen::Index i = 0; i < span.size - order; ++i) {
      double& forward = lattice->forward[span.begin + i + order];
      double& backward = lattice->backward[span.begin + i];
      const double before = forward;
      forward -= reflection * backward;
      backward -= reflection * before;
    }
  }
  return reflection;
}

inline std::vector<double> ReflectionCoefficients(const Eigen::VectorXd& value, const std::vector<GapFreeSpan>& spans,
                                                  int longest) {
  Lattice lattice{value, value};
  std::vector<double> reflection;
  for (int order = 1; order <= longest; ++order) {
    const double next = Reflect(spans, order, &lattice);
    if (!(std::abs(next) < 1)) break;
    reflection.push_back(next);
  }
  return reflection;
}

inline std::vector<double> CoefficientsFromReflection(const std::vector<double>& reflection) {
  std::vector<double> autoregression;
  for (const double last : reflection) {
    const std::vector<double> before = autoregression;
    for (std::size_t j = 0; j < before.size(); ++j) autoregression[j] -= last * before[before.size() - 1 - j];
    autoregression.push_back(last);
  }
  return autoregression;
}

}  // namespace pendulum
