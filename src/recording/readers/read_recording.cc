// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/readers/read_recording.h"

#include <algorithm>
#include <span>
#include <utility>

#include "pendulum/base/file.h"
#include "pendulum/base/sha256.h"
#include "pendulum/base/try.h"
#include "pendulum/recording/readers/columns/line_reader.h"
#include "recording/readers/bytes_recording.h"
#include "recording/readers/containers/npy.h"
#include "recording/readers/containers/utf16.h"
#include "recording/readers/content.h"
#include "recording/readers/mat/mat_recording.h"
#include "recording/readers/text/labelled_rows.h"
#include "recording/readers/text/row_reader.h"
#include "recording/readers/workbook_recording.h"
#include "recording/readers/zip_recording.h"

namespace pendulum {
namespace {

/// Files other than text are read into memory completely. A larger file is refused, because it is not a recording.
constexpr std::size_t kMaxBytes = std::size_t{1} << 29;

/// Reads the remaining bytes of a file. `bytes` are its first bytes.
Result<std::string> ReadRest(InputFile& file, std::string bytes) {
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  while (true) {
    const std::size_t used = bytes.size();
    bytes.resize(std::max(2 * used, kBlock));
    ASSIGN_OR_RETURN(const std::size_t got, file.Read(std::span(bytes).subspan(used)));
    const bool is_end = used + got < bytes.size();
    bytes.resize(used + got);
    if (bytes.size() > kMaxBytes) {
      return Fault(file.name(), "the file has more than " + std::to_string(kMaxBytes) +
                                    " bytes, too many for a file other than text; export the recording as CSV");
    }
    if (is_end) return bytes;
  }
}

Result<Recording> ReadInput(InputFile file, const ReadOptions& options) {
  std::string begin(kContentBytes, '\0');
  ASSIGN_OR_RETURN(const std::size_t got, file.Read(begin));
  begin.resize(got);
  const Content content = ContentOf(begin);
  if (content == Content::kText) return ReadRows(LineReader(std::move(file), begin), options);
  if (content == Content::kForeign) return ForeignContent(begin, file.name());  // may be larger than the memory
  ASSIGN_OR_RETURN(const std::string bytes, ReadRest(file, std::move(begin)));
  return ParseRecording(bytes, file.name(), options);
}

/// A recording that was read from a text made from the bytes of a file.
Result<Recording> FromConverted(Result<Recording> recording, std::string_view bytes) {
  if (!recording) return recording;
  ASSIGN_OR_RETURN(std::string sha256, Sha256(bytes));
  recording->sha256 = std::move(sha256);
  return recording;
}

/// Reads text in UTF-16 as if it were UTF-8. An XML text names its encoding.
Result<Recording> ReadUtf16(std::string_view bytes, const std::string& name, const ReadOptions& options,
                            Nesting nesting) {
  const bool is_marked = bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF");
  const bool is_big = is_marked ? bytes.starts_with('\xFE') : bytes.starts_with('\0');
  const std::string text = Utf8OfUtf16(bytes.substr(is_marked ? 2 : 0), is_big ? ByteOrder::kBig : ByteOrder::kLittle);
  if (ContentOf(std::string_view(text).substr(0, kContentBytes)) == Content::kXml) {
    return ReadXml(bytes, name, options);
  }
  return FromConverted(ReadBytes(text, name, options, nesting), bytes);
}

/// Reads text whose lines end with a carriage return alone.
Result<Recording> ReadLinesWithReturns(std::string_view bytes, const std::string& name, const ReadOptions& options,
                                       Nesting nesting) {
  std::string text(bytes);
  std::ranges::replace(text, '\r', '\n');
  return FromConverted(ReadBytes(text, name, options, nesting), bytes);
}

Result<Recording> ReadLabelled(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  ASSIGN_OR_RETURN(const std::string text, csv::TableOfLabelledRows(bytes, name));
  return FromConverted(ReadRows(LineReader(text, name), options), bytes);
}

}  // namespace

Result<Recording> ReadBytes(std::string_view bytes, const std::string& name, const ReadOptions& options,
                            Nesting nesting) {
  switch (ContentOf(bytes.substr(0, kContentBytes))) {
    case Content::kText: return ReadRows(LineReader(bytes, name), options);
    case Content::kLabelled: return ReadLabelled(bytes, name, options);
    case Content::kReturns: return ReadLinesWithReturns(bytes, name, options, nesting);
    case Content::kUtf16: return ReadUtf16(bytes, name, options, nesting);
    case Content::kZip: return ReadZip(bytes, name, options, nesting);
    case Content::kMat: return ReadMat(bytes, name, options);
    case Content::kNpy: return FromWorkbook(ReadNpy(bytes, options.most_unpacked_bytes), kArrays, bytes, name, options);
    case Content::kJson: return ReadJson(bytes, name, options);
    case Content::kXml: return ReadXml(bytes, name, options);
    case Content::kCompound: return ReadCompound(bytes, name, options);
    case Content::kForeign: break;
  }
  return ForeignContent(bytes.substr(0, kContentBytes), name);
}

Result<Recording> ParseRecording(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  return ReadBytes(bytes, name, options, Nesting::kFile);
}

Result<Recording> ReadRecording(const std::filesystem::path& path, const ReadOptions& options) {
  if (path == "-") return ReadInput(InputFile::StandardInput(), options);
  ASSIGN_OR_RETURN(InputFile file, InputFile::Open(path, "CSV"));
  return ReadInput(std::move(file), options);
}

}  // namespace pendulum
