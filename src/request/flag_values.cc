// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/flag_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"

namespace pendulum {
namespace {

/// Damerau's distance: the number of insertions, deletions, replacements and swaps of neighbours between two texts.
std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before;
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0U);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::vector<std::size_t> next = {i};
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = row[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      next.push_back(std::min({row[j] + 1, next[j - 1] + 1, replaced}));
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) next[j] = std::min(next[j], before[j - 2] + 1);
    }
    before = std::exchange(row, std::move(next));
  }
  return row.back();
}

}  // namespace

std::string NearestName(std::string_view name, std::span<const std::string_view> names) {
  std::size_t least = 2 + name.size() / 4;  // the distance of a similar name is below this
  std::string_view nearest;
  for (const std::string_view candidate : names) {
    const std::size_t distance = EditDistance(name, candidate);
    if (distance >= least) continue;
    least = distance;
    nearest = candidate;
  }
  return std::string(nearest);
}

tl::unexpected<Status> BadFlag(const std::string& sentence) { return Error(StatusCode::kInvalidArgument, sentence); }

Result<double> ParseNumber(std::string_view flag, std::string_view value, std::string_view meaning) {
  double number = 0;
  const char* end = value.data() + value.size();
  const auto [rest, error] = std::from_chars(value.data(), end, number);
  if (error != std::errc() || rest != end || !std::isfinite(number)) {
    return BadFlag(std::string(flag) + " is '" + std::string(value) + "'; it must be " + std::string(meaning));
  }
  return number;
}

namespace {

tl::unexpected<Status> BadSetting(std::string_view flag, const std::string& sentence) {
  return BadFlag(std::string(flag) + ": " + sentence);
}

/// One entry of a flag that sets parameters: name=value.
struct Setting {
  const ParameterInfo* info = nullptr;
  std::string value;
};

Result<Setting> ParseSetting(std::string_view flag, const std::string& entry, std::string_view model,
                             std::span<const ParameterInfo> parameters) {
  const std::size_t equals = entry.find('=');
  if (equals == 0 || equals == std::string::npos) return BadSetting(flag, "'" + entry + "' must be name=value");
  const std::string name = entry.substr(0, equals);
  const auto info = std::ranges::find(parameters, CurrentName(name), &ParameterInfo::name);
  if (info != parameters.end()) return Setting{&*info, entry.substr(equals + 1)};
  return BadSetting(flag, "model " + std::string(model) + " has no parameter '" + name + "'; its parameters are " +
                              NameList(parameters));
}

Result<double> ParseValue(std::string_view flag, const ParameterInfo& info, std::string_view text) {
  const std::string name(info.name);
  auto value = ParseNumber(std::string(flag) + " " + name, text, "a number in SI units");
  if (!value || (*value >= info.lower && *value <= info.upper)) return value;
  const bool low = *value < info.lower;
  return BadSetting(flag, name + " is " + NumberText(*value) + "; it must be at " + (low ? "least " : "most ") +
                              NumberText(low ? info.lower : info.upper));
}

/// Parses all entries; parse(info, value) returns the stored value of one.
template <typename Value, typename Parse>
Result<std::map<std::string, Value, std::less<>>> ParseEntries(std::string_view flag, std::string_view text,
                                                               std::string_view model,
                                                               std::span<const ParameterInfo> parameters,
                                                               const Parse& parse) {
  std::map<std::string, Value, std::less<>> values;
  if (text.ends_with(',')) return BadSetting(flag, "'" + std::string(text) + "' ends with a comma");
  for (const std::string& entry : Split(text, ',')) {
    ASSIGN_OR_RETURN(const auto setting, ParseSetting(flag, entry, model, parameters));
    ASSIGN_OR_RETURN(auto value, parse(*setting.info, setting.value));
    const std::string name(setting.info->name);
    if (!values.emplace(name, std::move(value)).second) return BadSetting(flag, name + " is given twice");
  }
  return values;
}

}  // namespace

std::vector<std::string> Split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

Result<ParameterValues> ParseSettings(std::string_view flag, std::string_view text, std::string_view model,
                                      std::span<const ParameterInfo> parameters) {
  return ParseEntries<double>(flag, text, model, parameters, [&](const ParameterInfo& info, const std::string& value) {
    return ParseValue(flag, info, value);
  });
}

Result<ParameterRanges> ParseRanges(std::string_view flag, std::string_view text, std::string_view model,
                                    std::span<const ParameterInfo> parameters) {
  const auto parse = [&](const ParameterInfo& info, const std::string& value) -> Result<ParameterRange> {
    const std::size_t colon = value.find(':');
    const std::string name(info.name);
    if (colon == std::string::npos) return BadSetting(flag, "'" + name + "=" + value + "' must be name=low:high");
    ParameterRange range;
    const auto read = [&](const std::string& end, double& bound) -> Result<void> {
      if (end.empty()) return {};
      ASSIGN_OR_RETURN(const auto number, ParseNumber(std::string(flag) + " " + name, end, "a number in SI units"));
      bound = number;
      return {};
    };
    RETURN_IF_ERROR(read(value.substr(0, colon), range.lower));
    RETURN_IF_ERROR(read(value.substr(colon + 1), range.upper));
    if (range.lower < range.upper) return range;
    return BadSetting(flag, "'" + name + "=" + value + "' leaves no value; low must be below high");
  };
  return ParseEntries<ParameterRange>(flag, text, model, parameters, parse);
}

Result<ParameterPriors> ParsePriors(std::string_view flag, std::string_view text, std::string_view model,
                                    std::span<const ParameterInfo> parameters) {
  const auto parse = [&](const ParameterInfo& info, const std::string& value) -> Result<ParameterPrior> {
    const std::size_t colon = value.find(':');
    const std::string name(info.name);
    if (colon == std::string::npos) return BadSetting(flag, "'" + name + "=" + value + "' must be name=mean:std_dev");
    ASSIGN_OR_RETURN(const auto mean, ParseValue(flag, info, value.substr(0, colon)));
    const auto std_dev =
        ParseNumber(std::string(flag) + " " + name, value.substr(colon + 1), "a standard deviation in SI units");
    if (!std_dev) return tl::unexpected(std_dev.error());
    if (*std_dev > 0) return ParameterPrior{mean, *std_dev};
    return BadSetting(flag, "the standard deviation of " + name + " is " + NumberText(*std_dev) +
                                "; it must be positive (use --fix to hold a parameter)");
  };
  return ParseEntries<ParameterPrior>(flag, text, model, parameters, parse);
}

}  // namespace pendulum
