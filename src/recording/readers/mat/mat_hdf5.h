// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "recording/readers/mat/mat_subsystem.h"

namespace pendulum {

/// Opens the file at this path, which has version 7.3, immediately. The returned function finds the objects of the file
/// in HDF5's groups and datasets. It never fails but returns the undamaged part; HDF5 itself may crash.
std::function<MatSubsystem()> OpenHdf5(const std::string& path);

}  // namespace pendulum
