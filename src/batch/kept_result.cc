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

std::string WhyKept(const std::string& result, const std::string& outcome, const std::string& reason,
                    bool has_lost_convergence) {
  const Json before = DataOf(result);
  if (before.is_null()) return "";
  if (outcome.empty()) return reason;
  const Json now = DataOf(outcome);
  const std::string path = before.value("path", "");
  if (has_lost_convergence) return path + ": the fit converged before, and does not converge now";
  if (now.is_null()) return "";
  const auto samples = now.value("samples", std::int64_t{0}), former = before.value("samples", std::int64_t{0});
  if (samples >= former) return "";
  return now.value("path", path) + ": the recording has become shorter: " + std::to_string(samples) +
         " samples instead of " + std::to_string(former) + " before";
}

}  // namespace pendulum
