// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "pendulum/closed_form/extrema.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// All turning points of a recording, disturbed or not; half swing i goes from turn i to turn i + 1. For M turns.
struct TurnTable {
  const Recording& recording;        ///< Must outlive the table.
  double noise = 0, threshold = 0;   ///< rad or rad/s: between neighbouring samples; what a turn stands out by
  std::vector<Extremum> turns = {};  ///< M
  /// M, rad or rad/s: near each turn, for it may drift, and distance from it; empty when M < 3
  std::vector<double> zero = {}, amplitude = {};
  double half_period = 0;  ///< s, typical, of a small swing

  std::size_t half_swings() const { return turns.empty() ? 0 : turns.size() - 1; }

  /// What a half swing from this turn takes over one of a small swing (MODEL.md eq. (20)).
  double Stretch(std::size_t turn) const;

  /// By how much a reading may differ from this turn's and be called the same: 5 % of the amplitude and the noise.
  double Tolerance(std::size_t turn) const;
};

TurnTable TabulateTurns(const Recording& recording);

/// What a half swing looks like beside its neighbours.
enum class Verdict {
  kFree,           ///< Crosses the zero, loses amplitude as those around it, and takes as long.
  kFreeAfterHold,  ///< The same, but takes half as long again: the turn before it is a hold.
  kGains,          ///< Gains amplitude for good: it was pushed, or a hand lifted the pendulum.
  kIrregular       ///< Neither: braked, too short, or samples were lost in it.
};

/// One verdict for each half swing of three turns or more. A turn that stands out alone is an outlier and disturbs
/// nothing; next to a gap in the samples only a gain counts.
std::vector<Verdict> JudgeHalfSwings(const TurnTable& table);

}  // namespace pendulum
