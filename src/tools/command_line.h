// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/model/parameter.h"

namespace pendulum {

/// A flag that a tool understands.
struct FlagInfo {
  std::string name;             ///< Without dashes.
  std::string help;             ///< What, unit, meaning of the default.
  std::string type = "string";  ///< In gflags' words: bool (takes no value after a blank), string, double, int32, ...
  bool own = true;              ///< The tool's, not a library's: shown by --help and suggested for a misspelt one.
};

/// Walks through the arguments (without the program's name) by gflags' grammar, setting nothing, and gives those that
/// belong to no flag. gflags itself exits with 1 on what this refuses.
///
/// kInvalidArgument: an unknown flag (the nearest own flag is suggested), a flag without its value or with an empty
/// one, a number that is none, a flag other than a switch that is given twice.
Result<std::vector<std::string>> PositionalArguments(std::span<const std::string> arguments,
                                                     std::span<const FlagInfo> flags);

/// The arguments with --model where --models stands: they are one flag.
std::vector<std::string> WithModelForModels(std::vector<std::string> arguments);

/// What --help prints: the usage, then the own flags.
std::string HelpText(std::string_view usage, std::span<const FlagInfo> flags);

/// kInvalidArgument: what is wrong with a flag.
tl::unexpected<Status> BadFlag(const std::string& sentence);

/// The value of a flag that is a finite number. kInvalidArgument names flag, value and what it should be.
Result<double> ParseNumber(std::string_view flag, std::string_view value, std::string_view meaning);

/// The value of a flag that sets parameters, "name=value,name=value", in SI units; empty text sets none.
///
/// kInvalidArgument: a name that is none of `parameters` (those of `model`), twice the same one, a value that is no
/// number or outside the parameter's bounds.
Result<ParameterValues> ParseSettings(std::string_view flag, std::string_view text, std::string_view model,
                                      std::span<const ParameterInfo> parameters);

/// The value of a flag that gives parameters bounds, "name=low:high,...", either of which may be left out; SI units.
///
/// kInvalidArgument: as ParseSettings, or low is not below high.
Result<ParameterRanges> ParseRanges(std::string_view flag, std::string_view text, std::string_view model,
                                    std::span<const ParameterInfo> parameters);

/// The value of a flag that gives parameters priors, "name=mean:std_dev,..."; SI units.
///
/// kInvalidArgument: as ParseSettings, or a standard deviation that is not positive.
Result<ParameterPriors> ParsePriors(std::string_view flag, std::string_view text, std::string_view model,
                                    std::span<const ParameterInfo> parameters);

/// The parts of a text between separators; none of an empty text.
std::vector<std::string> Split(std::string_view text, char separator);

}  // namespace pendulum
