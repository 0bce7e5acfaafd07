// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/run_flags.h"

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

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
  return options.error().message();
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
    ASSERT_TRUE(options) << options.error().message();
    EXPECT_TRUE(known.insert(OptionsJson(*options)).second) << flag.name;
  }
}

TEST(MakeIdentifyOptions, FitsCoulombToTheMostTellingSwingByDefault) {
  const auto options = MakeIdentifyOptions({});
  ASSERT_TRUE(options);
  EXPECT_THAT(options->models, ElementsAre("coulomb"));
  EXPECT_EQ(options->fit.model, "coulomb");
  EXPECT_EQ(options->swing.release, SwingChoice::kMostTelling);
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
  ASSERT_TRUE(options) << options.error().message();
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
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_THAT(options->models, ElementsAre("linear_coulomb"));
  EXPECT_EQ(options->fit.gravity, Gravity::kLinear);
  flags.model = "viscous,drag";
  options = MakeIdentifyOptions(flags);
  ASSERT_TRUE(options) << options.error().message();
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

// ---- The sensor ----------------------------------------------------------------------------------------------------

TEST(MakeIdentifyOptions, TakesAKindOrJsonForTheSensor) {
  RunFlags flags;
  EXPECT_FALSE(MakeIdentifyOptions(flags)->sensor);
  flags.sensor = "angle sensor";
  EXPECT_EQ(MakeIdentifyOptions(flags)->sensor->kind, "angle sensor");
  flags.sensor = R"({"gain": 0.002})";
  const auto options = MakeIdentifyOptions(flags);
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_EQ(options->sensor->std_devs[0], 0.002);
  EXPECT_EQ(options->sensor->source, "given by --sensor");
  EXPECT_THAT(OptionsJson(*options), HasSubstr(R"("sensor":{"kind":"","gain":0.002})"));
}

TEST(MakeIdentifyOptions, RefusesTheFileOfASensor) {
  RunFlags flags;
  flags.sensor = "/etc/hostname";
  EXPECT_THAT(Refusal(flags), HasSubstr("--sensor: \"/etc/hostname\" is not a kind of sensor"));
  flags.sensor = R"({"gain": -1})";
  EXPECT_THAT(Refusal(flags), HasSubstr("--sensor: \"gain\" is -1; it must be"));
}

/// A file with this text, for one test.
class SensorFile {
 public:
  explicit SensorFile(const std::string& text) { std::ofstream(path_) << text; }
  ~SensorFile() { std::filesystem::remove(path_); }

  const std::string& path() const { return path_; }

 private:
  std::string path_ = testing::TempDir() + "run_flags_test_" + std::to_string(getpid()) + ".json";
};

TEST(ReadSensorFile, ReplacesTheNameByTheText) {
  const SensorFile file(R"({"kind": "gyro"})");
  RunFlags flags;
  flags.sensor = file.path();
  EXPECT_EQ(ReadSensorFile(flags.sensor).value(), file.path());
  EXPECT_EQ(flags.sensor, R"({"kind": "gyro"})");
  for (const std::string text : {"", "gyro", R"({"gain": -1})"}) {
    flags.sensor = text;
    EXPECT_EQ(ReadSensorFile(flags.sensor).value(), "");
    EXPECT_EQ(flags.sensor, text);
  }
}

TEST(ReadSensorFile, NamesTheFileInErrors) {
  const SensorFile file(R"({"gian": 0.01})");
  RunFlags flags;
  flags.sensor = file.path();
  const auto wrong = ReadSensorFile(flags.sensor);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(wrong.error().message(), HasSubstr(file.path() + ": \"gian\" is not a key of a sensor"));
  flags.sensor = "gyroscope";
  const auto missing = ReadSensorFile(flags.sensor);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, StatusCode::kNotFound);
  EXPECT_THAT(missing.error().message(),
              HasSubstr("--sensor takes a file or a kind of sensor: potentiometer, encoder"));
}

}  // namespace
}  // namespace pendulum::run_flags_test
