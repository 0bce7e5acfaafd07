// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/identifiability.h"

#include <algorithm>
#include <array>

#include "pendulum/model/parameter.h"

namespace pendulum {

std::string_view VerdictName(Identifiability::Verdict verdict) {
  switch (verdict) {
    case Identifiability::Verdict::kIdentifiable: return "identifiable";
    case Identifiability::Verdict::kWeakly: return "weakly identifiable";
    case Identifiability::Verdict::kNotIdentifiable: return "not identifiable";
  }
  return "identifiable";
}

std::string MeasurementFor(std::string_view parameter) {
  struct Advice {
    std::string_view parameter;
    std::string_view measurement;
  };
  static constexpr std::array kAdvice = {
      Advice{kInertia.name, "record more periods"},
      Advice{kReleaseAngle.name, "record the hold for longer"},
      Advice{kReleaseTime.name, "record the hold and the first swing, with more samples per second"},
      Advice{kInitialAngle.name, "record the first swing with more samples per second"},
      Advice{kInitialRate.name, "record the first swing with more samples per second"},
      Advice{kZeroAngle.name, "record until the swing is small"},
      Advice{kRateBias.name, "record the sensor at rest too"},
      Advice{kZeroDrift.name, "record for longer"},
      Advice{kBiasDrift.name, "record for longer"},
      Advice{kRateScale.name, "turn the gyro by a known angle, and give --prior rate_scale=k:std_dev"},
      Advice{kAccelerationBias.name, "record the sensor at rest in two opposite positions"},
      Advice{kAccelerationScale.name, "record the sensor at rest in two opposite positions"},
      Advice{kAxis.name, "record the sensor at rest as it is mounted, with the pendulum hanging"},
      Advice{kRadius.name, "measure the distance from the pivot, and give --prior radius=r:std_dev"},
      Advice{kHysteresis.name, "record a larger swing"},
      Advice{kPivotX.name, "mark the pivot in the picture, and give --prior pivot_x=x:std_dev"},
      Advice{kPivotY.name, "mark the pivot in the picture, and give --prior pivot_y=y:std_dev"},
  };
  const auto* const found = std::ranges::find(kAdvice, parameter, &Advice::parameter);
  if (found != kAdvice.end()) return std::string(found->measurement);
  // Friction laws differ in how the loss depends on amplitude.
  return "release from a larger angle and record until the swing is small, or fix it at a value from another "
         "measurement";
}

}  // namespace pendulum
