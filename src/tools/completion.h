// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "pendulum/base/status.h"
#include "tools/flags.h"

namespace pendulum {

/// A script that completes the tool's flags, their values and file names in a shell: bash, zsh or fish. `flags`: those
/// of the tool; flags of libraries are left out. kInvalidArgument: another shell.
Result<std::string> CompletionScript(std::string_view shell, std::string_view tool, std::span<const FlagInfo> flags);

}  // namespace pendulum
