// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace pendulum {

/// SQL conditions on a row of table runs: how the run ended.

/// The last manifest does not name the run. Those requested from a service, rows of the table `requests`, belong to no
/// manifest.
inline std::string IsUnlisted(const std::string& requests) {
  return "(runs.position < 0 AND runs.run NOT IN (SELECT run FROM " + requests + "))";
}
inline const std::string kIsUnlisted = IsUnlisted("requests");

/// Why statistics leave the result of a run out; NULL if they do not.
inline const std::string kWhyStale =
    "coalesce(runs.stale, iif(" + kIsUnlisted + ", 'not among the recordings of the last refit', NULL))";

/// The run keeps the result of a former state of its recording, rig or options.
inline const std::string kIsStale = "(runs.stale IS NOT NULL AND NOT " + kIsUnlisted + ")";

/// Neither of these. Statistics leave other runs out.
inline std::string IsLive(const std::string& requests) {
  return "(runs.stale IS NULL AND NOT " + IsUnlisted(requests) + ")";
}
inline const std::string kIsLive = IsLive("requests");

/// A row of table fits, joined with that of its run, is of the result of a live run.
inline std::string IsLiveFit(const std::string& requests) {
  return "(fits.stale IS NULL AND " + IsLive(requests) + ")";
}
inline const std::string kIsLiveFit = IsLiveFit("requests");

/// The fit of the recommended law, or of the only law, converged, and the run is live.
inline const std::string kIsFitted = "(exit_code = 0 AND " + kIsLive + ")";

/// There is no such recording. Otherwise there is no such rig or calibration.
inline const std::string kIsMissing = "(exit_code = 3 AND place IS path)";

/// The reason of a run is about its recording or a place in it.
inline const std::string kIsOfRecording = "(place = path OR substr(place, 1, length(path) + 1) = path || ':')";

/// The run has no result, because there is no such recording, rig or calibration.
inline const std::string kLacksFile = "(exit_code = 3 AND " + kIsLive + ")";

}  // namespace pendulum
