// SPDX-License-Identifier: Apache-2.0
#include "batch/kept_result.h"

#include <cstdint>

namespace pendulum {

using Json = nlohmann::ordered_json;

const Json* RecordingOf(const Json& result) {
  const auto found = result.is_object() ? result.find("recordings") : result.end();
  if (found == result.end() || !found->is_array() || found->empty() || !found->front().is_object()) return nullptr;
  return &found->front();
}

Reason WhyKept(const std::string& result, int exit_code, const NewerOutcome& outcome,
               const std::function<bool(const std::string& path)>& is_gone) {
  const bool has_lost_convergence = exit_code == 0 && outcome.exit_code == 1;
  if (outcome.has_result && outcome.is_same_data && !has_lost_convergence) return {};
  const Json parsed = Json::parse(result, nullptr, false);
  const Json* const before = RecordingOf(parsed);
  if (before == nullptr) return {};
  if (!outcome.has_result) return outcome.reason;
  const std::string path = before->value("path", "");
  if (has_lost_convergence) return {path, "the fit converged before, and does not converge now"};
  if (outcome.recording == nullptr) return {};
  const auto samples = outcome.recording->value("samples", std::int64_t{0}),
             former = before->value("samples", std::int64_t{0});
  const std::string new_path = outcome.recording->value("path", "");
  if (samples >= former || (new_path != path && !is_gone(path))) return {};
  return {new_path, "the recording has become shorter: " + std::to_string(samples) + " samples, fewer than the " +
                        std::to_string(former) + " of " + (new_path == path ? "before" : path)};
}

}  // namespace pendulum
