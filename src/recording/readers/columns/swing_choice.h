// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "recording/readers/columns/choice.h"

/// Chooses the column that carries the swing.
namespace pendulum::csv {

/// The value of --value_column that combines the axes of a gyro.
inline constexpr std::string_view kCombined = "combined";

/// Whether the user asks for the axes of a gyro together.
bool WantsCombination(const Choice& choice);

/// The kind of a column's quantity: by its name, or by --unit if the name gives no unit.
std::optional<Kind> KindOf(const Choice& choice, std::size_t index);

/// Whether a column is one of x, y and z, which all have no unit: a gyro's, an accelerometer's or a point's.
bool IsAxisOfThree(const Choice& choice, std::size_t index);

/// Of several candidates, chooses the one that carries the swing; std::nullopt if none does, or if the user was asked.
/// Unless one `must_swing`, takes a single column of numbers, and asks which one of several it is.
/// Several axes of a gyro may be combined to the rotation about one fixed axis: Choice::axes. Errors of reading the
/// numbers.
Result<std::optional<std::size_t>> ChooseBySwing(Choice& choice, const Columns& candidates, bool must_swing);

}  // namespace pendulum::csv
