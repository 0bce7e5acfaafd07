// SPDX-License-Identifier: Apache-2.0
#include "tools/fit_pendulum_options.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum::fit_pendulum_options_test {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

FitPendulumFlags WithData() {
  FitPendulumFlags flags;
  flags.data = "run.csv";
  return flags;
}

/// The error message for refused flags; empty if they are accepted.
std::string Refusal(const FitPendulumFlags& flags) {
  const auto options = MakeFitPendulumOptions(flags);
  if (options) return "";
  EXPECT_EQ(options.error().code, StatusCode::kInvalidArgument);
  return options.error().message();
}

std::string RefusalOfFix(const std::string& fix) {
  FitPendulumFlags flags = WithData();
  flags.fix = fix;
  return Refusal(flags);
}

TEST(MakeFitPendulumOptions, HasDefaultsForEverythingButTheData) {
  const auto options = MakeFitPendulumOptions(WithData());
  ASSERT_TRUE(options);
  EXPECT_THAT(options->data, ElementsAre("run.csv"));
  EXPECT_EQ(options->fit.model, "coulomb");
  EXPECT_EQ(options->fit.start, std::nullopt);
  EXPECT_THAT(options->fit.fixed, IsEmpty());
  EXPECT_TRUE(std::isnan(options->swing.from));
  EXPECT_TRUE(std::isnan(options->swing.to));
  EXPECT_THAT(options->Outputs(), IsEmpty());
  EXPECT_EQ(options->Inputs().size(), 1);
}

TEST(MakeFitPendulumOptions, AcceptsEveryFlag) {
  FitPendulumFlags flags = WithData();
  flags.rig = "rig.json";
  flags.model = "drag";
  flags.start = "moving";
  flags.from = "-1.5";
  flags.to = "2e1";
  flags.fix = "drag=0.001,initial_angle=-0.25";
  flags.json = "-";
  flags.residuals = "r.csv";
  flags.series = "s.json";
  const auto options = MakeFitPendulumOptions(flags);
  ASSERT_TRUE(options);
  EXPECT_EQ(options->fit.model, "drag");
  EXPECT_EQ(options->fit.start, StartKind::kMoving);
  EXPECT_EQ(options->swing.from, -1.5);
  EXPECT_EQ(options->swing.to, 20);
  EXPECT_THAT(options->fit.fixed, ElementsAre(Pair("drag", 0.001), Pair("initial_angle", -0.25)));
  EXPECT_THAT(options->Outputs(),
              ElementsAre(testing::FieldsAre("--json", "-"), testing::FieldsAre("--residuals", "r.csv"),
                          testing::FieldsAre("--series", "s.json")));
  EXPECT_FALSE(options->closed_form_only);
  EXPECT_THAT(options->Inputs(),
              ElementsAre(testing::FieldsAre("--data", "run.csv"), testing::FieldsAre("--rig", "rig.json")));
}

TEST(MakeFitPendulumOptions, MakesNoFitForClosedFormsOnly) {
  FitPendulumFlags flags = WithData();
  flags.closed_form_only = true;
  flags.model = "drag";
  flags.rig = "rig.json";
  flags.from = "2";
  flags.json = "forms.json";
  flags.series = "-";
  const auto options = MakeFitPendulumOptions(flags);
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_TRUE(options->closed_form_only);
  EXPECT_EQ(options->fit.model, "drag");
  EXPECT_THAT(options->Outputs(),
              ElementsAre(testing::FieldsAre("--json", "forms.json"), testing::FieldsAre("--series", "-")));
  EXPECT_THAT(options->Outputs(1, 2), ElementsAre(testing::FieldsAre("--json", "forms_002.json"),
                                                  testing::FieldsAre("--series", NumberedPath("-", 1, 2))));
}

TEST(MakeFitPendulumOptions, RefusesFitFlagsForClosedFormsOnly) {
  const std::vector<std::pair<std::string FitPendulumFlags::*, std::string>> of_a_fit = {
      {&FitPendulumFlags::residuals, "--residuals r.csv"}, {&FitPendulumFlags::start, "--start moving"},
      {&FitPendulumFlags::fix, "--fix viscous=0"},         {&FitPendulumFlags::init, "--init viscous=0.1"},
      {&FitPendulumFlags::bounds, "--bounds viscous=0:1"}, {&FitPendulumFlags::prior, "--prior viscous=1:1"},
      {&FitPendulumFlags::noise, "--noise gaussian"},      {&FitPendulumFlags::loss, "--loss huber"},
      {&FitPendulumFlags::interval, "--interval profile"}, {&FitPendulumFlags::seed, "--seed 2"},
      {&FitPendulumFlags::threads, "--threads 1"},         {&FitPendulumFlags::shared, "--shared all"}};
  for (const auto& [member, text] : of_a_fit) {
    const std::size_t blank = text.find(' ');
    FitPendulumFlags flags = WithData();
    flags.*member = text.substr(blank + 1);
    EXPECT_EQ(Refusal(flags), "") << text;
    flags.closed_form_only = true;
    EXPECT_EQ(Refusal(flags),
              text.substr(0, blank) + " needs a fit, but --closed_form_only makes none; leave one of them out");
  }
}

TEST(MakeFitPendulumOptions, RequiresARecording) {
  FitPendulumFlags flags;
  EXPECT_EQ(Refusal(flags), "no recording was given; name its file, as in fit_pendulum run.csv; --help shows examples");
}

TEST(MakeFitPendulumOptions, TakesRecordingsWithoutAFlag) {
  FitPendulumFlags flags;
  flags.positional = {"run.csv", "a,b.csv"};
  const auto options = MakeFitPendulumOptions(flags);
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_THAT(options->data, ElementsAre("run.csv", "a,b.csv"));
  EXPECT_TRUE(options->IsJoint(2));
  flags.data = "c.csv";
  EXPECT_EQ(Refusal(flags),
            "'run.csv' and --data both name recordings; give all of them without a flag, or all with --data");
  flags.data.clear();
  flags.data_list = "list.txt";
  EXPECT_EQ(Refusal(flags),
            "'run.csv' and --data_list both name recordings; give all of them without a flag, or all with --data_list");
  flags.data_list.clear();
  flags.positional = {"-", "/dev/stdin"};
  EXPECT_EQ(Refusal(flags), "standard input is named twice, but it can be read only once");
}

TEST(MakeFitPendulumOptions, ListsTheModels) {
  FitPendulumFlags flags = WithData();
  flags.model = "columb";
  EXPECT_EQ(Refusal(flags), "--model: there is no model 'columb'; the models are " + MotionModelNames() +
                                "; or give 'all' by itself for every friction law");
}

TEST(MakeFitPendulumOptions, AcceptsSeveralModelsInOrder) {
  FitPendulumFlags flags = WithData();
  flags.model = "drag,viscous";
  EXPECT_THAT(MakeFitPendulumOptions(flags).value().models, ElementsAre("drag", "viscous"));
  flags.model = "drag,viscous,drag";
  EXPECT_EQ(Refusal(flags), "--model: 'drag,viscous,drag' names drag twice");
  flags.model = "drag,";
  EXPECT_THAT(Refusal(flags), HasSubstr("there is no model ''"));
}

TEST(MakeFitPendulumOptions, ExpandsAllToEveryFrictionLaw) {
  FitPendulumFlags flags = WithData();
  flags.model = "all";
  EXPECT_THAT(MakeFitPendulumOptions(flags).value().models, ElementsAreArray(FrictionModels::kNames));
}

TEST(MakeFitPendulumOptions, AcceptsParametersOfSomeModelsOnly) {
  FitPendulumFlags flags = WithData();
  flags.model = "viscous,drag";
  flags.fix = "drag=0.001";
  EXPECT_EQ(MakeFitPendulumOptions(flags).value().fit.fixed.size(), 1);
  flags.fix = "stiction=0.001";
  EXPECT_THAT(Refusal(flags), HasSubstr("stiction"));
}

TEST(MakeFitPendulumOptions, AcceptsThreeKindsOfStart) {
  FitPendulumFlags flags = WithData();
  flags.start = "held";
  EXPECT_EQ(Refusal(flags), "--start is 'held'; it must be one of auto, release, moving");
  flags.start = "release";
  EXPECT_EQ(MakeFitPendulumOptions(flags)->fit.start, StartKind::kRelease);
}

TEST(MakeFitPendulumOptions, RequiresAWindowOfPositiveLength) {
  FitPendulumFlags flags = WithData();
  flags.from = "3";
  flags.to = "2.5";
  EXPECT_EQ(Refusal(flags), "--from 3 s does not lie before --to 2.5 s");
  flags.to = "3";
  EXPECT_EQ(Refusal(flags), "--from 3 s does not lie before --to 3 s");
  flags.to = "later";
  EXPECT_EQ(Refusal(flags), "--to is 'later'; it must be a time in seconds on the file's clock");
  flags.to.clear();
  EXPECT_EQ(Refusal(flags), "");
}

TEST(MakeFitPendulumOptions, RefusesFixingAParameterTheModelLacks) {
  const std::string names =
      "inertia, viscous, coulomb, release_angle, release_time, initial_angle, initial_rate, zero_angle, rate_bias, "
      "zero_drift, bias_drift, rate_scale, acceleration_bias, acceleration_scale, axis, radius, pivot_x, pivot_y, "
      "hysteresis";
  EXPECT_EQ(RefusalOfFix("drag=0.1"), "--fix: model coulomb has no parameter 'drag'; its parameters are " + names);
}

TEST(MakeFitPendulumOptions, PassesTheDescriptionOfTheFile) {
  FitPendulumFlags flags = WithData();
  flags.data = "-";
  flags.calibration = "cal.json";
  flags.time_column = "none";
  flags.value_column = "2";
  flags.unit = "counts";
  flags.sample_rate_hz = "1e2";
  const auto options = MakeFitPendulumOptions(flags);
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_EQ(options->calibration, "cal.json");
  EXPECT_EQ(options->read.time_column, "none");
  EXPECT_EQ(options->read.value_column, "2");
  EXPECT_EQ(options->read.unit, "counts");
  EXPECT_EQ(options->read.sample_rate_hz, 100);
  EXPECT_THAT(options->Inputs(), ElementsAre(testing::FieldsAre("--calibration", "cal.json")));
}

TEST(MakeFitPendulumOptions, RefusesFlagsThatContradictEachOther) {
  FitPendulumFlags flags = WithData();
  flags.time_column = "t";
  flags.value_column = "t";
  EXPECT_EQ(Refusal(flags), "--time_column and --value_column are both 't'; choose two columns");
  flags.sample_rate_hz = "100";
  EXPECT_EQ(Refusal(flags), "--time_column and --sample_rate_hz both say what the times are; leave one of them out");
  flags = WithData();
  flags.calibration = "cal.json";
  flags.unit = "deg";
  EXPECT_EQ(
      Refusal(flags),
      "--calibration turns counts or volts into an angle, and --unit says that the values are in deg; leave one of "
      "them out");
  flags.unit = "grad";
  EXPECT_EQ(Refusal(flags),
            "--unit is 'grad'; it must be one of rad, deg, mrad, rev, gon, rad_s, deg_s, rpm, rev_s, counts, volts, "
            "mv, m_s2, g, mg, px, m, cm, mm");
}

TEST(MakeFitPendulumOptions, RequiresAPositiveSampleRate) {
  FitPendulumFlags flags = WithData();
  for (const char* const rate : {"0", "-5"}) {
    flags.sample_rate_hz = rate;
    EXPECT_EQ(Refusal(flags), "--sample_rate_hz is '" + std::string(rate) + "'; it must be positive");
  }
  flags.sample_rate_hz = "fast";
  EXPECT_EQ(Refusal(flags), "--sample_rate_hz is 'fast'; it must be a positive number of samples per second");
}

TEST(MakeFitPendulumOptions, AcceptsSeveralRecordingsOrAList) {
  FitPendulumFlags flags;
  flags.data = "a.csv,b.csv";
  flags.json = "fit.json";
  const auto several = MakeFitPendulumOptions(flags);
  ASSERT_TRUE(several) << several.error().message();
  EXPECT_THAT(several->data, ElementsAre("a.csv", "b.csv"));
  EXPECT_THAT(several->Inputs(),
              ElementsAre(testing::FieldsAre("--data", "a.csv"), testing::FieldsAre("--data", "b.csv")));
  EXPECT_THAT(several->Outputs(1, 2), ElementsAre(testing::FieldsAre("--json", "fit_002.json")));
  flags.data_list = "list.txt";
  EXPECT_EQ(Refusal(flags), "--data and --data_list both name recordings; give one of them");
  flags.data.clear();
  const auto listed = MakeFitPendulumOptions(flags);
  ASSERT_TRUE(listed) << listed.error().message();
  EXPECT_EQ(listed->data_list, "list.txt");
  EXPECT_THAT(listed->Inputs(), ElementsAre(testing::FieldsAre("--data_list", "list.txt")));
}

TEST(MakeFitPendulumOptions, RefusesAnEmptyNameBetweenCommas) {
  FitPendulumFlags flags;
  for (const std::string data : {"a.csv,,b.csv", ",a.csv"}) {
    flags.data = data;
    EXPECT_EQ(Refusal(flags), "--data '" + data + "' has an empty name between its commas");
  }
}

TEST(MakeFitPendulumOptions, ReadsStandardInputOnce) {
  FitPendulumFlags flags;
  for (const std::string data : {"-,-", "-,a.csv,/dev/stdin"}) {
    flags.data = data;
    EXPECT_EQ(Refusal(flags), "--data '" + data + "' names standard input twice, but it can be read only once");
  }
  flags.data = "a.csv,-";
  EXPECT_EQ(Refusal(flags), "");
}

TEST(MakeFitPendulumOptions, AcceptsReleasesByNumberOrAll) {
  FitPendulumFlags flags = WithData();
  EXPECT_EQ(MakeFitPendulumOptions(flags)->swing.release, SwingChoice::kMostTelling);
  flags.release = "all";
  EXPECT_EQ(MakeFitPendulumOptions(flags)->swing.release, SwingChoice::kAll);
  flags.release = "3";
  EXPECT_EQ(MakeFitPendulumOptions(flags)->swing.release, 3);
  for (const std::string wrong : {"0", "-1", "1.5", "1e7", "first"}) {
    flags.release = wrong;
    EXPECT_EQ(Refusal(flags), "--release is '" + wrong + "'; it must be all, or the number of a release from 1 on");
  }
}

TEST(MakeFitPendulumOptions, AcceptsPriorKnowledgeOfParameters) {
  FitPendulumFlags flags = WithData();
  flags.init = "inertia=0.08,zero_drift=0";
  flags.bounds = "viscous=:0.1";
  flags.prior = "coulomb=0.004:0.001";
  const auto options = MakeFitPendulumOptions(flags);
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_THAT(options->fit.initial, ElementsAre(Pair("inertia", 0.08), Pair("zero_drift", 0)));
  EXPECT_EQ(options->fit.bounds.at("viscous").upper, 0.1);
  EXPECT_EQ(options->fit.priors.at("coulomb").mean, 0.004);
  EXPECT_EQ(options->fit.priors.at("coulomb").std_dev, 0.001);
}

TEST(MakeFitPendulumOptions, NamesTheFlagOfAWrongParameter) {
  FitPendulumFlags flags = WithData();
  flags.init = "inertia=x";
  EXPECT_EQ(Refusal(flags), "--init inertia is 'x'; it must be a number in SI units");
  flags.init.clear();
  flags.bounds = "inertia=1";
  EXPECT_EQ(Refusal(flags), "--bounds: 'inertia=1' must be name=low:high");
  flags.bounds.clear();
  flags.prior = "inertia=1";
  EXPECT_EQ(Refusal(flags), "--prior: 'inertia=1' must be name=mean:std_dev");
}

TEST(MakeFitPendulumOptions, RefusesFixingAParameterNamedByAnotherFlag) {
  FitPendulumFlags flags = WithData();
  flags.fix = "viscous=0.003";
  flags.init = "viscous=0.002";
  EXPECT_EQ(Refusal(flags), "--fix holds viscous, and --init names it too; leave one of them out");
  flags.init.clear();
  flags.bounds = "viscous=0:1";
  EXPECT_EQ(Refusal(flags), "--fix holds viscous, and --bounds names it too; leave one of them out");
  flags.bounds.clear();
  flags.prior = "viscous=0.003:0.001";
  EXPECT_EQ(Refusal(flags), "--fix holds viscous, and --prior names it too; leave one of them out");
}

FitPendulumFlags WithTwoRecordings() {
  FitPendulumFlags flags;
  flags.data = "a.csv,b.csv";
  return flags;
}

TEST(MakeFitPendulumOptions, FitsSeveralRecordingsTogetherByDefault) {
  FitPendulumFlags flags = WithTwoRecordings();
  EXPECT_TRUE(MakeFitPendulumOptions(flags)->IsJoint(2));
  EXPECT_FALSE(MakeFitPendulumOptions(flags)->IsJoint(1));  // a list of one
  flags.shared = "none";
  EXPECT_FALSE(MakeFitPendulumOptions(flags)->IsJoint(2));
  flags.shared.clear();
  flags.closed_form_only = true;
  EXPECT_FALSE(MakeFitPendulumOptions(flags)->IsJoint(2));
  flags = WithData();
  flags.release = "all";
  EXPECT_FALSE(MakeFitPendulumOptions(flags)->IsJoint(1));
  flags.shared = "all";
  EXPECT_TRUE(MakeFitPendulumOptions(flags)->IsJoint(1));
}

TEST(MakeFitPendulumOptions, SharesInertiaAndFrictionByDefault) {
  FitPendulumFlags flags = WithTwoRecordings();
  EXPECT_THAT(MakeFitPendulumOptions(flags)->shared, ElementsAre("inertia", "viscous", "coulomb"));
  flags.model = "viscous,drag";
  EXPECT_THAT(MakeFitPendulumOptions(flags)->shared, ElementsAre("inertia", "viscous", "coulomb", "drag"));
  flags.shared = "all";
  EXPECT_THAT(MakeFitPendulumOptions(flags)->shared, ElementsAre("inertia", "viscous", "coulomb", "drag"));
  flags.shared = "drag,inertia";
  EXPECT_THAT(MakeFitPendulumOptions(flags)->shared, ElementsAre("drag", "inertia"));
}

TEST(MakeFitPendulumOptions, ListsTheParametersThatCanBeShared) {
  FitPendulumFlags flags = WithTwoRecordings();
  for (const std::string wrong : {"release_angle", "zero_angle", "drag", "", "All"}) {
    flags.shared = wrong.empty() ? "inertia,," : "inertia," + wrong;
    EXPECT_EQ(Refusal(flags), "--shared names '" + wrong +
                                  "', which recordings cannot share; they can share inertia, viscous, coulomb, or all, "
                                  "or none");
  }
  flags.shared = "inertia,viscous,inertia";
  EXPECT_EQ(Refusal(flags), "--shared names inertia twice");
}

TEST(MakeFitPendulumOptions, RejectsABootstrapOfAJointFit) {
  FitPendulumFlags flags = WithTwoRecordings();
  const std::string refusal =
      "--interval bootstrap is only for separate fits (--shared none); for a joint fit use covariance or profile";
  flags.interval = "bootstrap";
  EXPECT_EQ(Refusal(flags), refusal);
  flags.shared = "none";
  EXPECT_EQ(Refusal(flags), "");
  flags.shared = flags.data = "";
  flags.data_list = "list.txt";
  EXPECT_EQ(Refusal(flags), refusal);
  flags = WithData();
  flags.interval = "bootstrap";
  EXPECT_EQ(Refusal(flags), "");
  flags.release = "all";
  EXPECT_EQ(Refusal(flags), "");
  flags.shared = "all";
  EXPECT_EQ(Refusal(flags), refusal);
}

TEST(MakeFitPendulumOptions, KnowsTheFileOfTheSensorAsAnInput) {
  FitPendulumFlags flags = WithData();
  flags.sensor = "gyro";
  EXPECT_TRUE(MakeFitPendulumOptions(flags).value().sensor_path.empty());
  flags.sensor = "no_such_sensor.json";
  EXPECT_EQ(MakeFitPendulumOptions(flags).error().code, StatusCode::kNotFound);
}

TEST(JointOutputs, AreNumberedIfEachRecordingHasItsOwnOutput) {
  FitPendulumFlags flags = WithTwoRecordings();
  flags.json = "fit.json";
  flags.residuals = "r.csv";
  flags.report = "page.html";
  const auto options = MakeFitPendulumOptions(flags);
  EXPECT_THAT(
      options.value().JointOutputs(2),
      ElementsAre(testing::FieldsAre("--json", "fit.json"), testing::FieldsAre("--report", "page.html"),
                  testing::FieldsAre("--residuals", "r_001.csv"), testing::FieldsAre("--residuals", "r_002.csv")));
}

}  // namespace
}  // namespace pendulum::fit_pendulum_options_test
