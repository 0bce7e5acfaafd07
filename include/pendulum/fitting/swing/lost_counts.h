// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/synthetic.h"

namespace pendulum {

/// A zero that jumps within a recording.
struct ZeroJumps {
  std::vector<LostCounts> lost;  ///< Whole counts, s on the file's clock, in time order; empty when some are not whole.
  Recording corrected;           ///< With the readings after each moved back.
  std::optional<double> doubtful_from;  ///< s on the file's clock: where the first is that is not whole, or not sure.
  /// What was found, a sentence: of `lost` what was done, else what to do.
  std::string message;

  bool AreMended() const { return !lost.empty(); }
};

/// Whether the mean of a fit's residuals changes at some sample by four standard errors of independent ones, and a good
/// part of a resolution: the zero of an angle may jump.
bool MayJump(const FitReport& fit);

/// Jumps of an angle's zero (MODEL.md eq. (67)), looked for in what the richest law leaves, the more exactly the less
/// that is. Nothing where there are none, where the recording cannot be fitted, or once a stop is requested.
std::optional<ZeroJumps> FindZeroJumps(const Recording& recording, const FitOptions& options);

/// Says what became of jumps (`lost_counts`, or `zero_jumps`, which the fit then does not stand), and where there may
/// be one that is too small to be told (`zero_unsteady`), unless the fit `lacks` so much that it may be that.
void WarnOfJumps(const std::optional<ZeroJumps>& jumps, bool lacks, FitReport& fit);

}  // namespace pendulum
