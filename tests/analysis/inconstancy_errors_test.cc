// SPDX-License-Identifier: Apache-2.0
// What AddInconstancyError adds, over many seeded simulations of parts with a known scatter.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <boost/random/normal_distribution.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/analysis/inconstancy.h"
#include "pendulum/analysis/random_effects.h"
#include "tests/analysis/fitted_run.h"

namespace pendulum::inconstancy_errors_test {
namespace {

using testing::AllOf;
using testing::Ge;
using testing::Le;

constexpr double kInertiaOfParts = 0.05;  // s²
constexpr int kWindows = 8, kSimulations = 2000;

/// A converged fit of the inertia alone, at the weighted mean of the windows.
FitReport FitOf(const Constancy& constancy) {
  FitReport fit;
  fit.termination = Termination::kConverged;
  ParameterEstimate inertia;
  inertia.info = kInertia;
  inertia.unit = "s^2";
  double sum = 0, weights = 0;
  for (const AmplitudeRow& row : constancy.windows) {
    const double weight = 1 / (row.inertia_std_error * row.inertia_std_error);
    sum += weight * row.inertia;
    weights += weight;
  }
  inertia.estimate = sum / weights;
  inertia.std_error = 1 / std::sqrt(weights);
  fit.parameters.push_back(inertia);
  return fit;
}

/// Windows whose true inertias scatter with the standard deviation `between`; later windows are known less well.
class SimulatedWindows {
 public:
  Constancy Draw(double between, double spread_of_errors) {
    Constancy constancy;
    Eigen::VectorXd value(kWindows), std_error(kWindows);
    for (int w = 0; w < kWindows; ++w) {
      std_error[w] = 1e-5 * std::pow(spread_of_errors, static_cast<double>(w) / (kWindows - 1));
      const double truth = kInertiaOfParts + between * normal_(generator_);
      value[w] = truth + std_error[w] * normal_(generator_);
      constancy.windows.push_back({0, 1, 0.1, value[w], std_error[w], 0, 0});
    }
    constancy.trends = {{"inertia", "s^2", 0, 1, 0, 1, ScatterP(value, std_error)}};
    return constancy;
  }
  double Next() { return normal_(generator_); }

 private:
  std::mt19937_64 generator_{20261128};
  boost::random::normal_distribution<double> normal_;
};

double AddedError(const Constancy& constancy, FitReport& fit) {
  AddInconstancyError({Alone(fit, constancy)}, {}, fit);
  return fit.parameters[0].systematic.Of(ErrorSource::kInconstancy);
}

// p < 0.001 of 2000 constant recordings: 2 on average, more than 8 once in 5000 times (Poisson).
TEST(InconstancyErrors, RarelyAppearInConstantRecordings) {
  for (const double spread : {1.0, 10.0}) {
    SimulatedWindows windows;
    int added = 0;
    for (int i = 0; i < kSimulations; ++i) {
      const Constancy constancy = windows.Draw(0, spread);
      FitReport fit = FitOf(constancy);
      added += AddedError(constancy, fit) > 0 ? 1 : 0;
    }
    EXPECT_LE(added, 8) << spread;
  }
}

// The error promises that the next recording is within it as often as a normal distribution says. With seven degrees of
// freedom, Student's t covers 95 % at 2.36, and 2 standard deviations cover 91 %; the smaller one of two estimates
// covers somewhat less. It must not exceed the true scatter much, however different the errors of the windows are.
TEST(InconstancyErrors, PredictTheNextRecording) {
  constexpr double kBetween = 1e-4;
  for (const double spread : {1.0, 3.0, 10.0}) {
    SimulatedWindows windows;
    int covered = 0;
    std::vector<double> sizes;
    for (int i = 0; i < kSimulations; ++i) {
      const Constancy constancy = windows.Draw(kBetween, spread);
      FitReport fit = FitOf(constancy);
      const double error = AddedError(constancy, fit);
      const double next = kInertiaOfParts + kBetween * windows.Next();
      const double total = std::hypot(error, *fit.parameters[0].std_error);
      covered += std::abs(next - fit.parameters[0].estimate) < 2 * total ? 1 : 0;
      sizes.push_back(error);
    }
    std::ranges::nth_element(sizes, sizes.begin() + kSimulations / 2);
    EXPECT_THAT(static_cast<double>(covered) / kSimulations, AllOf(Ge(0.85), Le(0.96))) << spread;
    EXPECT_THAT(sizes[kSimulations / 2] / kBetween, AllOf(Ge(0.7), Le(1.1))) << spread;
  }
}

}  // namespace
}  // namespace pendulum::inconstancy_errors_test
