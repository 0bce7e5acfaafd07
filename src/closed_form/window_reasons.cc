// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/window_reasons.h"

#include "pendulum/base/format.h"

namespace pendulum {

std::string Sentence(const WindowBegin& begin) {
  switch (begin.reason) {
    using enum WindowBegin::Reason;
    case kUnknown: return "";
    case kAsked: return "as asked";
    case kHeld: return "held, then released";
    case kInMotion: return "the recording begins in motion";
    case kReleaseNotUsed:
      return "in motion: it was held before, but its motion determines the start better than its release";
    case kUnsteadyHold: return "after the release: the hold before it is not steady";
    case kHoldDisagrees: return "after the release: the hold before it does not agree with the swing";
    case kAccelerationJump: return "after the release, at which an acceleration jumps";
    case kAfterFall:
      return "after the fall from " + NumberText(begin.angle_deg, 3) +
             " deg: so near the top the smallest push determines when it falls, so the release is not used";
    case kAfterTurns: return "after its turns over the top";
    case kAfterMove: return "the first turning point after the pendulum was moved";
    case kAfterDrive: return "after a drive that kept the amplitude (--from 0 fits that part too)";
    case kAfterVibration:
      return "after a faster vibration of " + NumberText(begin.frequency_hz, 2) + " Hz has died away";
    case kDisturbed:
      return "the motion before it does not fit the later motion: the pendulum was touched, or follows another law";
    case kUndersampled: return "sampled too slowly to see half swings: the whole recording";
    case kUndersampledAfterFirst:
      return "sampled too slowly to see half swings: the whole recording, without the first reading, at which it may "
             "still have been held";
    case kUndersampledAfterHold:
      return "sampled too slowly to see half swings: the whole recording, without the constant readings at its start";
  }
  return "";
}

std::string Sentence(const WindowEnd& end) {
  switch (end.reason) {
    using enum WindowEnd::Reason;
    case kUnknown: return "";
    case kAsked: return "as asked";
    case kEndOfRecording: return "the end of the recording";
    case kAtRest: return "at rest from about " + NumberText(end.time, 4) + " s";
    case kBeforeMove: return "the last turning point before the pendulum is moved";
    case kBeforeStop: return "the last turning point before the pendulum is stopped";
    case kDisturbed:
      return "the motion after it does not fit the earlier motion: the pendulum was touched, or follows another law";
    case kPresliding: return "smaller swings are faster: friction acts like a spring before it slides";
    case kNotConverging: return "with the motion after it the fit does not converge";
    case kCountsLost: return "an unknown number of counts was lost after it";
  }
  return "";
}

}  // namespace pendulum
