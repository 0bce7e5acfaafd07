// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/base/warning.h"
#include "pendulum/model/rig.h"

namespace pendulum {

/// The unit that a mass without a unit most likely has, if it is odd in kg: "g" for 412 on a rod of less than a metre.
/// Empty if it is not odd, or no mass. source: the values of the rig in SI, by key.
std::string UnitOfMass(const nlohmann::ordered_json& source, const RigKey& key);

/// Questions about a rig that do not need its swing. rig_implausible: a value that is odd in its SI unit, such as a bob
/// of 380 kg; the sentence names the key, the likely unit and the number to write. rig_errors_assumed: values without a
/// standard deviation, what was assumed, and what it adds to the results. rig_exact: all are stated to be exact.
std::vector<Warning> QuestionRig(const Rig& rig);

/// The ratio G/I [1/s^2] that the rig alone predicts: from its torque and its inertia, or g over the length of a string
/// pendulum. std::nullopt if the rig does not say both.
std::optional<double> PredictedRatio(const Rig& rig);

/// Compares a rig with the ratio G/I [1/s^2] that its swing shows. Returns warnings: inertia_differs_from_rig if the
/// inertias differ by more than 1.5 times, rig_implausible if a length gives a g or a period
/// far from what is usual.
/// kDataLoss: the rig contradicts the swing. Its G/I differs by more than 5 times; or a length alone gives a g that
/// differs from the Earth's by more than 30 times; or the G/I of the swing is more than 1.5 times the largest one that
/// the centre of mass allows. The message names the key that is probably in another unit, and the number to write.
Result<std::vector<Warning>> CompareRigWithSwing(const Rig& rig, double gravity_over_inertia);

}  // namespace pendulum
