// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/form_data.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/base/utf8.h"
#include "pendulum/service/media_type.h"
#include "service/escapes.h"

namespace pendulum {
namespace {

constexpr std::string_view kLineEnd = "\r\n";

tl::unexpected<Status> WrongForm(const std::string& sentence) {
  return Error(StatusCode::kInvalidArgument, "the form " + sentence);
}

// ---- The boundary and its lines ------------------------------------------------------------------------------------

Result<std::string> BoundaryOf(std::string_view content_type) {
  constexpr std::size_t kLongest = 70;  // RFC 2046, section 5.1.1
  const auto type = ParseMediaType(content_type);
  if (!type) return tl::unexpected(type.error());
  if (type->type != "multipart/form-data") {
    return Error(StatusCode::kInvalidArgument,
                 "the content type is " + Quoted(type->type) + "; it must be multipart/form-data");
  }
  const auto boundary = type->Parameter("boundary");
  if (!boundary) return WrongForm("has no boundary; write it as multipart/form-data; boundary=...");
  if (boundary->empty() || boundary->size() > kLongest || boundary->ends_with(' ')) {
    return WrongForm("has the boundary " + Quoted(*boundary) +
                     "; it must have 1 to 70 bytes and must not end in a blank");
  }
  return std::string(*boundary);
}

/// A boundary line, from the line end before it to its own line end, both included.
struct BoundaryLine {
  std::size_t begin, end;
  bool is_last;
};

/// Finds the boundary lines of a body in linear time.
class BoundaryLines {
 public:
  BoundaryLines(std::string_view body, const std::string& boundary)
      : body_(body), mark_(std::string(kLineEnd) + "--" + boundary) {}

  /// The first boundary line; the body may begin with it.
  std::optional<BoundaryLine> First() const {
    const std::string_view at_begin = std::string_view(mark_).substr(kLineEnd.size());
    if (body_.starts_with(at_begin)) {
      if (auto line = LineOf(0, at_begin.size())) return line;
    }
    return FindFrom(0);
  }

  /// The boundary line after `line`; it may begin with the line end of `line`.
  std::optional<BoundaryLine> NextAfter(const BoundaryLine& line) const { return FindFrom(line.end - kLineEnd.size()); }

 private:
  std::optional<BoundaryLine> FindFrom(std::size_t from) const {
    while ((from = body_.find(mark_, from)) != std::string_view::npos) {
      if (auto line = LineOf(from, from + mark_.size())) return line;
      from += mark_.size();
    }
    return std::nullopt;
  }

  /// A boundary line has the boundary, two dashes if it is the last one, and blanks added in transport. A longer line
  /// is content.
  std::optional<BoundaryLine> LineOf(std::size_t begin, std::size_t behind_mark) const {
    const bool is_last = body_.substr(behind_mark).starts_with("--");
    const std::size_t blanks = behind_mark + (is_last ? 2 : 0);
    const std::size_t end = std::min(body_.find_first_not_of(" \t", blanks), body_.size());
    if (body_.substr(end).starts_with(kLineEnd)) return BoundaryLine{begin, end + kLineEnd.size(), is_last};
    if (is_last && end == body_.size()) return BoundaryLine{begin, end, is_last};
    return std::nullopt;
  }

  std::string_view body_;
  std::string mark_;
};

// ---- The head of a part --------------------------------------------------------------------------------------------

/// The fields of a part that are used, as written.
struct PartHead {
  std::optional<std::string> disposition, type, encoding;
};

/// Reads one part; `place` is its name in messages: "part 3".
struct PartReader {
  std::string place;

  tl::unexpected<Status> Wrong(const std::string& sentence) const {
    return Error(StatusCode::kInvalidArgument, place + " of the form " + sentence);
  }

  /// Splits the text between two boundaries into head and content.
  Result<std::pair<std::string_view, std::string_view>> Split(std::string_view part) const {
    constexpr std::string_view kBlankLine = "\r\n\r\n";
    if (part.starts_with(kLineEnd)) return std::pair(part.substr(0, 0), part.substr(kLineEnd.size()));
    const std::size_t head = part.substr(0, kMaxPartHeadBytes + kBlankLine.size()).find(kBlankLine);
    if (head != std::string_view::npos) return std::pair(part.substr(0, head), part.substr(head + kBlankLine.size()));
    if (part.size() > kMaxPartHeadBytes) {
      return Wrong("has a head of more than " + std::to_string(kMaxPartHeadBytes) +
                   " bytes, or no blank line below it; shorten its names");
    }
    // A part with a head only: its blank line may be the line end before the boundary.
    if (part.ends_with(kLineEnd)) return std::pair(part.substr(0, part.size() - kLineEnd.size()), std::string_view());
    return Wrong("has no blank line below its head; write one, with lines that end in CR LF");
  }

  Result<void> ReadField(std::string_view line, PartHead& head) const {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || !IsToken(line.substr(0, colon))) {
      return Wrong("has the line " + Quoted(line) + " in its head; write Name: value");
    }
    if (std::ranges::any_of(line, [](char c) { return c != '\t' && IsControl({&c, 1}); })) {
      return Wrong("has a control character in its head, " + Quoted(line) + "; leave it out, and end lines in CR LF");
    }
    const std::string name = LowerCase(line.substr(0, colon));
    std::optional<std::string>* const value = name == "content-disposition"         ? &head.disposition
                                              : name == "content-type"              ? &head.type
                                              : name == "content-transfer-encoding" ? &head.encoding
                                                                                    : nullptr;
    if (value == nullptr) return {};
    if (*value) return Wrong("has the field " + name + " twice; keep one of them");
    *value = WithoutBlanks(line.substr(colon + 1));
    return {};
  }

  /// A line that begins with a blank continues the previous one (RFC 5322, section 2.2.3).
  Result<PartHead> ReadHead(std::string_view text) const {
    PartHead head;
    while (!text.empty()) {
      std::string line;
      do {
        const std::string_view piece = text.substr(0, text.find(kLineEnd));
        line += piece;
        text.remove_prefix(std::min(text.size(), piece.size() + kLineEnd.size()));
      } while (text.starts_with(' ') || text.starts_with('\t'));
      RETURN_IF_ERROR(ReadField(line, head));
    }
    return head;
  }

  Result<FieldParameters> ReadDisposition(const std::optional<std::string>& disposition) const {
    if (!disposition) return Wrong("has no name; write Content-Disposition: form-data; name=\"data\"");
    const std::string_view text = *disposition;
    const std::string_view kind = text.substr(0, text.find(';'));
    if (LowerCase(WithoutBlanks(kind)) != "form-data") {
      return Wrong("has the Content-Disposition " + Quoted(text) + "; it must be form-data");
    }
    return ParseFieldParameters(text.substr(kind.size()), place + " of the form", Backslash::kEscapesQuotes);
  }

  /// Decodes an extended value (RFC 8187, section 3.2): charset, language and escaped bytes.
  Result<std::string> DecodeExtended(std::string_view value) const {
    const std::size_t charset = value.find('\'');
    const std::size_t language = charset == std::string_view::npos ? charset : value.find('\'', charset + 1);
    if (language == std::string_view::npos || LowerCase(value.substr(0, charset)) != "utf-8") {
      return Wrong("has the filename* " + Quoted(value) + "; write UTF-8''name, or filename=\"name\"");
    }
    auto decoded = WithoutEscapes(value.substr(language + 1));
    if (!decoded || !IsUtf8(*decoded)) {
      return Wrong("has the filename* " + Quoted(value) + ", whose escapes are not UTF-8; write filename=\"name\"");
    }
    return *std::move(decoded);
  }

  Result<void> CheckEncoding(const std::optional<std::string>& encoding) const {
    constexpr std::array<std::string_view, 3> kPlain = {"7bit", "8bit", "binary"};
    if (!encoding || std::ranges::find(kPlain, LowerCase(*encoding)) != kPlain.end()) return {};
    return Wrong("has the Content-Transfer-Encoding " + Quoted(*encoding) + "; send its bytes as they are, in binary");
  }

  Result<FormPart> Read(std::string_view text) const;
};

/// Decodes the browsers' escapes for a quote and line breaks; any other percent sign stays.
std::string WithoutBrowserEscapes(std::string_view text) {
  constexpr std::string_view kEscaped = "\"\r\n";
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = EscapedByte(text.substr(i));
    const bool is_escape = byte && kEscaped.find(*byte) != std::string_view::npos;
    decoded += is_escape ? *byte : text[i];
    if (is_escape) i += 2;
  }
  return decoded;
}

Result<FormPart> PartReader::Read(std::string_view text) const {
  ASSIGN_OR_RETURN(const auto split, Split(text));
  ASSIGN_OR_RETURN(const auto head, ReadHead(split.first));
  RETURN_IF_ERROR(CheckEncoding(head.encoding));
  ASSIGN_OR_RETURN(const auto parameters, ReadDisposition(head.disposition));
  FormPart part{"", "", head.type.value_or(""), split.second};
  bool is_extended = false;
  for (const auto& [name, value] : parameters) {
    if (name == "name") part.name = WithoutBrowserEscapes(value);
    if (name == "filename" && !is_extended) part.filename = WithoutBrowserEscapes(value);
    if (name != "filename*") continue;
    ASSIGN_OR_RETURN(auto decoded, DecodeExtended(value));
    part.filename = std::move(decoded);
    is_extended = true;
  }
  if (part.name.empty()) return Wrong("has no name; write Content-Disposition: form-data; name=\"data\"");
  return part;
}

}  // namespace

Result<std::vector<FormPart>> ParseFormData(std::string_view content_type, std::string_view body) {
  const auto boundary = BoundaryOf(content_type);
  if (!boundary) return tl::unexpected(boundary.error());
  const BoundaryLines lines(body, *boundary);
  auto line = lines.First();
  if (!line) {
    return WrongForm("has no line " + Quoted("--" + *boundary) +
                     ", the boundary of its content type; begin each part with one, and end it in CR LF");
  }
  std::vector<FormPart> parts;
  while (!line->is_last) {
    const PartReader reader{"part " + std::to_string(parts.size() + 1)};
    const auto next = lines.NextAfter(*line);
    if (!next) return reader.Wrong("has no boundary after it; end the form with " + Quoted("--" + *boundary + "--"));
    if (parts.size() == kMaxFormParts) {
      return WrongForm("has more than " + std::to_string(kMaxFormParts) + " parts; send several forms");
    }
    ASSIGN_OR_RETURN(auto part, reader.Read(body.substr(line->end, std::max(next->begin, line->end) - line->end)));
    parts.push_back(std::move(part));
    line = next;
  }
  return parts;
}

}  // namespace pendulum
