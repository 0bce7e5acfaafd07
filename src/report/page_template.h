// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pendulum {

/// src/report/page/dist/report.html as it was built, with a place for each JSON: @RESULT@, @SERIES@, @COMMAND@.
std::string_view PageTemplate();

}  // namespace pendulum
