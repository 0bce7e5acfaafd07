// SPDX-License-Identifier: Apache-2.0
#include "pendulum/identify/identification.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/window.h"
#include "tests/analysis/fitted_run.h"
#include "tests/base/warning_matchers.h"
#include "tests/identify/example_joint_identification.h"

namespace pendulum::identification_test {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::StartsWith;

TEST(SummarizeUsed, DescribesTheWindow) {
  Recording recording;
  recording.path = "a.csv";
  recording.time = Eigen::VectorXd::LinSpaced(101, 0, 10);
  recording.value = Eigen::VectorXd::Zero(101);
  recording.resolution = 0.5;
  recording.resolution_source = "file";
  FreeSwing swing;
  swing.begins = {WindowBegin::Reason::kAsked};
  DataSummary data;
  data.samples = 101;
  SummarizeUsed(*SelectWindow(recording, 1.95, 4.05), swing, data);
  EXPECT_EQ(data.path, "a.csv");
  EXPECT_EQ(data.samples, 101);
  EXPECT_EQ(data.used_samples, 21);
  EXPECT_DOUBLE_EQ(data.from, 2);
  EXPECT_DOUBLE_EQ(data.to, 4);
  EXPECT_DOUBLE_EQ(data.duration(), 2);
  EXPECT_DOUBLE_EQ(data.sample_rate(), 10);
  EXPECT_EQ(data.resolution, 0.5);
  EXPECT_EQ(data.resolution_source, "file");
  EXPECT_EQ(data.begins, "as asked");
  recording.resolution = 0;
  SummarizeUsed(recording, swing, data);
  EXPECT_EQ(data.resolution_source, "");
}

TEST(AllWarnings, ListEachWarningOnceAndStartWithTheData) {
  Identification report = ExampleIdentification();
  report.fits.push_back(report.fits.front());
  report.fits.back().warnings.push_back({"gaps", "another gap"});
  EXPECT_THAT(AllWarnings(report), ElementsAre(CodeIs("gaps"), CodeIs("lack_of_fit"),
                                               MessageIs(std::string(report.fits[1].model.name) + ": another gap")));
}

TEST(Identification, GivesTheCheckOfAFitIfThereIsOne) {
  Identification report = ExampleIdentification();
  EXPECT_EQ(report.recordings.front().CheckOf(0), &report.recordings.front().checks[0]);
  EXPECT_EQ(report.recordings.front().CheckOf(1), nullptr);
  report.recordings.front().checks.clear();
  EXPECT_EQ(report.recordings.front().CheckOf(0), nullptr);
}

TEST(AllWarnings, AreTheWarningsOfTheRecordingIfThereIsNoFit) {
  Identification report = ExampleIdentification();
  report.fits.clear();
  EXPECT_THAT(AllWarnings(report), ElementsAre(CodeIs("gaps")));
}

TEST(AllWarnings, NameTheRecordingInAJointFit) {
  Identification report = ExampleJointIdentification();
  report.fits[0].warnings = {{"recordings_disagree", "they do not agree"}};
  report.recordings[1].warnings = report.recordings[0].warnings;
  EXPECT_THAT(
      AllWarnings(report),
      ElementsAre(MessageIs("they do not agree"), MessageIs("each recording: there is a gap of 0.5 s after 7 s"),
                  MessageIs(StartsWith("recording 1 (run.csv): the residuals are not white"))));
  report.recordings[1].warnings[0].finding = "there is a gap of 0.7 s after 7 s";
  EXPECT_THAT(
      AllWarnings(report),
      ElementsAre(MessageIs("they do not agree"), MessageIs("recording 1 (run.csv): there is a gap of 0.5 s after 7 s"),
                  CodeIs("lack_of_fit"), MessageIs("recording 2 (b c.csv): there is a gap of 0.7 s after 7 s")));
}

TEST(RecordingLabel, IsNumberAndFile) {
  Identification report = ExampleJointIdentification();
  EXPECT_TRUE(report.is_joint());
  EXPECT_FALSE(ExampleIdentification().is_joint());
  EXPECT_EQ(RecordingLabel(report, 0), "recording 1 (run.csv)");
  report.recordings[1].data.path.clear();
  EXPECT_EQ(RecordingLabel(report, 1), "recording 2");
}

TEST(RecordingLabel, DistinguishesReleasesOfOneFile) {
  Identification report = ExampleJointIdentification();
  report.recordings[1].data.path = "run.csv";
  report.recordings[1].data.release = 3;
  EXPECT_EQ(RecordingLabel(report, 0), "recording 1 (run.csv, free swing 1)");
  EXPECT_EQ(RecordingLabel(report, 1), "recording 2 (run.csv, free swing 3)");
  report.recordings[1].data.release = 0;  // a window given by the user
  EXPECT_EQ(RecordingLabel(report, 1), "recording 2 (run.csv)");
}

TEST(MainFit, IsTheRecommendedOrTheConvergedFitWithTheSmallestResiduals) {
  Identification report = ExampleComparedIdentification();
  EXPECT_EQ(report.MainFit(), 0);
  report.comparison->recommended = "drag";
  EXPECT_EQ(report.MainFit(), 1);
  EXPECT_TRUE(report.IsShownInFull(1));
  EXPECT_FALSE(report.IsShownInFull(0));
  report.comparison->recommended.clear();
  report.fits[0].statistics.rms_residual = 0.002;
  report.fits[1].statistics.rms_residual = 0.001;
  report.fits[0].termination = report.fits[1].termination = Termination::kConverged;
  EXPECT_EQ(report.MainFit(), 1);
  report.fits[1].termination = Termination::kNotIdentifiable;
  EXPECT_EQ(report.MainFit(), 0);
  report.fits[0].termination = Termination::kNotIdentifiable;
  EXPECT_EQ(report.MainFit(), 1);
  report.fits[1].termination = Termination::kFailed;  // without residuals
  report.fits[1].statistics = {};
  EXPECT_EQ(report.MainFit(), 0);
}

TEST(IsShownInFull, IsTrueWithoutAComparison) {
  Identification report = ExampleComparedIdentification();
  report.comparison.reset();
  EXPECT_TRUE(report.IsShownInFull(0));
  EXPECT_TRUE(report.IsShownInFull(1));
}

Identification RunThatEnded(const std::vector<Termination>& fits) {
  Identification run;
  for (const Termination termination : fits) {
    run.fits.emplace_back();
    run.fits.back().termination = termination;
  }
  return run;
}

TEST(ExitCode, FollowsTheMainFitOfTheRun) {
  EXPECT_EQ(ExitCode(RunThatEnded({})), 0);  // closed forms alone
  EXPECT_EQ(ExitCode(RunThatEnded({Termination::kConverged})), 0);
  EXPECT_EQ(ExitCode(RunThatEnded({Termination::kNotConverged})), 1);
  EXPECT_EQ(ExitCode(RunThatEnded({Termination::kNotIdentifiable})), 1);
  EXPECT_EQ(ExitCode(RunThatEnded({Termination::kFailed})), 1);
  EXPECT_EQ(ExitCode(RunThatEnded({Termination::kFailed, Termination::kConverged})), 0);
  EXPECT_EQ(ExitCode(RunThatEnded({Termination::kFailed, Termination::kNotConverged})), 1);
}

TEST(ExitCode, FollowsTheRecommendedFit) {
  Identification run = RunThatEnded({Termination::kConverged, Termination::kNotIdentifiable});
  run.fits[0].model = Must(FindMotionModel("viscous"));
  run.fits[1].model = Must(FindMotionModel("coulomb"));
  run.comparison.emplace();
  run.comparison->recommended = "coulomb";
  EXPECT_EQ(ExitCode(run), 1);
  run.comparison->recommended = "viscous";
  EXPECT_EQ(ExitCode(run), 0);
}

TEST(Identification, HasTheFitOfARecordingWithAllItsParameters) {
  const Identification single = ExampleIdentification(), joint = ExampleJointIdentification();
  EXPECT_EQ(&single.FitOf(0, 0), &single.fits[0]);
  EXPECT_EQ(&joint.FitOf(1, 0), &joint.recordings[1].own_fits[0]);
  EXPECT_NE(joint.FitOf(1, 0).Find("initial_angle"), nullptr);
  EXPECT_EQ(joint.fits[0].Find("initial_angle"), nullptr);
}

TEST(Identification, HasThePathOfItsOnlyRecording) {
  EXPECT_EQ(ExampleIdentification().path(), "swing.csv");
  EXPECT_EQ(ExampleJointIdentification().path(), "");
}

TEST(Identification, SharesTheMotionIfAllParametersOfThePendulumAreShared) {
  Identification joint = ExampleJointIdentification();
  EXPECT_TRUE(joint.SharesMotion(0));
  joint.across[0].shared.pop_back();
  EXPECT_FALSE(joint.SharesMotion(0));
  EXPECT_TRUE(ExampleIdentification().SharesMotion(0));
}

}  // namespace
}  // namespace pendulum::identification_test
