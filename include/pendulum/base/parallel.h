// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace pendulum {

/// So many threads, or as many as there are cores if that is 0; at least 1.
int ThreadsOrCores(int threads);

/// Calls work(0) to work(count - 1), on `threads` threads, at most 256, or as many as there are cores if that is 0, the
/// calling one among them, or fewer where the system has no more; each takes the next number that is left. `work` must
/// not throw.
void ParallelFor(int count, int threads, const std::function<void(int)>& work);

}  // namespace pendulum
