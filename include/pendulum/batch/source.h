// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/batch/manifest.h"

namespace pendulum {

/// The source of a batch's runs: a manifest and its files, folders and patterns, or one packed file.
struct Source {
  std::string name;  ///< Name in messages.

  /// Passes every entry to `take`, in order of position. An error of the source or of `take` ends the loop.
  std::function<Result<void>(const EntrySink& take)> for_each;

  /// The bytes of a file of an entry (path, rig or calibration), for any thread. kNotFound: no such file. kDataLoss: a
  /// directory, a pipe or a device, unreadable, or larger than kMaxRecordingBytes.
  std::function<Result<std::string>(const std::string& path)> read;

  /// Numbers of the files in searched folders that are no recordings by their names, by pattern ("*.json").
  std::map<std::string, std::int64_t> left_out = {};

  /// Manifests and exports of refit_pendulums in these folders, which are left out, too.
  std::vector<std::string> lists = {};

  /// The folder that the paths of entries are relative to; std::nullopt: their files are in a packed file.
  std::optional<std::string> folder = {};
};

/// Limit for a recording, which is in memory while it is fitted.
inline constexpr std::uintmax_t kMaxRecordingBytes = std::uintmax_t{1} << 29;

/// Opens a path as a packed file if it is one, otherwise as a manifest. kNotFound: no such file.
Result<Source> OpenSource(const std::filesystem::path& path);

/// The recordings of folders and patterns (FindRecordings); their ids are their paths without "./", "//" and "x/../".
/// kNotFound: a pattern matches nothing.
Result<Source> FindSource(const std::vector<std::string>& patterns);

/// Number of packed files, how many of them are unreadable, and the reason for the first unreadable one.
struct PackCounts {
  std::int64_t files = 0, unreadable = 0;
  std::string first_reason;
};

/// Writes the current entries and files of a source into one SQLite file, which is itself a source: table `entries`
/// (columns as ManifestEntry), table `files` (path, and bytes or the reason why there are none). An existing file is
/// replaced at the end. kCannotWrite: the file cannot be written. kTryAgain: another process packs into it. Other
/// errors: of the source. A missing file is not an error here; the refit reports it.
Result<PackCounts> Pack(const Source& source, const std::filesystem::path& path);

}  // namespace pendulum
