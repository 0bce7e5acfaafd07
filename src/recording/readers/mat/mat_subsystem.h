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

/// The objects of a MAT-file. Variables only refer to objects; the objects are in a separate part of the file.
struct MatSubsystem {
  std::size_t variables = SIZE_MAX;      // Number of variables before the objects. matio cannot always unpack these.
  std::vector<MatReference> references;  // References to objects in the variables.
  std::optional<Mcos> objects;           // std::nullopt: no objects, or damage.
  std::size_t cells = 0;                 // Number of cells; most contain the value of a property.
  std::function<MatValue(std::size_t)> cell;  // Returns the value of a cell; kOther if it is damaged.
};

/// Reads the bytes of a file of version 5, which MATLAB calls 6 and 7. Never fails: returns the undamaged part.
MatSubsystem SubsystemOf(std::string_view bytes);

}  // namespace pendulum
