// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// What a search found, in the order of paths.
struct FoundRecordings {
  std::vector<std::string> paths;     ///< Recordings.
  std::vector<std::string> left_out;  ///< Other files of a folder, which were not searched for.
  std::vector<std::string> lists;     ///< Manifests and exports of refit_pendulums in a folder, by their first line.
};

/// The recordings of a folder or a pattern.
/// Folder: all files in it and in its subfolders whose names recordings have (HasRecordingName), except tables with
/// a column path, which are manifests and exports of refit_pendulums.
/// Pattern ("runs/2026-*/*.csv", "**/pendulum?.csv"): the files whose path matches part by part (fnmatch(3)); a part **
/// matches any number of folders. Hidden files and folders match only a pattern that begins with a dot. Links to
/// folders below the named folder are not followed, to avoid loops; links to files are.
/// The path of an existing file is returned unchanged, even if it looks like a pattern. kNotFound: no file found.
/// kDataLoss: a folder cannot be read, so its content is unknown.
Result<FoundRecordings> FindRecordings(const std::string& pattern);

}  // namespace pendulum
