// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/csv_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace pendulum {
namespace {

constexpr char kSeparator = ';';
constexpr std::string_view kSpecial = ",;\t\"";
constexpr std::size_t kMaxColumns = std::size_t{1} << 14;  // Excel and LibreOffice have 2^14 columns.

bool IsComment(std::string_view text) { return text.starts_with('#'); }

std::string OnOneLine(std::string_view text) {
  std::string line(text);
  std::ranges::replace_if(
      line, [](char c) { return c == '\n' || c == '\r' || c == '\0'; }, ' ');
  return line;
}

std::string InQuotes(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += c;
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace

std::string CsvCell(std::string_view text) {
  std::string line = OnOneLine(text);
  const bool has_end_blanks = !line.empty() && (line.front() == ' ' || line.back() == ' ');
  if (line.find_first_of(kSpecial) == std::string::npos && !has_end_blanks) return line;
  return InQuotes(line);
}

bool CsvText::HasRoom(std::size_t bytes) {
  is_full_ |= text_.size() + bytes > max_bytes_;
  return !is_full_;
}

/// Writes separators and line ends up to the cell. False if there is no such cell.
bool CsvText::BeginCell(std::size_t row, std::size_t column) {
  is_full_ |= row >= max_rows_ || column >= kMaxColumns;
  const bool is_before = row + 1 < rows_.size() || (row + 1 == rows_.size() && column < rows_.back().cells);
  is_disordered_ |= is_before;
  if (is_full_ || is_before) return false;
  const std::size_t lines = row + 1 - rows_.size();
  if (!HasRoom(lines + column + 1)) return false;
  text_.append(rows_.empty() ? lines - 1 : lines, '\n');
  rows_.resize(row + 1);
  Row& last = rows_.back();
  if (last.is_comment) QuoteComment();
  text_.append(last.cells == 0 ? column : column + 1 - last.cells, kSeparator);
  last.cells = static_cast<std::uint32_t>(column + 1);
  return true;
}

/// A row of several cells is no comment, even if it is a header that begins with "#" or "# time".
void CsvText::QuoteComment() {
  const std::size_t begin = text_.rfind('\n') + 1;  // npos + 1 is 0
  const std::string cell = text_.substr(begin);
  text_.erase(begin);
  text_ += InQuotes(cell);
  rows_.back().is_comment = false;
}

void CsvText::AddNumber(std::size_t row, std::size_t column, double number) {
  constexpr std::size_t kLongest = 32;  // "-2.2250738585072014e-308" has 24 characters.
  if (!std::isfinite(number) || !BeginCell(row, column)) return;
  std::array<char, kLongest> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), number);
  text_.append(digits.data(), end);
}

void CsvText::AddText(std::size_t row, std::size_t column, std::string_view text) {
  if (text.empty() || !HasRoom(2 * text.size() + 2) || !BeginCell(row, column)) return;
  if (column == 0 && IsComment(text)) {
    text_ += OnOneLine(text);
    rows_.back().is_comment = true;
    return;
  }
  text_ += CsvCell(text);
}

std::string CsvText::Padded(std::size_t width) const {
  std::string padded;
  std::string_view rest = text_;
  for (const Row& row : rows_) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    padded += rest.substr(0, end);
    if (row.cells > 0 && !row.is_comment) padded.append(width - row.cells, kSeparator);
    padded += '\n';
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return padded;
}

std::string CsvText::Finish() {
  std::size_t width = 0, missing = 0;
  for (const Row& row : rows_) width = std::max<std::size_t>(width, row.cells);
  for (const Row& row : rows_) missing += row.cells == 0 || row.is_comment ? 0 : width - row.cells;
  if (!HasRoom(missing)) return "";
  if (missing > 0) return Padded(width);
  if (!rows_.empty()) text_ += '\n';
  return std::move(text_);
}

}  // namespace pendulum
