// SPDX-License-Identifier: Apache-2.0
// Keys of a rig as its user writes them.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "pendulum/base/format.h"
#include "pendulum/model/rig.h"
#include "pendulum/model/rig_values.h"

namespace pendulum {

/// Whether a rig of this name was given by flags, not in a file.
inline bool IsGivenByFlags(std::string_view rig_name) { return rig_name == kRigOfValuesName; }

/// A key as the user of the rig writes it: "bob_mass" in a file, --bob_mass on the command line.
inline std::string KeyText(const RigKey& key, std::string_view rig_name) {
  return IsGivenByFlags(rig_name) ? "--" + std::string(key.flag) : Quoted(key.name);
}

}  // namespace pendulum
