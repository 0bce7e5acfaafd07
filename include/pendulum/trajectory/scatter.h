// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/model/parameter.h"

namespace pendulum {

/// A parameter whose true value differs from recording to recording: normal about `mean`, cut off at its bounds.
struct ScatteredParameter {
  ParameterInfo info;
  double mean = 0;     ///< SI, or in units of G.
  double std_dev = 0;  ///< In the same unit, 0 or more; of 0 comes `mean` itself.
};

/// Values of the parameters, drawn independently of each other, in their order and units. All are drawn again until
/// each is within its bounds and `order` holds (OrderOf, of indices among `parameters`; negative: none). A seed gives
/// the same everywhere; the draws are not those of the noise that SimulateRecording makes of the same seed.
/// kInvalidArgument: a thousand draws, none of which was admissible; the message has the seed and what the last broke.
Result<std::vector<double>> ScatterParameters(std::span<const ScatteredParameter> parameters, OrderedPair order,
                                              std::uint64_t seed);

}  // namespace pendulum
