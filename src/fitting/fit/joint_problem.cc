// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/joint_problem.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pendulum/base/try.h"
#include "pendulum/fitting/solve/search.h"
#include "pendulum/fitting/solve/trace_error.h"
#include "pendulum/trajectory/tolerance.h"

namespace pendulum {
namespace {

std::string NumberOf(std::size_t k) { return "recording " + std::to_string(k + 1); }

/// A problem with the same parameters as the recording's own fit.
Result<FitProblem> ProblemOf(const JointRun& run, FitOptions& options) {
  options = OptionsLike(run.alone, run.options);
  options.search.start_values = run.alone.start_values;
  options.initial.clear();
  // A drift is a parameter only if the options name it.
  for (const std::string_view drift : {kZeroDrift.name, kBiasDrift.name}) {
    if (run.alone.Find(drift) != nullptr && !options.fixed.contains(drift)) options.initial.emplace(drift, 0.0);
  }
  return MakeFitProblem(run.used, options);
}

/// The noise of the recording's own fit, with the sensor's range.
NoiseModel NoiseOf(const FitProblem& problem, const FitReport& alone) {
  NoiseModel noise = problem.noise;
  noise.family = alone.noise.family;
  noise.sigma = std::max(alone.noise.sigma, problem.negligible_sigma());
  const bool averaged = noise.family == NoiseFamily::kAveraged;
  const bool has_levels = noise.family == NoiseFamily::kQuantized || noise.family == NoiseFamily::kEdges || averaged;
  noise.resolution = has_levels ? problem.resolution : 0;
  noise.stamp_ratio = alone.noise.stamp_ratio;
  noise.lag = alone.noise.lag;
  noise.spread = alone.noise.spread;
  if (averaged) noise.averaging = alone.noise.averaging;
  return noise;
}

Result<JointMember> MakeMember(const JointRun& run, std::size_t k) {
  JointMember member;
  member.recording = &run.used;
  member.alone = &run.alone;
  if (run.alone.termination == Termination::kFailed) {
    return Error(StatusCode::kFailedPrecondition, NumberOf(k) + " cannot be fitted separately: " + run.alone.reason);
  }
  ASSIGN_OR_RETURN(FitProblem problem, ProblemOf(run, member.options));
  member.problem = std::make_unique<FitProblem>(std::move(problem));
  member.cost = MakeTrajectoryCost(member.problem->model, member.problem->start.start, member.problem->data);
  member.cost->set_threads(member.options.threads);
  member.tolerance = TraceTolerance(MaxTraceError(*member.problem, member.options), member.problem->start.amplitude);
  member.cost->set_tolerance(member.tolerance);
  Solution& solution = member.solution;
  for (std::size_t i = 0; i < member.problem->infos.size(); ++i) {
    const double own = member.problem->Internal(i, run.alone.parameters[i].estimate);
    solution.parameters.push_back(std::clamp(own, member.problem->solve.lower[i], member.problem->solve.upper[i]));
  }
  member.alone_parameters = solution.parameters;
  solution.noise = NoiseOf(*member.problem, run.alone);
  solution.noise_reason = run.alone.noise.why;
  member.cost_sigma = solution.noise.sigma;
  member.cost->set_noise(solution.noise);
  return member;
}

/// Checks that all runs have the same model and rig, because shared parameters are in units of the rig's gravity
/// torque.
Result<void> CheckSameModelAndRig(std::span<const JointRun> runs) {
  const auto torque = [](const JointRun& run) {
    const Rig* rig = SiRig(run.options);
    return rig != nullptr ? rig->gravity_torque.value : 0;
  };
  for (std::size_t k = 1; k < runs.size(); ++k) {
    if (runs[k].alone.model.name != runs[0].alone.model.name) {
      return Error(StatusCode::kInvalidArgument, NumberOf(k) + " was fitted with a different model from the first");
    }
    if (torque(runs[k]) != torque(runs[0])) {
      return Error(StatusCode::kInvalidArgument, NumberOf(k) + " is of a different rig from the first");
    }
  }
  return {};
}

/// The model's parameters that the user asked to share, in the model's order.
std::vector<std::string> SharedOf(const MotionModel& model, const std::vector<std::string>& requested) {
  std::vector<std::string> shared;
  for (const ParameterInfo& info : PhysicalParameters(model)) {
    if (std::ranges::find(requested, info.name) != requested.end()) shared.emplace_back(info.name);
  }
  return shared;
}

/// Extends the arrays to `count` parameters, without bounds.
void Resize(SolveOptions& solve, std::size_t count) {
  solve.lower.resize(count, -kUnbounded);
  solve.upper.resize(count, kUnbounded);
  solve.fixed.resize(count, false);
}

/// Index of a member's parameter among all. A parameter that is not shared is added.
std::size_t FindOrAddPlace(JointProblem& joint, std::string_view name) {
  const auto shared = std::ranges::find(joint.shared, name);
  if (shared != joint.shared.end()) return static_cast<std::size_t>(shared - joint.shared.begin());
  Resize(joint.solve, joint.solve.fixed.size() + 1);
  return joint.solve.fixed.size() - 1;
}

/// Assigns indices to a member's parameters. A shared parameter must keep to the bounds of all members.
void Place(JointProblem& joint, JointMember& member) {
  const SolveOptions& own = member.problem->solve;
  SolveOptions& all = joint.solve;
  for (std::size_t i = 0; i < own.fixed.size(); ++i) {
    const std::size_t place = FindOrAddPlace(joint, member.problem->infos[i].name);
    all.lower[place] = std::max(all.lower[place], own.lower[i]);
    all.upper[place] = std::min(all.upper[place], own.upper[i]);
    all.fixed[place] = all.fixed[place] || own.fixed[i];
    member.at.push_back(static_cast<int>(place));
  }
}

/// The priors of all members. A prior on a shared parameter counts once, taken from the first member.
std::vector<PriorTerm> PriorsOf(const JointProblem& joint) {
  std::vector<PriorTerm> priors;
  for (const JointMember& member : joint.members) {
    for (PriorTerm prior : member.problem->priors) {
      prior.parameter = member.at[static_cast<std::size_t>(prior.parameter)];
      if (!joint.IsShared(prior.parameter) || &member == &joint.members.front()) priors.push_back(prior);
    }
  }
  return priors;
}

/// Builds the cost of all members and the solver's options.
void Assemble(JointProblem& joint) {
  Resize(joint.solve, joint.shared.size());
  std::vector<JointTerm> terms;
  for (JointMember& member : joint.members) {
    Place(joint, member);
    terms.push_back({member.cost.get(), member.at});
  }
  const SolveOptions& first = joint.members.front().problem->solve;
  const int holding = first.holding_parameter;
  const int held = holding < 0 ? -1 : joint.members.front().at[static_cast<std::size_t>(holding)];
  joint.solve.holding_parameter = joint.IsShared(held) ? held : -1;
  joint.solve.max_iterations = first.max_iterations;
  joint.solve.max_traces = first.max_traces * static_cast<int>(terms.size());
  joint.cost =
      std::make_unique<JointCost>(std::move(terms), static_cast<int>(joint.solve.fixed.size()), PriorsOf(joint));
}

}  // namespace

SolvedFit JointProblem::SolvedAt(Solution& solution) {
  SolvedFit fit{{}, shared.size(), *cost, solve, cost->priors(), solution};
  for (JointMember& member : members) {
    fit.runs.push_back(
        {*member.recording, member.options, *member.problem, *member.cost, member.solution, member.at, {}});
  }
  return fit;
}

void JointProblem::Distribute(const std::vector<double>& parameters) {
  for (std::size_t k = 0; k < members.size(); ++k) members[k].solution.parameters = cost->OwnParameters(k, parameters);
}

std::vector<double> JointProblem::SeparateParameters() const {
  std::vector<double> all(solve.fixed.size());
  for (const JointMember& member : members) {
    for (std::size_t i = 0; i < member.at.size(); ++i) {
      all[static_cast<std::size_t>(member.at[i])] = member.alone_parameters[i];
    }
  }
  return all;
}

Result<JointProblem> MakeJointProblem(std::span<const JointRun> runs, const std::vector<std::string>& shared) {
  if (runs.size() < 2) {
    return Error(StatusCode::kInvalidArgument, "a joint fit needs two recordings or more; " +
                                                   std::string(runs.empty() ? "there is none" : "there is one"));
  }
  if (runs.front().options.interval == IntervalMethod::kBootstrap) {
    return Error(StatusCode::kInvalidArgument, "bootstrap intervals are only for the fit to a single recording");
  }
  RETURN_IF_ERROR(CheckSameModelAndRig(runs));
  JointProblem joint;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    ASSIGN_OR_RETURN(JointMember member, MakeMember(runs[k], k));
    joint.members.push_back(std::move(member));
  }
  const MotionModel& model = joint.members.front().problem->model;
  joint.shared = SharedOf(model, shared);
  if (joint.shared.empty()) {
    return Error(StatusCode::kInvalidArgument,
                 "model " + std::string(model.name) + " has none of the shared parameters");
  }
  Assemble(joint);
  return joint;
}

}  // namespace pendulum
