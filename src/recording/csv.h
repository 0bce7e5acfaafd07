// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>

#include "pendulum/base/format.h"

/// The grammar of CSV text, without a copy of a field: blanks, quotes, numbers, separators.
namespace pendulum::csv {

constexpr bool IsBlank(char c) { return c == ' ' || c == '\t'; }

inline std::string_view Trim(std::string_view text) {
  while (!text.empty() && IsBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
  return text;
}

inline std::string_view Unquote(std::string_view text) {
  text = Trim(text);
  return text.size() < 2 || text.front() != '"' || text.back() != '"' ? text : Trim(text.substr(1, text.size() - 2));
}

/// std::from_chars, and a leading plus sign.
inline std::from_chars_result FromChars(const char* begin, const char* end, double& number) {
  if (end - begin > 1 && begin[0] == '+' && begin[1] != '-') ++begin;
  return std::from_chars(begin, end, number);
}

inline bool ParseNumber(std::string_view text, double& number) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = FromChars(text.data(), end, number);
  return error == std::errc() && stop == end && std::isfinite(number);
}

/// What is wrong with a field that ParseNumber refuses, and what to do.
inline std::string WhyNotANumber(std::string_view text) {
  if (text.empty()) return "is empty where a number is needed; complete the row or delete it";
  const std::string holds = "holds " + Quoted(text);
  double number = 0;
  const auto [stop, error] = FromChars(text.data(), text.data() + text.size(), number);
  const std::string_view rest = text.substr(stop - text.data());
  if (error == std::errc::result_out_of_range) {
    return holds + ", beyond what a number can be (about 1e-308 to 1e308); correct the field or delete the row";
  }
  if (error != std::errc()) return holds + ", which is not a number; correct the field or delete the row";
  if (!std::isfinite(number)) return holds + ", and a sample must be finite; delete the row";
  if (rest.front() == ',') return holds + ", a number with a decimal comma; write decimals with a point";
  return holds + ", a number followed by " + Quoted(rest) + "; correct the field or delete the row";
}

/// std::find at the speed of memchr.
inline const char* Find(const char* from, const char* end, char wanted) {
  const void* found = from == end ? nullptr : std::memchr(from, wanted, end - from);
  return found == nullptr ? end : static_cast<const char*>(found);
}

/// Cuts a line into fields. A separator inside a field that begins with a double quote does not end it.
class FieldCutter {
 public:
  FieldCutter(std::string_view line, char separator)
      : at_(line.data()), end_(line.data() + line.size()), separator_(separator) {}

  bool done() const { return done_; }

  /// Where the text of the next field begins.
  const char* at() const { return SkipBlanks(at_); }

  /// The next field with its blanks and quotes, found without looking at each byte of it.
  std::string_view Next() {
    const char* begin = at_;
    const char* from = SkipBlanks(begin);
    if (from != end_ && *from == '"') from = ClosingQuote(from);
    const char* stop = Find(from, end_, separator_);
    Advance(stop);
    return {begin, static_cast<std::size_t>(stop - begin)};
  }

  /// The next field when it is an unquoted finite number, read without finding its end first; otherwise stays in front
  /// of it.
  bool NextNumber(double& number) {
    const auto [stop, error] = FromChars(SkipBlanks(at_), end_, number);
    const char* next = SkipBlanks(stop);
    if (error != std::errc() || !std::isfinite(number) || (next != end_ && *next != separator_)) return false;
    Advance(next);
    return true;
  }

 private:
  const char* SkipBlanks(const char* at) const {
    while (at != end_ && IsBlank(*at) && *at != separator_) ++at;
    return at;
  }

  /// A doubled quote stands for a quote; one that is never closed runs to the end of the line.
  const char* ClosingQuote(const char* opening) const {
    const char* quote = Find(opening + 1, end_, '"');
    while (end_ - quote > 1 && quote[1] == '"') quote = Find(quote + 2, end_, '"');
    return quote;
  }

  void Advance(const char* stop) {
    done_ = stop == end_;
    at_ = done_ ? end_ : stop + 1;
  }

  const char* at_;
  const char* end_;
  char separator_;
  bool done_ = false;
};

}  // namespace pendulum::csv
