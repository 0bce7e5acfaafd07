// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace pendulum {

/// The dates and times of workbooks, whose cells contain numbers of days.

/// True if a number format, such as "yyyy-mm-dd hh:mm:ss.000" or "[h]:mm:ss", shows a date, a time or a duration.
bool IsTimeFormat(std::string_view format);

/// True for one of the formats that Excel knows by number only.
bool IsTimeFormat(int built_in_format);

/// A number of days as text: "2024-03-01T16:04:31.273", or "16:04:31.273" below 60 days, which is a time of day or a
/// duration. `is_1904`: day 0 is 1 January 1904, not 30 December 1899. Empty for a number that is no date. Resolution:
/// 1 ms if the number is that of a millisecond, otherwise 1 us.
std::string TimeText(double days, bool is_1904);

/// "2024-03-01T16:04:31.273" for whole seconds since 1970 and a fraction of a second in units of 10^-digits.
std::string DateText(std::int64_t seconds, std::int64_t part, std::size_t digits);

/// The text without zeros at the end of its decimals: "16:04:31.273" for "16:04:31.273000000".
std::string_view WithoutEndZeros(std::string_view text);

/// A duration of ISO 8601, such as "PT16H04M31.273S", as "16:04:31.273". Empty if it has another form.
std::string DurationText(std::string_view duration);

}  // namespace pendulum
