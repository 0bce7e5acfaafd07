// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "pendulum/base/physics.h"
#include "recording/readers/columns/csv.h"

/// The information in a header: the file's separator, and what each column's name says.
namespace pendulum::csv {

/// The kinds of a quantity in the order in which a reader prefers them.
enum class Kind { kTime, kAngle, kRate, kRaw, kAcceleration, kLength };

/// A unit, and its suffix in the name of a column. The value in SI is value * factor / divisor: 33 ms is 33 / 1000.0,
/// the double nearest to 0.033, unlike 33 * 1e-3.
struct Unit {
  std::string_view suffix;
  Kind kind;
  std::string_view name;
  double factor = 1;
  double divisor = 1;

  constexpr double ToSi(double number) const { return number * factor / divisor; }

  /// The unit of the numbers in the file, for messages: "g", "mrad", "deg/s". `name` is the unit after ToSi.
  constexpr std::string_view Written() const { return suffix.find('_') == std::string_view::npos ? suffix : name; }
};

inline constexpr std::array kUnits = {
    Unit{"rad_s", Kind::kRate, "rad/s"},
    Unit{"deg_s", Kind::kRate, "deg/s", kRadFromDeg},
    Unit{"rpm", Kind::kRate, "rad/s", 2 * kPi, 60},
    Unit{"rev_s", Kind::kRate, "rad/s", 2 * kPi},
    Unit{"rad", Kind::kAngle, "rad"},
    Unit{"deg", Kind::kAngle, "deg", kRadFromDeg},
    Unit{"mrad", Kind::kAngle, "rad", 1, 1e3},
    Unit{"rev", Kind::kAngle, "rad", 2 * kPi},
    Unit{"gon", Kind::kAngle, "rad", kPi, 200},
    Unit{"s", Kind::kTime, "s"},
    Unit{"ms", Kind::kTime, "ms", 1, 1e3},
    Unit{"us", Kind::kTime, "us", 1, 1e6},
    Unit{"ns", Kind::kTime, "ns", 1, 1e9},
    Unit{"min", Kind::kTime, "min", 60},
    Unit{"days", Kind::kTime, "days", 86400},
    Unit{"counts", Kind::kRaw, "counts"},
    Unit{"volts", Kind::kRaw, "volts"},
    Unit{"mv", Kind::kRaw, "volts", 1, 1e3},
    Unit{"m_s2", Kind::kAcceleration, "m/s^2"},
    Unit{"g", Kind::kAcceleration, "m/s^2", kStandardGravity},
    Unit{"mg", Kind::kAcceleration, "m/s^2", kStandardGravity, 1e3},
    Unit{"px", Kind::kLength, "px"},
    Unit{"cm", Kind::kLength, "m", 1, 1e2},
    Unit{"mm", Kind::kLength, "m", 1, 1e3},
    Unit{"m", Kind::kLength, "m"},
};

/// The units of a quantity, as --unit takes them.
inline constexpr std::string_view kValueUnits =
    "rad, deg, mrad, rev, gon, rad_s, deg_s, rpm, rev_s, counts, volts, mv, m_s2, g, mg, px, m, cm or mm";

/// The unit with this suffix, or nullptr.
inline const Unit* UnitOfSuffix(std::string_view suffix) {
  const auto* const found = std::ranges::find(kUnits, suffix, &Unit::suffix);
  return found == kUnits.end() ? nullptr : found;
}

/// What the name of a column says.
struct NameMeaning {
  std::optional<Kind> kind;      // From the unit, else from the words; std::nullopt: the name says nothing.
  const Unit* unit = nullptr;    // nullptr: not in the name.
  const Unit* second = nullptr;  // Another unit before `unit`: `angle_deg [rad]`.
  std::string stem;              // The name without its unit, in small plain letters; words are separated by blanks.
  std::string unknown_unit;      // What stands in brackets as a unit does, but is none of kUnits; empty: nothing.
  bool has_other_unit = false;   // A unit that no quantity of a swing has: degrees Celsius, newton, m/s.
  bool is_secondary = false;     // By its words not a reading: a setpoint, an error, a model's value.

  /// Whether one of the words of the name is `word`.
  bool Has(std::string_view word) const;
};

/// Reads a column's name, in the forms `angle_deg`, `Angle (deg)`, `Angle [deg]`, `phi/deg`, `angle in deg`,
/// `angleDeg`, `degrees`; words in English, German, French, Spanish, Italian, Portuguese and others.
NameMeaning MeaningOf(std::string_view name);

/// Small letters of ASCII: letters with accents, Greek letters and signs such as the degree are written in plain
/// letters.
std::string PlainName(std::string_view name);

/// The index of the column that a number from 1 to `count` means; std::nullopt for another text.
std::optional<std::size_t> ColumnOfNumber(std::string_view text, std::size_t count);

/// The unit that a text names: `rad/s`, `°/s`, `Sekunden`; nullptr if it is none.
const Unit* UnitOfText(std::string_view text);

/// The unit in the name of a quantity or of a time, or nullptr. `delay_s` is not a time.
inline const Unit* FindUnit(std::string_view name) {
  const NameMeaning meaning = MeaningOf(name);
  return meaning.kind ? meaning.unit : nullptr;
}

/// The unit of time in the name of a column that the user declares to be the time; also `delay_ms`.
inline const Unit* FindTimeUnit(std::string_view name) {
  const Unit* unit = MeaningOf(name).unit;
  return unit != nullptr && unit->kind == Kind::kTime ? unit : nullptr;
}

/// True for the name of a time, with or without its unit.
inline bool IsTime(std::string_view name) { return MeaningOf(name).kind == Kind::kTime; }

/// The most frequent separator outside quotes in the header; a blank if there is no other. In a tie a comma loses,
/// because it is most likely part of a name.
inline char Separator(std::string_view header) {
  constexpr std::string_view kCandidates = "\t;,";
  std::array<std::size_t, kCandidates.size()> uses{};
  bool quoted = false;
  for (const char c : header) {
    if (c == '"') quoted = !quoted;
    const std::size_t candidate = kCandidates.find(c);
    if (!quoted && candidate < uses.size()) ++uses[candidate];
  }
  const auto* const most = std::ranges::max_element(uses);
  return *most == 0 ? ' ' : kCandidates[most - uses.begin()];
}

}  // namespace pendulum::csv
