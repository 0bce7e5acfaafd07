// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/status.h"
#include "pendulum/fitting/autocorrelation.h"
#include "pendulum/fitting/derived.h"
#include "pendulum/fitting/identifiability.h"
#include "pendulum/fitting/noise.h"
#include "pendulum/fitting/residual_diagnostics.h"
#include "pendulum/fitting/start_values.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/rig.h"
#include "pendulum/model/sensor_model.h"
#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// What to take the noise for: kAuto takes the resolution into account where the noise does not drown it, and edges
/// where the recording has them (Recording::edge).
enum class NoiseChoice { kAuto, kGaussian, kQuantized, kEdges };

/// Robust alternatives to normal noise, for recordings with outliers.
enum class Loss { kNone, kHuber, kStudent };

/// Where intervals come from. kAuto: covariance, but profiles where any parameter is at a bound or within three
/// standard errors of one, and the posterior where counts hardly scatter. kNone: neither intervals nor
/// errors, nor what rests on them (weak identifiability, rival sensors, memory): for trials.
enum class IntervalMethod { kAuto, kCovariance, kProfile, kBootstrap, kNone };

/// What FitRecording is to do. Values by name: SI with a rig (N m, kg m^2); torques and inertia in units of G without.
struct FitOptions {
  std::string model = "coulomb";
  std::optional<Gravity> gravity;  ///< Instead of the model's own.
  StartChoice start = StartChoice::kAuto;
  std::optional<Rig> rig;
  ParameterValues fixed;
  ParameterValues initial;                  ///< Where parameters begin instead of where the data say.
  std::optional<StartValues> start_values;  ///< Complete ones, instead of those of EstimateStartValues.
  std::size_t sensor_start = 0;             ///< Of SensorStarts, the one to begin with.
  ParameterRanges bounds;                   ///< Bounds within a parameter's own.
  ParameterPriors priors;                   ///< Each adds the residual (p - mean) / std_dev; priors are no samples.
  NoiseChoice noise = NoiseChoice::kAuto;
  Loss loss = Loss::kNone;
  IntervalMethod interval = IntervalMethod::kAuto;
  std::uint64_t seed = 1;  ///< Of the bootstrap and of posterior sampling.
  int threads = 0;         ///< Of the bootstrap and long recordings; 0: all cores. The result does not depend on it.
  std::function<void(int done, int total)> progress;  ///< Called now and then by the bootstrap, from one thread.
  double max_trace_error = 1e-8;  ///< Aim for the trajectory [rad], also sigma / 1000; warned above sigma / 100.
  int max_iterations = 100;       ///< Of Ceres, for each solve.
  int max_traces = 3000;          ///< Trajectories of a fit: good recordings need tens, hopeless ones go on for ever.
  /// Once it is requested, the fit ends soon with nothing, and what is concluded from fits means nothing; default
  /// never.
  std::stop_token stop;
};

/// The error of a fit whose stop was requested before it was done: kTryAgain.
tl::unexpected<Status> FitStopped();

/// How a fit ended, and what of its report means something:
///                                     estimates     std_error, covariance   statistics
///   kConverged                        yes           yes                     yes
///   kNotConverged, kNotIdentifiable   best found    no                      yes
///   kFailed                           not any       no                      no
enum class Termination { kConverged, kNotConverged, kNotIdentifiable, kFailed };

std::string_view TerminationName(Termination termination);

/// 0 for kConverged, 1 for the others.
int ExitCode(Termination termination);

/// One parameter after the fit, in the unit given.
struct ParameterEstimate {
  ParameterInfo info;
  std::string unit;  ///< info.unit with a rig, info.relative_unit without; counts and volts instead of rad.
  double estimate = 0;
  std::optional<double> std_error;         ///< Absent when fixed, at a bound, or not identifiable; `reason` says why.
  std::optional<double> lower95, upper95;  ///< Interval of 95 %; one end is the bound when at_bound.
  std::optional<double> t95;               ///< Standard errors that reach as far as 95 %: Student's t of its samples.
  std::string open_interval;               ///< Why an end of the interval is missing; empty when none is.
  std::optional<double> systematic_std_error;  ///< From rig, clock, calibration, inconstancy; absent without.
  std::optional<double> closed_form;           ///< The start value, where it is an estimate in closed form (same unit).
  bool fixed = false;
  bool at_bound = false;
  std::string reason;
};

/// The noise of the samples about the trajectory, and why this family.
struct NoiseEstimate {
  NoiseFamily family = NoiseFamily::kGaussian;
  double sigma = 0;  ///< rad or rad/s; Gaussian: sqrt(RSS / (N - free parameters)), else the likeliest σ or scale.
  std::optional<double> sigma_std_error;  ///< Same unit.
  double resolution = 0;                  ///< Of the readings, same unit; 0: none.
  Eigen::Index censored = 0;              ///< Readings at an end of the sensor's range.
  std::string why;
  double lag1_correlation = 0;  ///< Of the quantile residuals.
  Autocorrelation memory;       ///< Of the quantile residuals: white, AR(3), ARMA(1,1) ...
  // Of edges, as in NoiseModel.
  double stamp_ratio = 0;  ///< s/rad: standard deviation of a stamp over sigma.
  double lag = 0;          ///< rad: the estimate of edge_lag.
  std::optional<double> edge = std::nullopt;
  std::shared_ptr<const std::vector<double>> spread = nullptr;  ///< N
};

/// The likelihood along one parameter, the others at their best, at M values: what its profile interval rests on.
struct ProfileCurve {
  std::string name;
  std::vector<double> value;      ///< M, increasing, in the parameter's unit.
  std::vector<double> statistic;  ///< M, as ProfilePoint: 0 at the estimate, at least 0.
  double threshold = 0;           ///< Of the statistic, where the 95 % interval ends.
};

/// What the solver did, over all its runs.
struct SolverSummary {
  int iterations = 0;
  int evaluations = 0;  ///< Trajectories of the start that was kept, with and without sensitivities.
  std::string termination;
};

/// One model fitted to one recording.
struct FitReport {
  MotionModel model;
  Termination termination = Termination::kFailed;
  std::string reason;  ///< A sentence, whatever the termination.
  StartKind start = StartKind::kMoving;
  Quantity quantity = Quantity::kAngle;
  SensorModel sensor;
  std::string reading_unit = "rad";  ///< Of readings, residuals and noise: rad, rad/s, or the recording's unit.
  std::vector<ParameterEstimate> parameters;  ///< As FitParameters: the order of covariance's rows.
  std::vector<DerivedQuantity> derived;
  std::vector<std::string> covariance_names;  ///< The free parameters that are not at a bound.
  Eigen::MatrixXd covariance;  ///< M x M, M = covariance_names.size(), products of the parameters' units.
  std::string std_error_method, interval_method;
  std::vector<ProfileCurve> profiles;  ///< In the order of the parameters; empty unless intervals are profiles.
  std::vector<std::string> systematic_names;
  Eigen::MatrixXd systematic_covariance;         ///< K x K, K = systematic_names.size(), as covariance.
  std::vector<Identifiability> identifiability;  ///< Of the parameters that are not fixed; empty when not converged.
  NoiseEstimate noise;
  FitStatistics statistics;
  SolverSummary solver;
  StartValues start_values;  ///< Where the search began, in units of G.
  std::vector<Warning> warnings;
  double trace_error = 0;  ///< Largest difference to a trajectory of a hundredth of the tolerance, rad or rad/s.
  Eigen::VectorXd fitted, residual;  ///< N x 1, rad or rad/s: modelled (zero_angle included), measured - modelled.

  /// The parameter of that name, or nullptr.
  const ParameterEstimate* Find(std::string_view name) const;

  bool Warns(std::string_view code) const;
};

/// Takes out of a report the errors, intervals and covariance, which do not hold; the free parameters say `why`.
void WithdrawErrors(std::string_view why, FitReport& fit);

/// `options` that ask for the kind of start and the noise family that `fit` came out with; a robust loss has its own.
FitOptions AskAlike(const FitReport& fit, FitOptions options);

/// Those of a quick fit whose residuals are to be looked at: by the richest law, without errors. Of `options` it has
/// the start, the loss and how it may be stopped.
FitOptions TrialOptions(const Recording& recording, const FitOptions& options, int max_traces);

/// What else a direct sensor's zero does.
enum class ZeroMotion {
  kNone,
  kDrifts,  ///< Moves with time: zero_drift or bias_drift.
  kLags,    ///< Of events: stays behind in the direction of motion, edge_lag.
};

/// The parameters of a fit in order: inertia, friction, release_angle and release_time or initial_angle and
/// initial_rate, then those of the sensor: of a direct one zero_angle or rate_bias, and the zero's motion.
std::vector<ParameterInfo> FitParameters(const MotionModel& model, StartKind start, Quantity quantity,
                                         ZeroMotion zero = ZeroMotion::kNone, const SensorModel& sensor = {});

/// Fits one model to the whole of a recording. Seconds are true ones (clock_scale), but release_time is on the file's
/// own clock. zero_drift (bias_drift of a rate) is a parameter when the options name it, and 0 otherwise; else edge_lag
/// is one of events, MODEL.md eq. (81). kInvalidArgument: no such model, a name in the options that it does not have
/// with this start, a value outside its bounds, quantized noise without a resolution, edges of a recording that has
/// none, either with a robust loss. kDataLoss: counts or volts without a calibration. kFailedPrecondition: no swing, or
/// too little of one. kTryAgain: options.stop was requested. Cost: about a millisecond for 2000 samples, three with the
/// quantized likelihood, tens where the pendulum comes to rest.
Result<FitReport> FitRecording(const Recording& recording, const FitOptions& options);

}  // namespace pendulum
