// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "pendulum/identify/identify.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::identify_jointly_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

Result<Identification> Joined(const std::vector<std::string>& paths, const std::string& rig = "") {
  IdentifyOptions options;
  options.models = {"coulomb"};
  options.fit.interval = IntervalMethod::kCovariance;
  options.shared = {"inertia", "viscous", "coulomb"};
  std::optional<Rig> given;
  if (!rig.empty()) given = Must(ReadRig(rig));
  std::vector<PreparedRecording> recordings;
  for (const std::string& path : paths) recordings.push_back(Must(PrepareFile(path, options, given)));
  return IdentifyJointly(options, std::move(recordings));
}

// src/docs/examples.md: one rig, I_O = 0.079 kg m², b = 0.002 N m s/rad, τ_c = 0.004 N m.
TEST(IdentifyJointly, IdentifiesTheRigOfSeveralRecordings) {
  const auto run = Joined({"datasets/runs_2.csv", "datasets/runs_3.csv"}, "datasets/textbook_rig.json");
  ASSERT_TRUE(run) << run.error().message();
  const Identification& report = *run;
  ASSERT_EQ(report.fits.size(), 1);
  EXPECT_EQ(report.fits[0].termination, Termination::kConverged) << report.fits[0].reason;
  const ParameterEstimate* const inertia = report.fits[0].Find("inertia");
  ASSERT_TRUE(inertia != nullptr && inertia->std_error);
  EXPECT_NEAR(inertia->estimate, 0.079, 4 * *inertia->std_error);
  ASSERT_EQ(report.recordings.size(), 2);
  EXPECT_EQ(report.recordings[0].data.path, "datasets/runs_2.csv");
  EXPECT_EQ(report.recordings[1].data.samples, 1500);  // 15 s at 100 Hz
  ASSERT_EQ(report.across.size(), 1);
  EXPECT_THAT(report.across[0].separate, ElementsAre("converged", "converged"));
  EXPECT_TRUE(report.across[0].homogeneity->agrees()) << report.across[0].homogeneity->verdict;
}

TEST(IdentifyJointly, RefusesARecordingThatIsNamedTwice) {
  const auto run = Joined({"datasets/runs_1.csv", "datasets/../datasets/runs_1.csv"});
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, StatusCode::kInvalidArgument);
  EXPECT_EQ(run.error().message(),
            "datasets/runs_1.csv and datasets/../datasets/runs_1.csv are the same recording: all readings are equal; "
            "name it once");
}

TEST(IdentifyJointly, RefusesOneSwing) {
  const auto run = Joined({"datasets/runs_1.csv"});
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, StatusCode::kInvalidArgument);
  EXPECT_THAT(run.error().message(), HasSubstr("there is only one swing"));
}

TEST(IdentifyJointly, RefusesClosedFormsOnly) {
  IdentifyOptions options;
  options.models = {"coulomb"};
  options.closed_form_only = true;
  const auto run = IdentifyJointly(options, {});
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, StatusCode::kInvalidArgument);
  EXPECT_THAT(run.error().message(), HasSubstr("closed forms exist only for a single recording"));
}

TEST(IdentifyJointly, BlamesNoRecordingForAStop) {
  std::stop_source stop;
  stop.request_stop();
  IdentifyOptions options;
  options.models = {"coulomb"};
  options.fit.stop = stop.get_token();
  options.shared = {"inertia"};
  std::vector<PreparedRecording> recordings;
  for (const char* path : {"datasets/runs_1.csv", "datasets/runs_2.csv"}) {
    recordings.push_back(Must(PrepareFile(path, options, std::nullopt)));
  }
  const auto run = IdentifyJointly(options, std::move(recordings));
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, StatusCode::kTryAgain);
  EXPECT_THAT(run.error().message(), StartsWith("the fit was stopped"));
}

/// Copies of two recordings, each with a different rig.
class DifferentRigs : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(first_) << "# rig: {\"gravity_torque\": 1.8}\n" << std::ifstream("datasets/runs_1.csv").rdbuf();
    std::ofstream(second_) << "# rig: {\"gravity_torque\": 1.9}\n" << std::ifstream("datasets/runs_2.csv").rdbuf();
  }
  void TearDown() override {
    std::filesystem::remove(first_);
    std::filesystem::remove(second_);
  }

  const std::string start_ = testing::TempDir() + "identify_jointly_test_" + std::to_string(getpid());
  const std::string first_ = start_ + "_1.csv", second_ = start_ + "_2.csv";
};

TEST_F(DifferentRigs, AreRefused) {
  const auto run = Joined({first_, second_});
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(run.error().message(),
              AllOf(StartsWith(first_ + " and " + second_ + " describe different rigs"), HasSubstr("--rig")));
}

TEST_F(DifferentRigs, AreReplacedByTheRigOfTheCommandLine) {
  const auto run = Joined({first_, second_}, "datasets/textbook_rig.json");
  ASSERT_TRUE(run) << run.error().message();
  ASSERT_TRUE(run->rig);
  EXPECT_NEAR(run->rig->gravity_torque.value, 1.8033, 1e-4);  // (M + m / 2) g l, src/docs/examples.md
}

}  // namespace
}  // namespace pendulum::identify_jointly_test
