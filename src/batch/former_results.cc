// SPDX-License-Identifier: Apache-2.0
#include "batch/former_results.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "pendulum/base/json.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/parameter.h"
#include "pendulum/report/json_parts.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;
using Names = std::pair<std::string_view, std::string_view>;  // a name in version 1, and in version 2

constexpr std::array kKeys = {Names{"judged", "is_compared"}, Names{"seen_frequency_hz", "apparent_frequency_hz"},
                              Names{"why", "reason"}};

constexpr std::array kWarningCodes = {Names{"disturbed", "ends_trimmed"},
                                      Names{"left_out", "larger_motion_outside"},
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

// ---- From version 2 to version 3 ------------------------------------------------------------------------------------

using NameSet = std::set<std::string>;

/// A member; null if there is none, as in results of the first versions.
Json MemberOf(const Json& object, const char* key) { return object.value(key, Json(nullptr)); }

/// The parameters of the pendulum in a fit of version 2.
NameSet SharedNames(const Json& fit) {
  NameSet names;
  const auto model = FindMotionModel(fit.at("model").get<std::string>());
  if (!model) return names;
  for (const ParameterInfo& parameter : PhysicalParameters(*model)) names.emplace(parameter.name);
  return names;
}

/// Copies those of the members that there are.
void CopyMembers(const Json& from, const std::vector<std::string>& keys, Json& to) {
  for (const std::string& key : keys) {
    if (from.contains(key)) to[key] = from.at(key);
  }
}

Json Parameters(const Json& fit, const NameSet& shared, bool are_shared) {
  Json parameters = Json::object();
  for (const auto& [name, parameter] : fit.at("parameters").items()) {
    if (shared.contains(name) == are_shared) parameters[name] = parameter;
  }
  return parameters;
}

Json Identifiabilities(const Json& fit, const NameSet& shared, bool are_shared) {
  Json rows = Json::array();
  for (const Json& row : MemberOf(fit, "identifiability")) {
    if (shared.contains(row.at("parameter").get<std::string>()) == are_shared) rows.push_back(row);
  }
  return rows;
}

/// The rows and columns of the shared parameters.
Json SharedMatrix(const Json& matrix, const NameSet& shared) {
  Json names = Json::array(), rows = Json::array();
  std::vector<std::size_t> places;
  const Json all = matrix.is_object() ? matrix.at("names") : Json::array();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!shared.contains(all[i].get<std::string>())) continue;
    places.push_back(i);
    names.push_back(all[i]);
  }
  for (const std::size_t i : places) {
    rows.push_back(Json::array());
    for (const std::size_t j : places) rows.back().push_back(matrix.at("matrix").at(i).at(j));
  }
  return {{"names", std::move(names)}, {"matrix", std::move(rows)}};
}

/// Statistics over all recordings.
Json SumStatistics(const Json& statistics) {
  if (!statistics.is_object()) return nullptr;
  Json sums = Json::object();
  for (const auto& [key, value] : statistics.items()) {
    if (key != "durbin_watson" && key != "ljung_box_p" && key != "runs_p" && key != "reason") sums[key] = value;
  }
  return sums;
}

/// The part of a fit for its recording.
Json OwnPart(const Json& fit) {
  const NameSet shared = SharedNames(fit);
  const std::string status = fit.at("status").get<std::string>();
  Json part = {{"model", fit.at("model")}, {"amplitude_rad", nullptr}, {"parameters", Parameters(fit, shared, false)}};
  CopyMembers(fit, {"covariance", "correlation", "systematic_covariance", "std_error_method"}, part);
  part["identifiability"] = Identifiabilities(fit, shared, false);
  CopyMembers(fit, {"noise", "statistics", "closed_form", "constancy", "constancy_reason", "suspicions"}, part);
  part["separate"] = status == "converged" ? status : status + ": " + fit.at("reason").get<std::string>();
  return part;
}

Json SharedFit(const Json& fit) {
  const NameSet shared = SharedNames(fit);
  Json current;
  CopyMembers(fit, {"model", "status", "reason", "equation"}, current);
  const Json parameters = Parameters(fit, shared, true);
  Json names = Json::array();
  for (const auto& [name, parameter] : parameters.items()) names.push_back(name);
  current["shared"] = std::move(names);
  current["parameters"] = parameters;
  CopyMembers(fit, {"derived"}, current);
  for (const char* key : {"covariance", "correlation", "systematic_covariance"}) {
    current[key] = SharedMatrix(MemberOf(fit, key), shared);
  }
  CopyMembers(fit, {"std_error_method", "interval_method"}, current);
  current["identifiability"] = Identifiabilities(fit, shared, true);
  current["statistics"] = SumStatistics(MemberOf(fit, "statistics"));
  current["homogeneity"] = nullptr;
  CopyMembers(fit, {"rig_verdict", "ambiguities", "solver", "summary"}, current);
  return current;
}

/// A warning of an earlier version has a code and a message only.
Json WithParts(const Json& warning) {
  const Json& message = warning.at("message");
  Json whole = {{"code", warning.at("code")},  {"message", message},         {"text", message},
                {"finding", message},          {"explanation", nullptr},     {"advice", nullptr},
                {"flags", Json::array()},      {"assumed", nullptr},         {"law", nullptr},
                {"recordings", Json::array()}, {"parameters", Json::array()}};
  whole.update(warning);
  return whole;
}

/// A store has results of one recording only.
Json ToVersion3(const Json& former) {
  Json recording = former.at("data");
  const Json closed_forms = MemberOf(former, "closed_forms");
  recording["left_out"] = nullptr;
  recording["calibration"] = MemberOf(former, "calibration");
  recording["closed_forms"] = closed_forms;
  recording["fits"] = ArrayOf(former.at("fits"), OwnPart);
  if (closed_forms.is_null() && former.contains("reason")) recording["reason"] = former.at("reason");
  return {{"schema_version", 3},
          {"tool", MemberOf(former, "tool")},
          {"rig", MemberOf(former, "rig")},
          {"recordings", Json::array({std::move(recording)})},
          {"fits", ArrayOf(former.at("fits"), SharedFit)},
          {"comparison", MemberOf(former, "comparison")},
          {"warnings", ArrayOf(MemberOf(former, "warnings"), WithParts)}};
}

/// The unit of accelerations had another spelling in keys, "sigma_m_s^2", until shortly before version 3.
Json WithCurrentUnits(const Json& value) {
  if (value.is_array()) return ArrayOf(value, WithCurrentUnits);
  if (!value.is_object()) return value;
  constexpr std::string_view kFormer = "_m_s^2";
  Json members = Json::object();
  for (const auto& [key, member] : value.items()) {
    const bool is_former = key.ends_with(kFormer);
    members[is_former ? key.substr(0, key.size() - kFormer.size()) + "_m_s2" : key] = WithCurrentUnits(member);
  }
  return members;
}

/// `convert` of a JSON object; the text unchanged if it is none, or lacks members that every result has.
template <typename Convert>
std::string Converted(std::string_view text, const Convert& convert) {
  const Json former = Json::parse(text, nullptr, false);
  if (!former.is_object()) return std::string(text);
  try {
    return convert(former);
  } catch (const Json::exception&) {
    return std::string(text);
  }
}

}  // namespace

std::string ToCurrentResult(std::string_view result) {
  return Converted(result, [&](const Json& former) {
    const Json version = former.value("schema_version", Json());
    if (version != 1 && version != 2) return std::string(result);
    return JsonText(ToVersion3(WithCurrentUnits(version == 1 ? Translated(former, "") : former)));
  });
}

std::string ToCurrentFit(std::string_view fit) {
  return Converted(fit, [&](const Json& former) {
    if (former.contains("recordings")) return std::string(fit);
    const Json renamed = WithCurrentUnits(former);
    Json current = SharedFit(renamed);
    current["recordings"] = Json::array({OwnPart(renamed)});
    return JsonText(current);
  });
}

}  // namespace pendulum
