// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pendulum {

/// src/report/page/dist/summary.html as it was built, with a place for its JSON: @SUMMARY@.
std::string_view SummaryPageTemplate();

}  // namespace pendulum
