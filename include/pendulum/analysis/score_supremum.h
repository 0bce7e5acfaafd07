// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace pendulum {

/// Probability that the likelihood ratio of one term >= 0 reaches `statistic` when the term is not there and the shape
/// it would have is chosen freely (B. E. Hansen, Econometrica 64:413, 1996): a parametric bootstrap of the model
/// linearized at the null, where each of its 19999 recordings costs a few numbers instead of two fits. The statistic is
/// the largest of max(0, z_g)², z normal with the correlations of the columns of `shapes` beside those of `nuisance`
/// (MODEL.md eq. (52)). nuisance N x P: derivatives of the readings by the parameters of the simpler law; shapes N x G:
/// by the term, one column for each shape, any units. A column that the nuisance explains is left out; 1 where none
/// remains.
double SupremumTail(const Eigen::MatrixXd& nuisance, const Eigen::MatrixXd& shapes, double statistic,
                    std::uint64_t seed);

}  // namespace pendulum
