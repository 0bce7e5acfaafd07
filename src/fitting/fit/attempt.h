// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/fitting/fit/alternative_minima.h"
#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/solve.h"
#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// A fit before it is judged. The cost refers to the problem.
struct Attempt {
  std::unique_ptr<FitProblem> problem;
  std::unique_ptr<TrajectoryCost> cost;
  Solution solution;
  std::vector<AlternativeMinimum> alternatives;  ///< Local minima at which the searches from other starts ended.
};

/// Solves from one start: the start in options.search if given, otherwise the start estimated from the data. Errors as
/// MakeFitProblem.
Result<Attempt> SolveFromOneStart(const Recording& recording, const FitOptions& options);

/// Solves from the start values, from each further start of the sensor (SensorStarts), and from the mirror image of the
/// solution (MirrorImage) if there is one. Returns the best solution. Errors as MakeFitProblem.
Result<Attempt> MakeAttempt(const Recording& recording, const FitOptions& options);

/// Log-likelihood of the samples and the priors.
double LogPosterior(const Attempt& attempt);

/// Where the search of the attempt ended.
AlternativeMinimum MinimumOf(const Attempt& attempt);

/// Whether `a` is usable and more likely than `b`.
bool IsBetter(const Attempt& a, const Attempt& b);

}  // namespace pendulum
