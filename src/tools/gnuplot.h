// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/base/status.h"

namespace pendulum {

/// kCannotWrite: there is no gnuplot to draw with; the message names the package that has it.
Result<void> CheckGnuplot();

/// What gnuplot, the one that PATH finds, writes to its standard output when it reads the script. Runs no shell and
/// none of the user's start files. kCannotWrite: there is no gnuplot, or it fails: its own words follow.
Result<std::string> RunGnuplot(const std::string& script);

}  // namespace pendulum
