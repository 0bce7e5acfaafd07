// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/provenance.h"

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pendulum/fitting/swing/choose_swings.h"

namespace pendulum::provenance_test {
namespace {

using testing::AnyOf;
using testing::EndsWith;

struct Change {
  std::string name;
  std::function<void(IdentifyOptions&)> make;
};

std::string JsonAfter(const Change& change) {
  IdentifyOptions options;
  options.models = {"coulomb"};
  change.make(options);
  return OptionsJson(options);
}

/// Changes of every option that affects a result, except those of the fit.
std::vector<Change> ChangesOfTheRun() {
  return {
      {"nothing", [](IdentifyOptions&) {}},
      {"time_column", [](IdentifyOptions& o) { o.read.time_column = "t"; }},
      {"value_column", [](IdentifyOptions& o) { o.read.value_column = "t"; }},
      {"unit", [](IdentifyOptions& o) { o.read.unit = "deg"; }},
      {"sample_rate_hz", [](IdentifyOptions& o) { o.read.sample_rate_hz = 100; }},
      {"resolution of none", [](IdentifyOptions& o) { o.read.resolution = 0; }},
      {"resolution", [](IdentifyOptions& o) { o.read.resolution = 0.1; }},
      {"range",
       [](IdentifyOptions& o) {
         o.read.range = SensorRange{0, 1023};
       }},
      {"another range",
       [](IdentifyOptions& o) {
         o.read.range = SensorRange{0, 4095};
       }},
      {"from", [](IdentifyOptions& o) { o.swing.from = 0; }},
      {"to", [](IdentifyOptions& o) { o.swing.to = 0; }},
      {"release 1", [](IdentifyOptions& o) { o.swing.release = 1; }},
      {"all releases", [](IdentifyOptions& o) { o.swing.release = SwingChoice::kAll; }},
      {"model", [](IdentifyOptions& o) { o.models = {o.fit.model = "viscous"}; }},
      {"models",
       [](IdentifyOptions& o) {
         o.models = {"coulomb", "viscous"};
       }},
      {"order of models",
       [](IdentifyOptions& o) {
         o.models = {o.fit.model = "viscous", "coulomb"};
       }},
      {"checks none", [](IdentifyOptions& o) { o.checks = Checks::kNone; }},
      {"checks full", [](IdentifyOptions& o) { o.checks = Checks::kFull; }},
      {"closed_form_only", [](IdentifyOptions& o) { o.closed_form_only = true; }},
      {"rig value", [](IdentifyOptions& o) { o.rig_values["bob_mass"] = 0.38; }},
  };
}

/// Changes of the fit's options, with every value of the enumerations.
std::vector<Change> ChangesOfTheFit() {
  return {
      {"gravity sine", [](IdentifyOptions& o) { o.fit.gravity = Gravity::kSine; }},
      {"gravity linear", [](IdentifyOptions& o) { o.fit.gravity = Gravity::kLinear; }},
      {"start release", [](IdentifyOptions& o) { o.fit.start = StartKind::kRelease; }},
      {"start moving", [](IdentifyOptions& o) { o.fit.start = StartKind::kMoving; }},
      {"fix", [](IdentifyOptions& o) { o.fit.fixed["viscous"] = 0.1; }},
      {"fix another", [](IdentifyOptions& o) { o.fit.fixed["coulomb"] = 0.1; }},
      // The double next to 0.1.
      {"fix at another value", [](IdentifyOptions& o) { o.fit.fixed["viscous"] = 0.10000000000000002; }},
      {"init", [](IdentifyOptions& o) { o.fit.initial["viscous"] = 0.1; }},
      {"lower bound", [](IdentifyOptions& o) { o.fit.bounds["viscous"].lower = 0.1; }},
      {"upper bound", [](IdentifyOptions& o) { o.fit.bounds["viscous"].upper = 0.1; }},
      {"prior",
       [](IdentifyOptions& o) {
         o.fit.priors["viscous"] = {0.1, 0.01};
       }},
      {"prior of another error",
       [](IdentifyOptions& o) {
         o.fit.priors["viscous"] = {0.1, 0.02};
       }},
      {"noise gaussian", [](IdentifyOptions& o) { o.fit.noise = NoiseFamily::kGaussian; }},
      {"noise quantized", [](IdentifyOptions& o) { o.fit.noise = NoiseFamily::kQuantized; }},
      {"loss huber", [](IdentifyOptions& o) { o.fit.noise = NoiseFamily::kHuber; }},
      {"loss student", [](IdentifyOptions& o) { o.fit.noise = NoiseFamily::kStudent; }},
      {"interval covariance", [](IdentifyOptions& o) { o.fit.interval = IntervalMethod::kCovariance; }},
      {"interval profile", [](IdentifyOptions& o) { o.fit.interval = IntervalMethod::kProfile; }},
      {"interval bootstrap", [](IdentifyOptions& o) { o.fit.interval = IntervalMethod::kBootstrap; }},
      {"seed", [](IdentifyOptions& o) { o.fit.seed = 18446744073709551615U; }},
      {"seed 2", [](IdentifyOptions& o) { o.fit.seed = 2; }},
      {"max_trace_error", [](IdentifyOptions& o) { o.fit.search.max_trace_error = 1e-9; }},
      {"max_iterations", [](IdentifyOptions& o) { o.fit.search.max_iterations = 7; }},
      {"max_traces", [](IdentifyOptions& o) { o.fit.search.max_traces = 7; }},
      {"oversample", [](IdentifyOptions& o) { o.read.oversample = 4; }},
      {"window_s",
       [](IdentifyOptions& o) {
         o.read.averaging_window = AveragingWindow{-0.001, 0.001};
       }},
      {"sensor",
       [](IdentifyOptions& o) {
         o.sensor = SensorStatement{"gyro", {}, "given by --sensor"};
       }},
  };
}

TEST(OptionsJson, DependsOnEveryOption) {
  std::map<std::string, std::string> known;
  std::vector<Change> changes = ChangesOfTheRun();
  for (const Change& change : ChangesOfTheFit()) changes.push_back(change);
  for (const Change& change : changes) {
    const std::string json = JsonAfter(change);
    const auto [other, is_new] = known.emplace(json, change.name);
    EXPECT_TRUE(is_new) << change.name << " gives the same JSON as " << other->second << ": " << json;
    EXPECT_TRUE(nlohmann::json::parse(json).is_object());
    EXPECT_EQ(json, JsonAfter(change));
  }
}

// A new member causes a compile error here: add it to the changes above or to the options without effect below. Some
// members are in neither list: `model` is the first of `models`; rig and calibration are hashed separately; `window` of
// the reader is that of the swing; `notes` are warnings; a rig chooses the gravity, and `is_spring` is set, only by
// what `gravity` and the models say; `preview` receives what the reader sees;
// users cannot set `start_values`, `sensor_start` and `may_doubt_gravity`, and `may_correct` follows from `models`,
// `with_losses` from `checks`;
// `shared` is for joint identifications, of which a batch has none.
TEST(OptionsJson, CoversEveryMember) {
  IdentifyOptions options;
  [[maybe_unused]] auto& [read, swing, models, fit, rig_chooses_gravity, checks, closed_form_only, rig_values, sensor,
                          notes, shared] = options;
  [[maybe_unused]] auto& [time_column, value_column, unit, sample_rate_hz, calibration, resolution, range, oversample,
                          averaging_window, window, most_unpacked_bytes, preview] = read;
  [[maybe_unused]] auto& [from, to, release, is_spring] = swing;
  [[maybe_unused]] auto& [model, gravity, may_be_spring, start, rig, fixed, initial, bounds, priors, noise, interval,
                          with_losses, seed, threads, progress, search, stop] = fit;
  [[maybe_unused]] auto& [start_values, sensor_start, vibration_period, max_trace_error, max_iterations, max_traces,
                          may_correct, may_doubt_gravity] = search;
}

TEST(OptionsJson, IgnoresOptionsWithoutInfluence) {
  const std::string json = JsonAfter({"nothing", [](IdentifyOptions&) {}});
  EXPECT_EQ(json, JsonAfter({"threads", [](IdentifyOptions& o) { o.fit.threads = 7; }}));
  EXPECT_EQ(json, JsonAfter({"progress", [](IdentifyOptions& o) { o.fit.progress = [](const ProgressStep&) {}; }}));
  EXPECT_EQ(json, JsonAfter({"most_unpacked_bytes", [](IdentifyOptions& o) { o.read.most_unpacked_bytes = 1; }}));
}

// The bytes of rig and calibration are hashed separately.
TEST(OptionsJson, ExcludesRigAndCalibration) {
  const std::string json = JsonAfter({"nothing", [](IdentifyOptions&) {}});
  EXPECT_EQ(json, JsonAfter({"rig", [](IdentifyOptions& o) { o.fit.rig = Rig{{1.8, 0}, {}, {}}; }}));
  EXPECT_EQ(json, JsonAfter({"calibration", [](IdentifyOptions& o) { o.read.calibration = Calibration(); }}));
}

TEST(OptionsJson, DoesNotDependOnTheOrder) {
  const auto set = [](const std::string& first, const std::string& second) {
    return JsonAfter({"", [&](IdentifyOptions& o) {
                        o.fit.fixed[first] = 1;
                        o.fit.fixed[second] = 1;
                      }});
  };
  EXPECT_EQ(set("viscous", "coulomb"), set("coulomb", "viscous"));
}

TEST(Provenance, AgreesUnlessRelevantMembersDiffer) {
  const Provenance one = {"d", "r", "c", "o", "v", "cpu"};
  EXPECT_TRUE(one.Agrees(one));
  EXPECT_TRUE(one.Agrees({"d", "r", "c", "o", "v", "another cpu"}));
  EXPECT_FALSE(one.Agrees({"x", "r", "c", "o", "v", "cpu"}));
  EXPECT_FALSE(one.Agrees({"d", "x", "c", "o", "v", "cpu"}));
  EXPECT_FALSE(one.Agrees({"d", "r", "x", "o", "v", "cpu"}));
  EXPECT_FALSE(one.Agrees({"d", "r", "c", "x", "v", "cpu"}));
  EXPECT_FALSE(one.Agrees({"d", "r", "c", "o", "x", "cpu"}));
  EXPECT_FALSE(one.Agrees({"d", "r", "", "o", "v", "cpu"}));
}

TEST(CpuType, NamesProcessorAndInstructionSet) {
  EXPECT_THAT(CpuType(), AnyOf(EndsWith(" (baseline)"), EndsWith(" (avx2)"), EndsWith(" (avx512)")));
  EXPECT_EQ(CpuType(), CpuType());
}

}  // namespace
}  // namespace pendulum::provenance_test
