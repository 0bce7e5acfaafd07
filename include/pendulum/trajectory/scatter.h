// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/model/parameter.h"

namespace pendulum {

/// A parameter whose true value varies between recordings: normally distributed about `mean`, truncated at its bounds.
struct ScatteredParameter {
  ParameterInfo info;
  double mean = 0;     ///< SI, or in units of the restoring torque G.
  double std_dev = 0;  ///< In the same unit, 0 or more; 0 always gives `mean`.
};

/// Independent draws of the parameters, in their order and units. All values are drawn again until each is within its
/// bounds and the larger parameter of `order` is not below the smaller one. `order` contains indices into `parameters`
/// (FindOrderedPair); negative indices mean no order. The draws depend only on the seed and differ from the noise that
/// SimulateRecording makes with the same seed. kInvalidArgument: none of a thousand draws was admissible; the message
/// gives the seed and the rule that the last draw violated.
Result<std::vector<double>> ScatterParameters(std::span<const ScatteredParameter> parameters, OrderedPair order,
                                              std::uint64_t seed);

}  // namespace pendulum
