// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/find_recordings.h"

#include <algorithm>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>

#include <fnmatch.h>

#include "pendulum/base/file.h"

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

/// Appends the paths that match `parts` in `folder` to `found`, in the order of names.
Result<void> Find(const fs::path& folder, std::span<const std::string> parts, std::vector<std::string>& found) {
  if (parts.front() == kAnyFolders) {  // matches zero folders, too
    if (auto done = Find(folder, parts.subspan(1), found); !done) return done;
  }
  const auto entries = EntriesOf(folder);
  if (!entries) return tl::unexpected(entries.error());
  std::error_code error;
  for (const fs::directory_entry& entry : *entries) {
    const std::string name = entry.path().filename().string();
    const bool any = parts.front() == kAnyFolders;
    if (any ? name.starts_with('.') : !MatchesPattern(name, parts.front())) continue;
    const bool last = parts.size() == 1;
    if (last && !any) {
      if (!entry.is_directory(error)) found.push_back((folder / name).string());
    } else if (entry.is_directory(error) && !entry.is_symlink(error)) {
      if (auto done = Find(folder / name, any ? parts : parts.subspan(1), found); !done) return done;
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

Result<std::vector<std::string>> FindRecordings(const std::string& pattern) {
  std::error_code error;
  std::vector<std::string> found;
  Result<void> done;
  std::string what = "there is no such file or folder";
  if (fs::is_directory(pattern, error)) {
    // Excel keeps a file ~$run.xlsx while run.xlsx is open.
    for (const char* const kind : {"*.[cC][sS][vV]", "*.[mM][aA][tT]", "*.[zZ][iI][pP]", "[!~]*.[xX][lL][sS]",
                                   "[!~]*.[xX][lL][sS][xX]", "*.[oO][dD][sS]", "*.[nN][pP][zZ]"}) {
      if (done) done = Find(pattern, std::vector<std::string>{kAnyFolders, kind}, found);
    }
    what = "there is no *.csv, *.mat, *.npz, *.ods, *.xls, *.xlsx or *.zip file in this folder or below it";
  } else if (fs::exists(pattern, error)) {
    found.push_back(pattern);
  } else if (IsPattern(pattern)) {
    auto [folder, parts] = Cut(pattern);
    if (parts.back() == kAnyFolders) parts.emplace_back("*");
    done = Find(folder, parts, found);
    what = "no file matches this pattern";
  }
  if (!done) return tl::unexpected(done.error());
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());  // several ** may match the same file
  if (!found.empty()) return found;
  return Error(StatusCode::kNotFound, pattern + ": " + what + "; check the path");
}

}  // namespace pendulum
