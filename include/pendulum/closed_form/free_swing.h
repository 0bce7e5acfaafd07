// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pendulum/recording/recording.h"

namespace pendulum {

inline constexpr std::string_view kHeld = "held, then released";
inline constexpr std::string_view kInMotion = "the recording begins in motion";

/// A stretch of a recording in which nothing but gravity and friction moves the pendulum.
struct FreeSwing {
  double from = 0, to = 0;       ///< s, file's clock; `from`: where its hold begins, or its first sample in motion
  double half_period = 0;        ///< s, typical
  double amplitude = 0;          ///< rad or rad/s: the largest distance of a turning point from its zero
  double amplitude_outside = 0;  ///< rad or rad/s: the same of what belongs to no free swing of the recording
  std::vector<double> turns;     ///< s, its turning points
  std::string begins, ends;      ///< Why it begins and ends there, to follow "begins: " and "ends: ".
  double behind_hold = 0;   ///< s, the first sample behind the hold that it begins with; `from` where there is none
  bool from_given = false;  ///< The user chose `from`; likewise:
  bool to_given = false;
  bool undersampled = false;  ///< Sampled too slowly to show turning points: not looked into.
  bool beats = false;         ///< The amplitude rises again and again, though it decays: no single pendulum does that.
};

/// The free swings of a recording in time order: runs of two half swings and more that JudgeHalfSwings calls free. A
/// swing begins with the steady part of the hold before it, or where the motion towards its first turn begins if that
/// takes no longer than a half swing; held within 15 deg of the upright, at the next turn. It ends one period after the
/// last motion that stands out of the noise, or before it is touched.
/// kFailedPrecondition: none; the message says whether it is constant, does not turn, is driven, or was moved by hand.
Result<std::vector<FreeSwing>> FindFreeSwings(const Recording& recording);

}  // namespace pendulum
