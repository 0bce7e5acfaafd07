// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/model/parameter.h"

namespace pendulum {

/// The most similar name to a misspelt one, by Damerau's distance; empty if none is similar.
std::string NearestName(std::string_view name, std::span<const std::string_view> names);

/// kInvalidArgument with a sentence about a flag.
tl::unexpected<Status> BadFlag(const std::string& sentence);

/// The finite number in a flag's value. kInvalidArgument: not such a number; the message gives flag, value and
/// `meaning`.
Result<double> ParseNumber(std::string_view flag, std::string_view value, std::string_view meaning);

/// Parses a flag's value that sets parameters, "name=value,name=value", in SI units; an empty text sets none.
///
/// kInvalidArgument: a name that is not in `parameters` (the parameters of `model`), a repeated name, a value that is
/// not a number or is outside the parameter's bounds.
Result<ParameterValues> ParseSettings(std::string_view flag, std::string_view text, std::string_view model,
                                      std::span<const ParameterInfo> parameters);

/// Parses a flag's value that sets bounds, "name=low:high,..."; either bound may be omitted; SI units.
///
/// kInvalidArgument: as ParseSettings, or low is not below high.
Result<ParameterRanges> ParseRanges(std::string_view flag, std::string_view text, std::string_view model,
                                    std::span<const ParameterInfo> parameters);

/// Parses a flag's value that sets priors, "name=mean:std_dev,..."; SI units.
///
/// kInvalidArgument: as ParseSettings, or a standard deviation that is not positive.
Result<ParameterPriors> ParsePriors(std::string_view flag, std::string_view text, std::string_view model,
                                    std::span<const ParameterInfo> parameters);

/// The parts of a text between separators; empty for an empty text.
std::vector<std::string> Split(std::string_view text, char separator);

}  // namespace pendulum
