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

/// The samples beside the fit as CSV, one line a sample in SI with every digit a double has:
/// time_s,measured_rad,fitted_rad,residual_rad,linear_closed_form_rad,nonlinear_closed_form_rad (or ..._rad_s for a
/// rate), residual = measured - fitted. used: the N samples that were fitted. Where fit or overlay have not N numbers,
/// or one that is not finite, its fields are empty.
std::string ToResidualCsv(const Recording& used, const FitReport& fit, const TextbookOverlay& overlay = {});

/// The same for fit number `fit` of an identification of one recording, with its overlay if there is one.
std::string ToResidualCsv(const Identification& one, std::size_t fit);

/// All of the series, or what the page needs: seven digits, no residuals (it takes differences), and the closed forms'
/// trajectories of the main fit alone.
enum class SeriesDetail { kAll, kPage };

/// The samples and what was made of them, beside the result: {"time_s", "measured", "unit" (of all readings),
/// "extrema": [[time_s, measured], ...] as FindExtrema sees them, "peaks": [{"number", "time_s", "time_std_error",
/// "angle_rad" (or rate_rad_s, angle_counts ...), "std_error", "zeta_pair", "zeta_pair_std_error", "zeta",
/// "zeta_std_error", "periods"}], "profiles": {model: {parameter: {"value", "statistic", "threshold"}}} as
/// ProfileCurve, "models": {name: {"fitted", "residual", "linear_closed_form", "nonlinear_closed_form"}}}. Missing
/// values are null: an array, a number in one, the profiles, the damping ratio (zeta) of a turning point that none on
/// its side follows. Of a joint identification: an array with such an object for each recording, in their order.
nlohmann::ordered_json SeriesJson(const Identification& one, SeriesDetail detail = SeriesDetail::kAll);

/// SeriesJson as one line of UTF-8 text.
std::string ToSeriesJsonText(const Identification& one);

}  // namespace pendulum
