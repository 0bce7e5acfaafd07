// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pendulum {

/// SQL conditions on a row of table runs: how the run ended.

/// The fit of the recommended law, or of the only law, converged.
inline constexpr const char* kIsFitted = "exit_code = 0";

/// There is no such recording. A run whose reason begins with its own path is about the recording; otherwise it is
/// about the rig or the calibration.
inline constexpr const char* kIsMissing =
    "(exit_code = 3 AND substr(coalesce(reason, ''), 1, length(path) + 1) = path || ':')";

}  // namespace pendulum
