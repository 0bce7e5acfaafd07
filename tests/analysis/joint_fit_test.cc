// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/joint_fit.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/joint_models.h"

namespace pendulum::joint_fit_test {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

TEST(FitTogether, FitsEveryModelToAllRecordings) {
  const FittedRecordings joint = FitJointModels(Simulate(ShortRuns(3, "coulomb", 1)), kThreeLaws, PlainOptions());
  EXPECT_EQ(joint.models, kThreeLaws);
  ASSERT_THAT(joint.recordings, SizeIs(3));
  ASSERT_THAT(joint.joint, SizeIs(3));
  ASSERT_THAT(joint.homogeneity, SizeIs(3));
  EXPECT_THAT(joint.joint[0].shared, ElementsAre("inertia", "viscous"));
  EXPECT_THAT(joint.joint[1].shared, ElementsAre("inertia", "viscous", "coulomb"));
  EXPECT_THAT(joint.joint[2].shared, ElementsAre("inertia", "viscous", "coulomb", "drag"));
  for (std::size_t m = 0; m < 3; ++m) {
    EXPECT_EQ(joint.joint[m].whole.model.name, kThreeLaws[m]);
    EXPECT_EQ(joint.joint[m].whole.termination, Termination::kConverged) << joint.joint[m].whole.reason;
    EXPECT_THAT(joint.joint[m].runs, SizeIs(3));
    EXPECT_EQ(joint.FitOf(1, m).model.name, kThreeLaws[m]);
  }
}

// TextbookParameters (fit_support.h): the true values in units of the restoring torque G.
TEST(FitTogether, RecoversTheTruthForTheTrueLaw) {
  const std::vector<SyntheticOptions> runs = ShortRuns(3, "coulomb", 4);
  const FittedRecordings joint = FitJointModels(Simulate(runs), {"coulomb"}, PlainOptions());
  for (const double deviation : Deviations(joint.joint[0].whole, runs[0].parameters)) {
    EXPECT_LT(std::abs(deviation), 4);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    for (const double deviation : Deviations(joint.FitOf(k, 0), Truth(runs[k]))) EXPECT_LT(std::abs(deviation), 4) << k;
  }
  EXPECT_TRUE(joint.homogeneity[0].agrees()) << joint.homogeneity[0].verdict;
  EXPECT_FALSE(joint.joint[0].whole.HasWarning("recordings_disagree"));
}

// Shared parameters are equal in all recordings; the other parameters differ.
TEST(FitTogether, HasTheSharedEstimatesInEveryRecording) {
  const FittedRecordings joint = FitJointModels(Simulate(ShortRuns(3, "coulomb", 7)), {"coulomb"}, PlainOptions());
  const FitReport& whole = joint.joint[0].whole;
  for (std::size_t k = 0; k < 3; ++k) {
    for (const ParameterEstimate& shared : whole.parameters) {
      const ParameterEstimate& own = *joint.FitOf(k, 0).Find(shared.info.name);
      EXPECT_EQ(own.estimate, shared.estimate) << shared.info.name;
      EXPECT_EQ(own.std_error, shared.std_error) << shared.info.name;
    }
    EXPECT_EQ(whole.Find("release_angle"), nullptr);
    EXPECT_NEAR(joint.FitOf(k, 0).Find("release_angle")->estimate, 0.4 + 0.1 * static_cast<double>(k), 2e-3);
  }
}

TEST(FitTogether, UsesOptionsOnlyForModelsThatHaveTheParameter) {
  FitOptions options = PlainOptions();
  options.fixed = {{"coulomb", 0.004 / kTextbookTorque}};
  const FittedRecordings joint = FitJointModels(Simulate(ShortRuns(2, "coulomb", 1)), {"viscous", "coulomb"}, options);
  EXPECT_EQ(joint.joint[0].whole.termination, Termination::kConverged);
  EXPECT_TRUE(joint.joint[1].whole.Find("coulomb")->fixed);
  EXPECT_EQ(joint.homogeneity[1].dof, 2);  // inertia and viscous friction
}

// ---- Recordings that disagree --------------------------------------------------------------------------------------

TEST(FitTogether, WarnsOfDisagreeingRecordings) {
  std::vector<SyntheticOptions> runs = ShortRuns(4, "coulomb", 1);
  runs[2].parameters[0] *= 1.01;
  const FittedRecordings joint = FitJointModels(Simulate(runs), {"coulomb"}, PlainOptions());
  EXPECT_THAT(joint.homogeneity[0].disagreeing, ElementsAre(2));
  EXPECT_TRUE(joint.joint[0].whole.HasWarning("recordings_disagree"));
  EXPECT_THAT(joint.homogeneity[0].verdict, HasSubstr("recording 3 disagrees with the others: its inertia is 1"));
}

// A rig whose torque is known to 3 % makes a difference of 1 % in inertia worth a remark alone.
TEST(FitTogether, DoesNotWarnOfADifferenceBelowTheOtherErrors) {
  std::vector<SyntheticOptions> runs = ShortRuns(4, "coulomb", 1);
  runs[2].parameters[0] *= 1.01;
  FitOptions options = PlainOptions();
  options.rig.emplace().gravity_torque = {kTextbookTorque, 0.03 * kTextbookTorque};
  const FittedRecordings joint = FitJointModels(Simulate(runs), {"coulomb"}, options);
  EXPECT_FALSE(joint.homogeneity[0].agrees());
  EXPECT_TRUE(joint.homogeneity[0].matters);  // one recording is another rig
  EXPECT_FALSE(joint.joint[0].whole.HasWarning("recordings_disagree"));
  EXPECT_THAT(joint.homogeneity[0].verdict, EndsWith("; the errors from other sources are larger than that"));
}

// Inertias that scatter by 0.5 %: the total error contains their standard deviation.
TEST(FitTogether, LeavesAScatterToTheTotalErrors) {
  std::vector<SyntheticOptions> runs = ShortRuns(4, "coulomb", 1);
  const std::vector<double> scale = {0.994, 0.998, 1.002, 1.006};
  for (std::size_t k = 0; k < 4; ++k) runs[k].parameters[0] *= scale[k];
  const FittedRecordings joint = FitJointModels(Simulate(runs), {"coulomb"}, PlainOptions());
  EXPECT_TRUE(joint.homogeneity[0].matters);
  EXPECT_THAT(joint.homogeneity[0].disagreeing, IsEmpty());
  const FitReport& whole = joint.joint[0].whole;
  EXPECT_FALSE(whole.HasWarning("recordings_disagree"));
  EXPECT_TRUE(whole.HasWarning("not_constant"));
  const ParameterEstimate& inertia = *whole.Find("inertia");
  // The sample standard deviation of the four scales is 0.00516.
  EXPECT_NEAR(*TotalStdError(inertia.std_error, inertia.systematic) / inertia.estimate, 0.00516, 0.0005);
}

TEST(FitTogether, NamesTheRecordingThatPreventsConvergence) {
  std::vector<SyntheticOptions> runs = ShortRuns(4, "coulomb", 1);
  runs[1].parameters[0] *= 2;
  const FittedRecordings joint = FitJointModels(Simulate(runs), {"coulomb"}, PlainOptions());
  const FitReport& whole = joint.joint[0].whole;
  EXPECT_EQ(whole.termination, Termination::kNotConverged);
  EXPECT_THAT(whole.reason, StartsWith("these are not swings of one pendulum"));
  EXPECT_THAT(whole.reason, EndsWith("; under this law the recordings do not agree"));  // the verdict says more, once
  EXPECT_FALSE(whole.HasWarning("recordings_disagree"));
  EXPECT_THAT(joint.homogeneity[0].verdict, HasSubstr("recording 2 disagrees with the others: its inertia is 1"));
  EXPECT_THAT(joint.homogeneity[0].disagreeing, ElementsAre(1));
}

// ---- Impossible joint fits -----------------------------------------------------------------------------------------

TEST(FitTogether, FailsForAModelWithoutSharedParameters) {
  const std::vector<std::string> models = {"coulomb", "drag"};
  const auto recordings = Simulate(ShortRuns(2, "drag", 1));
  const FittedRecordings joint =
      FitTogether(FitEach(recordings, models, PlainOptions()), PlainOptions(), models, {"drag"});
  const FitReport& failed = joint.joint[0].whole;
  EXPECT_EQ(failed.termination, Termination::kFailed);
  EXPECT_EQ(failed.reason, "model coulomb has none of the shared parameters");
  ASSERT_THAT(joint.joint[0].runs, SizeIs(2));
  for (const FitReport& run : joint.joint[0].runs) {
    EXPECT_EQ(run.termination, Termination::kFailed);
    EXPECT_THAT(run.covariance_names, IsEmpty());
    for (const ParameterEstimate& parameter : run.parameters) EXPECT_FALSE(parameter.std_error);
  }
  EXPECT_EQ(joint.joint[1].whole.termination, Termination::kConverged) << joint.joint[1].whole.reason;
  EXPECT_THAT(joint.joint[1].shared, ElementsAre("drag"));
}

TEST(FitTogether, FailsIfASeparateFitFailed) {
  const auto recordings = Simulate(ShortRuns(2, "coulomb", 1));
  std::vector<FittedRecording> runs = FitEach(recordings, {"coulomb"}, PlainOptions());
  runs[1].fits[0].termination = Termination::kFailed;
  runs[1].fits[0].reason = "made so";
  const FittedRecordings joint = FitTogether(std::move(runs), PlainOptions(), {"coulomb"}, PhysicalNames({"coulomb"}));
  EXPECT_EQ(joint.joint[0].whole.termination, Termination::kFailed);
  EXPECT_EQ(joint.joint[0].whole.reason, "recording 2 cannot be fitted separately: made so");
  EXPECT_FALSE(joint.homogeneity[0].p);
}

}  // namespace
}  // namespace pendulum::joint_fit_test
