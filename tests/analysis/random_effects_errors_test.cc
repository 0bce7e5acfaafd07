// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <boost/random/normal_distribution.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/analysis/coverage_scenarios.h"
#include "pendulum/analysis/fit_models.h"
#include "pendulum/analysis/homogeneity.h"
#include "pendulum/analysis/random_effects.h"
#include "pendulum/base/parallel.h"
#include "pendulum/fitting/fit/fit_jointly.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::random_effects_errors_test {
namespace {

using testing::Ge;
using testing::Lt;

constexpr int kSets = 100;
constexpr int kRuns = 5;
constexpr double kInertia = 0.079;  // kg m², of CoverageScenarios

/// Counts of intervals that contain the rig's inertia, over sets of recordings whose inertia scatters about it.
struct Covered {
  std::atomic<int> by_mean = 0, by_joint = 0, between = 0;
};

bool Contains(double lower, double upper, double value) { return lower <= value && value <= upper; }

/// One set: each recording has a separate inertia, drawn about the rig's inertia with the relative standard deviation
/// `scatter`.
void CountSet(const CoverageScenario& scenario, double scatter, std::uint64_t set, Covered& covered) {
  std::mt19937_64 generator(900 + set);
  boost::random::normal_distribution<double> normal;
  std::vector<Recording> recordings;
  std::vector<FitReport> fits;
  for (int k = 0; k < kRuns; ++k) {
    SyntheticOptions run = ScenarioRun(scenario, 50'000 + 100 * set + static_cast<std::uint64_t>(k));
    run.release_angle *= 0.7 + 0.15 * k;
    run.parameters[0] *= 1 + scatter * normal(generator);
    recordings.push_back(Must(SimulateRecording(run)));
    fits.push_back(Must(FitRecording(recordings.back(), scenario.fit)));
  }
  std::vector<RunAlone> alone;
  std::vector<JointRun> joint;
  for (std::size_t k = 0; k < kRuns; ++k) {
    alone.push_back({"recording", recordings[k], fits[k], scenario.fit, nullptr});
    joint.push_back({recordings[k], fits[k], scenario.fit});
  }
  const std::vector<std::string> shared = PhysicalNames({scenario.fit.model});
  const RandomEffects effects = TestHomogeneity(alone, shared).parameters.front().scatter;
  const JointFit fit = Must(FitJointly(joint, shared));
  const ParameterEstimate& inertia = fit.whole.parameters.front();
  if (Contains(effects.lower95, effects.upper95, kInertia)) ++covered.by_mean;
  if (Contains(effects.between_lower95, effects.between_upper95, scatter * kInertia)) ++covered.between;
  if (inertia.lower95 && Contains(*inertia.lower95, *inertia.upper95, kInertia)) ++covered.by_joint;
}

void Count(double scatter, Covered& covered) {
  const CoverageScenario scenario = Must(FindCoverageScenarios("white_2.5")).front();
  ParallelFor(kSets, 0, [&](int set) { CountSet(scenario, scatter, static_cast<std::uint64_t>(set), covered); });
}

// The binomial 99.9 % limits of 100 trials at 95 % are 87 and 100.

TEST(RandomEffects, CoverTheInertiaIfRecordingsScatterMore) {
  Covered covered;
  Count(0.005, covered);  // forty times the errors
  EXPECT_THAT(covered.by_mean, Ge(87));
  EXPECT_THAT(covered.between, Ge(87));
  EXPECT_THAT(covered.by_joint, Lt(30));
}

TEST(RandomEffects, CoverTheInertiaIfScatterMatchesTheErrors) {
  Covered covered;
  Count(0.0002, covered);
  EXPECT_THAT(covered.by_mean, Ge(87));
  EXPECT_THAT(covered.between, Ge(87));
}

}  // namespace
}  // namespace pendulum::random_effects_errors_test
