// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal.h"

#include <cstdlib>
#include <string_view>

#include <sys/ioctl.h>
#include <unistd.h>

namespace pendulum {
namespace {

/// An environment variable; empty if it is not set.
std::string_view Environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string_view() : value;
}

}  // namespace

bool CanRedraw(int descriptor) {
  const std::string_view terminal = Environment("TERM");
  return ::isatty(descriptor) == 1 && !terminal.empty() && terminal != "dumb";
}

TerminalSize SizeOfTerminal(int descriptor) {
  winsize size{};
  if (::ioctl(descriptor, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) return {};
  return {size.ws_col, size.ws_row};
}

bool WantsColour(int descriptor) { return CanRedraw(descriptor) && Environment("NO_COLOR").empty(); }

}  // namespace pendulum
