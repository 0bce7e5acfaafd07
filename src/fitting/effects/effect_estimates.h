// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

namespace pendulum {

/// Least squares in F parameters of a fit and E effects, from their sums alone.
struct EffectSums {
  Eigen::MatrixXd information;  ///< (F + E) x (F + E): A'A of the weighted columns.
  Eigen::MatrixXd meat;         ///< Covariance of A'r if the law is right; s² A'A for independent residuals.
  Eigen::VectorXd score;        ///< F + E: A'r
  Eigen::Index parameters = 0;  ///< F
};

/// A score test of some effects beside others (C. R. Rao, Proc. Camb. Phil. Soc. 44:50, 1948).
struct EffectTest {
  double chi_square = 0;
  int freedom = 0;          ///< The number of effects that the parameters do not take up.
  double significance = 0;  ///< Standard deviations of a normal variable with the same probability.
};

/// Tests effects `tested` (indices of columns) beside the parameters and effects `base`.
EffectTest TestEffects(const EffectSums& sums, const std::vector<Eigen::Index>& base,
                       const std::vector<Eigen::Index>& tested);

/// What is known of K effects before the recording.
struct EffectPriors {
  Eigen::VectorXd precision;  ///< K, 1 / variance; 0: nothing is known.
  Eigen::VectorXd mean;       ///< K
};

/// Sizes of K effects with their covariance.
struct EffectSizes {
  Eigen::VectorXd mean;        ///< K
  Eigen::MatrixXd covariance;  ///< K x K; at most that of the priors.
};

/// Estimates the effects `chosen` (K columns) together with all parameters, by generalized least squares from their
/// scores, which are normal with mean L e and the covariance that the correlation of the residuals gives.
EffectSizes EstimateEffects(const EffectSums& sums, const std::vector<Eigen::Index>& chosen,
                            const EffectPriors& priors);

}  // namespace pendulum
