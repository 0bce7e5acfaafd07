// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/recording/recording.h"

namespace pendulum {

/// The part of a recording with from <= time <= to [s, on the file's clock]; NaN leaves that end open.
/// kInvalidArgument: from >= to. kFailedPrecondition: fewer than kMinimumSamples remain; the message gives both spans.
Result<Recording> SelectWindow(Recording recording, double from, double to);

/// The recording with times converted to true seconds (clock_scale), counted from its first sample.
Recording InTrueSeconds(Recording recording);

/// Up to `max_samples` samples from the start or the end. Denser recordings are thinned to `per_second` [Hz].
Recording Excerpt(const Recording& recording, Eigen::Index max_samples, double per_second, bool at_end);

/// Every k-th sample, with k such that at most `max_samples` remain.
Recording Thinned(const Recording& recording, Eigen::Index max_samples);

}  // namespace pendulum
