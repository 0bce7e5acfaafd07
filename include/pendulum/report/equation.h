// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/rig.h"

namespace pendulum {

/// The equation of motion in the symbols of MODEL.md, with the model's friction law: "I_O th'' + b th' + τ_c sgn(th') +
/// G sin th = 0". th is the angle from hanging straight down.
std::string SymbolicEquation(const MotionModel& model);

/// Which error rounds the numbers of an equation: with kOfTotalError the digits are those that one may quote, with
/// kOfStdError those that simulate the fitted swing.
enum class EquationDigits { kOfStdError, kOfTotalError };

/// The equation with the fitted numbers: "0.0790 th'' + 0.0030 th' + 0.0010 sgn(th') + 1.80 sin th = 0" in N m with a
/// rig, in units of the restoring torque G without one. Each number is rounded by its error (PdgRounding), to
/// four significant digits if it has none. G has as many digits as the inertia: a swing determines only their ratio.
std::string FittedEquation(const FitReport& fit, const std::optional<Rig>& rig,
                           EquationDigits digits = EquationDigits::kOfStdError);

/// The equation without terms whose factor is 0: "0.079 th'' + sin th = 0" from "0.079 th'' + 0 sgn(th') + sin th = 0".
std::string WithoutZeroTerms(std::string equation);

}  // namespace pendulum
