// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/utc_time.h"

#include <array>

namespace pendulum {

std::string UtcTimeText(std::time_t time) {
  std::tm utc{};
  ::gmtime_r(&time, &utc);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc)};
}

std::string UtcTimeText() { return UtcTimeText(std::time(nullptr)); }

}  // namespace pendulum
