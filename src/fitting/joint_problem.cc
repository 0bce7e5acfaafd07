// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/joint_problem.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pendulum/fitting/joint_parabolas.h"
#include "pendulum/fitting/maximum_likelihood.h"
#include "pendulum/fitting/optimum.h"
#include "pendulum/fitting/search.h"
#include "pendulum/fitting/trace_error.h"
#include "pendulum/trajectory/tolerance.h"

namespace pendulum {
namespace {

using Eigen::Index;

std::string NumberOf(std::size_t k) { return "recording " + std::to_string(k + 1); }

/// A problem whose parameters are those of the fit alone.
Result<FitProblem> ProblemOf(const JointRun& run, FitOptions& options) {
  options = AskAlike(run.alone, run.options);
  options.start_values = run.alone.start_values;
  options.initial.clear();
  for (const std::string_view drift : {kZeroDrift.name, kBiasDrift.name}) {  // a parameter where the options name it
    if (run.alone.Find(drift) == nullptr) continue;
    options.start_values->parameters.pop_back();
    if (!options.fixed.contains(drift)) options.initial.emplace(drift, 0.0);
  }
  return MakeFitProblem(run.used, options);
}

/// The noise of the fit alone, with the sensor's range.
NoiseModel NoiseOf(const FitProblem& problem, const FitReport& alone) {
  NoiseModel noise = problem.noise;
  noise.family = alone.noise.family;
  noise.sigma = std::max(alone.noise.sigma, problem.negligible_sigma());
  noise.resolution = noise.family == NoiseFamily::kQuantized ? problem.resolution : 0;
  return noise;
}

Result<JointMember> MakeMember(const JointRun& run, std::size_t k) {
  JointMember member;
  member.recording = &run.used;
  member.alone = &run.alone;
  if (run.alone.termination == Termination::kFailed) {
    return Error(StatusCode::kFailedPrecondition, NumberOf(k) + " cannot be fitted alone: " + run.alone.reason);
  }
  Result<FitProblem> problem = ProblemOf(run, member.options);
  if (!problem) return tl::unexpected(problem.error());
  member.problem = std::make_unique<FitProblem>(*std::move(problem));
  member.cost = MakeTrajectoryCost(member.problem->model, member.problem->start.start, member.problem->data);
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

/// One model, and one rig, for parameters are shared in units of its gravity torque.
Result<void> CheckAlike(std::span<const JointRun> runs) {
  const auto torque = [](const JointRun& run) { return run.options.rig ? run.options.rig->gravity_torque.value : 0; };
  for (std::size_t k = 1; k < runs.size(); ++k) {
    if (runs[k].alone.model.name != runs[0].alone.model.name) {
      return Error(StatusCode::kInvalidArgument, NumberOf(k) + " was fitted with another model than the first");
    }
    if (torque(runs[k]) != torque(runs[0])) {
      return Error(StatusCode::kInvalidArgument, NumberOf(k) + " is of another rig than the first");
    }
  }
  return {};
}

/// Names of the model's parameters among those asked for, in the model's order.
std::vector<std::string> SharedOf(const MotionModel& model, const std::vector<std::string>& asked) {
  std::vector<std::string> shared;
  for (const ParameterInfo& info : PhysicalParameters(model)) {
    if (std::ranges::find(asked, info.name) != asked.end()) shared.emplace_back(info.name);
  }
  return shared;
}

/// Room for so many parameters, without bounds.
void Resize(SolveOptions& solve, std::size_t count) {
  solve.lower.resize(count, -kUnbounded);
  solve.upper.resize(count, kUnbounded);
  solve.fixed.resize(count, false);
}

/// Where the parameter of a member stands among all: what is its own is added to them.
std::size_t PlaceOf(JointProblem& joint, std::string_view name) {
  const auto shared = std::ranges::find(joint.shared, name);
  if (shared != joint.shared.end()) return static_cast<std::size_t>(shared - joint.shared.begin());
  Resize(joint.solve, joint.solve.fixed.size() + 1);
  return joint.solve.fixed.size() - 1;
}

/// Gives a member's parameters their places. What is shared keeps to the bounds of all members.
void Place(JointProblem& joint, JointMember& member) {
  const SolveOptions& own = member.problem->solve;
  SolveOptions& all = joint.solve;
  for (std::size_t i = 0; i < own.fixed.size(); ++i) {
    const std::size_t place = PlaceOf(joint, member.problem->infos[i].name);
    all.lower[place] = std::max(all.lower[place], own.lower[i]);
    all.upper[place] = std::min(all.upper[place], own.upper[i]);
    all.fixed[place] = all.fixed[place] || own.fixed[i];
    member.at.push_back(static_cast<int>(place));
  }
}

/// What is known beforehand of a shared parameter counts once, as the first member has it.
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

/// One cost of all members, and how it is solved.
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

/// How many of the free parameters a recording pays for: those of all recordings add up to their number.
double ShareOf(const JointMember& member, const Optimum& optimum) {
  Eigen::MatrixXd sums;
  if (!member.cost->Sums(member.solution.parameters, &sums)) return 0;
  const std::vector<int> own = member.Own(optimum.free);
  const std::vector<Index> rows = member.RowsAmong(optimum.free, own);
  return optimum.inverse.matrix(rows, rows).cwiseProduct(sums(own, own)).sum();
}

/// σ of a recording at the joint optimum; of Gaussian noise RSS / (N - its share of the parameters).
double SigmaOf(const JointMember& member, const Optimum& optimum) {
  const FitProblem& problem = *member.problem;
  const NoiseModel& noise = member.solution.noise;
  const double smallest = problem.negligible_sigma();
  if (!noise.IsPlain()) {
    return LikeliestSigma(noise, problem.data.values(), member.solution.readings,
                          std::max(kSmallestSigma * problem.resolution, smallest));
  }
  const double rss = (problem.data.values() - member.solution.readings).squaredNorm();
  return std::max(std::sqrt(rss / std::max(member.samples() - ShareOf(member, optimum), 1.0)), smallest);
}

/// Gives every recording its parameters and readings at the solution. False where a motion cannot be traced.
bool UpdateReadings(JointProblem& joint, const Solution& solution) {
  joint.Distribute(solution.parameters);
  return std::ranges::all_of(joint.members, [](JointMember& member) {
    return member.cost->Readings(member.solution.parameters, &member.solution.readings, nullptr);
  });
}

/// Gives every recording the σ that its residuals have at the solution, and its cost too unless that has it to a
/// fraction of σ's own error: another σ of levels costs a trajectory. False where a motion cannot be traced.
bool UpdateNoise(JointProblem& joint, const Solution& solution) {
  constexpr double kSame = 3e-3;
  const std::optional<Optimum> optimum = Linearize(joint.solve, *joint.cost, solution);
  if (!optimum || !UpdateReadings(joint, solution)) return false;
  if (!optimum->inverse.identifiable) return true;
  for (JointMember& member : joint.members) {
    const double sigma = SigmaOf(member, *optimum);
    const bool changed = std::abs(std::log(sigma / member.cost_sigma)) > kSame;
    member.solution.noise.sigma = sigma;
    if (!changed && !member.solution.noise.IsPlain()) continue;
    member.cost_sigma = sigma;
    member.cost->set_noise(member.solution.noise);
  }
  return true;
}

/// Parameters and σ in turn.
void Settle(JointProblem& joint, Solution& solution) {
  constexpr int kMostRounds = 30;
  constexpr double kSettled = 0.01;  // standard errors
  for (int round = 0; round < kMostRounds && solution.usable; ++round) {
    solution.usable = UpdateNoise(joint, solution);
    const std::optional<Optimum> optimum = Linearize(joint.solve, *joint.cost, solution);
    if (!optimum || !optimum->inverse.identifiable || RemainingShift(*optimum) < kSettled) return;
    solution = Continue(*joint.cost, solution, joint.solve);
  }
  solution.usable = solution.usable && UpdateReadings(joint, solution);
}

/// Whether all trajectories are accurate enough, or no finer tolerance is left to try. Where the fit alone was accurate
/// at the first tolerance, so is the joint one.
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

std::vector<int> JointMember::Own(const std::vector<int>& of_all) const {
  std::vector<int> own;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (std::ranges::find(of_all, at[i]) != of_all.end()) own.push_back(static_cast<int>(i));
  }
  return own;
}

std::vector<Eigen::Index> JointMember::RowsAmong(const std::vector<int>& of_all, const std::vector<int>& own) const {
  std::vector<Index> rows;
  rows.reserve(own.size());
  for (const int i : own) {
    rows.push_back(std::ranges::find(of_all, at[static_cast<std::size_t>(i)]) - of_all.begin());
  }
  return rows;
}

double JointProblem::samples() const {
  double samples = 0;
  for (const JointMember& member : members) samples += member.samples();
  return samples;
}

void JointProblem::Distribute(const std::vector<double>& parameters) {
  for (std::size_t k = 0; k < members.size(); ++k) members[k].solution.parameters = cost->Own(k, parameters);
}

std::vector<double> JointProblem::AloneParameters() const {
  std::vector<double> all(solve.fixed.size());
  for (const JointMember& member : members) {
    for (std::size_t i = 0; i < member.at.size(); ++i) {
      all[static_cast<std::size_t>(member.at[i])] = member.alone_parameters[i];
    }
  }
  return all;
}

std::string JointProblem::NameOf(int parameter) const {
  if (IsShared(parameter)) return shared[static_cast<std::size_t>(parameter)];
  for (std::size_t k = 0; k < members.size(); ++k) {
    const auto own = std::ranges::find(members[k].at, parameter);
    if (own == members[k].at.end()) continue;
    const auto i = static_cast<std::size_t>(own - members[k].at.begin());
    return std::string(members[k].problem->infos[i].name) + " of " + NumberOf(k);
  }
  return "";
}

Result<JointProblem> MakeJointProblem(std::span<const JointRun> runs, const std::vector<std::string>& shared) {
  if (runs.size() < 2) {
    return Error(StatusCode::kInvalidArgument, "a joint fit needs two recordings or more; " +
                                                   std::string(runs.empty() ? "there is none" : "there is one"));
  }
  if (Result<void> checked = CheckAlike(runs); !checked) return tl::unexpected(checked.error());
  JointProblem joint;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    Result<JointMember> member = MakeMember(runs[k], k);
    if (!member) return tl::unexpected(member.error());
    joint.members.push_back(*std::move(member));
  }
  const MotionModel& model = joint.members.front().problem->model;
  joint.shared = SharedOf(model, shared);
  if (joint.shared.empty()) {
    return Error(StatusCode::kInvalidArgument,
                 "model " + std::string(model.name) + " has none of the parameters that are to be shared");
  }
  Assemble(joint);
  return joint;
}

Solution SolveJointly(JointProblem& joint) {
  Solution solution;
  solution.parameters = CombineParabolas(joint).parameters;
  solution = Refine(*joint.cost, solution, joint.solve);
  if (!solution.usable) {  // far from parabolas the step may lead where nothing can be traced
    solution.parameters = joint.AloneParameters();
    solution = Refine(*joint.cost, solution, joint.solve);
  }
  Settle(joint, solution);
  for (int refinement = 0; !AreAccurate(joint, solution, refinement == kMostTraceRefinements); ++refinement) {
    solution = Continue(*joint.cost, solution, joint.solve);
    Settle(joint, solution);
  }
  for (JointMember& member : joint.members) {
    member.solution.usable = solution.usable;
    member.solution.iterations = solution.iterations;
    member.solution.message = solution.message;
    if (solution.usable) member.solution.log_likelihood = LogLikelihoodOf(*member.problem, member.solution);
  }
  return solution;
}

}  // namespace pendulum
