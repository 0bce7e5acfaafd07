// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/analysis/difference_causes.h"
#include "pendulum/closed_form/closed_forms.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// One quantity from a closed form and from the fit, both in `unit`.
struct ClosedFormRow {
  std::string quantity;  ///< "inertia_small_angle": the quantity and its formula; unique among the rows.
  std::string method;    ///< The formula in words.
  std::string unit;      ///< Unit of the fit's parameter: SI with a rig, units of the restoring torque G without.
  double closed_form = 0;
  std::optional<double> std_error;  ///< Standard error of closed_form, if there is one.
  double fit = 0;
  std::optional<double> fit_std_error;  ///< 0 if the parameter was fixed.
  /// Difference over its standard deviation. The closed form and the fit use the same readings; the standard deviation
  /// of their difference is then sqrt(se² - se_fit²) (J. A. Hausman, Econometrica 46:1251, 1978). If residuals are
  /// autocorrelated, or the difference of variances is small, it is computed from the response of both estimates to
  /// noise with the autocorrelation of the residuals (MODEL.md eq. (6.11)). Absent without a standard error.
  std::optional<double> z;
  std::optional<bool> agrees;  ///< |z| < kAgrees
  std::string why;             ///< Cause of a difference, or of a missing z; empty if closed form and fit agree.
  std::optional<DifferenceCause> cause = std::nullopt;  ///< The largest cause of a difference that was split.
};

inline constexpr double kAgrees = 3;
inline constexpr double kUnexplained = 5;  // in |z|, so that some ten rows alarm by chance in 1 of 100,000 recordings

/// Trajectories with the textbook's numbers: inertia and viscous friction from the linear formulas, start and zero from
/// the fit. Values at the N used samples; empty if the linear formulas gave no numbers.
struct TextbookOverlay {
  Eigen::VectorXd linear, nonlinear;                         ///< N, rad or rad/s: small-angle and sine gravity.
  double linear_rms = 0, nonlinear_rms = 0, fitted_rms = 0;  ///< rad or rad/s, of measured - modelled.
  std::string summary;                                       ///< Says which model is nearer to the readings, and why.
};

/// Comparison of a fit with the closed forms of the same recording.
struct ClosedFormCheck {
  std::vector<ClosedFormRow> rows;
  TextbookOverlay overlay;
  std::string summary;  ///< Says how many rows agree.
  /// How the readings differ from the fitted law, if a closed form is at least kUnexplained from the fit for no reason
  /// of its formula, or the turning points exclude the law (ClosedForms::wrong_law); otherwise empty.
  std::string unexplained;
};

/// Compares a fit with the closed forms of its model, and with the inertia from the rig's geometry; empty for a fit
/// that is kFailed. To find the cause of a difference, the formula is applied to the fitted model's trajectory: with
/// small angles, with the fitted angles, at the recording's time stamps, and on the sensor's levels (MODEL.md eq.
/// (6.12)). `used` holds the fitted samples. After a stop request the function returns early and its rows are
/// meaningless. Cost: a few milliseconds; tens of milliseconds if something differs; seconds with thousands of turning
/// points.
ClosedFormCheck CheckClosedForms(const Recording& used, const ClosedForms& forms, const FitReport& fit,
                                 const std::optional<Rig>& rig, const std::stop_token& stop = {});

}  // namespace pendulum
