// SPDX-License-Identifier: Apache-2.0
#include "tools/command_line.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/report/layout.h"

namespace pendulum {
namespace {

/// Levenshtein's distance: insertions, deletions and replacements that turn one text into the other.
std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0U);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row.back();
}

std::string Suggestion(std::string_view name, std::span<const FlagInfo> flags) {
  std::size_t least = 2 + name.size() / 4;  // as many slips as still look like one
  std::string nearest;
  for (const FlagInfo& flag : flags) {
    const std::size_t distance = EditDistance(name, flag.name);
    if (!flag.own || distance >= least) continue;
    least = distance;
    nearest = flag.name;
  }
  return nearest.empty() ? "--help lists the flags" : "did you mean --" + nearest + "?";
}

/// The flag of that name, dashes within it standing for underscores; "noNAME" finds the boolean NAME.
const FlagInfo* FindFlag(std::string name, std::span<const FlagInfo> flags) {
  std::replace(name.begin(), name.end(), '-', '_');
  const auto found = std::find_if(flags.begin(), flags.end(), [&](const FlagInfo& flag) {
    return flag.name == name || (flag.type == "bool" && "no" + flag.name == name);
  });
  return found == flags.end() ? nullptr : &*found;
}

tl::unexpected<Status> WrongFlag(const std::string& name, const std::string& why) {
  return Error(StatusCode::kInvalidArgument, "--" + name + " " + why);
}

/// True unless the flag is a number and the value is none; whether it lies in the type's range is left to gflags.
bool Fits(const FlagInfo& flag, std::string_view value) {
  if (flag.type == "string" || flag.type == "bool") return true;
  const char* end = value.data() + value.size();
  double number = 0;
  const auto [rest, error] = std::from_chars(value.data(), end, number);
  return error == std::errc() && rest == end && (flag.type == "double" || number == std::floor(number));
}

/// Checks the flag that begins the arguments and gives how many of them it takes.
Result<std::size_t> CheckFlag(std::span<const std::string> arguments, std::span<const FlagInfo> flags) {
  const std::string body = arguments[0].substr(arguments[0][1] == '-' ? 2 : 1);
  const std::size_t equals = body.find('=');
  const std::string name = body.substr(0, equals);
  const FlagInfo* flag = FindFlag(name, flags);
  if (flag == nullptr) return WrongFlag(name, "is not a flag of this tool; " + Suggestion(name, flags));
  const bool joined = equals != std::string::npos;
  if (flag->type == "bool" && !joined) return 1;
  if (!joined && arguments.size() == 1) return WrongFlag(name, "needs a value");
  const std::string value = joined ? body.substr(equals + 1) : arguments[1];
  if (value.empty()) return WrongFlag(name, "has an empty value; leave the flag out for its default");
  if (!Fits(*flag, value)) {
    return WrongFlag(name, "is '" + value + "'; it must be a" + (flag->type == "double" ? " number" : "n integer"));
  }
  return joined ? 1 : 2;
}

}  // namespace

Result<std::vector<std::string>> PositionalArguments(std::span<const std::string> arguments,
                                                     std::span<const FlagInfo> flags) {
  std::vector<std::string> positional;
  bool flags_ended = false;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (flags_ended || argument.size() < 2 || argument[0] != '-') {
      positional.push_back(argument);
    } else if (argument == "--") {
      flags_ended = true;
    } else {
      const auto used = CheckFlag(arguments.subspan(i), flags);
      if (!used) return tl::unexpected(used.error());
      i += *used - 1;
    }
  }
  return positional;
}

std::string HelpText(std::string_view usage, std::span<const FlagInfo> flags) {
  constexpr int kWidth = 100;
  std::size_t longest = 0;
  for (const FlagInfo& flag : flags) longest = std::max(longest, flag.own ? flag.name.size() : 0);
  std::string text(usage);
  for (const FlagInfo& flag : flags) {
    if (!flag.own) continue;
    text += Paragraph(flag.help, "  --" + flag.name + std::string(longest - flag.name.size() + 2, ' '), kWidth);
  }
  return text;
}

Result<double> ParseNumber(std::string_view flag, std::string_view value, std::string_view meaning) {
  double number = 0;
  const char* end = value.data() + value.size();
  const auto [rest, error] = std::from_chars(value.data(), end, number);
  if (error != std::errc() || rest != end || !std::isfinite(number)) {
    return Error(StatusCode::kInvalidArgument,
                 std::string(flag) + " is '" + std::string(value) + "'; it must be " + std::string(meaning));
  }
  return number;
}

namespace {

tl::unexpected<Status> BadSetting(std::string_view flag, const std::string& sentence) {
  return Error(StatusCode::kInvalidArgument, std::string(flag) + ": " + sentence);
}

Result<void> CheckSetting(std::string_view flag, std::string_view model, std::span<const ParameterInfo> parameters,
                          const std::string& name, double value) {
  const auto info = std::ranges::find(parameters, name, &ParameterInfo::name);
  if (info == parameters.end()) {
    return BadSetting(flag, "model " + std::string(model) + " has no parameter '" + name + "'; its parameters are " +
                                NameList(parameters));
  }
  if (value >= info->lower && value <= info->upper) return {};
  const bool low = value < info->lower;
  return BadSetting(flag, name + " is " + NumberText(value) + "; it must be at " + (low ? "least " : "most ") +
                              NumberText(low ? info->lower : info->upper));
}

}  // namespace

Result<ParameterValues> ParseSettings(std::string_view flag, std::string_view text, std::string_view model,
                                      std::span<const ParameterInfo> parameters) {
  ParameterValues settings;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string entry(text.substr(begin, end - begin));
    const std::size_t equals = entry.find('=');
    if (equals == 0 || equals == std::string::npos) return BadSetting(flag, "'" + entry + "' must be name=value");
    const std::string name = entry.substr(0, equals);
    const auto value = ParseNumber(std::string(flag) + " " + name, entry.substr(equals + 1), "a number in SI units");
    if (!value) return tl::unexpected(value.error());
    if (const auto checked = CheckSetting(flag, model, parameters, name, *value); !checked) {
      return tl::unexpected(checked.error());
    }
    if (!settings.emplace(name, *value).second) return BadSetting(flag, name + " is given twice");
    begin = end + 1;
    if (begin == text.size()) return BadSetting(flag, "'" + std::string(text) + "' ends with a comma");
  }
  return settings;
}

}  // namespace pendulum
