// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <utility>

namespace pendulum {

/// A step of a long computation.
struct ProgressStep {
  std::string what;  ///< "fitting stribeck".
  int done = 0;      ///< Parts that are complete.
  int total = 0;     ///< All parts; 0: their number is unknown.
};

/// Receives each step when it begins, and the number of its parts when one is complete. May be empty. Several threads
/// may call it at a time.
using ProgressSink = std::function<void(const ProgressStep&)>;

/// Passes a step to a sink, if there is one.
inline void ReportProgress(const ProgressSink& sink, std::string what, int done = 0, int total = 0) {
  if (sink) sink({std::move(what), done, total});
}

}  // namespace pendulum
