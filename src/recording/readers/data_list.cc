// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/readers/data_list.h"

#include <map>
#include <string_view>
#include <system_error>
#include <utility>

#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/recording/readers/columns/line_reader.h"
#include "recording/readers/columns/csv.h"

namespace pendulum {
namespace {

namespace fs = std::filesystem;

Result<void> CheckListed(const ListedFile& file, const std::map<fs::path, std::string>& places) {
  std::error_code error;
  const fs::file_type type = fs::status(file.path, error).type();
  if (type == fs::file_type::not_found) {
    return ErrorAt(StatusCode::kNotFound, file.place,
                   "there is no file " + file.path.string() + "; paths are relative to the folder of the list");
  }
  if (type == fs::file_type::directory) {
    return Fault(file.place, file.path.string() + " is a directory; name a CSV file in it");
  }
  const auto found = places.find(file.path.lexically_normal());
  if (found == places.end()) return {};
  return Fault(file.place, file.path.string() + " is also at " + found->second + "; keep one of them");
}

}  // namespace

Result<std::vector<ListedFile>> ReadDataList(const fs::path& path) {
  ASSIGN_OR_RETURN(InputFile input, path == "-" ? InputFile::StandardInput() : InputFile::Open(path, "list"));
  LineReader lines(std::move(input));
  std::vector<ListedFile> files;
  std::map<fs::path, std::string> places;
  while (true) {
    ASSIGN_OR_RETURN(const bool next, lines.Next());
    if (!next) break;
    const std::string_view text = csv::Trim(lines.line());
    if (text.empty() || text.front() == '#') continue;
    const fs::path folder = path == "-" ? fs::path() : path.parent_path();
    files.push_back({folder / text, lines.name() + ":" + std::to_string(lines.number())});
    RETURN_IF_ERROR(CheckListed(files.back(), places));
    places.emplace(files.back().path.lexically_normal(), files.back().place);
  }
  if (!files.empty()) return files;
  return ErrorAt(StatusCode::kFailedPrecondition, lines.name(), "the list names no file; give one path per line");
}

}  // namespace pendulum
