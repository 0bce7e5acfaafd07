// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "pendulum/analysis/homogeneity.h"
#include "pendulum/fitting/fit/fit_report.h"

namespace pendulum {

/// Adds the error of parameters that are not constant to a fit of K >= 1 recordings, in quadrature to the systematic
/// errors, with the warning not_constant. A standard error describes one value for a whole recording; it does not
/// include the difference to the next window or run.
///
/// In one recording the error is added if a test with p < kNotConstant shows that windows scatter by more than their
/// errors or depend on amplitude, or that halves differ. It is the standard deviation of the windows about the
/// estimate, beyond their errors, and at least that of the trend; if windows show no change, that of the halves. It is
/// at least half of a significant difference between the halves (MODEL.md section 9). Recordings of one rig change in
/// the same way, so their number does not reduce it: of several it is the root mean square, weighted with 1 /
/// std_error² of their fits alone, or equally if none of them determines the parameter. Recordings that are too short
/// for a test of their own do not count there. If the
/// recordings differ by more than their errors (p < Homogeneity::kDisagree), the error is at least their standard
/// deviation `between` (MODEL.md eq. (10.5)).
///
/// runs: K fits of each recording alone. between: the shared parameters of TestHomogeneity; none for K = 1. whole: the
/// fit to all recordings; parts: of K > 1, the part of each.
void AddInconstancyError(const std::vector<RunAlone>& runs, const std::vector<SharedParameter>& between,
                         FitReport& whole, std::span<FitReport> parts = {});

/// Adds the error by friction that the law does not have (MODEL.md section 16): how far the estimates are off by
/// friction that was named (ParameterEstimate::named_friction), and in a recording too short for windows also by terms
/// that its readings suggest too weakly to be named (hidden_friction). A change during the recording is a consequence
/// of it, so only what is beyond AddInconstancyError, which comes before, is added. Recordings of one rig have the same
/// friction, so their number does not reduce it either.
void AddFrictionLawError(const std::vector<RunAlone>& runs, FitReport& whole, std::span<FitReport> parts = {});

}  // namespace pendulum
