// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/run_report.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/window.h"
#include "tests/report/example_joint_report.h"

namespace pendulum::run_report_test {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::StartsWith;

TEST(SummarizeData, TellsTheWindowFromTheWhole) {
  Recording recording;
  recording.path = "a.csv";
  recording.time = Eigen::VectorXd::LinSpaced(101, 0, 10);
  recording.value = Eigen::VectorXd::Zero(101);
  recording.resolution = 0.5;
  recording.resolution_source = "file";
  const DataSummary data = SummarizeData(recording, *SelectWindow(recording, 1.95, 4.05));
  EXPECT_EQ(data.path, "a.csv");
  EXPECT_EQ(data.samples, 101);
  EXPECT_EQ(data.used_samples, 21);
  EXPECT_DOUBLE_EQ(data.from, 2);
  EXPECT_DOUBLE_EQ(data.to, 4);
  EXPECT_DOUBLE_EQ(data.duration(), 2);
  EXPECT_DOUBLE_EQ(data.sample_rate(), 10);
  EXPECT_EQ(data.resolution, 0.5);
  EXPECT_EQ(data.resolution_source, "file");
  recording.resolution = 0;
  EXPECT_EQ(SummarizeData(recording, recording).resolution_source, "");
}

TEST(AllWarnings, SaysEachOnceDataFirst) {
  RunReport report = ExampleReport();
  report.fits.push_back(report.fits.front());
  report.fits.back().warnings.push_back({"gap", "another gap"});
  EXPECT_THAT(AllWarnings(report),
              ElementsAre(Field(&Warning::code, "gap"), Field(&Warning::code, "lack_of_fit"),
                          Field(&Warning::message, std::string(report.fits[1].model.name) + ": another gap")));
}

TEST(RunReport, HasTheCheckOfAFitOrNone) {
  RunReport report = ExampleReport();
  EXPECT_EQ(report.CheckOf(0), &report.checks[0]);
  EXPECT_EQ(report.CheckOf(1), nullptr);
  report.checks.clear();
  EXPECT_EQ(report.CheckOf(0), nullptr);
}

TEST(AllWarnings, AreThoseOfTheRecordingWithoutAFit) {
  RunReport report = ExampleReport();
  report.fits.clear();
  EXPECT_THAT(AllWarnings(report), ElementsAre(Field(&Warning::code, "gap")));
}

TEST(AllWarnings, OfAJointFitSayWhoseTheyAre) {
  RunReport report = ExampleJointReport();
  report.fits[0].warnings = {{"recordings_disagree", "they do not agree"}};
  report.runs[1].warnings = report.runs[0].warnings;
  EXPECT_THAT(AllWarnings(report),
              ElementsAre(Field(&Warning::message, "they do not agree"),
                          Field(&Warning::message, "each recording: there is a gap of 0.5 s after 7 s"),
                          Field(&Warning::message, StartsWith("recording 1 (run.csv): the residuals are not white"))));
  report.runs[1].warnings[0].message = "there is a gap of 0.7 s after 7 s";
  EXPECT_THAT(AllWarnings(report),
              ElementsAre(Field(&Warning::message, "they do not agree"),
                          Field(&Warning::message, "recording 1 (run.csv): there is a gap of 0.5 s after 7 s"),
                          Field(&Warning::code, "lack_of_fit"),
                          Field(&Warning::message, "recording 2 (b c.csv): there is a gap of 0.7 s after 7 s")));
}

TEST(RecordingLabel, IsItsNumberAndItsFile) {
  RunReport report = ExampleJointReport();
  EXPECT_TRUE(report.is_joint());
  EXPECT_FALSE(ExampleReport().is_joint());
  EXPECT_EQ(RecordingLabel(report, 0), "recording 1 (run.csv)");
  report.runs[1].data.path.clear();
  EXPECT_EQ(RecordingLabel(report, 1), "recording 2");
}

TEST(RecordingLabel, TellsTheReleasesOfOneFileApart) {
  RunReport report = ExampleJointReport();
  report.runs[1].data.path = "run.csv";
  report.runs[1].data.release = 3;
  EXPECT_EQ(RecordingLabel(report, 0), "recording 1 (run.csv, free swing 1)");
  EXPECT_EQ(RecordingLabel(report, 1), "recording 2 (run.csv, free swing 3)");
  report.runs[1].data.release = 0;  // a window as it was asked for
  EXPECT_EQ(RecordingLabel(report, 1), "recording 2 (run.csv)");
}

TEST(Correlation, IsCovarianceOverBothStandardErrors) {
  const FitReport fit = ExampleFit();
  EXPECT_DOUBLE_EQ(Correlation(fit, 0, 1), 0.5);
  EXPECT_EQ(Correlation(fit, 2, 2), 1);
  EXPECT_EQ(Correlation(fit, 0, 2), 0);
}

TEST(MainFit, IsTheRecommendedElseTheFirstThatConverged) {
  RunReport report = ExampleComparedReport();
  EXPECT_EQ(report.MainFit(), 0);
  report.comparison->recommended = "drag";
  EXPECT_EQ(report.MainFit(), 1);
  EXPECT_TRUE(report.IsShownInFull(1));
  EXPECT_FALSE(report.IsShownInFull(0));
  report.comparison->recommended.clear();
  std::swap(report.fits[0], report.fits[1]);
  EXPECT_EQ(report.MainFit(), 1);
  report.fits[1].termination = Termination::kNotIdentifiable;
  EXPECT_EQ(report.MainFit(), 0);
}

TEST(IsShownInFull, IsTrueOfAllFitsThatAreNotCompared) {
  RunReport report = ExampleComparedReport();
  report.comparison.reset();
  EXPECT_TRUE(report.IsShownInFull(0));
  EXPECT_TRUE(report.IsShownInFull(1));
}

}  // namespace
}  // namespace pendulum::run_report_test
