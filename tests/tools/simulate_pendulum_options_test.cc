// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate_pendulum_options.h"

#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::simulate_pendulum_options_test {
namespace {

using testing::DoubleEq;
using testing::HasSubstr;

constexpr double kRadPerDeg = 0.017453292519943295;  // π / 180

SimulateFlags Flags(const std::string& set) {
  SimulateFlags flags;
  flags.set = set;
  flags.out = "run.csv";
  return flags;
}

constexpr std::string_view kRelease = "release_angle=0.4,release_time=1.5";

struct Refusal {
  std::string message;
  void (*spoil)(SimulateFlags&);
};

TEST(MakeSimulateOptions, RefusesWrongOutputsAndNamesThem) {
  const std::vector<Refusal> refusals = {
      {"--out is missing", [](SimulateFlags& f) { f.out.clear(); }},
      {"'stray' does not belong to a flag", [](SimulateFlags& f) { f.positional = {"stray"}; }},
      {"--count is 0; it must be at least 1", [](SimulateFlags& f) { f.count = 0; }},
      {"--count 2 needs files", [](SimulateFlags& f) { (f.count = 2, f.out = "-"); }},
      {"--manifest lists files; give --out a file instead of -",
       [](SimulateFlags& f) { (f.manifest = "runs.csv", f.out = "-"); }},
      {"--threads is -1; it must be 0 to 1024", [](SimulateFlags& f) { f.threads = -1; }},
      {"--threads is 1025; it must be 0 to 1024", [](SimulateFlags& f) { f.threads = 1025; }},
  };
  for (const Refusal& refusal : refusals) {
    SimulateFlags flags = Flags("inertia=0.04," + std::string(kRelease));
    refusal.spoil(flags);
    const Result<SimulateOptions> options = MakeSimulateOptions(flags, {});
    ASSERT_FALSE(options) << refusal.message;
    EXPECT_EQ(options.error().code, StatusCode::kInvalidArgument) << refusal.message;
    EXPECT_THAT(options.error().message(), HasSubstr(refusal.message));
  }
}

SimulateFlags PlanFlags() {
  SimulateFlags flags = Flags("inertia=0.04," + std::string(kRelease));
  flags.plan = true;
  flags.out.clear();
  flags.noise = 0.1;
  return flags;
}

TEST(MakeSimulateOptions, PlansWithoutAnOutput) {
  const Result<SimulateOptions> options = MakeSimulateOptions(PlanFlags(), {});
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_TRUE(options->plan);
  EXPECT_THAT(options->synthetic.noise, DoubleEq(0.1 * kRadPerDeg));
  EXPECT_FALSE(MakeSimulateOptions(Flags("inertia=0.04," + std::string(kRelease)), {})->plan);
}

TEST(MakeSimulateOptions, PlansWithOnlyAResolution) {
  SimulateFlags flags = PlanFlags();
  flags.noise = 0;
  flags.resolution = 0.2;
  EXPECT_TRUE(MakeSimulateOptions(flags, {}));
}

TEST(MakeSimulateOptions, RefusesFlagsThatAPlanIgnores) {
  const std::vector<Refusal> refusals = {
      {"--out contradicts --plan, which makes no recording", [](SimulateFlags& f) { f.out = "-"; }},
      {"--truth contradicts --plan", [](SimulateFlags& f) { f.truth = "truth.json"; }},
      {"--count contradicts --plan", [](SimulateFlags& f) { f.count = 2; }},
      {"--spread contradicts --plan", [](SimulateFlags& f) { f.spread = "inertia=0.001"; }},
      {"--manifest contradicts --plan", [](SimulateFlags& f) { f.manifest = "runs.csv"; }},
      {"--plan needs --noise or --resolution", [](SimulateFlags& f) { f.noise = 0; }},
      {"'stray' does not belong to a flag", [](SimulateFlags& f) { f.positional = {"stray"}; }},
  };
  for (const Refusal& refusal : refusals) {
    SimulateFlags flags = PlanFlags();
    refusal.spoil(flags);
    const Result<SimulateOptions> options = MakeSimulateOptions(flags, {});
    ASSERT_FALSE(options) << refusal.message;
    EXPECT_EQ(options.error().code, StatusCode::kInvalidArgument) << refusal.message;
    EXPECT_THAT(options.error().message(), HasSubstr(refusal.message));
  }
}

TEST(SimulateOptions, NumberTruthFilesLikeRecordings) {
  SimulateFlags flags = Flags("inertia=0.04," + std::string(kRelease));
  EXPECT_EQ(MakeSimulateOptions(flags, {})->Outputs(0).size(), 1);
  flags.truth = "truth.json";
  flags.count = 2;
  const std::vector<NamedFile> files = MakeSimulateOptions(flags, {})->Outputs(1);
  ASSERT_EQ(files.size(), 2);
  EXPECT_EQ(files[0].flag, "--out");
  EXPECT_EQ(files[0].path, "run_002.csv");
  EXPECT_EQ(files[1].flag, "--truth");
  EXPECT_EQ(files[1].path, "truth_002.json");
}

}  // namespace
}  // namespace pendulum::simulate_pendulum_options_test
