// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/trajectory/synthetic.h"

namespace pendulum {

/// What a parameter's row of a coverage study must show to pass.
struct CoverageRule {
  /// The binomial 95 % interval of the coverage must meet [lowest, highest]; highest = 1: it may be too wide.
  double lowest = 0.93, highest = 0.97;
  double largest_error = 1.1;  ///< Of the rms error over the Cramér-Rao bound.
};

/// The rule of a parameter whose truth is at its bound; its error has no bound to be compared with.
inline constexpr CoverageRule kAtBoundRule = {0.94, 0.99};

/// A kind of recording whose truth is known, how it is fitted, and what the fit's intervals are to be.
struct CoverageScenario {
  std::string name;         ///< As in --scenario: words and numbers, "white_0.25".
  std::string description;  ///< One line.
  SyntheticOptions run;     ///< Units of G; seed, zero and release_time vary from recording to recording.
  FitOptions fit;
  CoverageRule rule;
};

/// All scenarios: the rig of datasets/textbook_rig.json with viscous and dry friction, read at 100 Hz by a
/// potentiometer of 0.1985 deg a count or, "fine", without counts.
std::vector<CoverageScenario> CoverageScenarios();

/// The scenarios of a list of names, "white_2.5,no_noise", in that order, or `all`.
/// kInvalidArgument: an empty list, a name that is none (the message lists those there are) or that comes twice.
Result<std::vector<CoverageScenario>> FindCoverageScenarios(const std::string& names);

/// The recording of a seed: its own noise, and zero and release within ± half a count and ± half a sampling interval.
SyntheticOptions ScenarioRun(const CoverageScenario& scenario, std::uint64_t seed);

}  // namespace pendulum
