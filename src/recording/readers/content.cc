// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/content.h"

#include <algorithm>

#include "pendulum/base/file.h"
#include "pendulum/base/utf8.h"
#include "recording/readers/foreign_formats.h"
#include "recording/readers/mat/mat_version_4.h"
#include "recording/readers/text/labelled_rows.h"

namespace pendulum {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kHdf5 = "\x89HDF\r\n\x1A\n"sv;
constexpr std::string_view kMat = "MATLAB "sv;

/// MATLAB's own files begin with a text of 116 bytes, "MATLAB 5.0 MAT-file, ...". In version 7.3, HDF5 data follow.
/// Files of version 4 begin with a variable.
bool IsMat(std::string_view begin) {
  constexpr std::size_t kHeader = 128, kUserBlock = 512;
  if (SizeOfVersion4(begin)) return true;
  if (!begin.starts_with(kMat) || begin.size() < kHeader) return false;
  const std::string_view text = begin.substr(0, kHeader - 12);
  if (text.find("MAT-file") == std::string_view::npos) return false;
  const std::string_view order = begin.substr(kHeader - 2, 2);
  return order == "IM" || order == "MI" || begin.substr(std::min(kUserBlock, begin.size())).starts_with(kHdf5);
}

/// The text without a byte order mark and blanks before it.
std::string_view WithoutBeginning(std::string_view text) {
  text = WithoutByteOrderMark(text);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  return text;
}

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// XML begins with a declaration, a comment or the name of an element. Rows such as <12,34> do not.
bool IsXml(std::string_view begin) {
  const std::string_view text = WithoutBeginning(begin);
  if (text.starts_with("<?xml") || text.starts_with("<!--") || text.starts_with("<!DOCTYPE")) return true;
  if (text.size() < 2 || text.front() != '<' || !IsLetter(text[1])) return false;
  const auto is_of_name = [](char c) {
    return IsLetter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == ':' || c == '.';
  };
  const auto* const end = std::find_if_not(text.begin() + 1, text.end(), is_of_name);
  return end == text.end() || " \t\r\n/>"sv.find(*end) != std::string_view::npos;
}

/// Whether a text after "[", which begins with a number, is the rest of a list of JSON and not of a row with a stamp,
/// such as "[12:00:01.123] 0.5".
bool IsListOfNumbers(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of("+-.0123456789eE"), text.size()));
  text = WithoutBeginning(text);
  if (text.empty() || text.front() == ',') return true;
  return text.front() == ']' && WithoutBeginning(text.substr(1)).empty();
}

/// A table may also begin with a bracket, as in "[Header]" or "[s],[deg]".
bool IsJson(std::string_view begin) {
  const std::string_view text = WithoutBeginning(begin);
  if (text.empty() || (text.front() != '{' && text.front() != '[')) return false;
  const std::string_view rest = WithoutBeginning(text.substr(1));
  if (rest.empty()) return false;
  if (text.front() == '{') return rest.front() == '"';
  if ("-0123456789"sv.find(rest.front()) != std::string_view::npos) return IsListOfNumbers(rest);
  return R"([{"])"sv.find(rest.front()) != std::string_view::npos || rest.starts_with("null") ||
         rest.starts_with("NaN");
}

/// UTF-16 has a mark, or, where text is mostly ASCII, a NUL in each second byte.
bool IsUtf16(std::string_view begin) {
  constexpr std::size_t kEnough = 8;
  if (begin.starts_with("\xFF\xFE"sv) || begin.starts_with("\xFE\xFF"sv)) return true;
  std::size_t even = 0, odd = 0;
  for (std::size_t i = 0; i < begin.size(); ++i) {
    if (begin[i] == '\0') ++(i % 2 == 0 ? even : odd);
  }
  const std::size_t half = begin.size() / 2;
  return half >= kEnough && std::min(even, odd) == 0 && 10 * std::max(even, odd) >= 9 * half;
}

bool HasReturnsAlone(std::string_view begin) {
  return begin.find('\r') < begin.size() - 1 && begin.find('\n') == std::string_view::npos;
}

}  // namespace

Content ContentOf(std::string_view begin) {
  if (begin.starts_with("PK\3\4"sv)) return Content::kZip;
  if (IsMat(begin)) return Content::kMat;
  if (begin.starts_with("\x93NUMPY"sv)) return Content::kNpy;
  if (begin.starts_with("\xD0\xCF\x11\xE0"sv)) return Content::kCompound;
  if (IsUtf16(begin)) return Content::kUtf16;
  if (!ForeignFormat(begin).empty()) return Content::kForeign;
  if (IsXml(begin)) return Content::kXml;
  if (IsJson(begin)) return Content::kJson;
  if (HasReturnsAlone(begin)) return Content::kReturns;
  return csv::HasLabelledRows(begin) ? Content::kLabelled : Content::kText;
}

tl::unexpected<Status> ForeignContent(std::string_view begin, const std::string& name) {
  const std::string_view sentence = ForeignFormat(begin);
  return Fault(name, std::string(sentence.empty() ? "the format of this file is not supported" : sentence));
}

}  // namespace pendulum
