// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/model/parameter.h"
#include "pendulum/recording/sensor_errors.h"
#include "pendulum/trajectory/synthetic.h"

namespace pendulum {

/// The largest amplitude in a plan [rad].
inline constexpr double kLargestPlannedAmplitude = 2.5;

/// The base case, or the base case with one factor changed.
struct PlanRow {
  std::string_view factor;  ///< release_angle (amplitude of a moving start), duration, rate or resolution.
  std::string_view unit;    ///< rad, s, Hz, and rad/s for the resolution of a rate.
  double value = 0;         ///< Value of the factor, in `unit`; of an angle its magnitude.
  bool is_base = false;
  std::vector<std::optional<double>> std_errors;  ///< P, the smallest possible ones (CramerRaoBounds).
  std::optional<double> linear_bias;              ///< LinearInertiaBias; absent with less than one whole period.
  std::string reason;                             ///< Why there is no such recording; empty if there is one.
  SyntheticOptions run = {};                      ///< The recording.
  /// P, with rig, sensor and clock (AddTotalErrors); empty without them.
  std::vector<std::optional<double>> total_errors = {};
  std::string without_totals = {};  ///< Why its recording has no total errors; empty if it has.
};

/// Predicted accuracy of recordings of a rig; one factor varies at a time.
struct Plan {
  std::vector<ParameterInfo> parameters;  ///< P, FitParameters of the base.
  std::vector<double> truth;              ///< P, in units of the restoring torque G.
  std::size_t physical = 0;               ///< Number of inertia and friction parameters; these come first.
  std::vector<PlanRow> rows;              ///< Grouped by factor, with increasing values; each group has the base case.
  std::optional<double> noise_of_levels;  ///< q/√12 [rad or rad/s], used as the noise if the base has none.
  /// The amplitude [rad] where |linear_bias| equals the relative error of inertia, with a relative accuracy of 1e-4;
  /// the other factors are those of the base. At larger amplitudes the bias exceeds the error, except where the effects
  /// of friction and finite amplitude cancel. At smaller ones the bias is smaller than the error, or there is no whole
  /// period. May be absent.
  std::optional<double> amplitude_of_equal_bias;
  /// A fit to the simulated base case whose estimates are the true values, and whose standard errors are the bounds of
  /// the noise if there are any (AddTotalErrors). Its intervals and derived quantities are those of that recording.
  std::optional<FitReport> fit;
  SensorErrors sensor;         ///< Of that fit.
  std::string without_totals;  ///< Why there is no such fit; empty before AddTotalErrors and if there is one.
};

/// Relative error I_linear / I - 1 of the textbook's linear formulas on exact turning points (t_k, A_k), over all n
/// whole periods until `end` [s]:
/// ω_d = 2πn / (t_2n - t_0),  δ = ln(A_0 / A_2n) / n,  ζ = δ / sqrt(4π² + δ²),  I = (1 - ζ²) / ω_d² (over G).
/// Without friction it is PeriodRatio(A)² - 1. Absent with less than one whole period.
std::optional<double> LinearInertiaBias(const SyntheticOptions& run, double end);

/// Predicts standard errors for `base` with release angle × 1/4, 1/2, 1, 2 (at most 2.5 rad; a moving start keeps its
/// phase), duration × 1/2, 1, 2, 4, rate × 1/4, 1, 4 and, if there is one, resolution × 1/4, 1, 4. Levels without noise
/// have no Cramér-Rao bound; they count as white noise of q/√12, and a hold counts as one reading. kInvalidArgument:
/// neither noise nor resolution. Other errors as SimulateRecording, for the base. Cost: 40 ms for 2000 samples.
Result<Plan> MakePlan(const SyntheticOptions& base);

}  // namespace pendulum
