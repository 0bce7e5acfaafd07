// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "pendulum/analysis/separate_estimates.h"

namespace pendulum {

/// Whether K recordings have the same S parameters.
struct Agreement {
  double statistic = 0;     ///< χ² of all parameters together (MODEL.md eq. (10.3)).
  int dof = 0;              ///< S (K - 1)
  std::optional<double> p;  ///< std::nullopt: a covariance cannot be inverted.

  static constexpr double kDisagree = 0.01;  ///< Probability that recordings of one rig are reported as disagreeing.
};

/// Tests estimates of the same parameters from K >= 2 recordings: the test of W. G. Cochran, Biometrics 10:101 (1954),
/// for several parameters. The covariances contain the errors that are independent between recordings
/// (EstimatesToCompare).
Agreement TestAgreement(const std::vector<SeparateEstimates>& estimates);

/// Indices into `estimates` of K >= 2 recordings that do not agree: the fewest recordings without which a majority
/// agrees. If no majority agrees: the recordings that are far outside the scatter of the others. In order; often none.
/// Takes time in proportion to K².
std::vector<std::size_t> FindDisagreeing(const std::vector<SeparateEstimates>& estimates);

}  // namespace pendulum
