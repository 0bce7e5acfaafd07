// SPDX-License-Identifier: Apache-2.0
#include "fitting/effects/effect_estimates.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Eigenvalues>

namespace pendulum {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Pseudo-inverse of a symmetric matrix, positive semidefinite, after scaling to unit diagonal. Directions with less
/// than `smallest` of the largest eigenvalue count as not determined.
struct ScaledInverse {
  MatrixXd matrix;
  int rank = 0;

  ScaledInverse(const MatrixXd& of, double smallest) {
    const VectorXd scale = of.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scale.asDiagonal() * of * scale.asDiagonal());
    const VectorXd& values = solver.eigenvalues();
    const double limit = smallest * values.cwiseAbs().maxCoeff();
    const VectorXd inverse = values.unaryExpr([&](double v) { return v > limit ? 1 / v : 0.0; });
    rank = static_cast<int>((inverse.array() > 0).count());
    const MatrixXd vectors = scale.asDiagonal() * solver.eigenvectors();
    matrix = vectors * inverse.asDiagonal() * vectors.transpose();
  }
};

constexpr double kSmallestEigenvalue = 1e-10;

/// The normal variable that is exceeded as rarely as chi_square with so many degrees of freedom (E. B. Wilson and M. M.
/// Hilferty, PNAS 17:684, 1931).
double NormalOf(double chi_square, int freedom) {
  if (freedom == 0) return 0;
  const double k = freedom;
  const double variance = 2 / (9 * k);
  return std::max((std::cbrt(chi_square / k) - (1 - variance)) / std::sqrt(variance), 0.0);
}

std::vector<Index> ParametersAnd(const EffectSums& sums, const std::vector<Index>& effects) {
  std::vector<Index> columns(static_cast<std::size_t>(sums.parameters));
  std::iota(columns.begin(), columns.end(), Index{0});
  columns.insert(columns.end(), effects.begin(), effects.end());
  return columns;
}

/// The scores of K effects beside others without what parameters and base take up: u = L e + noise for sizes e.
struct EfficientScores {
  VectorXd score;             // K, u
  MatrixXd information;       // K x K, L
  MatrixXd covariance;        // K x K, of the noise
  std::vector<Index> usable;  // of the K, those that are not taken up
};

EfficientScores FindEfficientScores(const EffectSums& sums, const std::vector<Index>& base,
                                    const std::vector<Index>& effects) {
  constexpr double kTakenUp = 1e-6;  // a share of an effect's square that the parameters leave is rounding below this
  const std::vector<Index> beside = ParametersAnd(sums, base);
  const MatrixXd& meat = sums.meat;
  const ScaledInverse inverse(sums.information(beside, beside), kSmallestEigenvalue);
  const MatrixXd taken = sums.information(effects, beside) * inverse.matrix;
  const MatrixXd across = taken * meat(beside, effects);
  EfficientScores efficient;
  efficient.score = sums.score(effects) - taken * sums.score(beside);
  efficient.information = sums.information(effects, effects) - taken * sums.information(beside, effects);
  efficient.covariance =
      meat(effects, effects) - across - across.transpose() + taken * meat(beside, beside) * taken.transpose();
  for (Index k = 0; k < efficient.score.size(); ++k) {
    const Index column = effects[static_cast<std::size_t>(k)];
    if (efficient.information(k, k) > kTakenUp * sums.information(column, column)) efficient.usable.push_back(k);
  }
  return efficient;
}

constexpr double kSmallestVariance = 1e-6;  // of scores, relative to the largest

}  // namespace

EffectTest TestEffects(const EffectSums& sums, const std::vector<Index>& base, const std::vector<Index>& tested) {
  const EfficientScores efficient = FindEfficientScores(sums, base, tested);
  const std::vector<Index>& usable = efficient.usable;
  if (usable.empty()) return {};
  const ScaledInverse of_score(efficient.covariance(usable, usable), kSmallestVariance);
  const VectorXd u = efficient.score(usable);
  EffectTest test;
  test.chi_square = u.dot(of_score.matrix * u);
  test.freedom = of_score.rank;
  test.significance = NormalOf(test.chi_square, test.freedom);
  return test;
}

EffectSizes EstimateEffects(const EffectSums& sums, const std::vector<Index>& chosen, const EffectPriors& priors) {
  const EfficientScores efficient = FindEfficientScores(sums, {}, chosen);
  const std::vector<Index>& usable = efficient.usable;
  MatrixXd precision = priors.precision.asDiagonal();
  VectorXd weighted = priors.precision.cwiseProduct(priors.mean);
  if (!usable.empty()) {
    const ScaledInverse of_score(efficient.covariance(usable, usable), kSmallestVariance);
    const MatrixXd weights = efficient.information(usable, usable) * of_score.matrix;
    precision(usable, usable) += weights * efficient.information(usable, usable);
    weighted(usable) += weights * efficient.score(usable);
  }
  const ScaledInverse covariance(precision, kSmallestEigenvalue);
  return {covariance.matrix * weighted, covariance.matrix};
}

}  // namespace pendulum
