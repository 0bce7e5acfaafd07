// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace pendulum {

/// The command for a POSIX shell. Words with special characters are in single quotes.
std::string ShellCommand(std::span<const std::string> words);

/// The command with the flags of Status::try_flags, in the place of the same flags with other values.
std::string CommandToTry(std::span<const std::string> words, std::span<const std::string> try_flags);

}  // namespace pendulum
