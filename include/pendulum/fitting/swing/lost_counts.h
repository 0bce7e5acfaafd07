// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/base/warning.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/synthetic.h"

namespace pendulum {

/// Jumps of the zero within a recording.
struct OffsetJumps {
  std::vector<LostCounts> lost;  ///< Whole counts, s on the file's clock, in time order; empty if some are not whole.
  Recording corrected;           ///< The readings after each jump are shifted back.
  std::optional<double> uncertain_from;  ///< s on the file's clock: the first jump that is not whole or not certain.
  /// It says what was corrected, or what to do if `lost` is empty.
  Warning warning = {.code = "offset_jumps", .finding = ""};

  bool AreCorrected() const { return !lost.empty(); }
};

/// Whether the zero of an angle may have jumped: at some sample the mean of a fit's residuals changes by at least 0.4
/// of the resolution and by four standard errors (of independent residuals).
bool MayHaveOffsetJump(const FitReport& fit);

/// Finds jumps of an angle's zero (MODEL.md eq. (13.1)) in the residuals of the richest law; smaller residuals give a
/// more accurate result. Returns std::nullopt if there are no jumps, if the recording cannot be fitted, or after a stop
/// request.
std::optional<OffsetJumps> FindOffsetJumps(const Recording& recording, const FitOptions& options);

/// Adds warnings about jumps: `lost_counts` if they were corrected, otherwise `offset_jumps`, which invalidates the
/// fit. Adds `offset_unsteady` for a possible jump that is too small to identify, unless `has_misfit`, because a misfit
/// may look like a jump.
void WarnOfOffsetJumps(const std::optional<OffsetJumps>& jumps, bool has_misfit, FitReport& fit);

}  // namespace pendulum
