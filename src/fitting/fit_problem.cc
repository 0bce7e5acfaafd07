// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit_problem.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pendulum/base/format.h"
#include "pendulum/closed_form/extrema.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {
namespace {

/// Index of the first friction parameter that holds the pendulum at rest, among all parameters; -1: none.
int HoldingParameter(const MotionModel& model) {
  int holding = -1;
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    for (int k = kFrictionParameters<F> - 1; k >= 0; --k) {
      std::array<double, kFrictionParameters<F>> unit{};
      unit[k] = 1;
      if (F::Torque(0.0, 1.0, unit.data()) > 0) holding = 1 + k;
    }
  });
  return holding;
}

/// Trajectories of a fit: good recordings need tens, hopeless ones would take for ever.
constexpr int kMostTraces = 3000;

/// s², in units of G; ω0 = 1/sqrt(I) must be of a size that can be traced.
constexpr double kSmallestInertia = 1e-30;

/// What a parameter may be, for a sentence, in the units of the report.
std::string Range(const FitProblem& problem, std::size_t i) {
  const auto reported = [&](double internal) {
    return NumberText(problem.si_per_internal[i] * internal + problem.offset[i]);
  };
  if (problem.infos[i].name == kInertia.name) return "greater than " + reported(kSmallestInertia);
  const std::string from = "at least " + reported(problem.solve.lower[i]);
  return std::isfinite(problem.solve.upper[i]) ? from + " and at most " + reported(problem.solve.upper[i]) : from;
}

/// Puts a fixed value in, in the units of the problem; refuses one that the parameter cannot have.
Result<void> FixParameter(double value, std::size_t i, FitProblem& problem) {
  const double internal = (value - problem.offset[i]) / problem.si_per_internal[i];
  const bool too_small = problem.infos[i].name == kInertia.name && !(internal > kSmallestInertia);
  const bool outside = internal < problem.solve.lower[i] || internal > problem.solve.upper[i];
  if (!std::isfinite(internal) || outside || too_small) {
    return Error(StatusCode::kInvalidArgument, std::string(problem.infos[i].name) + " cannot be fixed at " +
                                                   NumberText(value) + "; it must be " + Range(problem, i));
  }
  problem.first_guess[i] = internal;
  problem.solve.fixed[i] = true;
  return {};
}

Result<void> FixParameters(const ParameterValues& fixed, FitProblem& problem) {
  for (const auto& entry : fixed) {
    const auto info =
        std::find_if(problem.infos.begin(), problem.infos.end(), [&](const auto& i) { return i.name == entry.first; });
    if (info == problem.infos.end()) {
      return Error(StatusCode::kInvalidArgument, "model " + std::string(problem.model.name) + " has no parameter '" +
                                                     entry.first + "' to fix with this start; it has " +
                                                     NameList(problem.infos));
    }
    const auto i = static_cast<std::size_t>(info - problem.infos.begin());
    if (Result<void> done = FixParameter(entry.second, i, problem); !done) return done;
  }
  return {};
}

/// Bounds in the units of the problem: those of the parameters, and the hold for the release.
void SetBounds(FitProblem& problem) {
  for (const ParameterInfo& info : problem.infos) {
    const bool is_release = info.name == kReleaseTime.name;
    problem.solve.lower.push_back(is_release ? 0.0 : info.name == kInertia.name ? -kUnbounded : info.lower);
    problem.solve.upper.push_back(is_release ? problem.start.latest_release : info.upper);
  }
}

TrajectoryData MakeData(const Recording& recording, const StartValues& start) {
  TrajectoryData data;
  data.quantity = recording.quantity;
  data.time.resize(static_cast<std::size_t>(recording.size()));
  std::transform(recording.time.begin(), recording.time.end(), data.time.begin(),
                 [&](double time) { return time - recording.time[0]; });
  data.value.assign(recording.value.begin(), recording.value.end());
  data.natural_frequency = start.natural_frequency;
  data.latest_release = start.latest_release;
  const double range = recording.value.maxCoeff() - recording.value.minCoeff();
  data.scale = std::max({SuccessiveDifferenceNoise(recording), 0.3 * recording.resolution, 1e-6 * range});
  return data;
}

}  // namespace

std::vector<ParameterInfo> FitParameters(const MotionModel& model, StartKind start, Quantity quantity) {
  std::vector<ParameterInfo> infos = PhysicalParameters(model);
  if (start == StartKind::kRelease) {
    infos.insert(infos.end(), {kReleaseAngle, kReleaseTime});
  } else {
    infos.insert(infos.end(), {kInitialAngle, kInitialRate});
  }
  infos.push_back(quantity == Quantity::kAngle ? kZeroAngle : kRateBias);
  return infos;
}

Result<FitProblem> MakeFitProblem(const Recording& recording, const FitOptions& options) {
  const Result<MotionModel> model = FindMotionModel(options.model);
  if (!model) return tl::unexpected(model.error());
  const Result<StartValues> start = EstimateStartValues(recording, *model, options.start);
  if (!start)
    return Error(start.error().code,
                 recording.path.empty() ? start.error().message : recording.path + ": " + start.error().message);

  FitProblem problem;
  problem.model = *model;
  problem.start = *start;
  problem.infos = FitParameters(*model, start->start, recording.quantity);
  problem.first_guess = start->parameters;
  problem.data = MakeData(recording, *start);
  const double gravity_torque = options.rig ? options.rig->gravity_torque.value : 1.0;
  for (const ParameterInfo& info : problem.infos) {
    problem.si_per_internal.push_back(info.scales_with_gravity() ? gravity_torque : 1.0);
    problem.offset.push_back(info.name == kReleaseTime.name ? recording.time[0] : 0.0);
  }
  SetBounds(problem);
  problem.solve.fixed.assign(problem.infos.size(), false);
  problem.solve.holding_parameter = HoldingParameter(*model);
  problem.solve.last_friction = static_cast<int>(PhysicalParameters(*model).size()) - 1;
  if (start->start == StartKind::kRelease) problem.solve.release_time = problem.solve.last_friction + 2;
  problem.solve.max_iterations = options.max_iterations;
  problem.solve.max_traces = kMostTraces;
  if (const Result<void> fixed = FixParameters(options.fixed, problem); !fixed) return tl::unexpected(fixed.error());
  return problem;
}

std::vector<double> FirstGuess(const FitProblem& problem, const std::vector<bool>& fixed) {
  if (fixed == problem.solve.fixed) return problem.first_guess;
  const auto first = fixed.begin() + 1;
  const std::vector<bool> left_out(first, first + problem.solve.last_friction);
  const std::vector<double> friction = FrictionFrom(problem.start.energy_balance, left_out);
  std::vector<double> guess = problem.first_guess;
  for (std::size_t i = 1; i <= friction.size(); ++i) {
    if (!problem.solve.fixed[i]) guess[i] = fixed[i] ? problem.solve.lower[i] : friction[i - 1];
  }
  return guess;
}

}  // namespace pendulum
