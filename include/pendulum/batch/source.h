// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/batch/manifest.h"

namespace pendulum {

/// Where the runs of a batch come from: a manifest and the files beside it, folders and patterns, or one packed file.
struct Source {
  std::string name;  ///< For messages.

  /// Gives every entry, in order of position. Errors of the source, or of `take`, end it.
  std::function<Result<void>(const TakeEntry& take)> for_each;

  /// The bytes of a file that an entry names (path, rig or calibration), for any thread. kNotFound: there is none.
  /// kDataLoss: a directory, a pipe or a device, unreadable, or larger than kMostRecordingBytes.
  std::function<Result<std::string>(const std::string& path)> read;
};

/// A recording is in memory while it is fitted.
inline constexpr std::uintmax_t kMostRecordingBytes = std::uintmax_t{1} << 29;

/// The source that a path names: a packed file if it is one, else a manifest. kNotFound: no such file.
Result<Source> OpenSource(const std::filesystem::path& path);

/// The recordings of folders and patterns (FindRecordings), whose ids are their paths without "./", "//" and "x/../".
/// kNotFound: one of them stands for nothing.
Result<Source> FindSource(const std::vector<std::string>& patterns);

/// What a pack was made of: files, those of them that could not be read, and why the first could not.
struct PackCounts {
  std::int64_t files = 0, unreadable = 0;
  std::string first_reason;
};

/// Writes entries and files of a source, as they are now, into one SQLite file that is a source itself: table `entries`
/// (columns as ManifestEntry), table `files` (path, bytes, or why there are none). An existing file is replaced at the
/// end. kCannotWrite: the file cannot be written. kTryAgain: another process packs into it. Other errors: of the
/// source; a file that is missing is none, for the batch will say so.
Result<PackCounts> Pack(const Source& source, const std::filesystem::path& path);

}  // namespace pendulum
