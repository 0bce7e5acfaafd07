// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/fitting/fit/fit_description.h"
#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/solve/solved_fit.h"

namespace pendulum {

/// How a fit ended, and why.
struct Ending {
  Termination termination = Termination::kNotConverged;
  std::string reason;
};

/// Judges the solution of a fit to K recordings by what it leaves unexplained, its plausibility and the remaining step.
/// A trajectory that does not explain the readings comes before parameters that these do not determine.
/// described: K. alone: the fits of each of several recordings alone; none for one recording.
Ending EndingOf(const SolvedFit& fit, const Optimum& optimum, const std::vector<Description>& described,
                const std::vector<const FitReport*>& alone);

}  // namespace pendulum
