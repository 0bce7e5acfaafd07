// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/readers/read_recording.h"

#include <algorithm>
#include <span>
#include <utility>

#include "pendulum/base/file.h"
#include "pendulum/recording/readers/columns/line_reader.h"
#include "recording/readers/content.h"
#include "recording/readers/mat/mat_recording.h"
#include "recording/readers/text/row_reader.h"
#include "recording/readers/zip_recording.h"

namespace pendulum {
namespace {

/// Zip and MAT-files are read into memory completely. A larger file is refused, because it is not a recording.
constexpr std::size_t kMaxBytes = std::size_t{1} << 29;

/// Reads the remaining bytes of a file. `bytes` are its first bytes.
Result<std::string> ReadRest(InputFile& file, std::string bytes) {
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  while (true) {
    const std::size_t used = bytes.size();
    bytes.resize(std::max(2 * used, kBlock));
    const Result<std::size_t> got = file.Read(std::span(bytes).subspan(used));
    if (!got) return tl::unexpected(got.error());
    const bool is_end = used + *got < bytes.size();
    bytes.resize(used + *got);
    if (bytes.size() > kMaxBytes) {
      return Fault(file.name(), "the file has more than " + std::to_string(kMaxBytes) +
                                    " bytes, too many for a zip or a MAT-file; export the recording as CSV");
    }
    if (is_end) return bytes;
  }
}

Result<Recording> ReadInput(InputFile file, const ReadOptions& options) {
  std::string begin(kContentBytes, '\0');
  const Result<std::size_t> got = file.Read(begin);
  if (!got) return tl::unexpected(got.error());
  begin.resize(*got);
  const Content content = ContentOf(begin);
  if (content == Content::kText) return ReadRows(LineReader(std::move(file), begin), options);
  if (content == Content::kForeign) return ForeignContent(begin, file.name());  // may be larger than the memory
  const Result<std::string> bytes = ReadRest(file, std::move(begin));
  if (!bytes) return tl::unexpected(bytes.error());
  return ParseRecording(*bytes, file.name(), options);
}

}  // namespace

Result<Recording> ParseRecording(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  switch (ContentOf(bytes.substr(0, kContentBytes))) {
    case Content::kText: return ReadRows(LineReader(bytes, name), options);
    case Content::kZip: return ReadZip(bytes, name, options);
    case Content::kMat: return ReadMat(bytes, name, options);
    case Content::kForeign: break;
  }
  return ForeignContent(bytes, name);
}

Result<Recording> ReadRecording(const std::filesystem::path& path, const ReadOptions& options) {
  if (path == "-") return ReadInput(InputFile::StandardInput(), options);
  Result<InputFile> file = InputFile::Open(path, "CSV");
  if (!file) return tl::unexpected(std::move(file).error());
  return ReadInput(*std::move(file), options);
}

}  // namespace pendulum
