// SPDX-License-Identifier: Apache-2.0
// Samples at which derivatives of the readings can be compared with finite differences.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/model/friction/registry.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// The times [s] when the motion begins, turns and stops.
inline std::vector<double> Instants(const MotionModel& model, StartKind start, const std::vector<double>& p,
                                    double end) {
  const double begin = start == StartKind::kRelease ? p[p.size() - 2] : 0.0;
  std::vector<double> instants = {begin};
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    Pendulum<F, double> pendulum{model.gravity, p[0], {}};
    std::copy_n(p.begin() + 1, pendulum.friction.size(), pendulum.friction.begin());
    TraceOptions options;
    options.end = end;
    options.tolerance = 1e-14;
    const double rate = start == StartKind::kRelease ? 0.0 : p[p.size() - 2];
    TraceTrajectory(pendulum, Start<double>{start, begin, p[p.size() - 3], rate}, options,
                    [&](const Segment<double>& segment) {
                      const bool turns = segment.order == 0 || segment.angle[1] == 0;
                      if (turns && segment.start > begin) instants.push_back(segment.start);
                    });
  });
  return instants;
}

/// Parameters shifted up and down along one of them.
struct BesideParameters {
  std::vector<double> above, below;
  double step = 0;
};

inline BesideParameters Beside(const MotionModel& model, const std::vector<double>& p, int column) {
  const std::vector<ParameterInfo> infos = PhysicalParameters(model);
  const bool is_share = static_cast<std::size_t>(column) < infos.size() && std::isfinite(infos[column].upper);
  BesideParameters beside{p, p, (is_share ? 1e-4 : 1e-6) * std::abs(p[column])};  // a share hardly changes the motion
  beside.above[column] += beside.step;
  beside.below[column] -= beside.step;
  return beside;
}

/// All samples except those near an event (start, reversal or stop) whose time depends on the parameters: the samples
/// between the event's earliest and latest time for these sets of parameters. Each set holds the model's parameters,
/// the start and the zero.
inline std::vector<Eigen::Index> SamplesAwayFromEvents(const MotionModel& model, StartKind start,
                                                       const TrajectoryData& data,
                                                       const std::array<std::vector<double>, 3>& parameters) {
  std::array<std::vector<double>, 3> instants;
  for (std::size_t k = 0; k < 3; ++k) instants[k] = Instants(model, start, parameters[k], data.time.back());
  std::vector<Eigen::Index> quiet;
  EXPECT_THAT(instants, testing::Each(testing::SizeIs(instants[0].size())));
  if (instants[1].size() != instants[0].size() || instants[2].size() != instants[0].size()) return quiet;
  EXPECT_THAT(instants[0].size(), testing::Ge(31));
  std::vector<bool> is_passed(data.time.size());
  for (std::size_t k = 0; k < instants[0].size(); ++k) {
    const auto [first, last] = std::minmax({instants[0][k], instants[1][k], instants[2][k]});
    const auto from = std::ranges::lower_bound(data.time, first - 1e-9);
    const auto to = std::upper_bound(from, data.time.end(), last + 1e-9);
    std::fill_n(is_passed.begin() + (from - data.time.begin()), to - from, true);
  }
  for (std::size_t i = 0; i < data.time.size(); ++i) {
    if (!is_passed[i]) quiet.push_back(static_cast<Eigen::Index>(i));
  }
  EXPECT_THAT(quiet.size(), testing::Ge(0.95 * static_cast<double>(data.time.size())));
  return quiet;
}

}  // namespace pendulum
