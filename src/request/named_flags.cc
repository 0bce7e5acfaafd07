// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/named_flags.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <variant>

#include "pendulum/base/try.h"
#include "pendulum/request/flag_values.h"

namespace pendulum {
namespace {

/// A member of a struct of flags, with its name.
template <typename Flags, typename Value>
struct NamedFlag {
  std::string_view name;
  Value Flags::*member;
};

template <typename Value>
using SimulationFlag = NamedFlag<SimulationFlags, Value>;
template <typename Value>
using CalibrationFlag = NamedFlag<CalibrationFlags, Value>;

/// A flag of a fit.
struct NamedRunFlag {
  std::string_view name;
  const RunFlag* member;
};

/// The flags of RunFlagTable that requests may give; `models` is another name of `model`.
const std::vector<NamedRunFlag>& NamedRunFlags() {
  static const auto flags = [] {
    std::vector<NamedRunFlag> all;
    for (const RunFlag& flag : RunFlagTable()) {
      if (flag.name == "model") all.push_back({"models", &flag});
      if (!flag.is_local) all.push_back({flag.name, &flag});
    }
    return all;
  }();
  return flags;
}

constexpr std::array<SimulationFlag<std::string>, 7> kSimulationTexts = {{{"model", &SimulationFlags::model},
                                                                          {"gravity", &SimulationFlags::gravity},
                                                                          {"set", &SimulationFlags::set},
                                                                          {"spread", &SimulationFlags::spread},
                                                                          {"unit", &SimulationFlags::unit},
                                                                          {"range", &SimulationFlags::range},
                                                                          {"lose", &SimulationFlags::lose}}};
constexpr std::array<SimulationFlag<double>, 10> kSimulationNumbers = {
    {{"window_s", &SimulationFlags::window_s},
     {"duration", &SimulationFlags::duration},
     {"rate", &SimulationFlags::rate},
     {"jitter", &SimulationFlags::jitter},
     {"start_time", &SimulationFlags::start_time},
     {"noise", &SimulationFlags::noise},
     {"noise_correlation", &SimulationFlags::noise_correlation},
     {"noise_freedom", &SimulationFlags::noise_freedom},
     {"time_noise", &SimulationFlags::time_noise},
     {"resolution", &SimulationFlags::resolution}}};
constexpr std::array<SimulationFlag<bool>, 1> kSimulationSwitches = {
    {{"event_driven", &SimulationFlags::event_driven}}};
constexpr std::array<SimulationFlag<std::uint64_t>, 2> kSimulationWholes = {
    {{"seed", &SimulationFlags::seed}, {"oversample", &SimulationFlags::oversample}}};

constexpr std::array<CalibrationFlag<std::string>, 1> kCalibrationTexts = {
    {{"input_range", &CalibrationFlags::input_range}}};
constexpr std::array<CalibrationFlag<int>, 2> kCalibrationWholes = {
    {{"order", &CalibrationFlags::order}, {"bits", &CalibrationFlags::bits}}};

Result<void> Parse(std::string_view /*flag*/, const std::string& text, std::string& value) {
  value = text;
  return {};
}

Result<void> Parse(std::string_view flag, const std::string& text, bool& value) {
  if (text != "true" && text != "false")
    return BadFlag(std::string(flag) + " is '" + text + "'; it must be true or false");
  value = text == "true";
  return {};
}

Result<void> Parse(std::string_view flag, const std::string& text, double& value) {
  ASSIGN_OR_RETURN(const auto number, ParseNumber(flag, text, "a number"));
  value = number;
  return {};
}

template <typename Whole>
Result<void> ParseWhole(std::string_view flag, const std::string& text, Whole& value) {
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc() && rest == end) return {};
  return BadFlag(std::string(flag) + " is '" + text + "'; it must be an integer");
}

Result<void> Parse(std::string_view flag, const std::string& text, int& value) { return ParseWhole(flag, text, value); }

Result<void> Parse(std::string_view flag, const std::string& text, std::uint64_t& value) {
  return ParseWhole(flag, text, value);
}

template <typename Flags, typename Value>
Result<void> Set(Value Flags::*member, std::string_view name, const std::string& text, Flags& flags) {
  return Parse("--" + std::string(name), text, flags.*member);
}

Result<void> Set(const RunFlag* flag, std::string_view name, const std::string& text, RunFlags& flags) {
  return std::visit([&](auto* value) { return Parse("--" + std::string(name), text, *value); }, flag->In(flags));
}

/// Sets the member with this name, if the table has it.
template <typename Flags, typename Table>
Result<void> SetIfNamed(const Table& table, std::string_view name, const std::string& text, Flags& flags) {
  for (const auto& flag : table) {
    if (flag.name == name) return Set(flag.member, name, text, flags);
  }
  return {};
}

template <typename... Tables>
std::vector<std::string_view> NamesOf(const Tables&... tables) {
  std::vector<std::string_view> names;
  const auto add = [&](const auto& table) {
    for (const auto& flag : table) names.push_back(flag.name);
  };
  (add(tables), ...);
  return names;
}

/// Makes the flags from all tables.
template <typename Flags, typename... Tables>
Result<Flags> FlagsOf(const FlagTexts& texts, const Tables&... tables) {
  const std::vector<std::string_view> names = NamesOf(tables...);
  Flags flags;
  for (const auto& given : texts) {
    RETURN_IF_ERROR(CheckFlagName(given.first, names));
    if (given.second.empty()) {
      return BadFlag("--" + given.first + " has an empty value; leave the flag out for its default");
    }
    Result<void> set;
    const auto set_in = [&](const auto& table) {
      if (set) set = SetIfNamed(table, given.first, given.second, flags);
    };
    (set_in(tables), ...);
    if (!set) return tl::unexpected(set.error());
  }
  return flags;
}

}  // namespace

std::vector<std::string_view> RunFlagNames() { return NamesOf(NamedRunFlags()); }
std::vector<std::string_view> SimulationFlagNames() {
  return NamesOf(kSimulationTexts, kSimulationNumbers, kSimulationSwitches, kSimulationWholes);
}
std::vector<std::string_view> CalibrationFlagNames() { return NamesOf(kCalibrationTexts, kCalibrationWholes); }

Result<void> CheckFlagName(std::string_view name, std::span<const std::string_view> names) {
  if (std::ranges::find(names, name) != names.end()) return {};
  const std::string nearest = NearestName(name, names);
  return BadFlag("--" + std::string(name) + " is not a flag of this request; " +
                 (nearest.empty() ? "GET /openapi.json lists the flags" : "did you mean --" + nearest + "?"));
}

Result<RunFlags> RunFlagsOf(const FlagTexts& texts) {
  if (texts.contains("model") && texts.contains("models")) {
    return BadFlag("--model and --models are the same flag; give only one of them");
  }
  return FlagsOf<RunFlags>(texts, NamedRunFlags());
}

Result<SimulationFlags> SimulationFlagsOf(const FlagTexts& texts) {
  return FlagsOf<SimulationFlags>(texts, kSimulationTexts, kSimulationNumbers, kSimulationSwitches, kSimulationWholes);
}

Result<CalibrationFlags> CalibrationFlagsOf(const FlagTexts& texts) {
  return FlagsOf<CalibrationFlags>(texts, kCalibrationTexts, kCalibrationWholes);
}

}  // namespace pendulum
