// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include <Eigen/Core>

#include "pendulum/recording/recording.h"

namespace pendulum {

/// What the text of an averaging window must be, for messages.
inline constexpr std::string_view kAveragingWindowRule =
    "a length of 0 to 1 s about the time stamp, or begin,end in s from the time stamp, increasing and within 1 s of it";

/// Reads a window from text: its length T in s, for a window from -T/2 to T/2 about the time stamp, or begin and end,
/// "-0.004,0.001". std::nullopt if the text is no such numbers, by kAveragingWindowRule.
std::optional<AveragingWindow> ParseAveragingWindow(std::string_view text);

/// The spacing of the values in which lost counts are whole numbers: a count of the converter if rows are means of its
/// readings, otherwise the resolution. 0: none.
double CountOf(const Recording& recording);

/// How many readings a value seems to be the mean of, 1 if there is no sign of a mean. The mean of n readings that were
/// rounded to whole counts is a multiple of 1/n count, but values gather at whole counts where noise is less than half
/// a count, because there all readings round to the same side (MODEL.md eq. (7.12)). `step`: spacing of the values.
/// Needs motion over many counts, and finds usual numbers from 3 on: means of 2 look like rows that were interpolated.
int ReadingsPerMean(const Eigen::VectorXd& value, double step);

/// Finds the levels of single readings from the resolution and the grid of the means, for a recording whose readings
/// are n > 1: sets oversampling.count and .level, and the resolution to that of the means. If `has_counts`, the unit is
/// counts, and whole numbers are levels. A resolution that is that of single readings is recognized by means between
/// its levels. Sets count 0 if the means do not lie on the grid, or if their resolution says that they were rounded to
/// whole counts.
void FindCountLevels(bool has_counts, Recording& recording);

}  // namespace pendulum
