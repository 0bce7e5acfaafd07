// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/recording/recording.h"

namespace pendulum {

/// The part of a recording with from <= time <= to [s, on the file's clock]; NaN leaves that end open.
/// kInvalidArgument: from >= to. kFailedPrecondition: fewer than kMinimumSamples left; the message gives both spans.
Result<Recording> SelectWindow(Recording recording, double from, double to);

/// The recording with seconds that last a second (clock_scale), from its first sample on.
Recording InTrueTime(Recording recording);

/// At most `most` samples from the first (or the last) on, as dense as `per_second` [Hz] asks where the recording is.
Recording Excerpt(const Recording& recording, Eigen::Index most, double per_second, bool at_end);

/// Every so many-th sample, so that at most `most` remain.
Recording Thinned(const Recording& recording, Eigen::Index most);

}  // namespace pendulum
