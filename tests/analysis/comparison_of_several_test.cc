// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/analysis/model_comparison.h"
#include "tests/analysis/joint_models.h"
#include "tests/fitting/correlated_noise.h"

namespace pendulum::comparison_of_several_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr CompareOptions kCriteriaOnly = {.predict = false};

struct Compared {
  FittedRecordings joint;
  Comparison comparison;
};

Compared Compare(const std::vector<Recording>& recordings, const std::vector<std::string>& models,
                 const CompareOptions& how = kCriteriaOnly) {
  FittedRecordings joint = FitJointModels(recordings, models, PlainOptions());
  Comparison comparison = CompareModels(joint, PlainOptions(), how);
  return {std::move(joint), std::move(comparison)};
}

/// log L of Gaussian residuals with their most likely σ.
double GaussianLogLikelihood(const Eigen::VectorXd& residual) {
  const auto n = static_cast<double>(residual.size());
  return -0.5 * n * (std::log(2 * kPi * residual.squaredNorm() / n) + 1);
}

// ---- Criteria ------------------------------------------------------------------------------------------------------

// The criteria of one recording (model_comparison_test.cc), with the log-likelihood summed over three recordings of
// 1000 samples. Each recording has four parameters of its own: two of its start, its zero and its σ. Residuals are
// white, so effective_samples is 3000.
TEST(CompareModels, HasTheTextbooksCriteriaOfAllRecordings) {
  const auto [joint, comparison] = Compare(Simulate(ShortRuns(3, "coulomb", 1)), {"viscous", "coulomb"});
  ASSERT_EQ(comparison.likelihood, Likelihood::kIndependent);
  ASSERT_THAT(comparison.rows, SizeIs(2));
  for (std::size_t m = 0; m < 2; ++m) {
    const ComparisonRow& row = comparison.rows[m];
    double log_likelihood = 0;
    for (std::size_t k = 0; k < 3; ++k) log_likelihood += GaussianLogLikelihood(joint.FitOf(k, m).residual);
    const int parameters = (m == 0 ? 2 : 3) + 3 * (2 + 1 + 1);
    EXPECT_EQ(row.parameters, parameters);
    EXPECT_NEAR(*row.log_likelihood, log_likelihood, 0.01);
    EXPECT_NEAR(*row.aic, 2 * parameters - 2 * *row.log_likelihood, 1e-6);
    EXPECT_NEAR(*row.bic, parameters * std::log(comparison.effective_samples) - 2 * *row.log_likelihood, 1e-6);
  }
  EXPECT_NEAR(comparison.effective_samples, 3000, 1);
  EXPECT_THAT(comparison.criterion, HasSubstr(", of all recordings"));
}

// The same recording used twice has the same optimum and twice the log-likelihood.
TEST(CompareModels, DoublesTheLogLikelihoodOfARepeatedRecording) {
  const Recording recording = Must(SimulateRecording(NoisyRun()));
  const auto [joint, comparison] = Compare({recording, recording}, kThreeLaws);
  const FittedRecording once = Must(FitModels(recording, Whole(recording), PlainOptions(), kThreeLaws));
  const Comparison alone = CompareModels(OnlyOne(once), PlainOptions(), kCriteriaOnly);
  for (std::size_t m = 0; m < 3; ++m) {
    EXPECT_NEAR(*comparison.rows[m].log_likelihood, 2 * *alone.rows[m].log_likelihood, 0.02) << kThreeLaws[m];
  }
}

TEST(CompareModels, GivesARicherLawNoSmallerLikelihood) {
  const auto [joint, comparison] = Compare(Simulate(ShortRuns(3, "viscous", 11)), kThreeLaws);
  EXPECT_GE(*comparison.rows[1].log_likelihood, *comparison.rows[0].log_likelihood - 1e-3);
  EXPECT_GE(*comparison.rows[2].log_likelihood, *comparison.rows[1].log_likelihood - 1e-3);
}

// ---- Recommendation ------------------------------------------------------------------------------------------------

TEST(CompareModels, RecommendsTheTrueLaw) {
  for (const std::string& law : kThreeLaws) {
    SCOPED_TRACE(law);
    std::vector<SyntheticOptions> runs = ShortRuns(3, law, 21);
    for (SyntheticOptions& run : runs) {
      run.release_angle += 0.4;
      run.duration = 20;
      if (law == "drag") run.parameters[3] *= 4;  // 0.002 N m s²/rad², as in recommendation_cases.h
    }
    const auto [joint, comparison] = Compare(Simulate(runs), kThreeLaws);
    EXPECT_EQ(comparison.recommended, law) << comparison.reason;
  }
}

TEST(CompareModels, RecommendsNothingIfNothingConverged) {
  FittedRecordings joint = FitJointModels(Simulate(ShortRuns(2, "coulomb", 1)), {"viscous", "coulomb"}, PlainOptions());
  for (JointFit& fit : joint.joint) fit.whole.termination = Termination::kNotConverged;
  const Comparison none = CompareModels(joint, PlainOptions(), kCriteriaOnly);
  EXPECT_EQ(none.likelihood, Likelihood::kNone);
  EXPECT_THAT(none.recommended, IsEmpty());
  EXPECT_EQ(none.reason, "no model converged, so none is recommended");
}

// Without noise the residuals of all laws that contain the true one are rounding errors in each recording.
TEST(CompareModels, RecommendsTheSimplestLawWithoutNoise) {
  std::vector<SyntheticOptions> runs = ShortRuns(2, "coulomb", 1);
  for (SyntheticOptions& run : runs) run.noise = run.resolution = 0;
  const auto [joint, comparison] = Compare(Simulate(runs), kThreeLaws);
  EXPECT_EQ(comparison.likelihood, Likelihood::kNone);
  EXPECT_EQ(comparison.recommended, "coulomb") << comparison.reason;
}

TEST(CompareModels, ComparesConvergedFitsOnly) {
  FittedRecordings joint = FitJointModels(Simulate(ShortRuns(2, "coulomb", 1)), {"viscous", "coulomb"}, PlainOptions());
  joint.joint[1].whole.termination = Termination::kNotConverged;
  joint.joint[1].whole.reason = "made so";
  const Comparison comparison = CompareModels(joint, PlainOptions(), kCriteriaOnly);
  EXPECT_EQ(comparison.recommended, "viscous");
  EXPECT_FALSE(comparison.rows[1].judged || comparison.rows[1].bic);
  EXPECT_THAT(comparison.rows[1].reason, HasSubstr("made so"));
}

// ---- Nested tests --------------------------------------------------------------------------------------------------

// One term is added, for any number of recordings: half χ²(0), half χ²(1), with the tail erfc(√(x/2)) / 2.
TEST(CompareModels, TestsASharedTermWithOneDegreeOfFreedom) {
  for (const std::uint64_t seed : {11, 21, 31}) {
    const auto [joint, comparison] = Compare(Simulate(ShortRuns(3, "viscous", seed)), {"viscous", "coulomb"});
    ASSERT_THAT(comparison.tests, SizeIs(1));
    const NestedTest& test = comparison.tests[0];
    EXPECT_EQ(test.simpler, "viscous");
    EXPECT_EQ(test.richer, "coulomb");
    EXPECT_THAT(test.added, ElementsAre("coulomb"));
    EXPECT_EQ(test.null, "half χ²(0), half χ²(1)");
    const double statistic = 2 * std::max(*comparison.rows[1].log_likelihood - *comparison.rows[0].log_likelihood, 0.0);
    EXPECT_THAT(test.statistic, DoubleNear(statistic, 1e-9));
    ASSERT_TRUE(test.p);
    if (statistic > 1e-6) {
      EXPECT_THAT(*test.p, DoubleNear(0.5 * std::erfc(std::sqrt(statistic / 2)), 1e-9));
    }
    EXPECT_GT(*test.p, 1e-4);
  }
}

// Three recordings, each with too little information, determine the common term together. Statistics of independent
// recordings of one rig add up, except for a part from their disagreement, with expectation 2 and rarely above 20.
TEST(CompareModels, AddsTheInformationOfRecordingsOnATerm) {
  std::vector<SyntheticOptions> runs = ShortRuns(3, "coulomb", 41);
  for (SyntheticOptions& run : runs) run.noise = 0.006;
  const auto recordings = Simulate(runs);
  const auto [joint, comparison] = Compare(recordings, {"viscous", "coulomb"});
  double sum = 0;
  for (const FittedRecording& run : joint.recordings) {
    sum += CompareModels(OnlyOne(run), PlainOptions(), kCriteriaOnly).tests.at(0).statistic;
  }
  EXPECT_GT(comparison.tests.at(0).statistic, sum - 20);
  EXPECT_LT(comparison.tests.at(0).p.value_or(1), 1e-6);
}

TEST(CompareModels, GivesNoPValueForTermsThatAreNotShared) {
  const std::vector<std::string> models = {"viscous", "coulomb"};
  const auto recordings = Simulate(ShortRuns(2, "coulomb", 1));
  const FittedRecordings joint =
      FitTogether(FitEach(recordings, models, PlainOptions()), PlainOptions(), models, {"inertia", "viscous"});
  const Comparison comparison = CompareModels(joint, PlainOptions(), kCriteriaOnly);
  ASSERT_THAT(comparison.tests, SizeIs(1));
  EXPECT_FALSE(comparison.tests[0].p);
  EXPECT_EQ(comparison.tests[0].reason, "the added parameters are not shared: each recording has its own");
  EXPECT_EQ(comparison.rows[1].parameters, 2 + 2 * (1 + 3 + 1));  // each recording has a separate dry friction
}

// ---- Autocorrelated noise ------------------------------------------------------------------------------------------

/// Recordings of dry friction with AR(1) noise of correlation 0.9 and 4 mrad, without other noise.
std::vector<Recording> AutocorrelatedRecordings(int count, std::uint64_t seed) {
  std::vector<SyntheticOptions> runs = ShortRuns(count, "coulomb", seed);
  for (SyntheticOptions& run : runs) {
    run.noise = 0;
    run.duration = 15;
  }
  std::vector<Recording> recordings = Simulate(runs);
  for (Recording& recording : recordings) {
    recording.value += 0.004 * FirstOrderNoise(recording.size(), 0.9, 0, ++seed);
  }
  return recordings;
}

// The innovations of AR(1) noise with correlation 0.9 have sqrt(1 - 0.81) times its standard deviation. ln L of all N
// samples together is larger by -N/2 ln 0.19. Each recording has a separate autocorrelation of one or more parameters.
TEST(CompareModels, UsesTheAutocorrelationOfEachRecording) {
  const auto [joint, comparison] = Compare(AutocorrelatedRecordings(3, 5), kThreeLaws);
  EXPECT_EQ(comparison.likelihood, Likelihood::kCorrelated);
  EXPECT_THAT(comparison.criterion, HasSubstr("autocorrelated residuals"));
  EXPECT_LT(comparison.effective_samples, 2250);
  double independent = 0;
  for (std::size_t k = 0; k < 3; ++k) independent += GaussianLogLikelihood(joint.FitOf(k, 1).residual);
  EXPECT_THAT(*comparison.rows[1].log_likelihood - independent, DoubleNear(-0.5 * 4500 * std::log(0.19), 0.1 * 4500));
  EXPECT_GE(comparison.rows[1].parameters, joint.joint[1].parameters + 3);
  EXPECT_GE(*comparison.rows[1].log_likelihood, *comparison.rows[0].log_likelihood - 0.1);
  EXPECT_EQ(comparison.recommended, "coulomb") << comparison.reason;
}

// Two copies have the same autocorrelation and the same optimum: twice the log-likelihood.
TEST(CompareModels, DoublesTheLogLikelihoodOfARepeatedCorrelatedRecording) {
  const Recording recording = AutocorrelatedRecordings(1, 9).front();
  const auto [joint, comparison] = Compare({recording, recording}, {"viscous", "coulomb"});
  const FittedRecording once = Must(FitModels(recording, Whole(recording), PlainOptions(), {"viscous", "coulomb"}));
  const Comparison alone = CompareModels(OnlyOne(once), PlainOptions(), kCriteriaOnly);
  ASSERT_EQ(alone.likelihood, Likelihood::kCorrelated);
  ASSERT_EQ(comparison.likelihood, Likelihood::kCorrelated);
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_NEAR(*comparison.rows[m].log_likelihood, 2 * *alone.rows[m].log_likelihood, 0.1) << m;
  }
}

// ---- Predictions and units -----------------------------------------------------------------------------------------

TEST(CompareModels, PredictsEachRecordingFromItsOwnFit) {
  std::vector<SyntheticOptions> runs = ShortRuns(2, "coulomb", 51);
  for (SyntheticOptions& run : runs) run.duration = 20;
  const auto [joint, comparison] = Compare(Simulate(runs), {"viscous", "coulomb"}, CompareOptions{});
  const Prediction& pooled = comparison.rows[1].forward;
  double squares = 0, samples = 0;
  for (const FittedRecording& run : joint.recordings) {
    const Prediction own = PredictForward(run.used, run.fits[1], PlainOptions());
    squares += static_cast<double>(own.samples) * own.rms * own.rms;
    samples += static_cast<double>(own.samples);
  }
  EXPECT_EQ(static_cast<double>(pooled.samples), samples);
  EXPECT_THAT(pooled.rms, DoubleNear(std::sqrt(squares / samples), 1e-12));
  EXPECT_THAT(comparison.rows[1].cross_validation.standardized, DoubleNear(1, 0.1));
  EXPECT_GT(comparison.rows[0].forward.rms, 1.3 * pooled.rms);
  EXPECT_EQ(comparison.recommended, "coulomb");
}

// An angle and a rate have no common unit. The true law's residuals over their σ have an rms of 1.
TEST(CompareModels, NormalizesResidualsOfDifferentUnits) {
  std::vector<SyntheticOptions> runs = ShortRuns(2, "coulomb", 61);
  runs[1].quantity = Quantity::kRate;
  runs[1].noise = 0.01;
  const auto [joint, comparison] = Compare(Simulate(runs), {"viscous", "coulomb"});
  EXPECT_THAT(comparison.rows[1].rms, DoubleNear(1, 0.02));
  EXPECT_GT(comparison.rows[0].rms, 0);
  const auto [same, in_radians] = Compare(Simulate(ShortRuns(2, "coulomb", 61)), {"coulomb"});
  EXPECT_THAT(in_radians.rows[0].rms, DoubleNear(0.002, 2e-4));
}

}  // namespace
}  // namespace pendulum::comparison_of_several_test
