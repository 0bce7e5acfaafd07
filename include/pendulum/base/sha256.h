// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "pendulum/base/status.h"

namespace pendulum {

/// SHA-256 (FIPS 180-4) of bytes in memory, 64 lower-case hexadecimal digits. kInternal: OpenSSL cannot compute it.
Result<std::string> Sha256(std::string_view bytes);

}  // namespace pendulum
