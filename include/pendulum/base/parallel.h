// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace pendulum {

/// `threads`, or the number of cores if `threads` is 0; at least 1.
int ThreadsOrCores(int threads);

/// Calls work(0) to work(count - 1) on `threads` threads, or on one per core if `threads` is 0; at most 256. The
/// calling thread is one of them. If the system cannot start as many, fewer are used. Each thread takes the next free
/// number. `work` must not throw.
void ParallelFor(int count, int threads, const std::function<void(int)>& work);

}  // namespace pendulum
