// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace pendulum {

/// What decides whether one result of a run replaces another.
struct StoredResult {
  std::string path;         ///< Of the recording, as in the manifest.
  std::string data_sha256;  ///< Of the recording.
  std::string result;       ///< JSON; empty if the recording could not be fitted.
};

/// Why a result stays in place of a newer outcome of the same run: that has none, or it is of the same recording, which
/// has become shorter. Empty if the outcome may replace it, as when the result is damaged. `reason`: why the outcome
/// has no result.
std::string WhyKept(const StoredResult& kept, const StoredResult& outcome, const std::string& reason);

}  // namespace pendulum
