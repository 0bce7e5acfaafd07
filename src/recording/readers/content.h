// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "pendulum/base/status.h"

namespace pendulum {

/// What a file is by its first bytes, whatever its name.
enum class Content { kText, kZip, kMat, kForeign };

inline constexpr std::size_t kContentBytes = 520;  ///< So many bytes tell it.

/// Of a file's first kContentBytes, or all that there are.
Content ContentOf(std::string_view begin);

/// kDataLoss: what a file of kForeign is, and what to do about it. `name` stands for the path.
tl::unexpected<Status> ForeignContent(std::string_view begin, const std::string& name);

}  // namespace pendulum
