// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/model/rig.h"

namespace pendulum {

/// The fitted inertia against the one that the rig gives or that follows from its geometry.
struct RigVerdict {
  double geometric = 0, fitted = 0;  ///< kg m²
  double excess = 0;                 ///< fitted / geometric - 1
  std::optional<double> z;  ///< (fitted - geometric) / standard deviation of this difference; absent if the fit
                            ///< gives no error.
  std::string finding;      ///< The verdict, or why there is none.
  std::string advice;       ///< What to do if they differ; otherwise empty.
  std::string brief;        ///< If they differ: what, by how much, why and what to do, in few words; otherwise empty.

  bool differs() const;      ///< |z| > kRigDiffers
  std::string text() const;  ///< Finding and advice, a sentence without full stop.
};

inline constexpr double kRigDiffers = 3;

/// Judges a converged fit. The standard deviation contains the rig's errors, which act on both inertias (MODEL.md eq.
/// (6.10)), all other errors of the fit, statistical and systematic, and 5 % if the geometry takes the bob for a point.
/// std::nullopt if the fit did not converge, the rig gives no inertia to compare with, or the inertia was fixed.
std::optional<RigVerdict> JudgeInertia(const std::optional<Rig>& rig, const FitReport& fit);

/// The standard deviation of a fitted inertia by all but the rig's errors, which the rig's own inertia shares.
double ErrorBesideRig(const ParameterEstimate& inertia);

/// The error of an inertia from masses and lengths, which takes the bob for a point at the end of the rod (MODEL.md eq.
/// (1.3)): a bob's extent, a clamp or a shaft change it by some percent. 0 if the rig states its inertia.
double PointBobError(const Rig& rig, double geometric);

}  // namespace pendulum
