// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "recording/readers/mat/mat_value.h"
#include "recording/readers/mat/mcos.h"

namespace pendulum {

/// The objects of a MAT-file, whose variables only refer to them: all are in a part of the file of its own.
struct MatSubsystem {
  std::size_t variables = SIZE_MAX;      // Those before the objects, which are last as MATLAB writes it: matio cannot
                                         // always unpack what comes then.
  std::vector<MatReference> references;  // From its variables.
  std::optional<Mcos> objects;           // None: there are none, or damage.
  std::size_t cells = 0;                 // Number of values of properties and the like.
  std::function<MatValue(std::size_t)> cell;  // One of them; kOther where it is damaged.
};

/// From the bytes of a file of version 5, which MATLAB calls 6 and 7. Never fails: it gives what is whole.
MatSubsystem SubsystemOf(std::string_view bytes);

}  // namespace pendulum
