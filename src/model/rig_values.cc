// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/rig_values.h"

#include <algorithm>
#include <array>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/json.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMeanGravity = 9.806;  // m/s², at sea level

/// Whether the values are part of a description that needs g, without it. A length or an inertia beside a mass needs
/// none; g may be what the user measures.
bool LacksGravity(const Json& values) {
  constexpr std::array<std::string_view, 4> kBesideGravity = {"bob_mass", "rod_mass", "rod_length", "center_of_mass"};
  return !values.contains("gravity") && !values.contains("gravity_torque") &&
         std::ranges::any_of(kBesideGravity, [&](std::string_view key) { return values.contains(key); });
}

/// The rig of the values. If it needs g and has none, it gets the mean at sea level, and a warning says so.
Result<Rig> ParseWithGravity(Json values, const std::string& name, std::vector<Warning>& warnings) {
  const bool lacks_gravity = LacksGravity(values);
  if (lacks_gravity) values["gravity"] = kMeanGravity;
  Result<Rig> rig = ParseRig(JsonText(values), name);
  if (rig && lacks_gravity) {
    const std::string mean = NumberText(kMeanGravity);
    const std::string std_dev = NumberText(NominalStdDev(RigQuantity::kAcceleration, kMeanGravity));
    warnings.push_back({.code = "gravity_assumed",
                        .finding = "g was taken as " + mean + " ± " + std_dev + " m/s^2, as at sea level",
                        .advice = "give the local value with --g",
                        .flags = {"g"},
                        .assumed = "g " + mean + " (--g)"});
  }
  return rig;
}

}  // namespace

Result<Rig> ParseRigWith(const Json& values, std::string_view text, const std::string& name,
                         std::vector<Warning>& warnings) {
  auto rig = ParseJsonObject(text, name, "rig", "{}");
  if (!rig) return ParseRig(text, name);  // ParseRig has the better message
  if (!values.empty()) rig->update(values);
  return ParseWithGravity(*std::move(rig), name, warnings);
}

Result<Rig> RigOfValues(Json values, std::vector<Warning>& warnings) {
  Result<Rig> rig = ParseWithGravity(std::move(values), std::string(kRigOfValuesName), warnings);
  if (rig) return rig;
  Status error = std::move(rig).error();
  error.code = StatusCode::kInvalidArgument;
  return tl::unexpected(std::move(error));
}

Warning OverrideWarning(const Json& values) {
  std::vector<std::string> names, flags;
  for (const RigKey& key : RigKeys()) {
    if (!values.contains(key.name)) continue;
    names.emplace_back(key.flag);
    flags.push_back("--" + names.back());
  }
  return {.code = "rig_overridden",
          .finding = "the values of the rig file were replaced by " + NameList(flags),
          .flags = names,
          .assumed = NameList(flags) + " instead of the rig file's"};
}

}  // namespace pendulum
