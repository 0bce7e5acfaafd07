// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "pendulum/base/status.h"
#include "tools/refit_pendulums_options.h"

namespace pendulum {

inline constexpr std::string_view kRefitToolName = "refit_pendulums";

/// Runs the command of refit_pendulums and returns the exit code. A refit returns 0 if every run has its rows, and
/// 130 or 75 if it was interrupted or terminated (finished runs are kept). A comparison returns 1 if a value changed by
/// more than its error or a fit ended with another status.
Result<int> RunRefitCommand(const RefitPendulumsOptions& options);

}  // namespace pendulum
