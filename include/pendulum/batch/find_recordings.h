// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// The recordings that a folder or a pattern stands for, in the order of their names: of a folder every *.csv,
/// *.mat and *.zip file in it and below, in small letters or capitals; of a pattern ("runs/2026-*/*.csv",
/// "**/pendulum?.csv") the files whose path has as many parts, each like its own (fnmatch(3); a part ** stands for any
/// number of folders). Hidden files and folders are named by a dot only. Below the folder that is named, links to
/// folders are not followed, so that no loop is; links to files are. A path that is neither folder nor pattern stands
/// for itself. kNotFound: nothing is there. kDataLoss: a folder on the way cannot be looked into, and who knows what is
/// in it.
Result<std::vector<std::string>> FindRecordings(const std::string& pattern);

}  // namespace pendulum
