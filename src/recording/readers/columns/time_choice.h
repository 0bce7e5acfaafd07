// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "recording/readers/columns/choice.h"

/// Chooses the column of times.
namespace pendulum::csv {

/// Finds the column that --time_column names, NAME or NUMBER, optionally with :s, :ms or :us; its unit may stay open.
/// kInvalidArgument: there is no such column, or the flag contradicts the column's name or another flag.
Result<void> FindNamedTime(Choice& choice);

/// Chooses the column of times and its unit, after the quantity. Asks the user if no column can be a time. Errors of
/// reading the numbers; kInvalidArgument: flags that contradict each other or the file.
Result<void> ChooseTime(Choice& choice);

}  // namespace pendulum::csv
