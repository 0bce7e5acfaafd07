// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace pendulum {

/// Whether only the former of two fits converged, by their exit codes.
constexpr bool HasLostConvergence(int former, int now) { return former == 0 && now == 1; }

/// Why the result of a run stays in place of a newer outcome: that has none, its recording has fewer samples,
/// under the same path or another, or only the former fit converged. Empty if the outcome may replace it, as when the
/// result is damaged. `result` and `outcome` are JSON; the outcome is empty if the recording could not be fitted for
/// this `reason`.
std::string WhyKept(const std::string& result, const std::string& outcome, const std::string& reason,
                    bool has_lost_convergence);

}  // namespace pendulum
