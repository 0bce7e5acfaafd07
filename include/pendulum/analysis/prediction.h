// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// How well a model predicts readings that were not fitted. Readings at an end of the sensor's range are left out.
struct Prediction {
  double rms = 0;            ///< rad or rad/s, of measured - predicted; 0 if a part could not be predicted.
  double standardized = 0;   ///< rms of (measured - predicted) / predicted standard deviation, MODEL.md eq. (9.5).
  Eigen::Index samples = 0;  ///< Predicted samples; 0 if there is no prediction or no standard deviation.
  std::string reason;        ///< Why there are no samples; empty if there are some.
};

/// Blocked cross-validation (P. Burman, E. Chow and D. Nolan, Biometrika 81:351, 1994). The recording is cut into
/// kBlocks blocks of equal duration. Each block in turn is left out and predicted by a fit to the remaining samples.
/// The blocks begin one period after the release (or the first sample); every fit includes that period. `used` holds
/// the samples of `fit`, which converged; `options` are those of `fit`. There is no prediction for fewer than
/// kMinPeriods, for a recording that IsUndersampled, or if a fit fails. Cost: kBlocks fits.
Prediction CrossValidate(const Recording& used, const FitReport& fit, const FitOptions& options);

/// Fits the hold and the first kFirstPart of the time after the release (or the first sample), and predicts the
/// remaining readings. Otherwise as CrossValidate, with one fit.
Prediction PredictForward(const Recording& used, const FitReport& fit, const FitOptions& options);

inline constexpr int kBlocks = 5;
inline constexpr double kFirstPart = 0.6;
inline constexpr double kMinPeriods = 3;  ///< Periods of small swings after the release.

}  // namespace pendulum
