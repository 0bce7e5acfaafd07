// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/request/run_flags.h"

namespace pendulum {

/// Makes the flags of RunFlagTable flags of this tool (gflags). Call it once, before the command line is parsed.
void RegisterRunFlags();

/// Their values after the command line was parsed.
const RunFlags& RegisteredRunFlags();

}  // namespace pendulum
