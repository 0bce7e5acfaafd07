// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>

#include "pendulum/base/progress.h"
#include "pendulum/base/status.h"
#include "pendulum/base/warning.h"
#include "pendulum/fitting/likelihood/noise.h"
#include "pendulum/fitting/start/start_values.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/parameter.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// How confidence intervals are computed.
enum class IntervalMethod {
  kAuto,        ///< From the covariance; near a bound kProfile; from the posterior if quantized noise is very small.
  kCovariance,  ///< Estimate plus or minus Student's t times the standard error.
  kProfile,     ///< From the profile likelihood. kAuto uses it within three standard errors of a bound.
  kBootstrap,   ///< From refits of recordings with simulated or resampled noise.
  kNone,        ///< For trial fits: no errors, intervals or autocorrelation.
};

/// How the search for the solution runs. Trial fits and refits change it; users do not.
struct SearchOptions {
  std::optional<StartValues> start_values;  ///< Replaces EstimateStartValues; all values must be set.
  std::size_t sensor_start = 0;             ///< Index into SensorStarts.
  double vibration_period = 0;              ///< Of a vibration that start values must not see [s]; 0: none.
  /// Target error of the trajectory [rad]; sigma / 1000 if that is smaller. Warning above sigma / 100.
  double max_trace_error = 1e-8;
  int max_iterations = 100;  ///< Limit for the iterations of Ceres in each run.
  int max_traces = 3000;     ///< Trajectories per fit. A good recording needs tens; the limit ends failing fits.
  /// Whether the readings are corrected for suspected causes; not where laws are compared: they need the same readings.
  bool may_correct = true;
  bool may_doubt_gravity = true;  ///< Whether the name of an acceleration may be wrong about gravity in it.
};

/// The user's options for a fit. Values by name are in SI with a rig (N m, kg m^2); without a rig, torques and inertia
/// are in units of the restoring torque G.
struct FitOptions {
  std::string model = "coulomb";
  std::optional<Gravity> gravity;  ///< Replaces the model's own.
  /// The user gave no law of gravity, and the rig does not say that this is a pendulum: FitSwing may take a linear
  /// restoring torque instead of gravity if the recording shows it.
  bool may_be_spring = false;
  std::optional<StartKind> start;  ///< std::nullopt: decided from the readings.
  std::optional<Rig> rig;
  ParameterValues fixed;
  ParameterValues initial;  ///< Initial values that replace those estimated from the readings.
  ParameterRanges bounds;   ///< In addition to a parameter's own bounds.
  ParameterPriors priors;   ///< Each adds the residual (p - mean) / std_dev. A prior is not counted as a sample.
  /// std::nullopt: kEdges if the recording has edges (Recording::edge), kQuantized if the noise is smaller than the
  /// resolution, otherwise kGaussian.
  std::optional<NoiseFamily> noise;
  IntervalMethod interval = IntervalMethod::kAuto;
  bool with_losses = false;  ///< Whether the derived quantities contain the shares of the losses (LossQuantities).
  std::uint64_t seed = 1;    ///< For the bootstrap and posterior sampling.
  int threads = 0;           ///< For the bootstrap and long recordings; 0: all cores. The result does not depend on it.
  ProgressSink progress;     ///< Told of each fit, comparison and test, and how far a bootstrap is.
  SearchOptions search;
  /// Once a stop is requested, the fit ends soon with kTryAgain and its results are discarded. Default: never.
  std::stop_token stop;
};

/// The error of a fit that was stopped on request: kTryAgain.
inline tl::unexpected<Status> FitStopped() {
  return Error(
      StatusCode::kTryAgain,
      "the fit was stopped before it was done; give it more time, or ask for fewer models, a shorter window or "
      "intervals by covariance");
}

/// The rig that converts to SI; nullptr: torques and inertia are in units of the restoring torque G.
const Rig* SiRig(const FitOptions& options);

/// The model of the options, with their law of gravity. Errors as FindMotionModel.
Result<MotionModel> ModelOf(const FitOptions& options);

/// Options of a quick trial fit whose residuals are to be inspected: the richest law (drag), without errors. The law of
/// gravity, the start, a robust noise family, threads and stop are those of `options`.
FitOptions TrialOptions(const Recording& recording, const FitOptions& options, int max_traces);

}  // namespace pendulum
