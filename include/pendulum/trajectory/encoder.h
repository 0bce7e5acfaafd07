// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/synthetic.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// A change of an encoder's count.
struct CountChange {
  double time = 0;   ///< s, when the angle crosses the edge; exact.
  double count = 0;  ///< The one entered, a whole number: the angle it stands for is count · resolution.
};

/// The changes of count of θ + zero between the trajectory's begin and `end` [s], in order. Each crossing of an edge,
/// (k + 1/2) · resolution, has an error of its own, normal with the standard deviation options.noise; a seed gives the
/// same ones however the encoder is read. Requires a resolution and a noise that is small against it.
std::vector<CountChange> CountChanges(const Trajectory& trajectory, const SyntheticOptions& options, double end);

/// Rows of an encoder as options.rows says; `instants` are those of even sampling, of which events take first and
/// last. The stamps of events have normal errors of options.time_noise and increase all the same. Nothing else of the
/// recording is set.
void ReadEncoder(const Trajectory& trajectory, const SyntheticOptions& options, const Eigen::VectorXd& instants,
                 Recording& recording);

}  // namespace pendulum
