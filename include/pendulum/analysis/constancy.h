// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// One physical parameter in the two halves of a recording, in the unit of the fit's parameter. Estimates ignore the
/// parameter's bounds, so friction near 0 may be negative.
struct HalvesRow {
  std::string name, unit;
  double first = 0, second = 0;
  double first_std_error = 0, second_std_error = 0;
  double z = 0;  ///< (second - first) / its standard deviation

  bool differs() const;  ///< p < kNotConstant of z.
};

/// A window of the recording. Inertia and the friction parameter with the smallest relative error are fitted again,
/// with a separate start. Standard errors include those of the parameters held at the whole fit's estimates.
struct AmplitudeRow {
  double from = 0, to = 0;                      ///< s, on the file's clock
  double amplitude = 0;                         ///< rad, mean over the window
  double inertia = 0, inertia_std_error = 0;    ///< Values in the fit's unit.
  double friction = 0, friction_std_error = 0;  ///< Values in the fit's unit; NaN if no friction has an error.
};

/// Change of a parameter with amplitude: value = a + slope · (amplitude² - mean of amplitude²).
struct AmplitudeTrend {
  std::string name, unit;  ///< Name and unit of the parameter.
  double slope = 0;        ///< unit per rad²
  double slope_std_error = 0;
  double span = 0;       ///< slope · (largest - smallest amplitude²) / estimate: the relative change over the run.
  double p = 1;          ///< Two-sided probability of a slope at least this large by chance.
  double scatter_p = 1;  ///< Probability that the windows scatter by at least this much by chance (ScatterP).

  bool has_trend() const;  ///< p < kNotConstant.
  bool scatters() const;   ///< scatter_p < kNotConstant.
};

/// Whether the parameters of a fit stay constant during its recording.
struct Constancy {
  std::vector<HalvesRow> halves;  ///< Inertia and friction, without fixed parameters.
  double halves_statistic = 0;    ///< χ² of the joint difference of all rows, with covariances (MODEL.md eq. (9.7)).
  int halves_dof = 0;
  std::optional<double> halves_p;  ///< Absent if there is no such test; `reason` gives the cause.
  std::vector<AmplitudeRow> windows;
  std::vector<AmplitudeTrend> trends;  ///< Trends of inertia and one friction parameter; empty with too few windows.
  std::optional<std::size_t> half_swings;  ///< Of the recording after its release, if its samples show them.
  std::string reason;                      ///< Why a test is missing; empty if none is.
  std::string verdict;                     ///< A sentence that names what is not constant, or says that everything is.

  bool halves_differ() const;             ///< All parameters together, or one of them: a test has p < kNotConstant.
  bool windows_differ() const;            ///< A parameter has a trend, or scatters: a test has p < kNotConstant.
  bool constant() const;                  ///< No test has p < kNotConstant.
  bool is_too_short_for_halves() const;   ///< The half swings are too few for any test.
  bool is_too_short_for_windows() const;  ///< No test can show how a parameter depends on amplitude.
};

/// The level of each of some ten tests of a recording.
inline constexpr double kNotConstant = 3e-4;

/// Fits two parts of the recording with about equal information (the earlier one is shorter) and compares them (G. C.
/// Chow, Econometrica 28:591, 1960). Each part has at least three periods after the release. Also fits three to eight
/// such windows and tests their trend with amplitude, using the covariance that the windows' estimates have if the
/// whole fit is right. Priors and values of the start belong to the whole recording and are not used for its parts.
/// Samples after the last turning point are left out. Readings are as corrected by the fit. `reason` is set if the fit
/// did not converge on the recording with `options`, the recording is undersampled or too short, or a part does not
/// converge. Cost: up to ten fits of parts, some milliseconds for 2000 samples.
Constancy TestConstancy(const Recording& recorded, const FitReport& report, const FitOptions& options);

/// The constancy of a fit that is not tested, for this reason: the half swings alone.
Constancy UntestedConstancy(const Recording& recorded, const FitReport& report, const FitOptions& options,
                            std::string reason);

}  // namespace pendulum
