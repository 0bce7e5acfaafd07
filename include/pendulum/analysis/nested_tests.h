// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/analysis/model_comparison.h"

namespace pendulum {

/// Likelihood-ratio tests of every two models of which one is nested in the other and both have a log-likelihood in
/// `rows` (one for each fit; MODEL.md eq. (51)). Where the richer law has a rate of no meaning in the simpler, the
/// richest within it, by SupremumTail: independent residuals are taken for granted there.
std::vector<NestedTest> TestNested(const FittedModels& fitted, const std::vector<ComparisonRow>& rows,
                                   const FitOptions& options);

}  // namespace pendulum
