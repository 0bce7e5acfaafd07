// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "recording/readers/columns/choice.h"

namespace pendulum::csv {

/// Refuses the times at which a pendulum passed a light gate: one column of numbers that increase unevenly, perhaps
/// beside the numbers of its rows. kDataLoss: the message gives their period.
Result<void> RefusePassages(Choice& choice);

}  // namespace pendulum::csv
