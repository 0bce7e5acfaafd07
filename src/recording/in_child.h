// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "pendulum/base/status.h"

namespace pendulum {

/// What `work` gives, done in a process of its own that may crash, hang or eat memory: libraries that read binary files
/// of strangers do so (see MatTable). It gets so many seconds of a processor and 4 GiB of memory beyond what is in use,
/// and its output goes nowhere. kDataLoss: it did not come to its end; the message is empty. kTryAgain: no process to
/// be had.
Result<std::string> InChild(const std::function<std::string()>& work, int seconds);

}  // namespace pendulum
