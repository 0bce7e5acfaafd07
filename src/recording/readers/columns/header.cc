// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/header.h"

#include <algorithm>

#include "recording/readers/columns/csv.h"

namespace pendulum::csv {
namespace {

/// Splits a header at blanks, except those before or inside brackets.
std::vector<Name> SplitAtBlanks(std::string_view header) {
  std::vector<Name> names;
  header = Trim(header);
  int depth = 0;
  bool is_quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= header.size(); ++i) {
    const bool is_end = i == header.size();
    if (!is_end && header[i] == '"') is_quoted = !is_quoted;
    if (!is_end && (header[i] == '(' || header[i] == '[')) ++depth;
    if (!is_end && (header[i] == ')' || header[i] == ']')) --depth;
    if (!is_end && (!IsBlank(header[i]) || depth > 0 || is_quoted)) continue;
    const std::size_t next = std::min(header.find_first_not_of(" \t", i), header.size());
    if (next < header.size() && (header[next] == '(' || header[next] == '[')) continue;
    names.push_back({Unquote(header.substr(begin, i - begin)), header.data() + begin});
    if (next == header.size()) break;
    begin = next;
    i = next - 1;  // The next name may begin with a quote.
  }
  return names;
}

}  // namespace

bool IsName(std::string_view text) {
  text = Unquote(text);
  return text.find_first_not_of("0123456789+-.,;eE:> \t") != std::string_view::npos ||
         (!text.empty() && text.find_first_not_of("eE") == std::string_view::npos);
}

std::vector<Name> SplitHeader(std::string_view header, char separator) {
  if (separator == ' ') return SplitAtBlanks(header);
  std::vector<Name> names;
  for (FieldCutter fields(header, separator); !fields.done();) {
    const std::string_view field = fields.Next();
    names.push_back({Unquote(field), Trim(field).data()});
  }
  return names;
}

}  // namespace pendulum::csv
