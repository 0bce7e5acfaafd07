// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// How well a model foresees readings that it was not fitted to; those at an end of the sensor's range are left out.
struct Prediction {
  double rms = 0;            ///< rad or rad/s, of measured - predicted; 0 where a part could not be predicted.
  double standardized = 0;   ///< rms of that over its predicted standard deviation, MODEL.md eq. (53).
  Eigen::Index samples = 0;  ///< That were predicted; 0 when nothing was, or without a standard deviation.
  std::string reason;        ///< Why there are no samples; empty when there are.
};

/// Leaves out each of kBlocks stretches of equal duration in turn, fits the rest and predicts the stretch (blocked
/// cross-validation: P. Burman, E. Chow and D. Nolan, Biometrika 81:351, 1994). They tile what follows the first period
/// after the release or the first sample, which every fit sees. `used` are the samples of `fit`, which converged;
/// `options` those it was made with. Nothing is predicted of fewer than kFewestPeriods, of a recording that
/// IsUndersampled, or where a fit fails. Cost: kBlocks fits.
Prediction CrossValidate(const Recording& used, const FitReport& fit, const FitOptions& options);

/// Fits the hold and the first kFirstPart of what follows the release (or the first sample), and predicts the rest.
/// Likewise, one fit.
Prediction PredictForward(const Recording& used, const FitReport& fit, const FitOptions& options);

inline constexpr int kBlocks = 5;
inline constexpr double kFirstPart = 0.6;
inline constexpr double kFewestPeriods = 3;  ///< Of small swings, after the release.

}  // namespace pendulum
