// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/closed_form/window_reasons.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// A faster oscillation that lies over a swing: of a string, a rod that bends, or a building.
struct Vibration {
  double frequency = 0;  ///< Hz, on the file's clock
  double amplitude = 0;  ///< Unit of the readings; sqrt(2) times its rms.
};

/// A part of a recording in which only gravity and friction move the pendulum.
struct FreeSwing {
  double from = 0, to = 0;             ///< s, file's clock; `from`: start of its hold, or first sample in motion
  double half_period = 0;              ///< s, typical
  double amplitude = 0;                ///< rad or rad/s: the largest distance of its turning points from their zero
  double amplitude_outside = 0;        ///< rad or rad/s: the same distance for turning points outside all free swings
  std::vector<double> turns;           ///< s, its turning points
  std::vector<double> heights;         ///< rad or rad/s: between successive turning points; one less than `turns`
  WindowBegin begins;                  ///< Why it begins at `from`.
  WindowEnd ends;                      ///< Why it ends at `to`.
  std::optional<LeftOut> left_out;     ///< Half swings of the free swing outside [from, to].
  double after_hold = 0;               ///< s, the first sample after its initial hold; `from` without a hold
  double hold_from = 0, hold_to = 0;   ///< s, a hold that is not steady, without the release; empty if they are equal.
  std::optional<Vibration> vibration;  ///< During all of the swing.
  bool from_given = false;             ///< The user gave `from`; to_given: the user gave `to`.
  bool to_given = false;
  bool undersampled = false;  ///< Sampled too slowly to show turning points; not examined.
  bool has_beats = false;     ///< The amplitude decays but rises again and again, which a single pendulum does not do.
};

/// The free swings of a recording in time order: runs of at least two half swings that ClassifyHalfSwings calls free. A
/// swing begins with the steady part of the hold before it. Without a hold it begins where the motion towards its first
/// turning point begins, if that motion takes no longer than a half swing. After a hold within 15 deg of the upright it
/// begins at the next turning point. It ends one period after the last motion larger than the noise, or before the
/// pendulum is touched. Small half swings that are many, or a vibration faster than the swing, do not hide it: if none
/// is found among all turning points, or if larger motion lies outside, half swings are weighed by their size, and then
/// the low band of the readings is searched. kFailedPrecondition: there is no free swing; the message states whether
/// the reading is constant, has too few turning points, is in a wrong unit, or shows a pendulum that was driven or
/// moved by hand. A spring may turn beyond 180 deg.
Result<std::vector<FreeSwing>> FindFreeSwings(const Recording& recording, bool is_spring = false);

}  // namespace pendulum
