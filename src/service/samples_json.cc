// SPDX-License-Identifier: Apache-2.0
#include "service/samples_json.h"

#include <cstddef>
#include <string>
#include <utility>

#include "pendulum/base/physics.h"
#include "pendulum/report/json_parts.h"
#include "pendulum/service/thinning.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

Json ThinnedJson(const Recording& recording, Eigen::Index max_shown, double scale, const std::string& unit) {
  const auto size = static_cast<std::size_t>(recording.size());
  const auto shown = Thin({recording.time.data(), size}, {recording.value.data(), size}, max_shown);
  Json time = Json::array(), measured = Json::array();
  for (const Eigen::Index i : shown) {
    time.push_back(recording.time[i]);
    measured.push_back(NumberOrNull(scale * recording.value[i]));
  }
  return {
      {"time_s", std::move(time)}, {"measured", std::move(measured)}, {"unit", unit}, {"samples", recording.size()}};
}

}  // namespace

Json SamplesJson(const Recording& recording, Eigen::Index max_shown) {
  return ThinnedJson(recording, max_shown, 1, recording.value_unit());
}

Json SamplesInOwnUnitJson(const Recording& recording, Eigen::Index max_shown) {
  const bool is_in_degrees = recording.unit == "deg" || recording.unit == "deg/s";
  if (!is_in_degrees) return SamplesJson(recording, max_shown);
  return ThinnedJson(recording, max_shown, 1 / kRadFromDeg, recording.unit);
}

}  // namespace pendulum
