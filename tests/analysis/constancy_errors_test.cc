// SPDX-License-Identifier: Apache-2.0
// False alarm rates of TestConstancy for recordings whose friction law is right.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/analysis/constancy.h"
#include "tests/analysis/fitted_run.h"

namespace pendulum::constancy_errors_test {
namespace {

using testing::Le;

constexpr int kSeeds = 40;

struct Alarms {
  int tested = 0;
  int halves = 0, inertia = 0, friction = 0;  // number with p < 0.05
  int certain = 0;                            // number with any p < kNotConstant
};

Alarms CountAlarms(SyntheticOptions run) {
  Alarms alarms;
  const FitOptions options = ModelOptions(run.model.name);
  for (int i = 0; i < kSeeds; ++i) {
    ++run.seed;
    run.zero += 1e-4;  // another position relative to the levels
    const FitOfRun fitted = FitTo(Must(SimulateRecording(run)), options);
    const Constancy constancy = TestConstancy(fitted.recording, fitted.fit, options);
    if (!constancy.halves_p || constancy.trends.size() != 2) continue;
    ++alarms.tested;
    alarms.halves += *constancy.halves_p < 0.05 ? 1 : 0;
    alarms.inertia += constancy.trends[0].p < 0.05 ? 1 : 0;
    alarms.friction += constancy.trends[1].p < 0.05 ? 1 : 0;
    alarms.certain += constancy.constant() ? 0 : 1;
  }
  return alarms;
}

// Of 40 tests at p < 0.05, more than 8 alarms happen once in 1500 times (binomial). Of some 300 at p < 0.0003,
// three alarms happen once in 9000.
void ExpectFewAlarms(const SyntheticOptions& run) {
  SCOPED_TRACE(std::string(run.model.name));
  const Alarms alarms = CountAlarms(run);
  EXPECT_EQ(alarms.tested, kSeeds);
  EXPECT_THAT(alarms.halves, Le(8));
  EXPECT_THAT(alarms.inertia, Le(8));
  EXPECT_THAT(alarms.friction, Le(8));
  EXPECT_THAT(alarms.certain, Le(2));
}

SyntheticOptions RunOnCounts(std::string_view model, double noise) {
  SyntheticOptions run = TextbookRun(model);
  run.resolution = kCount;
  run.noise = noise * kCount;
  run.sample_rate = 50;
  return run;
}

TEST(ConstancyErrors, AreRightOnCountsBelowTheNoise) {
  for (const char* model : {"viscous", "coulomb", "drag"}) ExpectFewAlarms(RunOnCounts(model, 2.5));
}

TEST(ConstancyErrors, AreRightOnCoarseCounts) { ExpectFewAlarms(RunOnCounts("viscous", 0.25)); }

TEST(ConstancyErrors, AreRightForAutocorrelatedNoise) {
  SyntheticOptions run = RunOnCounts("viscous", 0.5);
  run.resolution = 0;
  run.noise_correlation = 0.9;
  ExpectFewAlarms(run);
}

}  // namespace
}  // namespace pendulum::constancy_errors_test
