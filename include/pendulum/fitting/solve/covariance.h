// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

namespace pendulum {

/// The inverse of an information matrix over the parameters that are free.
struct InformationInverse {
  bool identifiable = false;
  Eigen::MatrixXd matrix;  ///< M x M, M free parameters; empty when not identifiable.
  /// When not identifiable: the parameters (indices of all P) in the combination the data do not see.
  std::vector<int> direction;
};

/// Inverts the rows and columns `free` of a P x P information matrix. Not identifiable: an eigenvalue below 1e-12 times
/// the largest, scaled to unit diagonal (correlations so near 1 that sums have no digits left), or a zero on the
/// diagonal.
InformationInverse InvertInformation(const Eigen::MatrixXd& information, const std::vector<int>& free);

}  // namespace pendulum
