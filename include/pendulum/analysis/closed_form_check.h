// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/closed_form/closed_forms.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// One quantity by a closed form and by the fit, in the unit given.
struct ClosedFormRow {
  std::string quantity;  ///< "inertia_small_angle": what, and by which formula; no two rows alike.
  std::string method;    ///< The formula in words.
  std::string unit;      ///< As the fit's parameter: SI with a rig, units of G without.
  double closed_form = 0;
  std::optional<double> std_error;  ///< Of closed_form; absent where a rig gives none.
  double fit = 0;
  std::optional<double> fit_std_error;  ///< 0 for what was held.
  /// Difference over its standard deviation. Both come from the same readings, so that is sqrt(se² - se_fit²) (J. A.
  /// Hausman, Econometrica 46:1251, 1978); where residuals have memory, or that difference is small, what both
  /// estimates make of noise with that memory (MODEL.md eq. (37)). Absent where there is no error.
  std::optional<double> z;
  std::optional<bool> agrees;  ///< |z| < kAgrees
  std::string why;             ///< Why they differ, as computed; why there is no z; empty where they agree.
};

inline constexpr double kAgrees = 3;

/// What the textbook's numbers make of the recording: trajectories from the fit's start and zero with the inertia and
/// the viscous friction of the linear formulas. For N samples; empty where there are no such numbers.
struct TextbookOverlay {
  Eigen::VectorXd linear, nonlinear;                         ///< N, rad or rad/s: small-angle and sine gravity.
  double linear_rms = 0, nonlinear_rms = 0, fitted_rms = 0;  ///< rad or rad/s, of measured - modelled.
  std::string summary;                                       ///< Which is nearer, and why.
};

/// A fit beside the closed forms of the same recording.
struct ClosedFormCheck {
  std::vector<ClosedFormRow> rows;
  TextbookOverlay overlay;
  std::string summary;  ///< How many agree.
};

/// Compares a fit that is not kFailed with closed forms of its model, and with the inertia that the rig's geometry
/// gives. A difference is traced to its cause by applying the formula to the fitted model's own trajectory: with small
/// angles, with its own, at the recording's own instants and on the sensor's levels (MODEL.md eq. (38)). `used` is what
/// was fitted. Once a stop is requested it ends soon, with rows that mean nothing. Cost: some milliseconds, some tens
/// where something differs, seconds where turning points are thousands.
ClosedFormCheck CheckClosedForms(const Recording& used, const ClosedForms& forms, const FitReport& fit,
                                 const std::optional<Rig>& rig, const std::stop_token& stop = {});

}  // namespace pendulum
