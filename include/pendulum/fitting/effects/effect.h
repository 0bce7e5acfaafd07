// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pendulum {

/// What may make readings differ from a fitted law. The first five act in the sensor, the next two at the release, the
/// others are friction that the law does not have.
enum class Cause {
  kGain,              ///< The readings are proportional to the motion, but by another factor.
  kNonlinearity,      ///< The sensor's curve is bent, or the sensor is eccentric.
  kLag,               ///< The readings are late.
  kBacklash,          ///< The sensor follows with a play.
  kDrift,             ///< The zero moves during the recording.
  kPush,              ///< The pendulum was pushed at the release, or let go slowly.
  kHold,              ///< The pendulum was not held still at the angle of the release.
  kFrictionLaw,       ///< Friction depends on the rate in another way.
  kPositionFriction,  ///< Dry friction depends on the angle or the load.
  kPresliding,        ///< Dry friction builds up after each reversal.
};

inline constexpr std::array kCauses = {
    Cause::kGain, Cause::kNonlinearity, Cause::kLag,         Cause::kBacklash,         Cause::kDrift,
    Cause::kPush, Cause::kHold,         Cause::kFrictionLaw, Cause::kPositionFriction, Cause::kPresliding};

/// "gain", "nonlinearity", "lag", "backlash", "drift", "push", "hold", "friction_law", "position_friction",
/// "presliding".
std::string_view CauseName(Cause cause);

/// Whether the cause acts in the sensor: it has a plausible size (SensorErrors), and belongs to the error budget.
constexpr bool IsOfSensor(Cause cause) { return cause <= Cause::kDrift; }

/// Whether the readings can be corrected for the cause: it does not change the law of friction.
constexpr bool IsCorrectable(Cause cause) { return cause <= Cause::kHold; }

/// One cause and how strongly the residuals suggest it.
struct Suspicion {
  Cause cause = Cause::kGain;
  /// Of a single effect its size, with a sign; of a play its width. Of several, and of friction, the largest change of
  /// the readings by them, without what the parameters take up.
  double size = 0;
  double std_error = 0;       ///< Of `size`.
  std::string unit;           ///< Of size and std_error: "1" for the gain, "s" for the lag, else that of the readings.
  double significance = 0;    ///< Standard deviations of a normal variable.
  bool is_corrected = false;  ///< The estimates are those of readings that were corrected for it.
};

}  // namespace pendulum
