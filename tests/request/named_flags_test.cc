// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/named_flags.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::named_flags_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;
using testing::UnorderedElementsAre;

template <typename Flags>
void ExpectRefused(const Result<Flags>& flags, const std::string& message) {
  ASSERT_FALSE(flags) << message;
  EXPECT_EQ(flags.error().code, StatusCode::kInvalidArgument);
  EXPECT_EQ(flags.error().message(), message);
}

// ---- Names ---------------------------------------------------------------------------------------------------------

// The flags of the tools without files and threads, which a remote client must not set.
TEST(FlagNames, MatchTheFlagsOfTheTools) {
  EXPECT_THAT(RunFlagNames(), UnorderedElementsAre(
                                  "sensor", "model", "models", "start", "release", "from", "to", "fix", "init",
                                  "bounds", "prior", "time_column", "value_column", "unit", "sample_rate_hz",
                                  "resolution", "range", "oversample", "window_s", "noise", "loss", "interval",
                                  "checks", "seed", "closed_form_only", "gravity", "bob_mass", "rod_mass", "rod_length",
                                  "g", "gravity_torque", "mass", "center_of_mass", "stiffness", "length", "inertia"));
  EXPECT_THAT(SimulationFlagNames(),
              IsSupersetOf({"model", "gravity", "set", "unit", "duration", "rate", "jitter", "start_time", "noise",
                            "noise_correlation", "noise_freedom", "resolution", "range", "lose", "event_driven",
                            "time_noise", "oversample", "window_s", "seed"}));
  EXPECT_THAT(SimulationFlagNames(), Not(Contains("out")));
  EXPECT_THAT(CalibrationFlagNames(), UnorderedElementsAre("order", "input_range", "bits"));
}

TEST(CheckFlagName, SuggestsTheNearestName) {
  const std::vector<std::string_view> names = {"model", "noise"};
  EXPECT_TRUE(CheckFlagName("noise", names));
  const auto near = CheckFlagName("modle", names);
  ASSERT_FALSE(near);
  EXPECT_EQ(near.error().code, StatusCode::kInvalidArgument);
  EXPECT_EQ(near.error().message(), "--modle is not a flag of this request; did you mean --model?");
  EXPECT_EQ(CheckFlagName("quicksort", names).error().message(),
            "--quicksort is not a flag of this request; GET /openapi.json lists the flags");
}

// ---- Fits ----------------------------------------------------------------------------------------------------------

TEST(RunFlagsOf, KeepsDefaultsForMissingFlags) {
  const auto flags = RunFlagsOf({});
  ASSERT_TRUE(flags) << flags.error().message();
  EXPECT_EQ(flags->model, "");  // Coulomb, unless the recording shows a spring.
  EXPECT_EQ(flags->start, "auto");
  EXPECT_EQ(flags->release, "");
  EXPECT_EQ(flags->noise, "auto");
  EXPECT_EQ(flags->loss, "none");
  EXPECT_EQ(flags->interval, "auto");
  EXPECT_FALSE(flags->closed_form_only);
}

TEST(RunFlagsOf, StoresEachFlagInItsMember) {
  const std::vector<std::pair<std::string, std::string RunFlags::*>> places = {
      {"model", &RunFlags::model},
      {"models", &RunFlags::model},
      {"start", &RunFlags::start},
      {"release", &RunFlags::release},
      {"from", &RunFlags::from},
      {"to", &RunFlags::to},
      {"fix", &RunFlags::fix},
      {"init", &RunFlags::init},
      {"bounds", &RunFlags::bounds},
      {"prior", &RunFlags::prior},
      {"time_column", &RunFlags::time_column},
      {"value_column", &RunFlags::value_column},
      {"unit", &RunFlags::unit},
      {"sample_rate_hz", &RunFlags::sample_rate_hz},
      {"resolution", &RunFlags::resolution},
      {"range", &RunFlags::range},
      {"noise", &RunFlags::noise},
      {"loss", &RunFlags::loss},
      {"interval", &RunFlags::interval},
      {"seed", &RunFlags::seed}};
  for (const auto& [name, place] : places) {
    const auto flags = RunFlagsOf({{name, "its text, as it is"}});
    ASSERT_TRUE(flags) << flags.error().message();
    const RunFlags defaults;
    for (const auto& [other, member] : places) {
      EXPECT_EQ((*flags).*member, member == place ? "its text, as it is" : defaults.*member) << name << ", " << other;
    }
  }
}

TEST(RunFlagsOf, AcceptsOnlyTrueAndFalseForASwitch) {
  EXPECT_TRUE(RunFlagsOf({{"closed_form_only", "true"}})->closed_form_only);
  EXPECT_FALSE(RunFlagsOf({{"closed_form_only", "false"}})->closed_form_only);
  for (const char* text : {"1", "yes", "True", "true "}) {
    ExpectRefused(RunFlagsOf({{"closed_form_only", text}}),
                  std::string("--closed_form_only is '") + text + "'; it must be true or false");
  }
}

TEST(RunFlagsOf, RefusesUnknownFlags) {
  ExpectRefused(RunFlagsOf({{"modle", "drag"}}), "--modle is not a flag of this request; did you mean --model?");
  ExpectRefused(RunFlagsOf({{"from", ""}}), "--from has an empty value; leave the flag out for its default");
  ExpectRefused(RunFlagsOf({{"model", "drag"}, {"models", "drag"}}),
                "--model and --models are the same flag; give only one of them");
  // Flags that name files of the server or use its processors, and invalid names.
  for (const char* name : {"rig", "calibration", "threads", "data", "json", "report", "Model", ""}) {
    const auto flags = RunFlagsOf({{name, "1"}});
    ASSERT_FALSE(flags) << name;
    EXPECT_THAT(flags.error().message(), HasSubstr(std::string("--") + name + " is not a flag of this request"))
        << name;
  }
}

// ---- Simulations ---------------------------------------------------------------------------------------------------

TEST(SimulationFlagsOf, AcceptsTextsNumbersAndIntegers) {
  const auto flags = SimulationFlagsOf({{"model", "drag"},
                                        {"gravity", "linear"},
                                        {"set", "inertia=0.1"},
                                        {"spread", "inertia=0.01"},
                                        {"unit", "rad"},
                                        {"range", "-1,1"},
                                        {"lose", "5:-3"},
                                        {"duration", "1.5"},
                                        {"rate", "2e2"},
                                        {"jitter", "0.25"},
                                        {"start_time", "-3"},
                                        {"noise", "0.125"},
                                        {"noise_correlation", "0.5"},
                                        {"noise_freedom", "4"},
                                        {"resolution", "0.0625"},
                                        {"event_driven", "true"},
                                        {"time_noise", "0.03125"},
                                        {"oversample", "16"},
                                        {"window_s", "0.001953125"},
                                        {"seed", "18446744073709551615"}});
  ASSERT_TRUE(flags) << flags.error().message();
  EXPECT_EQ(flags->model, "drag");
  EXPECT_EQ(flags->gravity, "linear");
  EXPECT_EQ(flags->set, "inertia=0.1");
  EXPECT_EQ(flags->spread, "inertia=0.01");
  EXPECT_EQ(flags->unit, "rad");
  EXPECT_EQ(flags->range, "-1,1");
  EXPECT_EQ(flags->lose, "5:-3");
  EXPECT_EQ(flags->duration, 1.5);
  EXPECT_EQ(flags->rate, 200);
  EXPECT_EQ(flags->jitter, 0.25);
  EXPECT_EQ(flags->start_time, -3);
  EXPECT_EQ(flags->noise, 0.125);
  EXPECT_EQ(flags->noise_correlation, 0.5);
  EXPECT_EQ(flags->noise_freedom, 4);
  EXPECT_EQ(flags->resolution, 0.0625);
  EXPECT_TRUE(flags->event_driven);
  EXPECT_EQ(flags->time_noise, 0.03125);
  EXPECT_EQ(flags->oversample, 16U);
  EXPECT_EQ(flags->window_s, 0.001953125);
  EXPECT_EQ(flags->seed, 18446744073709551615U);
}

TEST(SimulationFlagsOf, RefusesInvalidNumbers) {
  for (const char* text : {"", "ten", "1 s", "1,5", "nan", "inf", "1e999"}) {
    const auto flags = SimulationFlagsOf({{"duration", text}});
    ASSERT_FALSE(flags) << text;
    EXPECT_EQ(flags.error().code, StatusCode::kInvalidArgument);
    EXPECT_THAT(flags.error().message(), HasSubstr("--duration")) << text;
  }
  for (const char* text : {"-1", "1.0", "18446744073709551616", "0x1", " 1"}) {
    ExpectRefused(SimulationFlagsOf({{"seed", text}}), std::string("--seed is '") + text + "'; it must be an integer");
  }
  ExpectRefused(SimulationFlagsOf({{"durration", "1"}}),
                "--durration is not a flag of this request; did you mean --duration?");
}

// ---- Calibrations --------------------------------------------------------------------------------------------------

TEST(CalibrationFlagsOf, AcceptsItsFlags) {
  const auto flags = CalibrationFlagsOf({{"order", "2"}, {"bits", "10"}});
  ASSERT_TRUE(flags) << flags.error().message();
  EXPECT_EQ(flags->order, 2);
  EXPECT_EQ(flags->bits, 10);
  EXPECT_EQ(flags->input_range, "");
  EXPECT_EQ(CalibrationFlagsOf({{"input_range", "0,1023"}})->input_range, "0,1023");
  EXPECT_EQ(CalibrationFlagsOf({})->order, 1);
}

TEST(CalibrationFlagsOf, RefusesNumbersThatAreNotWhole) {
  for (const char* text : {"1.5", "2147483648", "one", "1e1"}) {
    ExpectRefused(CalibrationFlagsOf({{"order", text}}),
                  std::string("--order is '") + text + "'; it must be an integer");
  }
  ExpectRefused(CalibrationFlagsOf({{"bit", "10"}}), "--bit is not a flag of this request; did you mean --bits?");
}

}  // namespace
}  // namespace pendulum::named_flags_test
