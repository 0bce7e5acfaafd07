// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/swing/offset_steps.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Regression within runs of successive edges in one direction, where no count is lost, with a free zero for each run.
/// `change` is the step of the P parameters that explains most of the residuals; `rms` is the root mean square of the
/// residuals before this step, in their unit.
struct RunRegression {
  Eigen::VectorXd change;
  double rms = 0;
};
RunRegression RegressWithinRuns(const FitResiduals& residuals, const Recording& edges);

/// Finds lost counts of an event-driven encoder: at turning points, where the motion crosses an edge back and forth,
/// and where rows are missing. Within a run of successive edges in one direction no count is lost, so each run has its
/// own zero in addition to the parameters. The differences of these zeros are numbers of counts (MODEL.md eq. (13.2)).
/// Steps of zero counts are omitted; a step not within 0.35 of a whole number keeps its own size.
///
/// residuals    of a fit to the edges, N
/// edges        N, from ConvertToEdges
std::vector<OffsetStep> FindEdgeSteps(const FitResiduals& residuals, const Recording& edges);

}  // namespace pendulum
