// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace pendulum {

/// Whether output to a file descriptor may be coloured: it is a terminal with colours (TERM is set and not "dumb"), and
/// NO_COLOR is absent or empty (https://no-color.org).
bool WantsColour(int descriptor);

/// Whether lines on a file descriptor can be redrawn: it is a terminal with cursor control.
bool CanRedraw(int descriptor);

struct TerminalSize {
  std::size_t columns = 80, rows = 24;
};

/// Current size of the terminal; a usual size if it is unknown.
TerminalSize SizeOfTerminal(int descriptor);

}  // namespace pendulum
