// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host_stamp.h"
#include "layout.h"

/// What the first lines of a file tell: whether there is a header, what separates fields, how many there are.
namespace pendulum::csv {

/// True for a line without anything in it, and for what a spreadsheet leaves of an empty row.
inline bool IsEmptyRow(std::string_view line) { return line.find_first_not_of(" \t,;") == std::string_view::npos; }

/// What a line such as `sep=;`, which a spreadsheet writes for itself, says of the separator.
inline std::optional<char> SeparatorLine(std::string_view line) {
  constexpr std::string_view kKey = "sep=";
  line.remove_prefix(line.starts_with('"') ? 1 : 0);
  if (line.size() <= kKey.size() || !line.starts_with(kKey)) return std::nullopt;
  return line[kKey.size()];
}

/// One of the first lines, which are kept until it is known what they are.
struct HeadLine {
  std::string text;
  std::size_t number;
};

inline bool HasHostStamps(const std::vector<HeadLine>& head) {
  return std::ranges::any_of(head, [](const HeadLine& line) {
    const auto stamp = FindHostStamp(line.text);
    return stamp && stamp->second_of_day;
  });
}

/// What the device sent of a line.
inline std::string_view DevicePart(std::string_view line, bool has_host) {
  const auto stamp = has_host ? FindHostStamp(line) : std::nullopt;
  return stamp ? stamp->rest : line;
}

/// Fills separator, width and has_header from the first one or two lines; gives the names, none without a header.
/// `separator` is what the file itself says, or '\0'.
inline std::vector<Name> LookAtHead(const std::vector<HeadLine>& head, bool has_host, char separator, Layout& layout) {
  const std::string_view first = DevicePart(head.front().text, has_host);
  const std::string_view second = DevicePart(head.back().text, has_host);
  layout.separator = separator != '\0' ? separator : Separator(first);
  std::vector<Name> names = SplitHeader(first, layout.separator);
  layout.has_header = std::ranges::any_of(names, [](const Name& name) { return IsName(name.text); });
  if (layout.has_header) {
    // Blanks stand in the name of a single column too; the row below it tells.
    const bool is_one_name = layout.separator == ' ' && head.size() > 1 && CountFields(second, ' ') == 1;
    if (is_one_name) names = {{Unquote(first), Trim(first).data()}};
    layout.width = names.size();
    return names;
  }
  if (separator == '\0') {
    std::optional<char> found = SeparatorOfNumbers(second);
    if (!found) found = SeparatorOfNumbers(first);
    layout.separator = found.value_or(Separator(second));
  }
  layout.width = std::max(CountFields(first, layout.separator), CountFields(second, layout.separator));
  return {};
}

}  // namespace pendulum::csv
