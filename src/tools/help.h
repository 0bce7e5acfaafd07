// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "tools/flags.h"

namespace pendulum {

/// The heading of --help under which a flag of a tool stands: "Input".
std::string_view HelpGroup(std::string_view flag);

/// The output of --help: the usage, the own flags under their headings, and the exit codes, which are the part of the
/// usage from "Exit codes:" on.
std::string HelpText(std::string_view usage, std::span<const FlagInfo> flags);

/// The output of --helpfull: also the flags of libraries.
std::string FullHelpText(std::string_view usage, std::span<const FlagInfo> flags);

}  // namespace pendulum
