// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

namespace pendulum {

/// The inverse of an information matrix over the free parameters.
struct InformationInverse {
  bool identifiable = false;
  Eigen::MatrixXd matrix;  ///< M x M, M free parameters; empty when not identifiable.
  /// If not identifiable: the parameters (indices into all P) in the combination that the data do not determine.
  std::vector<int> direction;
};

/// Inverts the rows and columns `free` of a P x P information matrix. Not identifiable: after scaling to unit diagonal,
/// an eigenvalue is below 1e-12 times the largest (correlations so near 1 that the sums have no digits left). A zero on
/// the diagonal is not identifiable either.
InformationInverse InvertInformation(const Eigen::MatrixXd& information, const std::vector<int>& free);

}  // namespace pendulum
