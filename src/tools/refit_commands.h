// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "pendulum/base/status.h"
#include "tools/refit_pendulums_options.h"

namespace pendulum {

inline constexpr std::string_view kRefitToolName = "refit_pendulums";

/// Does what refit_pendulums is asked to do; gives the exit code. Of a refit 0: every run has its rows, 130 or 75:
/// interrupted or terminated, what was done is kept; of compare 1: something moved by more than its error or ended
/// otherwise.
Result<int> RunRefitCommand(const RefitPendulumsOptions& options);

}  // namespace pendulum
