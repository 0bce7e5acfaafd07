// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/model/parameter.h"
#include "pendulum/trajectory/synthetic.h"

namespace pendulum {

/// The largest amplitude a plan goes to [rad].
inline constexpr double kLargestPlannedAmplitude = 2.5;

/// The base case with one thing changed, or the base case itself.
struct PlanRow {
  std::string_view factor;  ///< release_angle (amplitude of a moving start), duration, rate or resolution.
  std::string_view unit;    ///< rad, s, Hz, and rad/s for the resolution of a rate.
  double value = 0;         ///< Of the factor, in `unit`; of an angle its size.
  bool is_base = false;
  std::vector<std::optional<double>> std_errors;  ///< P, the least possible, as CramerRaoBounds: in units of G.
  std::optional<double> linear_bias;              ///< LinearInertiaBias; absent without a whole period.
  std::string reason;                             ///< Why there is no such recording; empty when there is one.
};

/// What recordings of a rig will tell, by one factor at a time.
struct Plan {
  std::vector<ParameterInfo> parameters;  ///< P, FitParameters of the base.
  std::vector<double> truth;              ///< P, in units of G.
  std::size_t physical = 0;               ///< Of the P, inertia and friction come first.
  std::vector<PlanRow> rows;              ///< Factor by factor, values increasing; each has the base case.
  std::optional<double> noise_of_levels;  ///< q/√12 [rad or rad/s], taken for the noise where there is none.
  /// rad, to 1e-4 of itself, the rest as in the base: above it |linear_bias| exceeds inertia's relative error, but
  /// where friction and finite amplitude cancel; below it, it does not, or there is no whole period. May be absent.
  std::optional<double> amplitude_of_equal_bias;
};

/// Relative error I_linear / I - 1 of the textbook's linear formulas on turning points (t_k, A_k) without any error,
/// over all n whole periods until `end` [s]:  ω_d = 2πn / (t_2n - t_0),  δ = ln(A_0 / A_2n) / n,  ζ = δ / sqrt(4π² +
/// δ²), I = (1 - ζ²) / ω_d² (units of G). Frictionless it is PeriodRatio(A)² - 1. Absent without a whole period.
std::optional<double> LinearInertiaBias(const SyntheticOptions& run, double end);

/// Predicts standard errors for `base` with release angle × 1/4, 1/2, 1, 2 (at most 2.5 rad; a moving start keeps its
/// phase), duration × 1/2, 1, 2, 4, rate × 1/4, 1, 4 and, if there is one, resolution × 1/4, 1, 4. Levels without noise
/// have no Cramér-Rao bound: they are taken for white noise of q/√12, and a hold for one reading. kInvalidArgument:
/// neither noise nor resolution. Both codes of SimulateRecording, of the base. Cost: 40 ms for 2000 samples.
Result<Plan> MakePlan(const SyntheticOptions& base);

}  // namespace pendulum
