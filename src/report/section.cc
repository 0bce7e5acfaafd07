// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/section.h"

#include <string>

namespace pendulum {

std::string FullTitle(const Section& section) {
  return section.title + (section.law.empty() ? "" : " of " + section.law) +
         (section.recording == 0 ? "" : ": recording " + std::to_string(section.recording));
}

}  // namespace pendulum
