// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pendulum {

/// The bytes of src/web/dist/summary.html, with a token for its JSON: @SUMMARY@.
std::string_view SummaryPageTemplate();

}  // namespace pendulum
