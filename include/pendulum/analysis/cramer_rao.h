// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "pendulum/model/parameter.h"
#include "pendulum/trajectory/synthetic.h"

namespace pendulum {

/// The parameters of a fit to a simulated recording, in the order of TrueParameters.
std::vector<ParameterInfo> ParametersOf(const SyntheticOptions& run);

/// The Cramér-Rao bound of each parameter of a simulated recording: no unbiased estimate has a smaller standard
/// deviation. The bound is for the simulated noise, with its size unknown; J (N x P): the readings' sensitivities at
/// the true values.
///   white Gaussian noise     JᵀJ / σ²; on levels the sum of ReadingInformation, with the sensor's range
///   AR(1) noise              Jᵀ R^-1 J; levels of spacing q count as additional white noise of variance q²/12
///   Student's t noise        (ν + 1) / (ν + 3) JᵀJ / s², with the scale s
///   edges of an encoder      JᵀWJ, 1 / W = variance of an edge + (rate · standard deviation of a time stamp)²
///
/// time N, s, increasing: the time stamps of the samples, from SimulateRecording.
/// Returns P in FitParameters' order, in the units of `truth` (torques and inertia in units of the restoring torque G).
/// All bounds are absent:
/// - without noise, except for edges,
/// - for an encoder read at equal intervals, and for means of several readings,
/// - for a sensor whose parameters have priors,
/// - for a range, unless the noise is white Gaussian noise on levels,
/// - for Student's t noise that is correlated or on levels,
/// - if the trajectory cannot be computed.
/// A single bound is absent if the readings do not determine that parameter.
std::vector<std::optional<double>> CramerRaoBounds(const SyntheticOptions& truth, const Eigen::VectorXd& time);

/// One of several recordings of one rig: its true values, and the time stamps of its samples (N, s).
struct SimulatedRun {
  SyntheticOptions truth;
  Eigen::VectorXd time;
};

/// The bounds of inertia and friction shared by all recordings; each recording has a separate start, zero and noise.
std::vector<std::optional<double>> SharedCramerRaoBounds(const std::vector<SimulatedRun>& runs);

}  // namespace pendulum
