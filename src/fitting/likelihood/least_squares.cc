// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/likelihood/least_squares.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace pendulum {

double PriorSum(std::span<const PriorTerm> priors, std::span<const double> parameters) {
  double sum = 0;
  for (const PriorTerm& prior : priors) {
    const double r = (parameters[prior.parameter] - prior.mean) * prior.weight;
    sum += r * r;
  }
  return sum;
}

void AddPriors(std::span<const PriorTerm> priors, std::span<const double> parameters, Eigen::MatrixXd* sums) {
  const Eigen::Index residual = sums->rows() - 1;
  for (const PriorTerm& prior : priors) {
    const double r = (parameters[prior.parameter] - prior.mean) * prior.weight;
    (*sums)(prior.parameter, prior.parameter) += prior.weight * prior.weight;
    (*sums)(prior.parameter, residual) += prior.weight * r;
    (*sums)(residual, prior.parameter) += prior.weight * r;
    (*sums)(residual, residual) += r * r;
  }
}

namespace {

using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxCompressed, 1>;
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxCompressed, kMaxCompressed>;

}  // namespace

/// Uses a pivoted Cholesky factor of J'J scaled to unit diagonal. A direction that the data do not determine gets a row
/// of zeros, which Levenberg-Marquardt leaves unchanged. If J'J is the information of a likelihood, the remainder of
/// |r|² may be negative. R is then enlarged until the remainder is zero, which shortens the step.
void CompressResiduals(const Eigen::MatrixXd& sums, double* residuals, double** jacobians) {
  constexpr double kRounding = 1e-15;  // relative to a unit diagonal
  const Eigen::Index size = sums.rows() - 1;
  const SmallVector norms = sums.diagonal().head(size).cwiseSqrt();
  const SmallVector inverse = norms.unaryExpr([](double norm) { return norm > 0 ? 1 / norm : 0.0; });
  const SmallMatrix correlation = inverse.asDiagonal() * sums.topLeftCorner(size, size) * inverse.asDiagonal();
  const Eigen::LDLT<SmallMatrix> ldlt(correlation);
  const SmallVector root = ldlt.vectorD().unaryExpr([](double x) { return x > kRounding ? std::sqrt(x) : 0.0; });
  const SmallVector scaled_gradient = inverse.cwiseProduct(sums.col(size).head(size));
  SmallVector gradient = ldlt.transpositionsP() * scaled_gradient;
  ldlt.matrixL().solveInPlace(gradient);
  const SmallMatrix unpermuted = norms.asDiagonal();
  const SmallMatrix scaled = ldlt.transpositionsP() * unpermuted;
  const SmallMatrix upper = ldlt.matrixU();
  const SmallMatrix factor = root.asDiagonal() * upper.lazyProduct(scaled);
  Eigen::Map<Eigen::VectorXd> seen(residuals, size);
  seen = root.unaryExpr([](double x) { return x > 0 ? 1 / x : 0.0; }).cwiseProduct(gradient);
  const double total = sums(size, size);
  const double longer = seen.squaredNorm() > total && total > 0 ? std::sqrt(seen.squaredNorm() / total) : 1.0;
  seen /= longer;
  residuals[size] = std::sqrt(std::max(total - seen.squaredNorm(), 0.0));
  for (Eigen::Index j = 0; j < size; ++j) {
    if (jacobians[j] == nullptr) continue;
    Eigen::Map<Eigen::VectorXd>(jacobians[j], size) = longer * factor.col(j);
    jacobians[j][size] = 0;
  }
}

}  // namespace pendulum
