// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/request/calibration_flags.h"
#include "pendulum/request/run_flags.h"
#include "pendulum/request/simulation.h"

namespace pendulum {

/// Given flags, by their names: {"model", "drag"}.
using FlagTexts = std::map<std::string, std::string, std::less<>>;

/// The names accepted by the corresponding functions below.
std::vector<std::string_view> RunFlagNames();
std::vector<std::string_view> SimulationFlagNames();
std::vector<std::string_view> CalibrationFlagNames();

/// The flags of a fit; `models` is another name of `model`. Remote clients cannot set files and threads.
/// kInvalidArgument: an unknown name (the message suggests the nearest one), an empty value, a switch that is neither
/// true nor false.
Result<RunFlags> RunFlagsOf(const FlagTexts& texts);

/// The flags of a simulation, with the same rules. kInvalidArgument: as RunFlagsOf, or an invalid number.
Result<SimulationFlags> SimulationFlagsOf(const FlagTexts& texts);

/// The flags of a calibration, with the same rules.
Result<CalibrationFlags> CalibrationFlagsOf(const FlagTexts& texts);

/// kInvalidArgument: `name` is not in `names`; the message suggests the nearest one.
Result<void> CheckFlagName(std::string_view name, std::span<const std::string_view> names);

}  // namespace pendulum
