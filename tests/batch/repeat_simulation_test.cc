// SPDX-License-Identifier: Apache-2.0
// What a summary concludes from simulated repeats: how often it is wrong, and what it finds.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pendulum/batch/summary.h"
#include "pendulum/batch/summary_json.h"
#include "tests/batch/made_outcomes.h"
#include "tests/batch/made_store.h"

namespace pendulum::repeat_simulation_test {
namespace {

using Json = nlohmann::ordered_json;
using made_outcomes::FitWithCovariance;
using made_outcomes::OutcomeOf;
using made_store::PlainManifest;

constexpr std::size_t kRuns = 8;
constexpr double kInertia = 10, kInertiaError = 0.05;  // 0.5 %
constexpr double kViscous = 5, kViscousError = 0.1;    // 2 %

class RepeatSimulation : public made_store::MadeStoreTest {
 protected:
  /// The summary of kRuns recordings without anything that says which pendulum they are of. The inertia of each is that
  /// of `truths`; both parameters scatter `excess` times as much as their errors.
  Json Draw(const std::vector<double>& truths, double excess) {
    boost::random::normal_distribution<double> normal;
    std::vector<RunOutcome> outcomes;
    for (const double truth : truths) {
      const double inertia = truth + excess * kInertiaError * normal(engine_);
      const double viscous = kViscous + excess * kViscousError * normal(engine_);
      outcomes.push_back(OutcomeOf({FitWithCovariance(inertia, kInertiaError, viscous, kViscousError)}));
    }
    std::filesystem::remove(folder_ / "store.sqlite");
    Store store = StoreOf(PlainManifest(truths.size()), [&](std::size_t i) { return outcomes[i]; });
    auto summary = Summarize(store, {});
    if (summary) return ToJson(*summary);
    ADD_FAILURE() << summary.error().message();
    return nullptr;
  }

  std::mt19937_64 engine_{29};
};

std::string VerdictOf(const Json& summary) { return summary["verdicts"][0]["verdict"].get<std::string>(); }

// Of 100 batches of repeats with true errors, a test at p 0.01 rejects 1 on average, and more than 5 with probability
// 0.0005. Half of the p are below 0.5: 50 ± 5. Each of the two parameters is tested alone at p 0.01 as well.
TEST_F(RepeatSimulation, CallsRepeatsWithTrueErrorsAgreeing) {
  constexpr int kDraws = 100;
  int disagreeing = 0, below_half = 0, too_small = 0, not_compared = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Json summary = Draw(std::vector<double>(kRuns, kInertia), 1);
    const double p = summary["agreement"]["rows"][0]["p"].get<double>();
    disagreeing += p < 0.01 ? 1 : 0;
    below_half += p < 0.5 ? 1 : 0;
    too_small += VerdictOf(summary) == "too_small" ? 1 : 0;
    not_compared += VerdictOf(summary) == "not_compared" ? 1 : 0;
  }
  EXPECT_LE(disagreeing, 5);
  EXPECT_NEAR(below_half, kDraws / 2, 18);
  EXPECT_LE(too_small, 8);  // 2 on average
  EXPECT_EQ(not_compared, 0);
}

// χ² of 14 degrees of freedom is nine times as large.
TEST_F(RepeatSimulation, FindsErrorsThatAreTooSmallByThree) {
  constexpr int kDraws = 30;
  int too_small = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    too_small += VerdictOf(Draw(std::vector<double>(kRuns, kInertia), 3)) == "too_small" ? 1 : 0;
  }
  EXPECT_GE(too_small, 28);
}

// Inertias between 5 and 15, as of pendulums whose lengths differ by up to a factor of 1.7.
TEST_F(RepeatSimulation, ConcludesNothingAboutTheErrorsOfDifferentPendulums) {
  constexpr int kDraws = 30;
  boost::random::uniform_real_distribution<double> inertia(5, 15);
  int too_small = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<double> truths(kRuns);
    for (double& truth : truths) truth = inertia(engine_);
    too_small += VerdictOf(Draw(truths, 1)) == "too_small" ? 1 : 0;
  }
  EXPECT_EQ(too_small, 0);
}

}  // namespace
}  // namespace pendulum::repeat_simulation_test
