// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/fitting/residuals/autocorrelation.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/solve/solve.h"
#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// One of the K >= 1 recordings of a fit, at its solution. Nothing is owned.
struct FittedRun {
  const Recording& recording;
  const FitOptions& options;
  const FitProblem& problem;
  TrajectoryCost& cost;              ///< Of one of several recordings: without priors.
  Solution& solution;                ///< Its own P_k parameters, and its noise.
  std::vector<int> at = {};          ///< P_k, indices of its parameters among all P parameters of the fit.
  Autocorrelation correlation = {};  ///< Of its residuals.

  double samples() const { return static_cast<double>(problem.data.time.size()); }
};

/// The parameters of a recording that are in a list of indices among all P; returns indices among its own. at: as in
/// FittedRun.
std::vector<int> OwnIndices(const std::vector<int>& at, const std::vector<int>& of_all);

/// The positions of its own parameters in a list of indices among all P, which must contain them.
std::vector<Eigen::Index> RowsAmong(const std::vector<int>& at, const std::vector<int>& of_all,
                                    const std::vector<int>& own);

/// The optimum of all P parameters restricted to those of one recording.
Optimum OwnOptimum(const std::vector<int>& at, const Optimum& all);

/// A fit to K >= 1 recordings at its solution. Of its P parameters the first S are common to all recordings, the others
/// belong to one recording each. K = 1: S = P.
struct SolvedFit {
  std::vector<FittedRun> runs;  ///< K
  std::size_t shared = 0;       ///< S
  LeastSquares& cost;           ///< Of all recordings and the priors.
  const SolveOptions& solve;
  const std::vector<PriorTerm>& priors;
  Solution& solution;  ///< P parameters. K = 1: that of the run.

  double samples() const;

  /// "inertia"; of one of several recordings: "release_angle of recording 2".
  std::string NameOf(int parameter) const;
};

/// The fit to one recording, whose `at` is set here.
SolvedFit SolvedFitOf(FittedRun run);

}  // namespace pendulum
