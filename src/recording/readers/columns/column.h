// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "pendulum/base/physics.h"
#include "recording/readers/columns/csv.h"

/// The information in a header: the file's separator, and the unit in each column's name.
namespace pendulum::csv {

/// An acceleration or a length is used as the quantity only if the file has no other quantity.
enum class Kind { kTime, kAngle, kRate, kRaw, kAcceleration, kLength };

/// The unit of a column whose name ends in `_suffix`. The value in SI is value * factor / divisor: 33 ms is 33 /
/// 1000.0, the double nearest to 0.033, unlike 33 * 1e-3.
struct Unit {
  std::string_view suffix;
  Kind kind;
  std::string_view name;
  double factor = 1;
  double divisor = 1;

  constexpr double ToSi(double number) const { return number * factor / divisor; }
};

/// True for an acceleration or a length.
constexpr bool IsFallbackQuantity(const Unit& unit) {
  return unit.kind == Kind::kAcceleration || unit.kind == Kind::kLength;
}

/// A suffix that ends in another suffix comes before it: rad_s before s.
inline constexpr std::array kUnits = {
    Unit{"rad_s", Kind::kRate, "rad/s"},
    Unit{"deg_s", Kind::kRate, "deg/s", kRadFromDeg},
    Unit{"rad", Kind::kAngle, "rad"},
    Unit{"deg", Kind::kAngle, "deg", kRadFromDeg},
    Unit{"s", Kind::kTime, "s"},
    Unit{"ms", Kind::kTime, "ms", 1, 1e3},
    Unit{"us", Kind::kTime, "us", 1, 1e6},
    Unit{"counts", Kind::kRaw, "counts"},
    Unit{"volts", Kind::kRaw, "volts"},
    Unit{"m_s2", Kind::kAcceleration, "m/s^2"},
    Unit{"px", Kind::kLength, "px"},
    Unit{"cm", Kind::kLength, "m", 1, 1e2},
    Unit{"mm", Kind::kLength, "m", 1, 1e3},
    Unit{"m", Kind::kLength, "m"},
};

/// Possible endings of the name of a column with a quantity.
inline constexpr std::string_view kSuffixes = "_rad, _deg, _rad_s, _deg_s, _counts, _volts, _m_s2, _px, _m, _cm or _mm";

/// Lower-case letters, with ASCII in place of ° and of the two code points of µ.
inline std::string PlainName(std::string_view name) {
  struct Spelling {
    std::string_view letter, ascii;
  };
  constexpr std::array kSpellings = {Spelling{"\u00B0", "deg"}, Spelling{"\u00B5", "u"}, Spelling{"\u03BC", "u"}};
  std::string plain;
  while (!name.empty()) {
    const auto* const found =
        std::ranges::find_if(kSpellings, [&](const Spelling& each) { return name.starts_with(each.letter); });
    const char c = name.front();
    if (found != kSpellings.end()) {
      plain += found->ascii;
      name.remove_prefix(found->letter.size());
    } else {
      plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
      name.remove_prefix(1);
    }
  }
  return plain;
}

/// The name in the form stem_unit and in plain letters: time_ms for `Time (ms)`, gyro_deg_s for `Gyro [°/s]`.
inline std::string CanonicalName(std::string_view name) {
  const std::size_t bracket = name.find_last_of("([");
  if (bracket == std::string_view::npos || (name.back() != ')' && name.back() != ']')) return PlainName(name);
  std::string canonical = PlainName(Trim(name.substr(0, bracket)));
  canonical += '_';
  for (const char c : PlainName(name.substr(bracket + 1, name.size() - bracket - 2))) {
    if (!IsBlank(c) && c != '^') canonical += c == '/' ? '_' : c;
  }
  return canonical;
}

/// The unit with this suffix, or nullptr.
inline const Unit* UnitOfSuffix(std::string_view suffix) {
  const auto* const found = std::ranges::find(kUnits, suffix, &Unit::suffix);
  return found == kUnits.end() ? nullptr : found;
}

/// The unit at the end of a canonical name, and the part before it.
struct NameParts {
  std::string_view stem;
  const Unit* unit = nullptr;
};

inline NameParts SplitName(std::string_view canonical) {
  for (const Unit& unit : kUnits) {
    if (!canonical.ends_with(unit.suffix)) continue;
    const std::string_view stem = canonical.substr(0, canonical.size() - unit.suffix.size());
    if (stem.empty() || stem.ends_with('_')) return {stem, &unit};
  }
  return {canonical};
}

/// The unit in the name, if any. Only `time` itself is a time; `delay_s` is not.
inline const Unit* FindUnit(std::string_view name) {
  const std::string canonical = CanonicalName(name);
  const auto [stem, unit] = SplitName(canonical);
  return unit != nullptr && unit->kind == Kind::kTime && stem != "time_" ? nullptr : unit;
}

/// The unit of time in the name of a column that the user declares to be the time; also `t_ms`.
inline const Unit* FindTimeUnit(std::string_view name) {
  const std::string canonical = CanonicalName(name);
  const Unit* unit = SplitName(canonical).unit;
  return unit != nullptr && unit->kind == Kind::kTime ? unit : nullptr;
}

/// The unit before the last one if the name has two, such as `angle_deg [rad]`; otherwise nullptr.
inline const Unit* SecondUnit(std::string_view name) {
  const std::string canonical = CanonicalName(name);
  std::string_view stem = SplitName(canonical).stem;
  if (stem.size() == canonical.size() || stem.size() < 2) return nullptr;
  stem.remove_suffix(1);
  const auto [rest, unit] = SplitName(stem);
  return unit == nullptr || rest.empty() || unit->kind == Kind::kTime ? nullptr : unit;
}

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
