// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/model/rig.h"

namespace pendulum {

/// Something that one free swing cannot tell from other values of the parameters: sentences without full stops.
struct Ambiguity {
  std::string cause;       ///< "a support that yields"
  std::string meaning;     ///< What the fitted number then is.
  std::string experiment;  ///< The second recording or measurement that separates it.
};

/// A support that yields adds this much to the inertia, relative to it (MODEL.md eq. (6.17)). gravity_torque: G [N m];
/// squared_frequency: (2π / period)² of the swing [1/s²]; compliance: displacement over force of the support at this
/// frequency [m/N].
double InertiaOfYieldingSupport(double gravity_torque, double squared_frequency, double gravity, double compliance);

/// The smallest stiffness of a spring parallel to gravity, relative to G, that a second swing of `amplitude` [rad]
/// shows beside a small one, at three standard deviations of the difference of their inertias (MODEL.md eq. (6.18)).
/// relative_error: of the inertia from each swing.
double SmallestVisibleSpring(double relative_error, double amplitude);

/// Inertia and friction that friction of another law, which the readings do not show, would change by more than their
/// total error (ParameterEstimate::unseen_friction).
std::vector<const ParameterEstimate*> ChangedByUnseenFriction(const FitReport& fit);

/// What a converged fit leaves ambiguous, whatever its residuals; empty for other fits. With a rig in SI units the
/// sentences have numbers of this pendulum.
std::vector<Ambiguity> AmbiguitiesOf(const FitReport& fit, const std::optional<Rig>& rig);

}  // namespace pendulum
