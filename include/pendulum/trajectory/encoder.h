// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/synthetic.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// A change of the count of an encoder.
struct CountChange {
  double time = 0;   ///< s, when the angle crosses the edge; exact.
  double count = 0;  ///< The new count, a whole number. It represents the angle count · resolution.
};

/// The changes of the count of θ + zero between the start of the trajectory and `end` [s], in order. Each crossing of
/// an edge (k + 1/2) · resolution has its own normal error with the standard deviation options.noise. The errors depend
/// only on the seed, not on how the encoder is read. Requires a resolution and a noise that is small compared with it.
std::vector<CountChange> CountChanges(const Trajectory& trajectory, const SyntheticOptions& options, double end);

/// Fills the rows of an encoder according to options.rows. `instants` are the times of equally spaced rows; event
/// rows use only the first and the last of these times. Time stamps of events have normal errors of options.time_noise
/// but still increase. Only the times and readings of `recording` are set.
void ReadEncoder(const Trajectory& trajectory, const SyntheticOptions& options, const Eigen::VectorXd& instants,
                 Recording& recording);

}  // namespace pendulum
