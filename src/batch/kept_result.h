// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include <nlohmann/json.hpp>

#include "pendulum/batch/reason.h"

namespace pendulum {

/// A newer outcome of a run that has a result.
struct NewerOutcome {
  bool has_result = false;                            ///< The recording was fitted.
  const nlohmann::ordered_json* recording = nullptr;  ///< As RecordingOf.
  Reason reason;                                      ///< Why the recording could not be fitted.
  int exit_code = 0;
  bool is_same_data = false;  ///< The recording has the bytes of the former one.
};

/// The only recording of a result; nullptr if there is none, as in a damaged result.
const nlohmann::ordered_json* RecordingOf(const nlohmann::ordered_json& result);

/// Why the result of a run, JSON with its exit code, stays in place of a newer outcome: that has none; it has fewer
/// samples, of the same path or of another one while the former path `is_gone`; or only the former fit converged. Empty
/// if the outcome may replace it, as when the result is damaged.
Reason WhyKept(const std::string& result, int exit_code, const NewerOutcome& outcome,
               const std::function<bool(const std::string& path)>& is_gone);

}  // namespace pendulum
