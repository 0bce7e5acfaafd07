// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/recording/recording.h"

namespace pendulum {

/// Whether a row comes only when the count of an encoder changes: of at least 20 steps between rows of an angle that
/// has a resolution, nearly all are whole counts of at most 3, at least 85 of 100 are one count, at most 5 of 100 none,
/// and the tenth shortest interval is less than two thirds of the tenth longest. A slow swing sampled at even times
/// repeats its counts, a fast one leaves many out.
bool IsEventDriven(const Recording& recording);

/// The events as what they say (MODEL.md eq. (81)): a row that comes when the count changes is the edge of the count
/// just entered, on the side that it came from, y - q/2 going up and y + q/2 going down. Between two rows in opposite
/// directions the angle turned within the count of the first: a row in the middle says so (a silence), as do rows that
/// repeat a count and the first one, whose edge nobody knows. A first row that a hold follows is left out, and
/// one or two rows against a long motion, which a counter makes that misses edges. Sets Recording::edge; the warning
/// `event_driven` says how many silences there are. Requires IsEventDriven.
Recording TakeEdges(Recording recording);

/// The direction in which each of N edges was crossed, 1 or -1, and 0 of silences: that of the step to the next edge,
/// or where that is no neighbour from the row before. Of a recording with Recording::edge.
Eigen::VectorXd EdgeDirections(const Recording& recording);

}  // namespace pendulum
