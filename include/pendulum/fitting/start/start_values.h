// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "pendulum/closed_form/energy_balance.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// Start of a fit, estimated from the data alone.
struct StartValues {
  StartKind start = StartKind::kMoving;
  std::vector<double> parameters;  ///< As TrajectoryCost's: torques over G, times from the first sample.
  double latest_release = 0;     ///< s from the first sample: the first sample visibly in motion; 0 for a moving start.
  bool short_hold = false;       ///< Held for less than half a period: the hold may be a turning point.
  double amplitude = 0;          ///< rad, the largest amplitude.
  double natural_frequency = 0;  ///< rad/s
  EnergyBalance energy_balance;  ///< Also gives the friction of the simpler laws.
  /// Energy balances at other reference rates, if the law has a reference rate. They give alternative starts.
  std::vector<EnergyBalance> other_balances;
};

/// Estimates the inertia from the zero crossings, friction from the energy balance, the zero from the turning points,
/// and the start: a release, or the first angle and rate. If `choice` is empty, a release is assumed when the reading
/// stays constant at first for at least a tenth of a period. kFailedPrecondition: the data contain no swing (see
/// FindTurningPoints), or kRelease was requested and no held part exists. A friction law that is not linear in its
/// parameters needs its own start values here.
Result<StartValues> EstimateStartValues(const Recording& recording, const MotionModel& model,
                                        std::optional<StartKind> choice);

}  // namespace pendulum
