// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/model/parameter.h"

namespace pendulum {

/// The name that a misspelt one most likely stands for, by Damerau's distance; empty: it resembles none of them.
std::string NearestName(std::string_view name, std::span<const std::string_view> names);

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
