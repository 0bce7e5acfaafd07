// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "recording/readers/mat/mat_subsystem.h"

namespace pendulum {

/// Opens the file of version 7.3 at this path at once, if it is one; the function then finds its objects, in HDF5's
/// groups and datasets. It never fails, but gives what is whole; HDF5 itself may crash.
std::function<MatSubsystem()> OpenHdf5(const std::string& path);

}  // namespace pendulum
