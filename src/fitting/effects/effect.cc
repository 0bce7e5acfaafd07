// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/effects/effect.h"

namespace pendulum {

std::string_view CauseName(Cause cause) {
  switch (cause) {
    case Cause::kGain: return "gain";
    case Cause::kNonlinearity: return "nonlinearity";
    case Cause::kLag: return "lag";
    case Cause::kBacklash: return "backlash";
    case Cause::kDrift: return "drift";
    case Cause::kPush: return "push";
    case Cause::kHold: return "hold";
    case Cause::kFrictionLaw: return "friction_law";
    case Cause::kPositionFriction: return "position_friction";
    case Cause::kPresliding: return "presliding";
  }
  return "";
}

}  // namespace pendulum
