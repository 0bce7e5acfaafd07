// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/rig_flags.h"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/model/rig_check.h"
#include "pendulum/model/rig_units.h"
#include "pendulum/request/flag_values.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

/// A unit without the characters in which its spellings differ: blanks, *, · and ^; ² is 2.
std::string Plain(std::string_view unit) {
  std::string text(unit);
  const auto replace = [&](std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
      text.replace(at, from.size(), to);
    }
  };
  replace("²", "2");
  for (const std::string_view ignored : {" ", "*", "·", "^", "\t"}) replace(ignored, "");
  return text;
}

std::string UnitsOf(RigQuantity quantity) {
  std::vector<std::string_view> names;
  for (const RigUnit& unit : kRigUnits) {
    if (unit.quantity == quantity) names.push_back(unit.name);
  }
  return NameList(names);
}

/// The text with points for decimal commas: 38,5cm. A comma with three digits after it may separate thousands, but not
/// after 0.
std::string WithDecimalPoints(std::string text) {
  const auto is_digit = [&](std::size_t at) { return at < text.size() && text[at] >= '0' && text[at] <= '9'; };
  if (text.find('.') != std::string::npos) return text;
  for (std::size_t at = text.find(','); at != std::string::npos && at > 0; at = text.find(',', at + 1)) {
    std::size_t end = at + 1;
    while (is_digit(end)) ++end;
    const bool is_after_zero = text[at - 1] == '0' && (at == 1 || !is_digit(at - 2));
    if (is_digit(at - 1) && end > at + 1 && (end != at + 4 || is_after_zero)) text[at] = '.';
  }
  return text;
}

/// Takes a number from the beginning of the text.
std::optional<double> TakeNumber(std::string_view& text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  double number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || !std::isfinite(number)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(rest - text.data()));
  while (text.starts_with(' ')) text.remove_prefix(1);
  return number;
}

bool TakePlusMinus(std::string_view& text) {
  for (const std::string_view sign : {"+-", "+/-", "±"}) {
    if (!text.starts_with(sign)) continue;
    text.remove_prefix(sign.size());
    return true;
  }
  return false;
}

/// Whether a standard deviation is given; 0 is exact, and none is nominal.
bool HasStdDev(const std::string& text) {
  const std::string with_points = WithDecimalPoints(text);
  std::string_view rest = with_points;
  TakeNumber(rest);
  return TakePlusMinus(rest);
}

bool HasUnit(const std::string& text) {
  const std::string with_points = WithDecimalPoints(text);
  std::string_view rest = with_points;
  TakeNumber(rest);
  if (TakePlusMinus(rest)) TakeNumber(rest);
  return !rest.empty();
}

}  // namespace

Result<RigValue> ParseRigValue(const std::string& flag, const std::string& text, const RigKey& key) {
  const auto fault = [&] {
    return BadFlag(flag + " is '" + text + "'; it must be a number with a unit, such as " +
                   (key.quantity == RigQuantity::kMass     ? "380g or 380+-1g"
                    : key.quantity == RigQuantity::kLength ? "43cm or 43+-0.1cm"
                                                           : "1.5" + Plain(key.unit)) +
                   "; the units are " + UnitsOf(key.quantity));
  };
  const std::string with_points = WithDecimalPoints(text);
  std::string_view rest = with_points;
  const std::optional<double> number = TakeNumber(rest);
  if (!number) return fault();
  RigValue value{*number, 0};
  if (TakePlusMinus(rest)) {
    const std::optional<double> error = TakeNumber(rest);
    if (!error || *error < 0) return fault();
    value.std_dev = *error;
  }
  if (rest.empty()) return value;
  for (const RigUnit& unit : kRigUnits) {
    if (unit.quantity == key.quantity && Plain(unit.name) == Plain(rest)) {
      return RigValue{unit.ToSi(value.value), unit.ToSi(value.std_dev)};
    }
  }
  return fault();
}

Result<nlohmann::ordered_json> RigValuesOf(const std::vector<std::string>& texts, std::vector<Warning>& warnings) {
  Json values = Json::object();
  std::vector<std::string> without_unit, names;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (texts[i].empty()) continue;
    const RigKey& key = RigKeys()[i];
    const std::string flag = "--" + std::string(key.flag);
    ASSIGN_OR_RETURN(const RigValue value, ParseRigValue(flag, texts[i], key));
    values[std::string(key.name)] =
        HasStdDev(texts[i]) ? Json{{"value", value.value}, {"std_dev", value.std_dev}} : Json(value.value);
    const bool is_zero = value.value == 0 && value.std_dev == 0;
    if (key.quantity == RigQuantity::kAcceleration || is_zero || HasUnit(texts[i])) continue;
    without_unit.push_back(flag + " " + texts[i] + " " + std::string(key.unit));
    names.emplace_back(key.flag);
  }
  // No swing tells a mass in g from one in kg: the period does not depend on it, and every result does.
  std::vector<std::string> odd, with_unit;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (texts[i].empty() || HasUnit(texts[i])) continue;
    const std::string flag = "--" + std::string(RigKeys()[i].flag) + " " + texts[i];
    const std::string unit = UnitOfMass(values, RigKeys()[i]);
    if (unit.empty()) continue;
    odd.push_back(flag);
    with_unit.push_back(flag + unit);
  }
  if (!odd.empty()) {
    return WithTry(BadFlag(NameList(odd) + (odd.size() == 1 ? " has" : " have") +
                           " no unit, and would be too heavy in kg; write the unit after the number, such as " +
                           with_unit.front() + " (or kg, if it is)"),
                   with_unit);
  }
  if (!without_unit.empty()) {
    warnings.push_back({.code = "rig_unit_assumed",
                        .finding = "values without a unit were taken in SI units: " + NameList(without_unit),
                        .advice = "write the unit after the number, such as 380g or 43cm",
                        .flags = names,
                        .assumed = NameList(without_unit) + " in SI units (380g, 43cm say otherwise)"});
  }
  return values;
}

}  // namespace pendulum
