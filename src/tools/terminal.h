// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace pendulum {

/// Whether text written to a file descriptor may be coloured: it is a terminal that knows how (TERM is there and not
/// "dumb"), and the user has not said otherwise (NO_COLOR is absent or empty, https://no-color.org).
bool WantsColour(int descriptor);

/// Whether lines drawn on a file descriptor can be drawn over: it is a terminal that knows how.
bool CanRedraw(int descriptor);

struct TerminalSize {
  std::size_t columns = 80, rows = 24;
};

/// Of the terminal as it is now; the usual one where it does not say.
TerminalSize SizeOfTerminal(int descriptor);

}  // namespace pendulum
