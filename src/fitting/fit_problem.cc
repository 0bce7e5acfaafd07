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

/// Puts the fixed values in, in the units of the problem; refuses names and values the model does not have.
Result<void> FixParameters(const FitOptions& options, FitProblem& problem) {
  for (const auto& [name, value] : options.fixed) {
    const auto info =
        std::find_if(problem.infos.begin(), problem.infos.end(), [&](const auto& i) { return i.name == name; });
    if (info == problem.infos.end()) {
      std::string names;
      for (const ParameterInfo& known : problem.infos) names += (names.empty() ? "" : ", ") + std::string(known.name);
      return Error(StatusCode::kInvalidArgument, "model " + std::string(problem.model.name) + " has no parameter '" +
                                                     name + "' to fix with this start; it has " + names);
    }
    const bool is_inertia = info->name == kInertia.name;
    const auto i = static_cast<std::size_t>(info - problem.infos.begin());
    const double internal = (value - problem.offset[i]) / problem.si_per_internal[i];
    // An inertia must leave ω0 = 1/sqrt(I) a number of a size that can be traced.
    const bool too_small = is_inertia && !(internal > 1e-30);
    if (!std::isfinite(internal) || value < info->lower || value > info->upper || too_small) {
      return Error(StatusCode::kInvalidArgument, name + " cannot be fixed at " + NumberText(value) + "; it must be " +
                                                     (is_inertia ? "positive" : "at least " + NumberText(info->lower)));
    }
    problem.first_guess[i] = internal;
    problem.solve.fixed[i] = true;
  }
  return {};
}

TrajectoryData MakeData(const Recording& recording, const StartValues& start, double noise) {
  TrajectoryData data;
  data.quantity = recording.quantity;
  data.time.resize(static_cast<std::size_t>(recording.size()));
  std::transform(recording.time.begin(), recording.time.end(), data.time.begin(),
                 [&](double time) { return time - recording.time[0]; });
  data.value.assign(recording.value.begin(), recording.value.end());
  data.natural_frequency = start.natural_frequency;
  data.latest_release = start.latest_release;
  const double range = recording.value.maxCoeff() - recording.value.minCoeff();
  data.scale = std::max({noise, 0.3 * recording.resolution, 1e-6 * range});
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
  if (!start) return tl::unexpected(start.error());

  FitProblem problem;
  problem.model = *model;
  problem.start = *start;
  problem.infos = FitParameters(*model, start->start, recording.quantity);
  problem.first_guess = start->parameters;
  problem.noise = SuccessiveDifferenceNoise(recording);
  problem.data = MakeData(recording, *start, problem.noise);
  const double gravity_torque = options.rig ? options.rig->gravity_torque.value : 1.0;
  for (const ParameterInfo& info : problem.infos) {
    problem.si_per_internal.push_back(info.scales_with_gravity() ? gravity_torque : 1.0);
    problem.offset.push_back(info.name == kReleaseTime.name ? recording.time[0] : 0.0);
    problem.solve.lower.push_back(info.name == kInertia.name ? -kUnbounded : info.lower);
  }
  problem.solve.fixed.assign(problem.infos.size(), false);
  problem.solve.holding_parameter = HoldingParameter(*model);
  problem.solve.max_iterations = options.max_iterations;
  if (const Result<void> fixed = FixParameters(options, problem); !fixed) return tl::unexpected(fixed.error());
  return problem;
}

}  // namespace pendulum
