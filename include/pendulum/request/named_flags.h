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

/// Flags as they were given, by their names: {"model", "drag"}.
using FlagTexts = std::map<std::string, std::string, std::less<>>;

/// The names that each of the functions below knows.
std::vector<std::string_view> RunFlagNames();
std::vector<std::string_view> SimulationFlagNames();
std::vector<std::string_view> CalibrationFlagNames();

/// The flags of a fit; `models` is another name of `model`. Files and threads are not for who asks from afar.
/// kInvalidArgument: a name that is none (the nearest is suggested), an empty value, a switch neither true nor false.
Result<RunFlags> RunFlagsOf(const FlagTexts& texts);

/// The flags of a simulation, likewise. kInvalidArgument: as RunFlagsOf, or a number that is none.
Result<SimulationFlags> SimulationFlagsOf(const FlagTexts& texts);

/// The flags of a calibration, likewise.
Result<CalibrationFlags> CalibrationFlagsOf(const FlagTexts& texts);

/// kInvalidArgument: `name` is none of `names`; the nearest is suggested.
Result<void> CheckFlagName(std::string_view name, std::span<const std::string_view> names);

}  // namespace pendulum
