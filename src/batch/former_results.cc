// SPDX-License-Identifier: Apache-2.0
#include "batch/former_results.h"

#include <algorithm>
#include <array>
#include <utility>

#include "pendulum/base/json.h"
#include "pendulum/model/parameter.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;
using Names = std::pair<std::string_view, std::string_view>;  // a name in version 1, and in version 2

constexpr std::array kKeys = {Names{"alone", "separate"},
                              Names{"disagreeing", "outliers"},
                              Names{"judged", "is_compared"},
                              Names{"rest_p", "p_of_remainder"},
                              Names{"seen_frequency_hz", "apparent_frequency_hz"},
                              Names{"why", "reason"}};

constexpr std::array kWarningCodes = {Names{"disturbed", "ends_trimmed"},
                                      Names{"left_out", "larger_motion_outside"},
                                      Names{"not_alone", "separate_fit_not_converged"},
                                      Names{"once_a_cycle", "samples_near_period"},
                                      Names{"quiet_sensor", "noise_below_resolution"},
                                      Names{"rig_frequency", "frequency_differs_from_rig"},
                                      Names{"stop_is_a_kink", "uncertain_stop"},
                                      Names{"trace_accuracy", "trajectory_accuracy"},
                                      Names{"turns_taken_out", "whole_turns_removed"},
                                      Names{"zero_jumps", "offset_jumps"},
                                      Names{"zero_unsteady", "offset_unsteady"}};

template <std::size_t N>
std::string Renamed(const std::array<Names, N>& names, std::string_view name) {
  const auto found = std::ranges::find(names, name, &Names::first);
  return std::string(found == names.end() ? CurrentName(name) : found->second);
}

/// Version 1 had both `why` and `reason`; one often repeated the other.
Json JoinedReason(const Json& why, const Json& reason) {
  if (!why.is_string() || !reason.is_string()) return why.is_null() ? reason : why;
  const auto first = why.get<std::string>(), second = reason.get<std::string>();
  return second.find(first) == std::string::npos ? first + "; " + second : second;
}

/// Replaces the names of version 1 in a value by the names of version 2. `key`: the key of the value in version 1.
Json Translated(const Json& value, std::string_view key) {
  if (value.is_string()) {
    const auto text = value.get<std::string>();
    return key == "code" ? Renamed(kWarningCodes, text) : std::string(CurrentName(text));
  }
  if (value.is_array()) {
    Json items = Json::array();
    for (const Json& item : value) items.push_back(Translated(item, key));
    return items;
  }
  if (!value.is_object()) return value;
  Json members = Json::object();
  for (const auto& [name, member] : value.items()) members[Renamed(kKeys, name)] = Translated(member, name);
  if (value.contains("why")) members["reason"] = JoinedReason(value["why"], value.value("reason", Json(nullptr)));
  return members;
}

}  // namespace

std::string WithCurrentNames(std::string_view result) {
  const Json former = Json::parse(result, nullptr, false);
  if (!former.is_object() || former.value("schema_version", Json()) != 1) return std::string(result);
  Json current = Translated(former, "");
  current["schema_version"] = 2;
  return JsonText(current);
}

}  // namespace pendulum
