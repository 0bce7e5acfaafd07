// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/base/status.h"

namespace pendulum {

/// kCannotWrite: gnuplot is not installed; the message names its package.
Result<void> CheckGnuplot();

/// Runs gnuplot from PATH with the script and returns its standard output. No shell and none of the user's start files
/// are used. kCannotWrite: gnuplot is missing or fails; the message includes gnuplot's message.
Result<std::string> RunGnuplot(const std::string& script);

}  // namespace pendulum
