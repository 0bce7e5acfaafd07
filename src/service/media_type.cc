// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/media_type.h"

#include <algorithm>
#include <cstddef>
#include <set>

#include "pendulum/base/format.h"

namespace pendulum {
namespace {

constexpr std::string_view kBlanks = " \t";

char LowerLetter(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool IsTokenLetter(char c) {
  const bool is_letter_or_digit = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
  return is_letter_or_digit || std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

std::size_t TokenLength(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::find_if_not(text, IsTokenLetter) - text.begin());
}

tl::unexpected<Status> WrongParameters(std::string_view what, std::string_view at, std::string_view fault) {
  return Error(StatusCode::kInvalidArgument,
               "the parameters of " + std::string(what) + " have " + Quoted(at) + ", " + std::string(fault));
}

bool IsControlInQuotes(char c) { return (c >= 0 && c < ' ' && c != '\t') || c == '\x7F'; }

/// Removes a quoted value from the beginning of the text and returns it; std::nullopt without a closing quote or with a
/// control character.
std::optional<std::string> TakeQuoted(std::string_view& text, Backslash backslash) {
  std::string value;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i] == '"') {
      text.remove_prefix(i + 1);
      return value;
    }
    if (IsControlInQuotes(text[i])) return std::nullopt;
    const char next = i + 1 < text.size() ? text[i + 1] : '\0';
    const bool all = backslash == Backslash::kEscapesAll && !IsControlInQuotes(next);
    const bool escapes = next == '"' || next == '\\' || all;
    if (text[i] == '\\' && escapes) ++i;
    value += text[i];
  }
  return std::nullopt;
}

/// Removes a token from the beginning of the text and returns it; empty if there is none.
std::string TakeToken(std::string_view& text) {
  std::string token(text.substr(0, TokenLength(text)));
  text.remove_prefix(token.size());
  return token;
}

}  // namespace

bool IsToken(std::string_view text) { return !text.empty() && TokenLength(text) == text.size(); }

std::string LowerCase(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(text, lower.begin(), LowerLetter);
  return lower;
}

bool IsSameWord(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, LowerLetter, LowerLetter);
}

std::string_view WithoutBlanks(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);  // npos + 1 is 0
}

Result<FieldParameters> ParseFieldParameters(std::string_view text, std::string_view what, Backslash backslash) {
  FieldParameters parameters;
  std::set<std::string> names;
  while (!(text = WithoutBlanks(text)).empty()) {
    if (text.front() != ';') return WrongParameters(what, text, "where a semicolon must be");
    text = WithoutBlanks(text.substr(1));
    if (text.empty() || text.front() == ';') continue;
    const std::string_view item = text;
    std::string name = LowerCase(TakeToken(text));
    if (name.empty() || !text.starts_with('=')) return WrongParameters(what, item, "which is not name=value");
    text.remove_prefix(1);
    const bool is_quoted = text.starts_with('"');
    std::optional<std::string> value = is_quoted ? TakeQuoted(text, backslash) : TakeToken(text);
    if (!value) return WrongParameters(what, item, "whose quotes do not close, or contain a control character");
    if (value->empty() && !is_quoted) return WrongParameters(what, item, "whose value must be in quotes");
    if (!names.insert(name).second) return WrongParameters(what, name, "which is given twice; keep one of them");
    parameters.emplace_back(std::move(name), *std::move(value));
  }
  return parameters;
}

std::optional<std::string_view> MediaType::Parameter(std::string_view name) const {
  const auto found = std::ranges::find(parameters, name, &FieldParameters::value_type::first);
  if (found == parameters.end()) return std::nullopt;
  return found->second;
}

Result<MediaType> ParseMediaType(std::string_view text) {
  text = WithoutBlanks(text);
  const std::string_view whole = WithoutBlanks(text.substr(0, text.find(';')));
  const std::size_t slash = whole.find('/');
  if (slash == std::string_view::npos || !IsToken(whole.substr(0, slash)) || !IsToken(whole.substr(slash + 1))) {
    return Error(StatusCode::kInvalidArgument,
                 "the content type " + Quoted(text) + " is not a media type; write one such as text/csv");
  }
  auto parameters =
      ParseFieldParameters(text.substr(text.find(whole) + whole.size()), "the content type", Backslash::kEscapesAll);
  if (!parameters) return tl::unexpected(parameters.error());
  return MediaType{LowerCase(whole), *std::move(parameters)};
}

}  // namespace pendulum
