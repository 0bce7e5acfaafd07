// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/likelihood/trajectory_cost.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fitting/likelihood/sensed_cost.h"
#include "fitting/likelihood/trajectory_cost_for.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {

TrajectoryCost::TrajectoryCost(int count) : count_(count) {
  set_num_residuals(count + 1);
  mutable_parameter_block_sizes()->assign(static_cast<std::size_t>(count), 1);
}

/// After a trial step is accepted, the solver asks for derivatives at the same point. They cost little more than the
/// residuals alone, so the first trial after a step computes them at once.
bool TrajectoryCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  std::array<double, kMaxCompressed> values{};
  for (int i = 0; i < count_; ++i) values[i] = *parameters[i];
  const std::span<const double> p(values.data(), count_);
  if (jacobians != nullptr) {
    trials_since_step_ = 0;
    if (!Sums(p, &scratch_)) return false;
    CompressResiduals(scratch_, residuals, jacobians);
    return true;
  }
  std::fill_n(residuals, count_, 0.0);
  double sum = 0;
  const bool likely_taken = trials_since_step_++ == 0;
  const bool valid = likely_taken ? Sums(p, &scratch_) : SumOfSquares(p, &sum);
  if (valid && likely_taken) sum = scratch_(count_, count_);
  residuals[count_] = std::sqrt(std::max(sum, 0.0));
  return valid;
}

void TrajectoryCost::AddTo(ceres::Problem& problem, const std::vector<double*>& parameters) {
  problem.AddResidualBlock(this, nullptr, parameters);
}

std::unique_ptr<TrajectoryCost> MakeTrajectoryCost(const MotionModel& model, StartKind start,
                                                   const TrajectoryData& data) {
  if (data.sensor.kind != SensorKind::kDirect) return MakeSensedCost(model, start, data);
  std::unique_ptr<TrajectoryCost> cost;
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    constexpr int kMotion = 1 + kFrictionParameters<F> + 2;
    static_assert(kMotion + SensorModel::kMaxParameters <= kMaxCompressed, "Evaluate has room for kMaxCompressed");
    if (start == StartKind::kRelease) {
      cost = std::make_unique<TrajectoryCostFor<F, StartKind::kRelease>>(model.gravity, data);
    } else {
      cost = std::make_unique<TrajectoryCostFor<F, StartKind::kMoving>>(model.gravity, data);
    }
  });
  return cost;
}

}  // namespace pendulum
