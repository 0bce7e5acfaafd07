// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/score_supremum.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <boost/random/normal_distribution.hpp>

namespace pendulum {
namespace {

using Eigen::Index;

/// The part of the shapes that the nuisance does not explain, with columns of length 1.
Eigen::MatrixXd Unexplained(const Eigen::MatrixXd& nuisance, const Eigen::MatrixXd& shapes) {
  constexpr double kExplained = 1e-6;
  Eigen::MatrixXd left = shapes;
  if (nuisance.cols() > 0) {
    Eigen::MatrixXd basis = nuisance;
    for (Index k = 0; k < basis.cols(); ++k) basis.col(k) /= std::max(basis.col(k).norm(), 1e-300);
    left -= basis * basis.colPivHouseholderQr().solve(shapes);
  }
  std::vector<Index> columns;
  for (Index g = 0; g < shapes.cols(); ++g) {
    if (left.col(g).norm() > kExplained * shapes.col(g).norm()) columns.push_back(g);
  }
  Eigen::MatrixXd kept = left(Eigen::all, columns);
  kept.colwise().normalize();
  return kept;
}

}  // namespace

double SupremumTail(const Eigen::MatrixXd& nuisance, const Eigen::MatrixXd& shapes, double statistic,
                    std::uint64_t seed) {
  constexpr int kDraws = 19'999;
  if (!(statistic > 0)) return 1;
  const Eigen::MatrixXd columns = Unexplained(nuisance, shapes);
  if (columns.cols() == 0) return 1;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(columns.transpose() * columns);
  const Eigen::MatrixXd root = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  std::mt19937_64 generator(seed);
  boost::random::normal_distribution<double> normal;
  const double edge = std::sqrt(statistic);
  Eigen::VectorXd independent(root.cols());
  int beyond = 0;
  for (int i = 0; i < kDraws; ++i) {
    for (double& x : independent) x = normal(generator);
    if ((root * independent).maxCoeff() >= edge) ++beyond;
  }
  return (beyond + 1.0) / (kDraws + 1.0);
}

}  // namespace pendulum
