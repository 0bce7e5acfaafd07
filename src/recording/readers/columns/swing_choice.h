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

/// Of several candidates, chooses the one that carries the swing; std::nullopt if none does, or if the user was asked.
/// Unless one `must_swing`, takes a single column of numbers, and asks which one of several it is.
/// Several axes of a gyro may be combined to the rotation about one fixed axis: Choice::axes. Errors of reading the
/// numbers.
Result<std::optional<std::size_t>> ChooseBySwing(Choice& choice, const Columns& candidates, bool must_swing);

}  // namespace pendulum::csv
