// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <functional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/batch/provenance.h"
#include "pendulum/identify/identify.h"
#include "pendulum/report/json.h"
#include "tests/batch/small_batch.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::identify_stop_test {
namespace {

using small_batch::OptionsFor;
using testing::AllOf;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

using Clock = std::chrono::steady_clock;

PreparedRecording Read(const std::string& path, const IdentifyOptions& options) {
  return Must(PrepareFile(path, options, std::nullopt));
}

Result<Identification> FitFirst(const IdentifyOptions& options, const PreparedRecording& swings) {
  return std::move(IdentifyEach(options, swings).front());
}

void ExpectStopped(const Result<Identification>& run) {
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, StatusCode::kTryAgain);
  EXPECT_THAT(run.error().message(), HasSubstr("the fit was stopped before it was done; "));
}

/// Stops a run at `count` instants spread evenly over its duration. The result must equal the result of a complete run
/// byte for byte, or be an error.
void StopEverywhere(IdentifyOptions options, const PreparedRecording& swings, int count) {
  const Clock::time_point begin = Clock::now();
  const std::string whole = ToJsonText(Must(FitFirst(options, swings)));
  const Clock::duration duration = Clock::now() - begin;
  for (int i = 0; i < count; ++i) {
    std::stop_source stop;
    options.fit.stop = stop.get_token();
    const std::jthread other([&stop, wait = duration * i / count] {
      std::this_thread::sleep_for(wait);
      stop.request_stop();
    });
    const Result<Identification> run = FitFirst(options, swings);
    if (run) {
      EXPECT_EQ(ToJsonText(*run), whole) << i;
    } else {
      ExpectStopped(run);
    }
  }
}

TEST(StoppedFitRuns, AreCompleteOrMissingWithSeveralModels) {
  const IdentifyOptions options = OptionsFor({"viscous", "coulomb", "stribeck"});
  StopEverywhere(options, Read("datasets/coulomb.csv", options), 6);
}

TEST(StoppedFitRuns, AreCompleteOrMissingForARunToStandstill) {
  const IdentifyOptions options = OptionsFor({"coulomb"});
  StopEverywhere(options, Read("datasets/to_rest.csv", options), 6);
}

TEST(StoppedFitRuns, AreCompleteOrMissingWithAnyIntervals) {
  for (const IntervalMethod method : {IntervalMethod::kProfile, IntervalMethod::kBootstrap}) {
    IdentifyOptions options = OptionsFor({"coulomb"});
    options.fit.interval = method;
    StopEverywhere(options, Read("datasets/coulomb.csv", options), 4);
  }
}

TEST(StoppedFitRuns, AreCompleteOrMissingWithCoarseQuantization) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.resolution = kCount;
  const IdentifyOptions options = OptionsFor({"coulomb"});
  StopEverywhere(options, Must(PrepareRecording(Must(SimulateRecording(run)), {}, std::nullopt)), 6);
}

TEST(StoppedFitRuns, AreErrorsIfStoppedBeforeTheStart) {
  std::stop_source stop;
  stop.request_stop();
  for (const bool closed_form_only : {false, true}) {
    IdentifyOptions options = OptionsFor({"viscous", "coulomb"});
    options.closed_form_only = closed_form_only;
    const PreparedRecording swings = Read("datasets/coulomb.csv", options);
    options.fit.stop = stop.get_token();
    ExpectStopped(FitFirst(options, swings));
  }
}

TEST(StoppedFitRuns, NameEachOfSeveralSwings) {
  SyntheticOptions run = NoisyRun("viscous");
  run.duration = 9;
  Recording recording = Must(SimulateRecording(run));
  recording.path = "two.csv";
  const FreeSwing whole = Must(FindFreeSwings(recording)).front();
  IdentifyOptions options = OptionsFor({"viscous"});
  std::stop_source stop;
  stop.request_stop();
  options.fit.stop = stop.get_token();
  PreparedRecording swings;
  swings.samples = recording.size();
  swings.recording = std::move(recording);
  swings.swings = {{whole, whole}, {1, 2}};
  const auto runs = IdentifyEach(options, std::move(swings));
  ASSERT_THAT(runs, SizeIs(2));
  for (const auto& [index, name] : {std::pair(0, "two.csv: free swing 1: "), std::pair(1, "two.csv: free swing 2: ")}) {
    ExpectStopped(runs[static_cast<std::size_t>(index)]);
    EXPECT_THAT(runs[static_cast<std::size_t>(index)].error().message(), StartsWith(name));
  }
}

TEST(StoppedFitRuns, AreErrorsIfStoppedDuringABootstrap) {
  IdentifyOptions options = OptionsFor({"viscous", "coulomb"});
  options.fit.interval = IntervalMethod::kBootstrap;
  const PreparedRecording swings = Read("datasets/coulomb.csv", options);
  for (const int number : {1, 5, 1500}) {  // of the steps: a fit and 999 fits of its bootstrap for each model
    std::stop_source stop;
    int reports = 0;
    options.fit.stop = stop.get_token();
    options.fit.progress = [&](const ProgressStep&) {
      if (++reports == number) stop.request_stop();
    };
    ExpectStopped(FitFirst(options, swings));
    EXPECT_GE(reports, number);
  }
}

/// 2000 readings of a pendulum of 0.7 Hz, one every 50.3 s: each trial trajectory has 70 000 periods.
Recording OneReadingAMinute() {
  SyntheticOptions run;
  run.model = Must(FindMotionModel("viscous"));
  run.parameters = {0.0517, 0.0000005};
  run.start = StartKind::kMoving;
  run.initial_angle = 0.17;
  run.sample_rate = 1 / 50.3;
  run.duration = 2000 * 50.3;
  run.noise = 0.0002;
  return Must(SimulateRecording(run));
}

TEST(StoppedFitRuns, EndWithinATrajectoryOfMillionsOfSteps) {
  IdentifyOptions options = OptionsFor({"coulomb"});
  const PreparedRecording swings = Must(PrepareRecording(OneReadingAMinute(), {}, std::nullopt));
  std::stop_source stop;
  options.fit.stop = stop.get_token();
  const std::jthread other([&stop] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    stop.request_stop();
  });
  ExpectStopped(FitFirst(options, swings));
}

TEST(IdentifyEachThatMayBeStopped, GivesTheSameResultIfNotStopped) {
  for (const char* const path : {"datasets/coulomb.csv", "datasets/to_rest.csv"}) {
    IdentifyOptions options = OptionsFor({"viscous", "coulomb"});
    const PreparedRecording swings = Read(path, options);
    const std::string never = ToJsonText(Must(FitFirst(options, swings)));
    const std::stop_source stop;
    options.fit.stop = stop.get_token();
    EXPECT_EQ(ToJsonText(Must(FitFirst(options, swings))), never) << path;
  }
}

TEST(IdentifyEachThatMayBeStopped, HasTheSameProvenance) {
  IdentifyOptions options = OptionsFor({"coulomb"});
  const std::string never = OptionsJson(options);
  std::stop_source stop;
  options.fit.stop = stop.get_token();
  EXPECT_EQ(OptionsJson(options), never);
  stop.request_stop();
  EXPECT_EQ(OptionsJson(options), never);
}

}  // namespace
}  // namespace pendulum::identify_stop_test
