// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/find_recordings.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <ios>
#include <span>
#include <system_error>
#include <utility>

#include <fnmatch.h>

#include "pendulum/base/file.h"
#include "pendulum/base/try.h"
#include "pendulum/base/utf8.h"
#include "pendulum/recording/readers/file_names.h"

namespace pendulum {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAnyFolders = "**";

bool IsPattern(const std::string& part) { return part.find_first_of("*?[") != std::string::npos; }

bool MatchesPattern(const std::string& name, const std::string& part) {
  return ::fnmatch(part.c_str(), name.c_str(), FNM_PERIOD) == 0;
}

/// The entries of a folder, in the order of names; empty if the folder does not exist.
Result<std::vector<fs::directory_entry>> EntriesOf(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::directory_entry> entries;
  for (fs::directory_iterator at(folder.empty() ? "." : folder, error), end; !error && at != end; at.increment(error)) {
    entries.push_back(*at);
  }
  if (error && error != std::errc::no_such_file_or_directory && error != std::errc::not_a_directory) {
    return Fault(folder.string(), "this folder cannot be read; check its permissions, or name another folder");
  }
  std::ranges::sort(entries, {}, [](const fs::directory_entry& entry) { return entry.path().filename(); });
  return entries;
}

/// Whether a file is a manifest or an export of refit_pendulums: text whose first line names columns, with one named
/// path.
bool IsList(const std::string& path) {
  constexpr std::streamsize kLongest = std::streamsize{1} << 16;
  std::error_code unknown;
  if (fs::status(path, unknown).type() != fs::file_type::regular) return false;  // a pipe would wait
  std::string line(static_cast<std::size_t>(kLongest), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(line.data(), kLongest);
  line.resize(static_cast<std::size_t>(file.gcount()));
  line.resize(std::min(line.find_first_of("\r\n"), line.size()));
  line = std::string(WithoutByteOrderMark(line));
  if (line.find('\0') != std::string::npos) return false;
  std::ranges::replace_if(
      line, [](char c) { return c == ';' || c == '\t'; }, ',');
  return line == "path" || ("," + line + ",").find(",path,") != std::string::npos;
}

/// Appends the paths that match `parts` in `folder` to `found`, in the order of names.
Result<void> Find(const fs::path& folder, std::span<const std::string> parts, std::vector<std::string>& found) {
  if (parts.front() == kAnyFolders) {  // matches zero folders, too
    RETURN_IF_ERROR(Find(folder, parts.subspan(1), found));
  }
  ASSIGN_OR_RETURN(const auto entries, EntriesOf(folder));
  std::error_code error;
  for (const fs::directory_entry& entry : entries) {
    const std::string name = entry.path().filename().string();
    const bool any = parts.front() == kAnyFolders;
    if (any ? name.starts_with('.') : !MatchesPattern(name, parts.front())) continue;
    const bool last = parts.size() == 1;
    if (last && !any) {
      if (!entry.is_directory(error)) found.push_back((folder / name).string());
    } else if (entry.is_directory(error) && !entry.is_symlink(error)) {
      RETURN_IF_ERROR(Find(folder / name, any ? parts : parts.subspan(1), found));
    }
  }
  return {};
}

/// Splits a path into the folder before its first pattern and the remaining parts. The folder is used literally.
std::pair<fs::path, std::vector<std::string>> Cut(const fs::path& path) {
  fs::path folder;
  std::vector<std::string> parts;
  for (const fs::path& part : path) {
    if (parts.empty() && !IsPattern(part.string())) {
      folder /= part;
    } else if (!part.empty()) {
      parts.push_back(part.string());
    }
  }
  return {folder, parts};
}

}  // namespace

Result<FoundRecordings> FindRecordings(const std::string& pattern) {
  std::error_code error;
  FoundRecordings found;
  std::vector<std::string>& paths = found.paths;
  Result<void> done;
  std::string what = "there is no such file or folder";
  if (fs::is_directory(pattern, error)) {
    done = Find(pattern, std::vector<std::string>{kAnyFolders, "*"}, paths);
    std::erase_if(paths, [&](const std::string& path) {
      const std::string name = fs::path(path).filename().string();
      if (name.starts_with("~$")) return true;  // Excel keeps ~$run.xlsx while run.xlsx is open
      const bool is_list = HasRecordingName(name) && IsList(path);
      if (HasRecordingName(name) && !is_list) return false;
      (is_list ? found.lists : found.left_out).push_back(path);
      return true;
    });
    what = "there is no " + RecordingNames() + " file in this folder or below it";
  } else if (fs::exists(pattern, error)) {
    paths.push_back(pattern);
  } else if (IsPattern(pattern)) {
    auto [folder, parts] = Cut(pattern);
    if (parts.back() == kAnyFolders) parts.emplace_back("*");
    done = Find(folder, parts, paths);
    what = "no file matches this pattern";
  }
  if (!done) return tl::unexpected(done.error());
  std::ranges::sort(paths);
  paths.erase(std::unique(paths.begin(), paths.end()), paths.end());  // several ** may match the same file
  if (!paths.empty()) return found;
  return ErrorAt(StatusCode::kNotFound, pattern, what + "; check the path");
}

}  // namespace pendulum
