// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <gmock/gmock.h>

#include "pendulum/base/warning.h"

namespace pendulum {

/// Matches a Warning of this code.
inline auto CodeIs(const std::string& code) {
  return testing::ResultOf([](const Warning& warning) { return std::string(warning.code.text()); }, code);
}

/// Matches a Warning whose MessageText matches.
template <typename Matcher>
auto MessageIs(const Matcher& matcher) {
  return testing::ResultOf(MessageText, matcher);
}

}  // namespace pendulum
