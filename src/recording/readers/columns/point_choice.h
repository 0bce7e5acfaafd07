// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "recording/readers/columns/choice.h"

/// Finds the columns that are the two coordinates of a point.
namespace pendulum::csv {

/// Two columns, and how clearly they are a point.
struct Point {
  std::size_t horizontal = 0, vertical = 0;
  bool is_clear = false;
  bool is_exact = false;         // The noise is small beside the height of the arc.
  bool is_about_origin = false;  // The coordinates are measured from the pivot.
};

/// The point that --value_column names as two columns, such as 2,3; std::nullopt if the flag names no two columns.
std::optional<Point> FindNamedPoint(const Choice& choice);

/// The horizontal coordinate if the names and units of the candidates show one point.
std::optional<std::size_t> FindPoint(const Choice& choice, const Columns& candidates);

/// The column with the other coordinate of the same point: bob_y_px for bob_x_px.
std::optional<std::size_t> FindVertical(const Choice& choice, std::size_t horizontal);

/// Whether two columns of numbers lie on an arc of a circle, as the coordinates of a point do; std::nullopt if not. It
/// is clear if the arc is long, and the points are near it and nearer than to a parabola. On a short arc, one column
/// must follow the bend of the arc within the swing, whose period is in rows. Needs the numbers.
std::optional<Point> FindPointOnArc(const Choice& choice, const Columns& two, double rows_per_period);

/// Refuses a vertical coordinate alone, which is the same on both sides, so it oscillates twice as fast as the angle;
/// and two columns that are no lengths in one unit.
Result<void> CheckCoordinates(const Choice& choice);

}  // namespace pendulum::csv
