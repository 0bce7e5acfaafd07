// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/analysis/closed_form_check.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/identify/identification.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// The samples and the fit as CSV, one line per sample in SI with all digits of a double:
/// time_s,measured_rad,fitted_rad,residual_rad,linear_closed_form_rad,nonlinear_closed_form_rad (or ..._rad_s for a
/// rate), residual = measured - fitted.
/// `used`: the N fitted samples. A number that is missing or not finite gives an empty field; a curve that does not
/// have N numbers is missing in all rows.
std::string ToResidualCsv(const Recording& used, const FitReport& fit, const TextbookOverlay& overlay = {});

/// The same for fit `fit` of recording k, with its overlay if there is one.
std::string ToResidualCsv(const Identification& identification, std::size_t k, std::size_t fit);

/// kAll: the complete series. kPage: the part for the page, with seven digits, without residuals (the page computes
/// them), with the closed forms' trajectories of the main fit only, and with standard errors of fitted readings only
/// where a plot would show them.
enum class SeriesDetail { kAll, kPage };

/// The samples of each recording and the curves computed from them, in addition to the result: an array with an object
/// for each recording,
/// {"time_s", "measured", "unit" (of all readings), "extrema": [[time_s, measured], ...] from FindTurningPoints,
/// "peaks": [{"number", "time_s", "time_std_error", "angle_rad" (or rate_rad_s, angle_counts ...), "std_error",
/// "zeta_pair", "zeta_pair_std_error", "zeta", "zeta_std_error", "periods"}], "profiles": {model: {parameter:
/// {"value", "statistic", "threshold"}}} as ProfileCurve, "models": {name: {"fitted", "fitted_std_error" (of the curve,
/// from the covariance of the estimates), "residual", "linear_closed_form", "nonlinear_closed_form"}}, "motions":
/// {model: {"start_s", "interval_s", "angle_unit", "angle", "rate", "reading"}}}. Missing values are null: an array, a
/// number in an array, the profiles, or the damping ratio (zeta) of the last turning point on its side.
///
/// "motions" are the fitted motions at equal steps from the release, or from the first sample, to the last sample,
/// about 60 per period, at most 100 001 (kPage: 20 001). Point i is at start_s + i interval_s on the file's clock:
/// "angle" from the equilibrium [angle_unit], "rate" [angle_unit per true s], "reading" of the sensor [unit]. "motions"
/// is null if the samples themselves show the motion: readings of an angle, without gaps, at least 12 per period.
nlohmann::ordered_json SeriesJson(const Identification& identification, SeriesDetail detail = SeriesDetail::kAll);

/// SeriesJson as one line of UTF-8 text.
std::string ToSeriesJsonText(const Identification& identification);

}  // namespace pendulum
