// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "pendulum/fitting/likelihood/fit_parameters.h"
#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/fitting/solve/solve.h"
#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/fitting/start/start_values.h"

namespace pendulum {

/// A recording prepared for the solver: all quantities in units of the restoring torque G, times from the first sample.
struct FitProblem {
  MotionModel model;
  StartValues start;                    ///< As estimated from the data, before fixed values are applied.
  std::vector<ParameterInfo> infos;     ///< P
  std::vector<double> si_per_internal;  ///< P; reported value = si_per_internal · internal + offset.
  std::vector<double> offset;           ///< P; for release_time the clock at the first sample, else 0.
  std::vector<double> first_guess;      ///< P, internal: start values with fixed values applied.
  TrajectoryData data;
  ZeroMotion zero_motion = ZeroMotion::kNone;
  SolveOptions solve;
  std::size_t sensor_starts = 1;  ///< Number of possible sensor starts; `start` is one of them.
  bool restricted = false;        ///< The user fixed or bounded parameters, or gave priors.
  std::vector<PriorTerm> priors;
  NoiseModel noise;           ///< Noise at the start of a search (σ is data.scale).
  Eigen::Index censored = 0;  ///< Number of censored readings.
  double resolution = 0;      ///< Of the readings; 0: none.
  /// How the samples are means of rounded readings; noise.averaging has its counts. One reading if they are none, or if
  /// their levels are not known.
  Oversampling oversampling;

  /// Converts parameter i from internal to reported units, and back.
  double Reported(std::size_t i, double internal) const { return si_per_internal[i] * internal + offset[i]; }
  double Internal(std::size_t i, double reported) const { return (reported - offset[i]) / si_per_internal[i]; }

  /// Index of the first angle: release_angle or initial_angle.
  std::size_t angle() const { return static_cast<std::size_t>(solve.last_friction) + 1; }

  /// Index of the parameter of that name; std::nullopt if there is none.
  std::optional<std::size_t> Find(std::string_view name) const;

  /// Index of the zero, which is the first parameter of the sensor.
  std::size_t zero() const { return static_cast<std::size_t>(solve.last_friction) + 3; }

  /// A σ below this is rounding error: a millionth of the data's scale.
  double negligible_sigma() const { return 1e-6 * data.scale; }

  /// Root mean square of the residuals of readings that are neither censored nor silences.
  double RmsResidual(const Eigen::VectorXd& readings) const;

  /// Share of the readings' variance that a trajectory does not explain. A censored reading counts as explained if the
  /// trajectory exceeds it.
  double UnexplainedShare(const Eigen::VectorXd& readings) const;
};

/// The first guess for a simpler law. Parameters fixed in addition to those of the problem are at their lower bound;
/// the other friction parameters balance the energy without them.
std::vector<double> FirstGuess(const FitProblem& problem, const std::vector<bool>& fixed);

/// Whether the model and the options suit the readings. Cheap. Returns the errors of FitRecording that no start value
/// and no fit is needed for.
Result<void> CheckReadings(const Recording& recording, const FitOptions& options);

/// Takes start values from the data, and bounds and fixed values from the options. Returns the errors of FitRecording.
Result<FitProblem> MakeFitProblem(const Recording& recording, const FitOptions& options);

}  // namespace pendulum
