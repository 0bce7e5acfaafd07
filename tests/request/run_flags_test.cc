// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/run_flags.h"

#include <set>
#include <string>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/batch/provenance.h"
#include "pendulum/fitting/swing/choose_swings.h"

namespace pendulum::run_flags_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string Refusal(const RunFlags& flags) {
  const auto options = MakeIdentifyOptions(flags);
  if (options) return "";
  EXPECT_EQ(options.error().code, StatusCode::kInvalidArgument);
  return options.error().message;
}

/// The default flags, except for a valid value of `flag`.
RunFlags With(const RunFlag& flag) {
  RunFlags flags;
  const auto value = flag.In(flags);
  if (const auto* is_on = std::get_if<bool*>(&value)) {
    **is_on = true;
    return flags;
  }
  const std::string word = flag.words.empty() ? "2" : std::string(flag.words.back().word);
  *std::get<std::string*>(value) = flag.example.empty() ? word : flag.example;
  return flags;
}

// The stored options must contain each flag; otherwise a run would not be fitted again after the flag was changed.
TEST(RunFlagTable, HasOnlyFlagsThatChangeTheStoredOptions) {
  std::set<std::string> known = {OptionsJson(*MakeIdentifyOptions({}))};
  for (const RunFlag& flag : RunFlagTable()) {
    if (flag.is_local) continue;
    const auto options = MakeIdentifyOptions(With(flag));
    ASSERT_TRUE(options) << options.error().message;
    EXPECT_TRUE(known.insert(OptionsJson(*options)).second) << flag.name;
  }
}

TEST(MakeIdentifyOptions, FitsCoulombToTheLongestSwingByDefault) {
  const auto options = MakeIdentifyOptions({});
  ASSERT_TRUE(options);
  EXPECT_THAT(options->models, ElementsAre("coulomb"));
  EXPECT_EQ(options->fit.model, "coulomb");
  EXPECT_EQ(options->swing.release, SwingChoice::kLongest);
  EXPECT_FALSE(options->closed_form_only);
}

TEST(MakeIdentifyOptions, AcceptsModelsWindowAndParameters) {
  RunFlags flags;
  flags.model = "viscous,drag";
  flags.from = "1.5";
  flags.to = "20";
  flags.fix = "viscous=0.003";
  flags.unit = "counts";
  const auto options = MakeIdentifyOptions(flags);
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_THAT(options->models, ElementsAre("viscous", "drag"));
  EXPECT_EQ(options->swing.from, 1.5);
  EXPECT_EQ(options->swing.to, 20);
  EXPECT_EQ(options->fit.fixed.at("viscous"), 0.003);
  EXPECT_EQ(options->read.unit, "counts");
}

TEST(MakeIdentifyOptions, GivesTheModelsALinearRestoringTorque) {
  RunFlags flags;
  flags.gravity = "linear";
  auto options = MakeIdentifyOptions(flags);
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_THAT(options->models, ElementsAre("linear_coulomb"));
  EXPECT_EQ(options->fit.gravity, Gravity::kLinear);
  flags.model = "viscous,drag";
  options = MakeIdentifyOptions(flags);
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_THAT(options->models, ElementsAre("linear", "linear_drag"));
  flags.model = "linear_coulomb";
  flags.gravity = "sin";
  EXPECT_THAT(Refusal(flags), HasSubstr("--gravity says sin"));
  flags.gravity = "cos";
  EXPECT_THAT(Refusal(flags), HasSubstr("--gravity is 'cos'; it must be one of auto, sin, linear"));
}

// Only a user who says nothing about the motion leaves the choice to the recording.
TEST(MakeIdentifyOptions, LeaveTheRestoringTorqueOpenOnlyByDefault) {
  EXPECT_TRUE(MakeIdentifyOptions({})->fit.may_be_spring);
  RunFlags flags;
  flags.model = "coulomb";
  EXPECT_FALSE(MakeIdentifyOptions(flags)->fit.may_be_spring);
  flags = {};
  flags.gravity = "sin";
  EXPECT_FALSE(MakeIdentifyOptions(flags)->fit.may_be_spring);
}

TEST(MakeIdentifyOptions, NamesTheWrongFlag) {
  RunFlags flags;
  flags.model = "tar";
  EXPECT_THAT(Refusal(flags), HasSubstr("--model: there is no model 'tar'"));
  flags = {};
  flags.from = "3";
  flags.to = "2";
  EXPECT_EQ(Refusal(flags), "--from 3 s does not lie before --to 2 s");
  flags = {};
  flags.fix = "drag=1";
  EXPECT_THAT(Refusal(flags), HasSubstr("--fix: model coulomb has no parameter 'drag'"));
}

}  // namespace
}  // namespace pendulum::run_flags_test
