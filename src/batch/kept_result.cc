// SPDX-License-Identifier: Apache-2.0
#include "batch/kept_result.h"

#include <cstdint>

#include <nlohmann/json.hpp>

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

/// The member `data` of a result; null if the result is damaged.
Json DataOf(const std::string& result) {
  const Json json = Json::parse(result, nullptr, false);
  const bool is_sound = json.is_object() && json.contains("data") && json["data"].is_object();
  return is_sound ? json["data"] : Json(nullptr);
}

}  // namespace

std::string WhyKept(const std::string& result, int exit_code, const NewerOutcome& outcome,
                    const std::function<bool(const std::string& path)>& is_gone) {
  const bool has_lost_convergence = exit_code == 0 && outcome.exit_code == 1;
  if (!outcome.result.empty() && outcome.is_same_data && !has_lost_convergence) return "";
  const Json before = DataOf(result);
  if (before.is_null()) return "";
  if (outcome.result.empty()) return outcome.reason;
  const Json now = DataOf(outcome.result);
  const std::string path = before.value("path", "");
  if (has_lost_convergence) return path + ": the fit converged before, and does not converge now";
  if (now.is_null()) return "";
  const auto samples = now.value("samples", std::int64_t{0}), former = before.value("samples", std::int64_t{0});
  const std::string new_path = now.value("path", "");
  if (samples >= former || (new_path != path && !is_gone(path))) return "";
  return new_path + ": the recording has become shorter: " + std::to_string(samples) + " samples, fewer than the " +
         std::to_string(former) + " of " + (new_path == path ? "before" : path);
}

}  // namespace pendulum
