// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// One physical parameter in the two halves of a recording, in the unit of the fit's parameter; as the half's readings
/// alone would have it, so that friction near its bound may be negative.
struct HalvesRow {
  std::string name, unit;
  double first = 0, second = 0;
  double first_std_error = 0, second_std_error = 0;
  double z = 0;  ///< (second - first) / its standard deviation
};

/// A window of the recording, where inertia and the friction parameter that is known best were fitted once more, with a
/// start of its own. Standard errors count those of what is held at the whole fit's estimates too.
struct AmplitudeRow {
  double from = 0, to = 0;                      ///< s, on the file's clock
  double amplitude = 0;                         ///< rad, mean over the window
  double inertia = 0, inertia_std_error = 0;    ///< In the fit's unit.
  double friction = 0, friction_std_error = 0;  ///< In the fit's unit; NaN where no friction has an error.
};

/// A parameter's change with amplitude: value = a + slope · (amplitude² - its mean).
struct AmplitudeTrend {
  std::string name, unit;  ///< Of the parameter.
  double slope = 0;        ///< unit per rad²
  double slope_std_error = 0;
  double span = 0;  ///< slope · (largest - smallest amplitude²) over the estimate: the relative change over the run.
  double p = 1;     ///< Probability of as much by chance, two-sided.
};

/// Whether a fit's parameters are constants of the recording.
struct Constancy {
  std::vector<HalvesRow> halves;  ///< Inertia and friction, but for what is fixed.
  double halves_statistic = 0;  ///< χ² of the joint difference of all rows, with their covariances (MODEL.md eq. (55))
  int halves_dof = 0;
  std::optional<double> halves_p;  ///< Absent when there is no such test; `reason` says why.
  std::vector<AmplitudeRow> windows;
  std::vector<AmplitudeTrend> trends;  ///< Of inertia and one friction parameter; empty when there are too few windows.
  std::string reason;                  ///< Why a test is missing; empty when none is.
  std::string verdict;                 ///< A sentence on what is not constant, or that all is.

  bool constant() const;  ///< No test has p < kNotConstant.
};

inline constexpr double kNotConstant = 1e-3;

/// Fits two parts of the recording that tell about equally much (the earlier is the shorter), each of three periods or
/// more after the release, and compares (G. C. Chow, Econometrica 28:591, 1960); and three to eight such windows, whose
/// trend with amplitude is weighed by the covariance that their estimates have when the whole fit is right. Priors and
/// values of the start are those of the whole, not of its parts. What follows the last turning point is left out.
/// `reason` says so when `fit` did not converge on `used` with `options`, the recording is undersampled or too short,
/// or a part does not converge. Cost: up to ten fits of parts, some milliseconds for 2000 samples.
Constancy TestConstancy(const Recording& used, const FitReport& fit, const FitOptions& options);

}  // namespace pendulum
