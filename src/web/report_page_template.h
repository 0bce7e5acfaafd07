// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pendulum {

/// The bytes of src/web/dist/report.html, with a token for each JSON: @RESULT@, @SERIES@, @COMMAND@.
std::string_view ReportPageTemplate();

}  // namespace pendulum
