// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

namespace pendulum {

/// The inverse of an information matrix over the parameters that are free.
struct InformationInverse {
  bool identifiable = false;  ///< False when some combination of the free parameters leaves no trace in the data.
  Eigen::MatrixXd matrix;     ///< M x M, M free parameters; empty when not identifiable.
  /// When not identifiable: the parameters (indices of all P) in the combination the data do not see.
  std::vector<int> direction;
};

/// Inverts the rows and columns `free` of a P x P information matrix. Not identifiable: an eigenvalue below 1e-12 times
/// the largest, of the matrix scaled to unit diagonal (correlations within 1e-12 of 1, where the sums over samples have
/// no digits left), or a zero on the diagonal.
InformationInverse InvertInformation(const Eigen::MatrixXd& information, const std::vector<int>& free);

}  // namespace pendulum
