// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace pendulum {

/// Probability that the likelihood ratio of one term >= 0 reaches `statistic` although the term is absent and its shape
/// is chosen freely (B. E. Hansen, Econometrica 64:413, 1996). It is a parametric bootstrap of the model linearized at
/// the null; each of its 19999 simulated recordings costs a few random numbers instead of two fits. The statistic is
/// the largest max(0, z_g)²; z is normal with the correlations of the columns of `shapes` after removing `nuisance`
/// (MODEL.md eq. (9.4)). nuisance N x P: derivatives of the readings with respect to the parameters of the simpler law.
/// shapes N x G: derivatives with respect to the term, one column per shape, any units. Columns explained by the
/// nuisance are left out; returns 1 if none remains.
double SupremumTail(const Eigen::MatrixXd& nuisance, const Eigen::MatrixXd& shapes, double statistic,
                    std::uint64_t seed);

}  // namespace pendulum
