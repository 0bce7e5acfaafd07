// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "pendulum/base/status.h"

namespace pendulum::csv {

/// Whether a text has rows in which each value has its label, as Arduino's serial plotter reads them ("t:2310,pot:638")
/// and as people print them ("t=2310 ms  pot=638"). `begin`: the first bytes of a text.
bool HasLabelledRows(std::string_view begin);

/// The rows of such a text as a table with commas, below a header of the labels and units, which is one line more. The
/// stamps of a serial monitor stay as they are, and so do lines of other form. kDataLoss: a row has other units.
Result<std::string> TableOfLabelledRows(std::string_view text, const std::string& name);

}  // namespace pendulum::csv
