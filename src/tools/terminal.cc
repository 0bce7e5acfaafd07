// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal.h"

#include <cstdlib>
#include <string_view>

#include <unistd.h>

namespace pendulum {
namespace {

/// An environment variable; empty when it is not set.
std::string_view Environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string_view() : value;
}

}  // namespace

bool CanRedraw(int descriptor) {
  const std::string_view terminal = Environment("TERM");
  return ::isatty(descriptor) == 1 && !terminal.empty() && terminal != "dumb";
}

bool WantsColour(int descriptor) { return CanRedraw(descriptor) && Environment("NO_COLOR").empty(); }

}  // namespace pendulum
