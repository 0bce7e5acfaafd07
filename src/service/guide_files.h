// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "pendulum/base/status.h"

namespace pendulum {

/// A file of the user guide.
struct GuideFile {
  std::string_view type;  ///< Content-Type, by the ending of the name.
  std::string bytes;
};

/// Reads a file of the user guide, a static site in a folder. `path` is relative to the folder: "recordings.html".
/// kNotFound: `folder` is an empty text or does not exist, or it has no such file. A path that leaves the folder, also
/// by a symbolic link, counts as a file that does not exist.
Result<GuideFile> ReadGuideFile(const std::string& folder, std::string_view path);

}  // namespace pendulum
