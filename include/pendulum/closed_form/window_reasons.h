// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace pendulum {

/// Why a window begins where it does.
struct WindowBegin {
  enum class Reason {
    kUnknown,
    kAsked,                   ///< The user gave it.
    kHeld,                    ///< The steady end of a hold; then the pendulum was released.
    kInMotion,                ///< The recording begins in motion.
    kReleaseNotUsed,          ///< It was held, but the motion determines the start better than the release.
    kUnsteadyHold,            ///< After a release from a hold that is not steady.
    kHoldDisagrees,           ///< After a release from a hold whose readings do not agree with the swing.
    kAccelerationJump,        ///< After the release, at which an acceleration jumps.
    kAfterFall,               ///< After a fall from near the upright, from `angle_deg`.
    kAfterTurns,              ///< After turns over the top.
    kAfterGap,                ///< After a long gap.
    kAfterMove,               ///< The first turning point after the pendulum was moved.
    kAfterDrive,              ///< After a drive has kept the amplitude.
    kAfterVibration,          ///< After a vibration with `frequency_hz` has died away.
    kDisturbed,               ///< The motion before the window does not fit the later motion.
    kUndersampled,            ///< The recording is undersampled: all of it is used.
    kUndersampledAfterFirst,  ///< As kUndersampled: all except the first reading.
    kUndersampledAfterHold,   ///< As kUndersampled: all except the hold.
  };
  Reason reason = Reason::kUnknown;
  double angle_deg = 0;
  double frequency_hz = 0;
};

/// Why a window ends where it does.
struct WindowEnd {
  enum class Reason {
    kUnknown,
    kAsked,  ///< The user gave it.
    kEndOfRecording,
    kAtRest,         ///< The pendulum is at rest from about `time`.
    kBeforeGap,      ///< A long gap follows, from `time` to `gap_to`.
    kBeforeMove,     ///< The last turning point before the pendulum is moved.
    kBeforeStop,     ///< The last turning point before the pendulum is stopped.
    kDisturbed,      ///< The motion after the window does not fit the earlier motion.
    kPresliding,     ///< From there on swings are faster, as friction acts like a spring.
    kNotConverging,  ///< A fit that includes the motion after the window does not converge.
    kCountsLost,     ///< After the window an unknown number of counts was lost.
  };
  Reason reason = Reason::kUnknown;
  double time = 0, gap_to = 0;  ///< s, file's clock
};

/// What a window leaves out of a free swing.
struct LeftOut {
  int half_swings = 0;      ///< At least one.
  int all = 0;              ///< Half swings of the free swing.
  bool is_largest = false;  ///< The largest half swing is among those left out.
  /// Error of the period divided by its error with all half swings, if the law held for all.
  double larger_errors = 1;
};

/// The reason in words, after "begins: " or "ends: "; empty for kUnknown.
std::string Sentence(const WindowBegin& begin);
std::string Sentence(const WindowEnd& end);

/// What it costs in words, after "left out: ".
std::string Sentence(const LeftOut& left_out);

}  // namespace pendulum
