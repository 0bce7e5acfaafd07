// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "pendulum/base/status.h"
#include "tools/refit_pendulums_options.h"

namespace pendulum {

inline constexpr std::string_view kRefitToolName = "refit_pendulums";

/// Runs the command of refit_pendulums and returns the exit code. Refit: 0: every run has its rows; 130 or 75:
/// interrupted or terminated, finished work is kept. Compare: 1: a value changed by more than its error, or a fit ended
/// differently.
Result<int> RunRefitCommand(const RefitPendulumsOptions& options);

}  // namespace pendulum
