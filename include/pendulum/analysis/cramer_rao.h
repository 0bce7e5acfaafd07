// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "pendulum/model/parameter.h"
#include "pendulum/trajectory/synthetic.h"

namespace pendulum {

/// The parameters of a fit to a simulated recording, as TrueParameters has them.
std::vector<ParameterInfo> ParametersOf(const SyntheticOptions& run);

/// The Cramér-Rao bound of each parameter of a simulated recording: no unbiased estimate has a smaller standard
/// deviation. Of the noise actually simulated, its size unknown; J (N x P): the readings' sensitivities at the truth.
///   white Gaussian noise     JᵀJ / σ², or with levels Σ of ReadingInformation, cut off by the range
///   AR(1) noise              Jᵀ R^-1 J; levels of spacing q count as additional white noise of variance q²/12
///   Student's t noise        (ν + 1) / (ν + 3) JᵀJ / s², s its scale
///
/// time N, s, increasing: the instants of the samples, from SimulateRecording.
/// Returns P in FitParameters' order, in the units of `truth` (torques and inertia in units of G). Absent, all of them,
/// for no noise, a range with other than white Gaussian noise on levels, Student's t noise that is correlated or on
/// levels, and a motion that cannot be traced; absent, each, where the readings do not tell the parameter.
std::vector<std::optional<double>> CramerRaoBounds(const SyntheticOptions& truth, const Eigen::VectorXd& time);

/// One of several recordings of one rig: its truth, and the instants of its samples (N, s).
struct SimulatedRun {
  SyntheticOptions truth;
  Eigen::VectorXd time;
};

/// The bounds of inertia and friction, which all the recordings share, each with a start, zero and noise of its own.
std::vector<std::optional<double>> SharedCramerRaoBounds(const std::vector<SimulatedRun>& runs);

}  // namespace pendulum
