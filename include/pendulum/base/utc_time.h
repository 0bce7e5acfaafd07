// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>
#include <string>

namespace pendulum {

/// A time as "2026-11-23T21:40:05Z" (RFC 3339).
std::string UtcTimeText(std::time_t time);

/// The current time in the same form.
std::string UtcTimeText();

}  // namespace pendulum
