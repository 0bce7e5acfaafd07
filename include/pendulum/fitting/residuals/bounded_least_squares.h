// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace pendulum {

/// Minimizes |A x - b|² over lowest <= x <= highest with an active set (P. B. Stark and R. L. Parker, Computational
/// Statistics 10:129, 1995). Starts from x = 0, which must lie within the bounds. If columns of A (N x F) are linearly
/// dependent, the solution with the shortest step is taken, with the columns scaled to equal length. x is 0 for a
/// column of zeros.
Eigen::VectorXd BoundedLeastSquares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& value,
                                    const Eigen::VectorXd& lowest, const Eigen::VectorXd& highest);

}  // namespace pendulum
