// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/warning.h"
#include "pendulum/fitting/effects/check_effects.h"
#include "pendulum/fitting/effects/effect.h"
#include "pendulum/fitting/likelihood/noise.h"
#include "pendulum/fitting/residuals/autocorrelation.h"
#include "pendulum/fitting/residuals/residual_diagnostics.h"
#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/fitting/start/start_values.h"
#include "pendulum/fitting/uncertainty/derived.h"
#include "pendulum/fitting/uncertainty/identifiability.h"
#include "pendulum/fitting/uncertainty/open_interval.h"
#include "pendulum/fitting/uncertainty/systematic_errors.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/parameter.h"
#include "pendulum/model/sensor_model.h"
#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// How a fit ended, and which parts of its report are valid:
///                                     estimates     std_error, covariance   statistics
///   kConverged                        yes           yes                     yes
///   kNotConverged, kNotIdentifiable   best found    no                      yes
///   kFailed                           none          no                      no
enum class Termination { kConverged, kNotConverged, kNotIdentifiable, kFailed };

std::string_view TerminationName(Termination termination);

/// 0 for kConverged, 1 for the others.
int ExitCode(Termination termination);

/// One parameter after the fit, in the given unit.
struct ParameterEstimate {
  ParameterInfo info;
  std::string unit;  ///< info.unit with a rig, info.relative_unit without; counts and volts instead of rad.
  double estimate = 0;
  std::optional<double> std_error;         ///< Absent if fixed, at a bound, or not identifiable; see `reason`.
  std::optional<double> lower95, upper95;  ///< 95 % confidence interval; at a bound it begins or ends there.
  std::optional<double> t95;               ///< Student's t for 95 %: half the interval divided by std_error.
  OpenInterval open_interval = OpenInterval::kClosed;  ///< Reason for a missing end of the interval.
  SystematicErrors systematic;
  /// How far the estimate would be off, as a standard deviation in `unit`, if friction had other terms that the
  /// readings do not exclude (EffectCheck::unseen_friction).
  std::optional<double> unseen_friction;
  double hidden_friction = 0;  ///< EffectCheck::hidden_friction in `unit`; part of the error of a short recording.
  double named_friction = 0;   ///< EffectCheck::named_friction in `unit`.
  std::optional<double> closed_form;  ///< The start value, if it is a closed-form estimate (same unit).
  bool fixed = false;
  bool at_bound = false;
  std::string reason;
};

/// The noise of the samples about the trajectory, and the reason for the chosen family.
struct NoiseEstimate {
  NoiseFamily family = NoiseFamily::kGaussian;
  double sigma = 0;  ///< rad or rad/s; Gaussian: sqrt(RSS / (N - free parameters)), else the likeliest σ or scale.
  std::optional<double> sigma_std_error;  ///< Same unit.
  double resolution = 0;                  ///< Of the readings, same unit; 0: none.
  Eigen::Index censored = 0;              ///< Readings at an end of the sensor's range.
  std::string why;
  double lag1_correlation = 0;      ///< Of the quantile residuals.
  Autocorrelation autocorrelation;  ///< Of the quantile residuals: white, AR(3), ARMA(1,1) ...
  // For kEdges, as in NoiseModel.
  double stamp_ratio = 0;  ///< s/rad: standard deviation of a time stamp over sigma.
  double lag = 0;          ///< rad: the estimate of the hysteresis.
  std::optional<double> edge = std::nullopt;
  std::shared_ptr<const std::vector<double>> spread = nullptr;  ///< N
  Averaging averaging = {};                                     ///< For kAveraged, as in NoiseModel.
};

/// The likelihood along one parameter, with the others at their optimum, at M values: the basis of its profile
/// interval.
struct ProfileCurve {
  std::string name;
  std::vector<double> value;      ///< M, increasing, in the parameter's unit.
  std::vector<double> statistic;  ///< M, as ProfilePoint: 0 at the estimate, at least 0.
  double threshold = 0;           ///< Value of the statistic at the ends of the 95 % interval.
};

/// A second attempt at a poor fit, or a change of its window or readings (fit.cc, fit_swing.cc).
struct AttemptRecord {
  std::string name;
  bool kept = false;  ///< Whether the fit is the result of this attempt.
};

/// The work of the solver over all its runs.
struct SolverSummary {
  int iterations = 0;
  int evaluations = 0;  ///< Trajectories computed for the accepted start, with and without sensitivities.
  std::string termination;
  std::vector<AttemptRecord> attempts;  ///< All attempts in order; empty if none was needed.
};

/// One model fitted to one recording.
struct FitReport {
  MotionModel model;
  Termination termination = Termination::kFailed;
  std::string reason;                      ///< A sentence, for every termination.
  std::optional<WarningCode> reason_code;  ///< Of the warning that says why the fit is not converged, if one does.
  StartKind start = StartKind::kMoving;
  Quantity quantity = Quantity::kAngle;
  SensorModel sensor;
  std::string reading_unit = "rad";  ///< Of readings, residuals and noise: rad, rad/s, or the recording's unit.
  std::vector<ParameterEstimate> parameters;  ///< As FitParameters; the covariance has the same order.
  std::vector<DerivedQuantity> derived;
  std::vector<std::string> covariance_names;  ///< The free parameters that are not at a bound.
  /// M x M, M = covariance_names.size(), products of the parameters' units. Parameters at a bound are held there, which
  /// std_error does not assume.
  Eigen::MatrixXd covariance;
  std::string std_error_method, interval_method;
  std::vector<ProfileCurve> profiles;  ///< In the order of the parameters; empty unless intervals are profiles.
  std::vector<std::string> systematic_names;
  Eigen::MatrixXd systematic_covariance;  ///< K x K, K = systematic_names.size(), as covariance.
  std::vector<BudgetLine> budget;         ///< Of rig, calibration, clock and sensor; parts in the units of report.
  std::vector<Identifiability> identifiability;  ///< Of unfixed parameters; may be empty if not converged.
  NoiseEstimate noise;
  FitStatistics statistics;
  SolverSummary solver;
  StartValues start_values;           ///< Start of the search, in units of the restoring torque G.
  std::vector<Suspicion> suspicions;  ///< What the residuals suggest, the strongest first.
  Eigen::VectorXd correction;         ///< N, what was subtracted from the readings before the fit; empty: nothing.
  EffectCheck effects;                ///< Of the readings as recorded, before any correction; empty if not converged.
  std::vector<Warning> warnings;
  double trace_error = 0;  ///< Largest difference from a trajectory with a hundredth of the tolerance, rad or rad/s.
  /// N x 1, rad or rad/s: modelled (zero_angle and correction included), measured - modelled.
  Eigen::VectorXd fitted, residual;

  /// The parameter with this name, or nullptr.
  const ParameterEstimate* Find(std::string_view name) const;

  bool HasWarning(WarningCode code) const;

  /// The warning with `reason_code`; nullptr if the reason is none of the warnings.
  const Warning* ReasonWarning() const;
};

/// Ends a fit for a reason, and withdraws its errors (WithdrawErrors). `without_errors` is the reason of each
/// parameter.
void Reject(Termination termination, std::string reason, std::string_view without_errors, FitReport& fit);

/// The same for the reason that a warning gives, which is added.
void RejectFor(Termination termination, Warning why, std::string_view without_errors, FitReport& fit);

/// Removes the errors, intervals and covariance from a report in which they are not valid. Each parameter that is not
/// fixed gets the reason `why`.
void WithdrawErrors(std::string_view why, FitReport& fit);

/// Correlation of two free parameters, given by their rows in the fit's covariance; NaN if a variance is 0.
double Correlation(const FitReport& fit, Eigen::Index row, Eigen::Index column);

/// `options` with the kind of start and the noise family of `fit`, for refits that must be comparable with it. They
/// do not correct their readings, and their losses are not of interest.
FitOptions OptionsLike(const FitReport& fit, FitOptions options);

}  // namespace pendulum
