// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "pendulum/fitting/fit/fit_jointly.h"
#include "pendulum/fitting/likelihood/joint_cost.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/solved_fit.h"

namespace pendulum {

/// One recording of a joint problem.
struct JointMember {
  const Recording* recording = nullptr;
  const FitReport* alone = nullptr;
  FitOptions options;                    // start kind and noise family as in `alone`
  std::unique_ptr<FitProblem> problem;   // the cost refers to it
  std::unique_ptr<TrajectoryCost> cost;  // without priors
  double tolerance = 0;                  // of its trajectory, rad
  double cost_sigma = 0;                 // the cost's present σ, rad or rad/s
  std::vector<double> alone_parameters;  // P_k, estimates of its separate fit
  Solution solution;                     // its own P_k parameters, and its noise
  std::vector<int> at;                   // P_k, indices of its parameters among all P

  double samples() const { return static_cast<double>(problem->data.time.size()); }
};

/// Several recordings with P parameters in total: first the shared parameters, then the own parameters of each
/// recording. Inertia and torques are divided by G.
struct JointProblem {
  std::vector<JointMember> members;
  std::vector<std::string> shared;  // names; shared[i] is parameter i
  std::unique_ptr<JointCost> cost;
  SolveOptions solve;

  /// The fit at a solution of all parameters; `solution` and this problem must outlive it.
  SolvedFit SolvedAt(Solution& solution);

  /// Copies the parameters into the members' solutions.
  void Distribute(const std::vector<double>& parameters);

  /// The P estimates of the separate fits. A shared parameter has the estimate from the last recording.
  std::vector<double> SeparateParameters() const;

  bool IsShared(int parameter) const { return 0 <= parameter && parameter < static_cast<int>(shared.size()); }
};

/// Builds a problem ready for the solver. Each member starts at the estimates of its own fit. Returns the same errors
/// as FitJointly.
Result<JointProblem> MakeJointProblem(std::span<const JointRun> runs, const std::vector<std::string>& shared);

}  // namespace pendulum
