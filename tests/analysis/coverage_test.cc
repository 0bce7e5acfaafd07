// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/coverage.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::coverage_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;

CoverageScenario Scenario(const std::string& name) {
  const auto found = FindCoverageScenarios(name);
  EXPECT_TRUE(found) << found.error().message();
  return found->front();
}

CoverageOptions Options(int count) {
  CoverageOptions options;
  options.count = count;
  return options;
}

CoverageStudy Study(const CoverageScenario& scenario, const CoverageOptions& options) {
  const Result<CoverageStudy> study = StudyCoverage(scenario, options);
  EXPECT_TRUE(study) << study.error().message();
  return *study;
}

CoverageRow Row(const CoverageStudy& study, const std::string& parameter) {
  const auto row = std::ranges::find(study.rows, parameter, &CoverageRow::parameter);
  EXPECT_NE(row, study.rows.end()) << parameter;
  return *row;
}

// ---- The binomial interval -----------------------------------------------------------------------------------------

// No success in n trials: the upper end u satisfies (1 - u)^n = 0.025. n successes give the mirror image.
TEST(BinomialInterval95, HasClosedFormsForNoSuccessAndForNoFailure) {
  const double end = 1 - std::pow(0.025, 1.0 / 20);
  const BinomialInterval none = BinomialInterval95(0, 20);
  const BinomialInterval all = BinomialInterval95(20, 20);
  EXPECT_EQ(none.lower, 0);
  EXPECT_THAT(none.upper, DoubleNear(end, 1e-12));
  EXPECT_THAT(all.lower, DoubleNear(1 - end, 1e-12));
  EXPECT_EQ(all.upper, 1);
}

// At each end p of the interval the observed or more extreme counts have a probability of 2.5 %, summed by hand.
TEST(BinomialInterval95, ExcludesTwoAndAHalfPercentOnEachSide) {
  constexpr int kTrials = 10, kSuccesses = 7;
  const auto at_least = [](int successes, double p) {
    double sum = 0;
    for (int k = successes; k <= kTrials; ++k) {
      const double ways = std::exp(std::lgamma(kTrials + 1.0) - std::lgamma(k + 1.0) - std::lgamma(kTrials - k + 1.0));
      sum += ways * std::pow(p, k) * std::pow(1 - p, kTrials - k);
    }
    return sum;
  };
  const BinomialInterval interval = BinomialInterval95(kSuccesses, kTrials);
  EXPECT_THAT(at_least(kSuccesses, interval.lower), DoubleNear(0.025, 1e-10));
  EXPECT_THAT(1 - at_least(kSuccesses + 1, interval.upper), DoubleNear(0.025, 1e-10));
}

// ---- Studies -------------------------------------------------------------------------------------------------------

// Least squares reach the bound in white noise of 2.5 counts, and their intervals have the right coverage.
TEST(StudyCoverage, PassesForWhiteNoise) {
  constexpr int kCount = 200;
  const CoverageStudy study = Study(Scenario("white_2.5"), Options(kCount));
  EXPECT_EQ(study.recordings, kCount);
  EXPECT_EQ(study.converged, kCount);
  EXPECT_EQ(study.failed, 0);
  ASSERT_EQ(study.rows.size(), 6);
  for (const CoverageRow& row : study.rows) {
    SCOPED_TRACE(row.parameter);
    EXPECT_TRUE(row.covers);
    EXPECT_FALSE(row.at_bound);
    EXPECT_EQ(row.without_interval, 0);
    EXPECT_THAT(row.coverage, DoubleNear(0.95, 4 * std::sqrt(0.95 * 0.05 / kCount)));  // 4 σ of a binomial share
    EXPECT_THAT(row.error_over_bound.value(),
                DoubleNear(1, 4 / std::sqrt(2.0 * kCount)));  // 4 σ of the scatter of a standard deviation
    EXPECT_THAT(row.std_error_over_error.value(), DoubleNear(1, 4 / std::sqrt(2.0 * kCount)));
  }
}

// Rig, clock and calibration are drawn from their errors; the total intervals cover, and the total errors are right.
TEST(StudyCoverage, CountsTotalIntervals) {
  constexpr int kCount = 200;
  const CoverageStudy study = Study(Scenario("all_errors"), Options(kCount));
  ASSERT_EQ(study.converged, kCount);
  for (const CoverageRow& row : study.rows) {
    SCOPED_TRACE(row.parameter);
    EXPECT_THAT(row.coverage, DoubleNear(0.95, 4 * std::sqrt(0.95 * 0.05 / kCount)));
    EXPECT_THAT(row.std_error_over_error.value(), DoubleNear(1, 4 / std::sqrt(2.0 * kCount)));
  }
}

// The intervals of noise alone would contain the true inertia in few recordings.
TEST(WithErrors, MakesErrorsThatNoiseDoesNotExplain) {
  CoverageScenario scenario = Scenario("all_errors");
  const CoverageRow with = Row(Study(scenario, Options(50)), "inertia");
  scenario.fit.rig->gravity_torque.std_dev = 0;
  scenario.clock_std_dev = 0;
  const CoverageRow without = Row(Study(scenario, Options(50)), "inertia");
  EXPECT_GT(*with.rms_error, 50 * *without.rms_error);
}

TEST(StudyCoverage, ReportsErrorsInTheUnitsOfTheRig) {
  CoverageScenario scenario = Scenario("white_2.5");
  const CoverageStudy with_rig = Study(scenario, Options(10));
  const double torque = scenario.fit.rig->gravity_torque.value;
  scenario.fit.rig.reset();
  const CoverageStudy without = Study(scenario, Options(10));
  EXPECT_EQ(Row(with_rig, "inertia").unit, "kg m^2");
  EXPECT_EQ(Row(without, "inertia").unit, "s^2");
  for (const char* parameter : {"inertia", "coulomb"}) {
    const CoverageRow row = Row(with_rig, parameter);
    EXPECT_THAT(*row.rms_error / *Row(without, parameter).rms_error, DoubleNear(torque, 1e-6));
    EXPECT_EQ(row.covered, Row(without, parameter).covered);
    EXPECT_THAT(*row.error_over_bound, DoubleNear(*Row(without, parameter).error_over_bound, 1e-6));
  }
  EXPECT_THAT(*Row(with_rig, "zero_angle").rms_error, DoubleNear(*Row(without, "zero_angle").rms_error, 1e-9));
}

TEST(StudyCoverage, DoesNotDependOnTheNumberOfThreads) {
  CoverageOptions options = Options(12);
  options.threads = 1;
  const CoverageStudy one = Study(Scenario("moving"), options);
  for (const int threads : {0, 3, 50}) {
    options.threads = threads;
    const CoverageStudy several = Study(Scenario("moving"), options);
    for (std::size_t i = 0; i < one.rows.size(); ++i) {
      EXPECT_EQ(several.rows[i].covered, one.rows[i].covered);
      EXPECT_EQ(several.rows[i].rms_error, one.rows[i].rms_error);
      EXPECT_EQ(several.rows[i].error_over_bound, one.rows[i].error_over_bound);
      EXPECT_EQ(several.rows[i].std_error_over_error, one.rows[i].std_error_over_error);
    }
  }
}

TEST(StudyCoverage, UsesSuccessiveSeeds) {
  CoverageOptions options = Options(1);
  double squares = 0;
  for (options.seed = 5; options.seed < 8; ++options.seed) {
    squares += std::pow(*Row(Study(Scenario("white_0.5"), options), "inertia").rms_error, 2);
  }
  options.seed = 5;
  options.count = 3;
  EXPECT_THAT(*Row(Study(Scenario("white_0.5"), options), "inertia").rms_error / std::sqrt(squares / 3),
              DoubleNear(1, 1e-9));
}

TEST(StudyCoverage, ReportsTheNumberOfRecordingsDone) {
  CoverageOptions options = Options(5);
  std::vector<int> done;
  options.progress = [&](int count) { done.push_back(count); };
  Study(Scenario("white_2.5"), options);
  EXPECT_THAT(done, testing::ElementsAre(1, 2, 3, 4, 5));
}

TEST(StudyCoverage, MakesNoErrorComparisonForATruthAtItsBound) {
  const CoverageStudy study = Study(Scenario("no_viscous"), Options(5));
  EXPECT_TRUE(Row(study, "viscous").at_bound);
  EXPECT_FALSE(Row(study, "viscous").error_over_bound);
  EXPECT_FALSE(Row(study, "coulomb").at_bound);
  EXPECT_TRUE(Row(study, "coulomb").error_over_bound);
}

// A fit with another kind of start has other parameters: its report lacks the parameters of the true start.
TEST(StudyCoverage, CountsAMissingParameterAsNotCovered) {
  CoverageScenario scenario = Scenario("white_2.5");
  scenario.run.release_time = 0;
  scenario.fit.start = StartKind::kMoving;
  const CoverageStudy study = Study(scenario, Options(5));
  const CoverageRow row = Row(study, "release_angle");
  EXPECT_EQ(row.without_interval, 5);
  EXPECT_EQ(row.covered, 0);
  EXPECT_EQ(row.coverage_lower, 0);
  EXPECT_FALSE(row.covers);
  EXPECT_FALSE(row.rms_error);
}

// With noise of ten times the swing no fit converges.
TEST(StudyCoverage, CountsFitsWithoutConvergenceAndContinues) {
  CoverageScenario scenario = Scenario("white_2.5");
  scenario.run.duration = 4;
  scenario.run.noise = 4;
  const CoverageStudy study = Study(scenario, Options(2));
  EXPECT_EQ(study.converged, 0);
  for (const CoverageRow& row : study.rows) EXPECT_EQ(row.without_interval, 2);
}

TEST(StudyCoverage, CountsImpossibleFits) {
  CoverageScenario scenario = Scenario("white_2.5");
  scenario.fit.fixed["nonsense"] = 1;
  EXPECT_EQ(Study(scenario, Options(3)).failed, 3);
}

// The times of count changes contain at least as much information as counts every millisecond. Over 300 recordings with
// shared edge errors, the ratio of rms errors is known to about 5 %.
TEST(StudyCoverage, FindsEventsAtLeastAsInformativeAs1KHzReadings) {
  constexpr int kCount = 300;
  constexpr double kChance = 1.1;
  for (const auto& [events, readings] :
       {std::pair("prompt_ticks", "ticks_1khz"), std::pair("few_prompt_ticks", "few_ticks_1khz")}) {
    const CoverageStudy by_events = Study(Scenario(events), Options(kCount));
    const CoverageStudy by_readings = Study(Scenario(readings), Options(kCount));
    for (const char* parameter : {"inertia", "viscous", "coulomb", "initial_angle", "initial_rate", "zero_angle"}) {
      EXPECT_LE(*Row(by_events, parameter).rms_error, kChance * *Row(by_readings, parameter).rms_error) << parameter;
    }
    EXPECT_EQ(by_events.rows.size(), 6U) << "a fixed parameter has no row";
  }
}

TEST(StudyCoverage, RefusesImpossibleSimulations) {
  CoverageScenario scenario = Scenario("white_2.5");
  scenario.run.noise = -1;
  const auto study = StudyCoverage(scenario, Options(3));
  ASSERT_FALSE(study);
  EXPECT_THAT(study.error().message(), HasSubstr("noise is -1"));
  EXPECT_EQ(StudyCoverage(Scenario("moving"), Options(0)).error().message(), "count is 0; it must be at least 1");
  CoverageOptions options = Options(1);
  options.threads = -1;
  EXPECT_EQ(StudyCoverage(Scenario("moving"), options).error().message(), "threads is -1; it must be 0 or more");
}

}  // namespace
}  // namespace pendulum::coverage_test
