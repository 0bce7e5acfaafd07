// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/swing/zero_steps.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// What differs within runs of successive edges in one direction, where nothing is lost: a step of the parameters (P)
/// that explains most of it whatever the zero of each run, and the root mean square before it [unit of the residuals].
struct RunRegression {
  Eigen::VectorXd change;
  double rms = 0;
};
RunRegression RegressWithinRuns(const FitResiduals& residuals, const Recording& edges);

/// Where the count of an event-driven encoder slips: at turning points, where an edge is crossed to and fro, and where
/// rows are missing. Within a run of successive edges in one direction nothing is lost, so each run has a zero of its
/// own beside the parameters, and what these zeros differ by is a number of counts (MODEL.md eq. (68)). Steps of no
/// counts are left out; one that is not within 0.35 of a number has its own size.
///
/// residuals    of a fit to the edges, N
/// edges        N, from TakeEdges
std::vector<ZeroStep> FindEdgeSteps(const FitResiduals& residuals, const Recording& edges);

}  // namespace pendulum
