// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/recording/recording.h"

namespace pendulum {

/// Whether the recording has rows only when the count of an encoder changes. It needs at least 20 steps between rows of
/// an angle with a resolution. Nearly all steps must be whole counts, at most 3; at least 85 % must be one count and at
/// most 5 % zero. The 90 % quantile of the intervals must be more than 1.5 times the 10 % quantile. In contrast, a slow
/// swing sampled at equal intervals repeats its counts, and a fast swing skips many.
bool IsEventDriven(const Recording& recording);

/// Converts events to edges (MODEL.md eq. (7.4)). A row at a change of the count becomes the edge of the new count on
/// the side from which it was entered: y - q/2 upwards, y + q/2 downwards. Between two rows in opposite directions the
/// angle turned within the count of the first; a row inserted in the middle represents this turning point (a silence).
/// Rows that repeat a count and the first row, whose edge is unknown, are silences too. A first row followed by a hold
/// is left out. One or two rows in the opposite direction within a long motion, which occur when a counter misses
/// edges, are left out too. Sets Recording::edge; the warning `event_driven` gives the number of silences. Requires
/// IsEventDriven.
Recording ConvertToEdges(Recording recording);

/// The direction in which each of N edges was crossed, 1 or -1; 0 for silences. It is the direction of the step to the
/// next edge or, if the next edge is not adjacent, of the step from the previous row. Requires Recording::edge.
Eigen::VectorXd EdgeDirections(const Recording& recording);

}  // namespace pendulum
