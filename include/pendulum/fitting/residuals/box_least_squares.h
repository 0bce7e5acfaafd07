// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace pendulum {

/// The x of least |A x - b|² with lowest <= x <= highest, by an active set from x = 0, which must be within (P. B.
/// Stark and R. L. Parker, Computational Statistics 10:129, 1995). Where columns of A (N x F) depend on each other, the
/// step to x is the shortest in units of the columns; where one is 0, so is its x.
Eigen::VectorXd BoxLeastSquares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& value,
                                const Eigen::VectorXd& lowest, const Eigen::VectorXd& highest);

}  // namespace pendulum
