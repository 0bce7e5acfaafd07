// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace pendulum {

/// What a sensor, its mounting and its clock may do to readings.
enum class SensorEffect { kGain, kCubic, kEccentricSine, kEccentricCosine, kLag, kBacklash, kDrift, kClock };

inline constexpr std::array kSensorEffects = {
    SensorEffect::kGain, SensorEffect::kCubic,    SensorEffect::kEccentricSine, SensorEffect::kEccentricCosine,
    SensorEffect::kLag,  SensorEffect::kBacklash, SensorEffect::kDrift,         SensorEffect::kClock};

/// "gain", "cubic", "eccentric_sine", "eccentric_cosine", "lag", "backlash", "drift" or "clock".
std::string_view SensorEffectName(SensorEffect effect);

/// The plausible size of one effect: a standard deviation about 0. Gain and clock are relative; the lag is in s; cubic,
/// eccentric, backlash and drift are in the unit of the readings (rad, rad/s, or Recording::value_unit). The cubic term
/// is the largest deviation from a line within the swing, the backlash the width of the gap, the drift the change of
/// the zero over the recording.
struct EffectSize {
  double std_dev = 0;  ///< 0: exact, or not to be considered.
  std::string source;  ///< "given by --sensor", "stated in the file", "calibration", "stated with the clock"; if it is
                       ///< assumed, of what: "a potentiometer", "times on an exact grid"; empty if nothing is known.
  bool is_assumed = false;  ///< Nobody stated it.

  /// "assumed for a potentiometer", "stated in the file".
  std::string SourceText() const { return is_assumed ? "assumed for " + source : source; }
};

/// The plausible sizes of all effects on a recording.
struct SensorErrors {
  std::string kind;  ///< "potentiometer", "encoder", "gyro", "accelerometer", "camera", "angle sensor" or "ideal";
                     ///< empty if not decided.
  bool is_kind_assumed = false;                         ///< Nobody stated the kind; the unit and the values suggest it.
  std::array<EffectSize, kSensorEffects.size()> sizes;  ///< In the order of kSensorEffects.

  const EffectSize& Of(SensorEffect effect) const { return sizes[static_cast<std::size_t>(effect)]; }

  EffectSize& Of(SensorEffect effect) { return sizes[static_cast<std::size_t>(effect)]; }
};

/// What a user or a file states about a sensor.
struct SensorStatement {
  std::string kind;  ///< As SensorErrors::kind; empty: not stated.
  /// In the order of kSensorEffects, in the units of EffectSize; std::nullopt: not stated, 0: exact.
  std::array<std::optional<double>, kSensorEffects.size()> std_devs;
  std::string source;  ///< EffectSize::source of what is stated: "given by --sensor" or "stated in the file".
};

/// Where the times of a recording come from, which tells how wrong the rate of their clock may be.
enum class TimeSource {
  kUnknown,   ///< Not from a file.
  kSeconds,   ///< Times in s or another unit that does not tell the clock.
  kDevice,    ///< Times in ms or us: the counter of a microcontroller.
  kGrid,      ///< Times on an exact grid, which a program may have counted instead of measuring them.
  kRate,      ///< No times, only a rate: perhaps a loop that waits for the nominal interval and also works.
  kComputer,  ///< Times of day, or stamps of a host.
  kMeasured,  ///< The file states the scale of the clock or its error (`# clock_scale`).
};

}  // namespace pendulum
