// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "pendulum/closed_form/energy_balance.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// Where a fit begins, found from the data alone.
struct StartValues {
  StartKind start = StartKind::kMoving;
  std::vector<double> parameters;  ///< In TrajectoryCost's order: units of G, times from the first sample.
  double latest_release = 0;       ///< s from the first sample: the first visibly moving one; 0 for a moving start.
  bool short_hold = false;         ///< Held for less than half a period: it may be a turning point.
  double amplitude = 0;            ///< rad, the largest.
  double natural_frequency = 0;    ///< rad/s
  EnergyBalance energy_balance;    ///< Gives the friction of simpler laws too.
  std::vector<EnergyBalance>
      other_balances;  ///< At other reference rates, where the law has one: starts to fall back on.
};

/// Inertia from the crossings, friction from the energy balance, zero from the turning points, and a release or the
/// first angle and rate. Without a choice, a release is taken if the reading at first stays put for at least a tenth of
/// a period. kFailedPrecondition: no swing in the data (see FindExtrema), or kRelease was asked for and no held part is
/// there. A friction law that is not linear in its parameters needs start values of its own here.
Result<StartValues> EstimateStartValues(const Recording& recording, const MotionModel& model,
                                        std::optional<StartKind> choice);

}  // namespace pendulum
