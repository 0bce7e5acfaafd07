// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "recording/readers/columns/column.h"

/// Finds units that a header does not give, from what is plausible for a pendulum.
namespace pendulum::csv {

inline constexpr double kMostDegrees = 400;  ///< A larger amplitude is not an angle in degrees.

/// Of the finite numbers; 0 without any.
double MedianOf(const Eigen::VectorXd& values);

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

/// The unit of acceleration in which axes of one sensor contain gravity, whose size they have together; empty: none.
std::string_view UnitOfGravity(const std::vector<Eigen::VectorXd>& axes);

/// As UnitOfGravity, if at least two of the axes move as in a swing. A pressure or a voltage beside an angle does not.
std::string_view UnitOfMovingGravity(const std::vector<Eigen::VectorXd>& axes);

/// The unit of a quantity of this kind, or of any kind. `seconds` is the sampling interval, 0 if unknown; `axes` are
/// those of an acceleration's sensor, perhaps this one alone. No unit and no example: none of the known ones is
/// plausible.
UnitGuess GuessValueUnit(std::optional<Kind> kind, const Eigen::VectorXd& values, double seconds,
                         const std::vector<Eigen::VectorXd>& axes);

}  // namespace pendulum::csv
