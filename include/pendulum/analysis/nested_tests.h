// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/analysis/model_comparison.h"

namespace pendulum {

/// One recording and the fits of all models to it, in the order of the comparison's rows.
struct ComparedRun {
  const Recording& used;
  std::vector<const FitReport*> fits;
};

/// The recordings on which models are compared: one, or several with joint fits.
struct ComparedRuns {
  std::vector<ComparedRun> runs;
  std::vector<std::string> shared;  ///< Parameters that the recordings have in common.
};

/// Likelihood-ratio tests of all pairs of models where one is nested in the other and both have a log-likelihood in
/// `rows` (one per fit; MODEL.md eq. (9.3)). A rate of the richer law may have no meaning in the simpler one. Such a
/// law is tested only against the largest law nested in it, with SupremumTail, and only for independent residuals.
/// `likelihood` is the likelihood of the rows. There is no p if options restrict an added parameter.
std::vector<NestedTest> TestNested(const ComparedRuns& compared, const std::vector<ComparisonRow>& rows,
                                   const FitOptions& options, Likelihood likelihood);

}  // namespace pendulum
