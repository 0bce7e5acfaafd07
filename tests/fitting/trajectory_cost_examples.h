// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/model/friction/registry.h"
#include "tests/model/typical_friction.h"
#include "tests/model/undamped_pendulum.h"

namespace pendulum {

inline constexpr StartKind kStarts[] = {StartKind::kRelease, StartKind::kMoving};
inline constexpr Quantity kQuantities[] = {Quantity::kAngle, Quantity::kRate};

/// Parameters of a model with typical friction, in the cost's order.
inline std::vector<double> TypicalParameters(const MotionModel& model, StartKind start) {
  std::vector<double> p = {kReferenceInertia};
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    const auto friction = TypicalFriction<F>(0.003);
    p.insert(p.end(), friction.begin(), friction.end());
  });
  const bool released = start == StartKind::kRelease;
  p.insert(p.end(), {released ? 1.1 : 0.7, released ? 0.83 : -3.2, 0.013});
  return p;
}

/// Samples at about 100 Hz, slightly off so that none coincides with a reversal; no readings yet.
inline TrajectoryData Samples(Quantity quantity, std::size_t count) {
  TrajectoryData data;
  data.quantity = quantity;
  for (std::size_t i = 0; i < count; ++i) data.time.push_back(0.010007 * static_cast<double>(i));
  data.value.assign(count, 0.0);
  data.latest_release = 2;
  return data;
}

inline Eigen::VectorXd ReadingsOf(const TrajectoryCost& cost, const std::vector<double>& p) {
  Eigen::VectorXd readings;
  EXPECT_TRUE(cost.Readings(p, &readings, nullptr));
  return readings;
}

/// Samples with the readings for these parameters plus uniform noise of ± `noise`.
inline TrajectoryData Simulated(const MotionModel& model, StartKind start, Quantity quantity, std::size_t count,
                                const std::vector<double>& p, double noise) {
  TrajectoryData data = Samples(quantity, count);
  const std::unique_ptr<TrajectoryCost> cost = MakeTrajectoryCost(model, start, data);
  cost->set_tolerance(1e-14);
  const Eigen::VectorXd readings = ReadingsOf(*cost, p);
  std::mt19937_64 generator(20260805);
  for (std::size_t i = 0; i < count; ++i) {
    const double uniform = std::ldexp(static_cast<double>(generator() >> 11), -52) - 1;
    data.value[i] = readings[static_cast<Eigen::Index>(i)] + noise * uniform;
  }
  return data;
}

inline std::string Describe(const MotionModel& model, StartKind start, Quantity quantity) {
  return std::string(model.name) + (start == StartKind::kRelease ? ", released" : ", moving") +
         (quantity == Quantity::kAngle ? ", angle" : ", rate");
}

/// Calls visit(model, start, quantity) for every combination.
template <typename Visitor>
void ForEachCase(Visitor&& visit) {
  for (const MotionModel& model : MotionModels()) {
    for (const StartKind start : kStarts) {
      for (const Quantity quantity : kQuantities) {
        SCOPED_TRACE(Describe(model, start, quantity));
        visit(model, start, quantity);
      }
    }
  }
}

/// Data simulated with the typical parameters, and trial parameters near them.
struct CostExample {
  std::vector<double> trial;
  TrajectoryData data;
  std::unique_ptr<TrajectoryCost> cost;

  CostExample(const MotionModel& model, StartKind start, Quantity quantity, std::size_t count = 2003)
      : trial(TypicalParameters(model, start)), data(Simulated(model, start, quantity, count, trial, 0.003)) {
    data.scale = 0.002;
    cost = MakeTrajectoryCost(model, start, data);
    for (double& p : trial) p *= 1.001;
  }
  CostExample(const CostExample&) = delete;  // the cost refers to the data here
  CostExample& operator=(const CostExample&) = delete;
};

}  // namespace pendulum
