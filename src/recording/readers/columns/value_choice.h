// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "recording/readers/columns/choice.h"

/// Chooses the column of the quantity.
namespace pendulum::csv {

/// Chooses the column of the quantity by the user's flag, else by the names, else by the swing. Asks the user if no
/// column or several can be the quantity. kInvalidArgument, kDataLoss: the column cannot be the quantity.
Result<void> ChooseValue(Choice& choice);

/// Sets the unit of the chosen column and, for a point, the column of its other coordinate. Asks the user if several
/// units are plausible. kInvalidArgument, kDataLoss: the units contradict each other.
Result<void> SetValue(Choice& choice);

}  // namespace pendulum::csv
