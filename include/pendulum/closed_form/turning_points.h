// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "pendulum/closed_form/extrema.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// All M turning points of a recording, disturbed or not. Half swing i goes from turning point i to i + 1.
struct TurningPointTable {
  const Recording& recording;        ///< Must outlive the table.
  double noise = 0, threshold = 0;   ///< rad or rad/s: noise between neighbours, and least height of a turning point
  std::vector<Extremum> turns = {};  ///< M
  /// M, rad or rad/s: the zero near each turning point (it may drift), and the distance from this zero; empty if M < 3
  std::vector<double> zero = {}, amplitude = {};
  double half_period = 0;  ///< s, typical, for small swings

  std::size_t half_swings() const { return turns.empty() ? 0 : turns.size() - 1; }

  /// Duration of a half swing from this turning point, divided by that of a small swing (MODEL.md eq. (6.1)).
  double Stretch(std::size_t turn) const;

  /// How far a reading may differ from that of this turning point and still count as equal: 5 % of the amplitude plus
  /// noise.
  double Tolerance(std::size_t turn) const;
};

TurningPointTable TabulateTurningPoints(const Recording& recording);

/// Classification of a half swing compared with its neighbours.
enum class Verdict {
  kFree,           ///< Crosses the zero, and loses as much amplitude and takes as long as its neighbours.
  kFreeAfterHold,  ///< The same, but takes at least half as long again: the turning point before it is a hold.
  kGains,          ///< Gains amplitude permanently: it was pushed, or a hand lifted the pendulum.
  kIrregular       ///< Otherwise: braked, too short, or with lost samples.
};

/// One verdict for each half swing; needs three turning points. A single deviating turning point is an outlier and
/// disturbs no half swing. Next to a gap in the samples only a gain counts.
std::vector<Verdict> ClassifyHalfSwings(const TurningPointTable& table);

}  // namespace pendulum
