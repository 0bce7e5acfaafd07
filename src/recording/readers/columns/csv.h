// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>

#include "pendulum/base/format.h"
#include "pendulum/base/status.h"
#include "pendulum/base/try.h"
#include "pendulum/recording/readers/columns/line_reader.h"

/// The grammar of CSV text: blanks, quotes, numbers, separators. Fields are never copied.
namespace pendulum::csv {

constexpr bool IsBlank(char c) { return c == ' ' || c == '\t'; }

inline std::string_view Trim(std::string_view text) {
  while (!text.empty() && IsBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
  return text;
}

/// Whether a cell says that there is no number, as programs write it.
inline bool IsMissing(std::string_view text) {
  constexpr std::array<std::string_view, 9> kWords = {"", "NaN", "nan", "NAN", "NA", "N/A", "#N/A", "null", "None"};
  return std::find(kWords.begin(), kWords.end(), text) != kWords.end();
}

/// Whether a line begins with text: a letter comes before any digit, or it has neither.
inline bool IsText(std::string_view line) {
  const auto is_letter_or_digit = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           static_cast<signed char>(c) < 0;
  };
  const auto* const first = std::find_if(line.begin(), line.end(), is_letter_or_digit);
  return first == line.end() || *first < '0' || *first > '9';
}

inline std::string_view Unquote(std::string_view text) {
  text = Trim(text);
  return text.size() < 2 || text.front() != '"' || text.back() != '"' ? text : Trim(text.substr(1, text.size() - 2));
}

/// A line of a file, for messages.
struct Line {
  std::string_view file;
  std::string_view text;
  std::size_t number = 0;

  static constexpr std::size_t kNoNumber = static_cast<std::size_t>(-1);  // For a file without lines.

  /// An error at byte `at` of the text.
  tl::unexpected<Status> Fault(const char* at, const std::string& sentence,
                               StatusCode code = StatusCode::kDataLoss) const {
    std::string place(file);
    if (number != kNoNumber)
      place += ":" + std::to_string(std::max<std::size_t>(number, 1)) + ":" + std::to_string(at - text.data() + 1);
    return ErrorAt(code, std::move(place), sentence);
  }
};

/// Calls take() for each line of a file, stored in `line`, until take() returns an error.
template <typename Take>
Result<void> ForEachLine(LineReader& lines, Line& line, const Take& take) {
  line.file = lines.name();
  while (true) {
    ASSIGN_OR_RETURN(const bool next, lines.Next());
    if (!next) return {};
    line.text = lines.line();
    line.number = lines.number();
    RETURN_IF_ERROR(take());
  }
}

/// std::from_chars that also accepts a leading plus sign.
inline std::from_chars_result FromChars(const char* begin, const char* end, double& number) {
  if (end - begin > 1 && begin[0] == '+' && begin[1] != '-') ++begin;
  return std::from_chars(begin, end, number);
}

/// std::from_chars for a number with a decimal comma.
inline std::from_chars_result FromCharsWithComma(const char* begin, const char* end, double& number) {
  constexpr std::size_t kLongest = 128;
  std::array<char, kLongest> point;  // The number with a decimal point.
  const char* stop = begin;
  std::size_t size = 0, commas = 0;
  for (; stop != end && size < kLongest; ++stop) {
    const bool is_comma = *stop == ',';
    if (is_comma && ++commas > 1) break;
    if (!is_comma && (*stop == '\0' || std::strchr("0123456789+-eE", *stop) == nullptr)) break;
    point.at(size++) = is_comma ? '.' : *stop;
  }
  const auto [read_to, error] = FromChars(point.data(), point.data() + size, number);
  return {begin + (read_to - point.data()), error};
}

/// Reads the numbers of one file, which all have a decimal point or all a decimal comma. The first number with a
/// decimal mark decides.
class Numbers {
 public:
  explicit Numbers(bool may_have_comma = false) : mark_(may_have_comma ? kUnknown : '.') {}

  /// Like std::from_chars.
  std::from_chars_result From(const char* begin, const char* end, double& number) {
    if (mark_ == '.') return FromChars(begin, end, number);
    const std::from_chars_result plain = FromChars(begin, end, number);
    if (mark_ == kUnknown && plain.ec == std::errc() && std::find(begin, plain.ptr, '.') != plain.ptr) {
      mark_ = '.';
      return plain;
    }
    const std::from_chars_result comma = FromCharsWithComma(begin, end, number);
    if (comma.ec == std::errc() && std::find(begin, comma.ptr, ',') != comma.ptr) mark_ = ',';
    return comma;
  }

  /// True if the whole text is a finite number. Other text, such as the date 05.11.2026, does not fix
  /// the decimal mark.
  bool Parse(std::string_view text, double& number) {
    const char* end = text.data() + text.size();
    Numbers trial = *this;
    const auto [stop, error] = trial.From(text.data(), end, number);
    const bool is_number = error == std::errc() && stop == end && std::isfinite(number);
    if (is_number) *this = trial;
    return is_number;
  }

  /// Why Parse refuses the field, and what to do.
  std::string NumberFault(std::string_view text) const;

 private:
  static constexpr char kUnknown = '?';

  char mark_;
};

inline std::string Numbers::NumberFault(std::string_view text) const {
  if (text.empty()) return "is empty where a number is needed; complete the row or delete it";
  const std::string holds = "holds " + Quoted(text);
  double number = 0;
  const auto [stop, error] = Numbers(*this).From(text.data(), text.data() + text.size(), number);
  const std::string_view rest = text.substr(stop - text.data());
  if (error == std::errc::result_out_of_range) {
    return holds +
           ", which is outside the range of numbers (about 1e-308 to 1e308); correct the field or delete the row";
  }
  if (error != std::errc()) return holds + ", which is not a number; correct the field or delete the row";
  if (!std::isfinite(number)) return holds + ", and a sample must be finite; delete the row";
  if (mark_ == '.' && rest.front() == ',') {
    return holds + ", a number with a decimal comma in a file of decimal points; write decimals with a point";
  }
  if (mark_ == ',' && rest.front() == '.') {
    return holds + ", a number with a decimal point in a file of decimal commas; write decimals with a comma";
  }
  return holds + ", a number followed by " + Quoted(rest) + "; correct the field or delete the row";
}

/// Parses a number with a decimal point, for metadata and flags.
inline bool ParseNumber(std::string_view text, double& number) { return Numbers().Parse(text, number); }

/// std::find for bytes; faster, because it uses memchr.
inline const char* Find(const char* from, const char* end, char wanted) {
  const void* found = from == end ? nullptr : std::memchr(from, wanted, end - from);
  return found == nullptr ? end : static_cast<const char*>(found);
}

/// Splits a line into fields. A separator inside a field that begins with a double quote does not end it. If the
/// separator is a blank, a run of blanks is one separator.
class FieldCutter {
 public:
  FieldCutter(std::string_view line, char separator)
      : at_(line.data()), end_(line.data() + line.size()), separator_(separator) {
    if (separator_ != ' ') return;
    while (at_ != end_ && IsBlank(end_[-1])) --end_;
    SkipSeparators();
  }

  bool done() const { return done_; }

  /// The start of the next field's text.
  const char* at() const { return SkipBlanks(at_); }

  /// The next field including blanks and quotes, found without examining each of its bytes.
  std::string_view Next() {
    const char* begin = at_;
    const char* from = SkipBlanks(begin);
    if (from != end_ && *from == '"') from = ClosingQuote(from);
    const char* stop = Find(from, end_, separator_);
    Advance(stop);
    return {begin, static_cast<std::size_t>(stop - begin)};
  }

  /// Reads the next field if it is an unquoted finite number, without first finding its end. Otherwise does not
  /// advance.
  bool NextNumber(Numbers& numbers, double& number) {
    Numbers trial = numbers;
    const auto [stop, error] = trial.From(SkipBlanks(at_), end_, number);
    const char* next = SkipBlanks(stop);
    if (error != std::errc() || !std::isfinite(number) || (next != end_ && *next != separator_)) return false;
    numbers = trial;
    Advance(next);
    return true;
  }

 private:
  const char* SkipBlanks(const char* at) const {
    while (at != end_ && IsBlank(*at) && *at != separator_) ++at;
    return at;
  }

  /// A doubled quote is part of the field. A quote that is never closed extends to the end of the line.
  const char* ClosingQuote(const char* opening) const {
    const char* quote = Find(opening + 1, end_, '"');
    while (end_ - quote > 1 && quote[1] == '"') quote = Find(quote + 2, end_, '"');
    return quote;
  }

  void Advance(const char* stop) {
    done_ = stop == end_;
    at_ = done_ ? end_ : stop + 1;
    if (separator_ == ' ') SkipSeparators();
  }

  void SkipSeparators() {
    while (at_ != end_ && IsBlank(*at_)) ++at_;
  }

  const char* at_;
  const char* end_;
  char separator_;
  bool done_ = false;
};

}  // namespace pendulum::csv
