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
    case kInMotion: return "in motion";
    case kReleaseNotUsed: return "in motion, which determines the start better than the release before";
    case kUnsteadyHold: return "after the release: the hold before it is not steady";
    case kHoldDisagrees: return "after the release: the hold before it does not agree with the swing";
    case kAccelerationJump: return "after the release, at which an acceleration jumps";
    case kAfterFall:
      return "after the fall from " + NumberText(begin.angle_deg, 3) +
             " deg: so near the top the smallest push determines when it falls, so the release is not used";
    case kAfterTurns: return "after its whole turns";
    case kAfterGap: return "after a gap that hides too many swings to bridge";
    case kAfterMove: return "first turning point after the pendulum was moved";
    case kAfterDrive: return "after a drive that kept the amplitude; --from 0 fits that too";
    case kAfterVibration:
      return "after a faster vibration of " + NumberText(begin.frequency_hz, 2) + " Hz has died away";
    case kDisturbed: return "the motion before does not fit: a touch, or another law";
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
    case kEndOfRecording: return "end of recording";
    case kAtRest: return "at rest from about " + NumberText(end.time, 4) + " s";
    case kBeforeGap:
      return "a gap of " + NumberText(end.gap_to - end.time, 3) + " s follows, which hides too many swings to bridge";
    case kBeforeMove: return "last turning point before the pendulum is moved";
    case kBeforeStop: return "last turning point before the pendulum is stopped";
    case kDisturbed: return "the motion after does not fit: a touch, or another law";
    case kPresliding: return "smaller swings are faster: friction acts like a spring before it slides";
    case kNotConverging: return "with the motion after it the fit does not converge";
    case kCountsLost: return "an unknown number of counts was lost after it";
  }
  return "";
}

std::string Sentence(const LeftOut& left_out) {
  constexpr double kMatters = 1.05;
  const std::string count = std::to_string(left_out.half_swings), all = std::to_string(left_out.all) + " half swings";
  const std::string what = !left_out.is_largest        ? count + " of " + all
                           : left_out.half_swings == 1 ? "the largest of " + all
                                                       : count + " of " + all + ", also the largest";
  const double errors = left_out.larger_errors;
  return what + ": " +
         (errors < kMatters ? "the period's error hardly changes" : "the period's error × " + NumberText(errors, 2));
}

}  // namespace pendulum
