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

/// The recordings that models are compared on: one, or several of joint fits.
struct ComparedRuns {
  std::vector<ComparedRun> runs;
  std::vector<std::string> shared;  ///< Parameters that the recordings have in common.
};

/// Likelihood-ratio tests of every two models of which one is nested in the other and both have a log-likelihood in
/// `rows` (one for each fit; MODEL.md eq. (51)). Where the richer law has a rate of no meaning in the simpler, the
/// richest within it, by SupremumTail, for independent residuals. `likelihood` is that of the rows. No p where options
/// restrict what is added.
std::vector<NestedTest> TestNested(const ComparedRuns& compared, const std::vector<ComparisonRow>& rows,
                                   const FitOptions& options, Likelihood likelihood);

}  // namespace pendulum
