// SPDX-License-Identifier: Apache-2.0
// Any bytes give a rig with a usable gravity torque, or an error sentence.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "pendulum/model/rig.h"
#include "tests/fuzz/require.h"

namespace pendulum {
namespace {

bool IsUsable(const RigValue& value) {
  return value.value > 0 && std::isfinite(value.value) && value.std_dev >= 0 && std::isfinite(value.std_dev);
}

void Check(std::string_view text) {
  const Result<Rig> rig = ParseRig(text, "a.json");
  if (rig) {
    Require(IsUsable(rig->gravity_torque) && (!rig->inertia || IsUsable(*rig->inertia)));
    Require(ParseRig(rig->source.dump(), "a.json").has_value());
  } else {
    Require(rig.error().code == StatusCode::kDataLoss);
    RequireSentence(rig.error().message(), "a.json");
  }
}

}  // namespace
}  // namespace pendulum

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pendulum::Check(pendulum::TextOf(data, size));
  return 0;
}
