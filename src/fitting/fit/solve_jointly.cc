// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/solve_jointly.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/fit/joint_parabolas.h"
#include "pendulum/fitting/solve/maximum_likelihood.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/solve/search.h"
#include "pendulum/fitting/solve/trace_error.h"
#include "pendulum/trajectory/tolerance.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Number of free parameters attributed to a recording; without priors the sum over all recordings is the number of
/// free parameters.
double ShareOf(const JointMember& member, const Optimum& optimum) {
  Eigen::MatrixXd sums;
  if (!member.cost->Sums(member.solution.parameters, &sums)) return 0;
  const std::vector<int> own = OwnIndices(member.at, optimum.free);
  const std::vector<Index> rows = RowsAmong(member.at, optimum.free, own);
  return optimum.inverse.matrix(rows, rows).cwiseProduct(sums(own, own)).sum();
}

/// σ of a recording at the joint optimum. For Gaussian noise σ² is RSS / (N - its share of the parameters).
double SigmaOf(const JointMember& member, const Optimum& optimum) {
  const FitProblem& problem = *member.problem;
  const NoiseModel& noise = member.solution.noise;
  const double smallest = problem.negligible_sigma();
  if (!noise.IsUncensoredGaussian()) {
    const double smallest_quantized = noise.family == NoiseFamily::kEdges ? 0 : kSmallestSigma * problem.resolution;
    return MostLikelySigma(noise, problem.data.values(), member.solution.readings,
                           std::max(smallest_quantized, smallest));
  }
  const double rss = (problem.data.values() - member.solution.readings).squaredNorm();
  return std::max(std::sqrt(rss / std::max(member.samples() - ShareOf(member, optimum), 1.0)), smallest);
}

/// Sets the parameters and readings of every recording at the solution. Returns false if a trajectory cannot be
/// computed.
bool UpdateReadings(JointProblem& joint, const Solution& solution) {
  joint.Distribute(solution.parameters);
  return std::ranges::all_of(joint.members, [](JointMember& member) {
    return member.cost->Readings(member.solution.parameters, &member.solution.readings, nullptr);
  });
}

/// Sets σ of every recording from its residuals. For noise that is not Gaussian, the cost gets the new σ only if σ
/// changes by more than 0.3 %, a fraction of its standard error, because a new σ of quantized noise costs a trajectory.
/// Returns false if a trajectory cannot be computed.
bool UpdateNoise(JointProblem& joint, const Solution& solution) {
  constexpr double kSame = 3e-3;
  const std::optional<Optimum> optimum = Linearize(joint.solve, *joint.cost, solution);
  if (!optimum || !UpdateReadings(joint, solution)) return false;
  if (!optimum->inverse.identifiable) return true;
  for (JointMember& member : joint.members) {
    const double sigma = SigmaOf(member, *optimum);
    const bool changed = std::abs(std::log(sigma / member.cost_sigma)) > kSame;
    member.solution.noise.sigma = sigma;
    if (!changed && !member.solution.noise.IsUncensoredGaussian()) continue;
    member.cost_sigma = sigma;
    member.cost->set_noise(member.solution.noise);
  }
  return true;
}

/// Estimates parameters and σ in turn.
void SolveAlternately(JointProblem& joint, Solution& solution) {
  constexpr int kMaxRounds = 30;
  constexpr double kSettled = 0.01;  // standard errors
  for (int round = 0; round < kMaxRounds && solution.usable; ++round) {
    solution.usable = UpdateNoise(joint, solution);
    const std::optional<Optimum> optimum = Linearize(joint.solve, *joint.cost, solution);
    if (!optimum || !optimum->inverse.identifiable || RemainingShift(*optimum) < kSettled) return;
    solution = Continue(*joint.cost, solution, joint.solve);
  }
  solution.usable = solution.usable && UpdateReadings(joint, solution);
}

/// Returns whether all trajectories are accurate enough, or true if `last` is set. Otherwise makes the tolerance of
/// inaccurate trajectories finer. A recording whose own fit was accurate at the first tolerance is accurate in the
/// joint fit too.
bool AreAccurate(JointProblem& joint, Solution& solution, bool last) {
  bool accurate = true;
  for (JointMember& member : joint.members) {
    const double max_error = MaxTraceError(*member.problem, member.options);
    member.solution.trace_error = member.alone->trace_error;
    if (member.solution.trace_error <= max_error) continue;
    solution.usable = solution.usable && MeasureTraceError(*member.cost, member.tolerance, member.solution);
    if (member.solution.trace_error <= max_error || last) continue;
    accurate = false;
    member.tolerance = FinerTolerance(member.tolerance);
    member.cost->set_tolerance(member.tolerance);
  }
  return accurate || !solution.usable;
}

}  // namespace

Solution SolveJointly(JointProblem& joint) {
  Solution solution;
  solution.parameters = CombineParabolas(joint).parameters;
  solution = Refine(*joint.cost, solution, joint.solve);
  if (!solution.usable) {  // if the likelihood is not parabolic, the combined point may have no trajectory
    solution.parameters = joint.SeparateParameters();
    solution = Refine(*joint.cost, solution, joint.solve);
  }
  SolveAlternately(joint, solution);
  for (int refinement = 0; !AreAccurate(joint, solution, refinement == kMaxTraceRefinements); ++refinement) {
    solution = Continue(*joint.cost, solution, joint.solve);
    SolveAlternately(joint, solution);
  }
  if (solution.usable) solution.usable = joint.cost->SumOfSquares(solution.parameters, &solution.sum);
  for (JointMember& member : joint.members) {
    member.solution.usable = solution.usable;
    member.solution.iterations = solution.iterations;
    member.solution.message = solution.message;
    if (solution.usable) member.solution.log_likelihood = LogLikelihoodOf(*member.problem, member.solution);
  }
  return solution;
}

}  // namespace pendulum
