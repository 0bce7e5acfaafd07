// SPDX-License-Identifier: Apache-2.0
// A recording that reaches rest has one minimum per number of half swings before the stop; the fit must find the lowest
// from start values in the data. Expected: the truth of the simulation, and normal deviations.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"

namespace pendulum {
namespace {

/// The textbook rig with dry friction at one count of noise: it stops after 48 s of 60.
SyntheticOptions RunToRest(std::uint64_t seed) {
  SyntheticOptions options = TextbookRun("coulomb");
  options.parameters = {0.079 / kTextbookTorque, 0.002 / kTextbookTorque, 0.004 / kTextbookTorque};
  options.duration = 60;
  options.noise = kCount;
  options.resolution = kCount;
  options.seed = seed;
  return options;
}

TEST(RunToRest, EndsInTheRightBasinOverTwoHundredSeeds) {
  constexpr int kSeeds = 200;
  int beyond_four = 0;
  std::vector<double> squares(6, 0.0);
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const SyntheticOptions run = RunToRest(static_cast<std::uint64_t>(seed));
    const FitReport report = FitOwnModel(run);
    ASSERT_EQ(report.termination, Termination::kConverged) << "seed " << seed << ": " << report.reason;
    const std::vector<double> deviations = Deviations(report, Truth(run));
    for (std::size_t i = 0; i < deviations.size(); ++i) {
      squares[i] += deviations[i] * deviations[i] / kSeeds;
      if (std::abs(deviations[i]) > 4) ++beyond_four;
      // A wrong basin is tens of standard errors away; the largest of 1200 normal deviations beyond 5 has p < 0.001.
      EXPECT_LT(std::abs(deviations[i]), 5) << report.parameters[i].info.name << ", seed " << seed;
    }
  }
  // 1200 normal deviations beyond 4: expected 0.08, more than one has p = 0.003.
  EXPECT_LE(beyond_four, 1);
  // Mean square of 200 normal deviations: 1 with a standard deviation of 0.1.
  EXPECT_THAT(squares, testing::Each(testing::DoubleNear(1, 0.35)));
}

}  // namespace
}  // namespace pendulum
