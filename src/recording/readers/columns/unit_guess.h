// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "recording/readers/columns/column.h"

/// Finds units that a header does not give, from what is plausible for a pendulum.
namespace pendulum::csv {

inline constexpr double kMostDegrees = 400;  ///< A larger amplitude is not an angle in degrees.

/// Half the distance between the smallest and the largest finite number; 0 without numbers.
double HalfRange(const Eigen::VectorXd& values);

/// Whether all finite numbers are whole.
bool AreWhole(const Eigen::VectorXd& values);

/// The median step between rows, from successive finite numbers; 0 if there is none.
double MedianStep(const Eigen::VectorXd& numbers);

struct TimeGuess {
  std::string_view unit;             // Suffix: s, ms, us, ns or days; empty if two are plausible.
  std::string reason;                // " (...)", or why it is not clear.
  bool has_calendar_origin = false;  // The times count from 1970 or 1900.
};

/// The unit of times: the one that gives a swing a period between 0.1 s and 20 s, of which only one exists; for values
/// without a swing the one that gives a usual sampling interval. `values` may be empty.
TimeGuess GuessTimeUnit(const Eigen::VectorXd& times, const Eigen::VectorXd& values);

/// Whether numbers that increase by 1 are most likely seconds: a swing has few rows, as of readings by hand.
bool MaySecondsCount(const Eigen::VectorXd& values);

struct UnitGuess {
  std::string_view unit;  // Suffix; empty if several units are plausible.
  std::string reason;     // ", because ...", or why it is not clear.
  std::string example;    // A plausible suffix.
};

/// The unit that x, y and z have most likely: of an acceleration if they contain gravity, otherwise of a rate.
std::string_view ExampleForAxes(const std::array<Eigen::VectorXd, 3>& axes);

/// The unit of a quantity of this kind, or of any kind. `seconds` is the sampling interval, 0 if unknown.
UnitGuess GuessValueUnit(std::optional<Kind> kind, const Eigen::VectorXd& values, double seconds);

}  // namespace pendulum::csv
