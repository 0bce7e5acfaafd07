// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/fit_jointly.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/joint_recordings.h"

namespace pendulum::fit_jointly_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

// ---- Recovery ------------------------------------------------------------------------------------------------------

/// Noise-free recordings: an angle after a release, a gyro's rate from a start in motion, and an angle whose file's
/// seconds last 1.02 true seconds.
Recordings NoiseFreeRecordings() {
  SyntheticOptions gyro = MovingRun("coulomb");
  gyro.quantity = Quantity::kRate;
  gyro.sample_rate = 47;
  SyntheticOptions slow = TextbookRun("coulomb");
  slow.release_angle = 1.1;
  slow.duration = 15;
  slow.sample_rate = 80;
  Recordings recordings = {Must(SimulateRecording(TextbookRun("coulomb"))), Must(SimulateRecording(gyro)),
                           Must(SimulateRecording(slow))};
  recordings[2].time /= 1.02;
  recordings[2].clock_scale = 1.02;
  return recordings;
}

void ExpectTruth(const FitReport& report, const std::vector<double>& truth, double relative) {
  ASSERT_GE(report.parameters.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(report.parameters[i].estimate, truth[i], relative * std::abs(truth[i]))
        << report.parameters[i].info.name;
  }
}

TEST(FitJointly, RecoversTheTruthFromNoiseFreeRecordingsOfDifferentKinds) {
  const JointFit fit = FitAllJointly(NoiseFreeRecordings(), RigOptions());
  ExpectConverged(fit);
  EXPECT_EQ(fit.shared, kPhysical);
  ASSERT_THAT(fit.whole.parameters, SizeIs(3));
  ExpectTruth(fit.whole, kTruthInSi, 1e-7);
  ASSERT_THAT(fit.runs, SizeIs(3));
  std::vector<double> first = kTruthInSi, second = kTruthInSi, third = kTruthInSi;
  first.insert(first.end(), {0.423, 1.9, 0.012});
  second.insert(second.end(), {-0.2, 1.5, 0.012});
  third.insert(third.end(), {1.1, 1.9 / 1.02, 0.012});  // release on the file's clock
  ExpectTruth(fit.runs[0], first, 1e-7);
  ExpectTruth(fit.runs[1], second, 1e-7);
  ExpectTruth(fit.runs[2], third, 1e-7);
}

TEST(FitJointly, DerivesTheWholesQuantitiesFromItsSharedParametersAlone) {
  const JointFit fit = FitAllJointly(NoiseFreeRecordings(), RigOptions());
  const auto ratio =
      std::ranges::find(fit.whole.derived, std::string_view("gravity_over_inertia"), &DerivedQuantity::name);
  ASSERT_NE(ratio, fit.whole.derived.end());
  // d(G/I)/dI for the inertia in units of G.
  ASSERT_EQ(ratio->gradient.size(), 3);
  EXPECT_NEAR(ratio->gradient[0], -ratio->estimate * ratio->estimate, 1e-9 * ratio->estimate * ratio->estimate);
  EXPECT_EQ(ratio->gradient[1], 0);
  EXPECT_EQ(ratio->gradient[2], 0);
}

TEST(FitJointly, IsWithinFourStandardErrorsForNoisyRecordings) {
  for (const std::uint64_t seed : {1, 11, 21}) {
    const JointFit fit = FitAllJointly(MixedRecordings(seed), RigOptions());
    ExpectConverged(fit);
    for (const double deviation : Deviations(fit.whole, kTruthInSi)) EXPECT_LT(std::abs(deviation), 4) << seed;
  }
}

TEST(FitJointly, RecoversADriftingZeroInEachRecording) {
  Recordings recordings = NoiseFreeRecordings();
  const double drifts[] = {2e-4, -1e-3, 5e-4};  // rad/s, rad/s², in true seconds
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::VectorXd since = recordings[k].time.array() - recordings[k].time[0];
    recordings[k].value += drifts[k] * recordings[k].clock_scale * since;
  }
  recordings.erase(recordings.begin() + 1);  // the gyro's drift parameter has another name
  FitOptions options = RigOptions();
  options.initial = {{"zero_drift", 0.0}};
  const JointFit fit = FitAllJointly(recordings, options);
  ExpectConverged(fit);
  ExpectTruth(fit.whole, kTruthInSi, 1e-7);
  EXPECT_NEAR(fit.runs[0].Find("zero_drift")->estimate, drifts[0], 1e-9);
  EXPECT_NEAR(fit.runs[1].Find("zero_drift")->estimate, drifts[2], 1e-9);
}

// Dry friction stops the first pendulum after about 40 s of 60 s.
TEST(FitJointly, RecoversTheTruthFromRecordingsThatComeToRest) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.duration = 60;
  run.sample_rate = 50;
  const JointFit fit =
      FitAllJointly({Must(SimulateRecording(run)), Must(SimulateRecording(TextbookRun("coulomb")))}, RigOptions());
  ExpectConverged(fit);
  ExpectTruth(fit.whole, kTruthInSi, 1e-6);
}

// ---- Against separate fits -----------------------------------------------------------------------------------------

void ExpectSame(const FitReport& joint, const std::vector<std::string>& names, const Estimates& expected) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double error = std::sqrt(expected.covariance(row, row));
    const ParameterEstimate& parameter = *joint.Find(names[i]);
    EXPECT_THAT(parameter.estimate, DoubleNear(expected.value[row], 0.05 * error)) << names[i];
    ASSERT_TRUE(parameter.std_error) << names[i] << parameter.reason;
    EXPECT_THAT(*parameter.std_error / error, DoubleNear(1, 0.02)) << names[i];
  }
}

TEST(FitJointly, IsTheWeightedMeanOfSeparateFits) {
  for (const std::uint64_t seed : {1, 11}) {
    const Recordings recordings = MixedRecordings(seed);
    std::vector<Estimates> parts;
    for (const FitReport& fit : FitAlone(recordings, RigOptions())) parts.push_back(EstimatesOf(fit, kPhysical));
    const JointFit fit = FitAllJointly(recordings, RigOptions());
    const Estimates expected = Combine(parts);
    ExpectSame(fit.whole, kPhysical, expected);
    const Eigen::VectorXd error = expected.covariance.diagonal().cwiseSqrt();
    const Eigen::MatrixXd difference = fit.whole.covariance - expected.covariance;
    EXPECT_LT(difference.cwiseQuotient(error * error.transpose()).cwiseAbs().maxCoeff(), 0.04) << seed;
  }
}

// A recording used twice has the information of twice as many samples: errors of shared parameters shrink by √2, but
// errors of unshared parameters do not.
TEST(FitJointly, ReducesErrorsBySqrtTwoForARepeatedRecording) {
  const Recording recording = Must(SimulateRecording(Released(0.5, 3)));
  const FitReport alone = Fit(recording, RigOptions());
  const JointFit fit = FitAllJointly({recording, recording}, RigOptions());
  for (const std::string& name : kPhysical) {
    EXPECT_THAT(*fit.whole.Find(name)->std_error / *alone.Find(name)->std_error, DoubleNear(std::sqrt(0.5), 2e-3));
    EXPECT_THAT(fit.whole.Find(name)->estimate,
                DoubleNear(alone.Find(name)->estimate, 1e-3 * *alone.Find(name)->std_error));
  }
  const ParameterEstimate& release = *fit.runs[1].Find("release_angle");
  EXPECT_GT(*release.std_error, 0.8 * *alone.Find("release_angle")->std_error);
}

// σ² = RSS / (N - share): together, all recordings lose one degree of freedom per parameter.
TEST(FitJointly, LosesOneDegreeOfFreedomPerParameter) {
  const Recordings recordings = {Must(SimulateRecording(Released(0.5, 1))), Must(SimulateRecording(Released(0.9, 2))),
                                 Must(SimulateRecording(Released(0.7, 3)))};
  const JointFit fit = FitAllJointly(recordings, RigOptions());
  double left = 0;
  for (const FitReport& run : fit.runs) left += run.residual.squaredNorm() / (run.noise.sigma * run.noise.sigma);
  EXPECT_NEAR(left, 3000 - (3 + 3 * 3), 0.01);
}

// One sample in fifty is an outlier of fifty times the noise.
TEST(FitJointly, IsTheWeightedMeanOfSeparateRobustFits) {
  Recordings recordings = {Must(SimulateRecording(Released(0.5, 1))), Must(SimulateRecording(Released(0.9, 2)))};
  for (Recording& recording : recordings) {
    for (Eigen::Index i = 7; i < recording.size(); i += 50) recording.value[i] += i % 3 == 0 ? 0.1 : -0.1;
  }
  FitOptions options = RigOptions();
  options.noise = NoiseFamily::kStudent;
  std::vector<Estimates> parts;
  for (const FitReport& fit : FitAlone(recordings, options)) parts.push_back(EstimatesOf(fit, kPhysical));
  const JointFit fit = FitAllJointly(recordings, options);
  ExpectConverged(fit);
  ExpectSame(fit.whole, kPhysical, Combine(parts));
}

TEST(FitJointly, AddsUpLikelihoodsAndCountsParameters) {
  const Recordings recordings = MixedRecordings();
  const JointFit fit = FitAllJointly(recordings, RigOptions());
  double sum = 0, samples = 0;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    sum += fit.runs[k].statistics.log_likelihood;
    samples += static_cast<double>(recordings[k].size());
  }
  EXPECT_EQ(fit.parameters, 15);  // 3 shared parameters; two start values, zero and σ of each of 3 recordings
  EXPECT_NEAR(fit.whole.statistics.log_likelihood, sum, 1e-9 * std::abs(sum));
  EXPECT_NEAR(fit.whole.statistics.aic, 30 - 2 * sum, 1e-6);
  EXPECT_NEAR(fit.whole.statistics.bic, 15 * std::log(samples) - 2 * sum, 1e-6);
}

// By hand: (3 · 2² + 1 · 4²) / 4 = 7. With k = 2 and N = 5, AIC is 4 - 2 L, AICc is larger by 12 / (5 - 3), BIC is 2 ln
// 5 - 2 L.
TEST(SumStatistics, WeighsUncensoredResidualsAndCountsAllSamples) {
  FitReport first, second;
  first.residual = Eigen::VectorXd::Zero(3);
  first.statistics.rms_residual = 2;
  first.statistics.log_likelihood = -7;
  first.statistics.effective_samples = 2.5;
  second.residual = Eigen::VectorXd::Zero(2);
  second.noise.censored = 1;
  second.statistics.rms_residual = 4;
  second.statistics.log_likelihood = -1;
  second.statistics.effective_samples = 2;
  const std::vector<const FitReport*> both = {&first, &second};
  const FitStatistics all = SumStatistics(both, 2);
  EXPECT_DOUBLE_EQ(all.rms_residual, std::sqrt(7));
  EXPECT_DOUBLE_EQ(all.log_likelihood, -8);
  EXPECT_DOUBLE_EQ(all.effective_samples, 4.5);
  EXPECT_DOUBLE_EQ(all.aic, 20);
  EXPECT_DOUBLE_EQ(all.aicc, 26);
  EXPECT_DOUBLE_EQ(all.bic, 2 * std::log(5) + 16);
}

TEST(SumStatistics, AreFiniteWithoutFits) {
  const FitStatistics none = SumStatistics({}, 0);
  EXPECT_EQ(none.rms_residual, 0);
  EXPECT_EQ(none.bic, 0);
}

// If only inertia is shared, the joint inertia I is the mean of the separate estimates I_k with weights 1 / C_II. The
// friction f of each recording changes to f + C_fI / C_II (I - I_k), where C is the covariance of its separate fit.
TEST(FitJointly, KeepsUnsharedParametersSeparate) {
  const Recordings recordings = MixedRecordings(5);
  const std::vector<FitReport> alone = FitAlone(recordings, RigOptions());
  const JointFit fit = Must(TryJointly(recordings, alone, RigOptions(), {"inertia"}));
  ExpectConverged(fit);
  EXPECT_THAT(fit.shared, ElementsAre("inertia"));
  ASSERT_THAT(fit.whole.parameters, SizeIs(1));
  EXPECT_THAT(fit.whole.derived, IsEmpty());
  std::vector<Estimates> inertias;
  for (const FitReport& one : alone) inertias.push_back(EstimatesOf(one, {"inertia"}));
  const Estimates inertia = Combine(inertias);
  ExpectSame(fit.whole, {"inertia"}, inertia);
  for (std::size_t k = 0; k < alone.size(); ++k) {
    const Estimates own = EstimatesOf(alone[k], kPhysical);
    const double moved = (inertia.value[0] - own.value[0]) / own.covariance(0, 0);
    for (const Eigen::Index i : {1, 2}) {
      const std::string& name = kPhysical[static_cast<std::size_t>(i)];
      EXPECT_THAT(fit.runs[k].Find(name)->estimate,
                  DoubleNear(own.value[i] + own.covariance(i, 0) * moved, 0.05 * std::sqrt(own.covariance(i, i))))
          << name << " of " << k;
    }
  }
}

// ---- Priors, fixed values, bounds ----------------------------------------------------------------------------------

/// A prior with its mean five joint standard errors above the joint estimate and a standard deviation of one such
/// error.
ParameterPrior InertiaPrior(const Estimates& combined) {
  const double error = std::sqrt(combined.covariance(0, 0));
  return {combined.value[0] + 5 * error, error};
}

/// Adds the prior as if it were another recording, which measures only inertia.
Estimates WithPrior(const Estimates& combined, const ParameterPrior& prior) {
  Eigen::MatrixXd precision = combined.covariance.inverse();
  Eigen::VectorXd sum = precision * combined.value;
  const double weight = 1 / (prior.std_dev * prior.std_dev);
  precision(0, 0) += weight;
  sum[0] += weight * prior.mean;
  return {precision.inverse() * sum, precision.inverse()};
}

TEST(FitJointly, CountsAPriorOnASharedParameterOnce) {
  const Recordings recordings = MixedRecordings(7);
  std::vector<Estimates> parts;
  for (const FitReport& fit : FitAlone(recordings, RigOptions())) parts.push_back(EstimatesOf(fit, kPhysical));
  const ParameterPrior prior = InertiaPrior(Combine(parts));
  FitOptions options = RigOptions();
  options.priors = {{"inertia", prior}};
  ExpectSame(FitAllJointly(recordings, options).whole, kPhysical, WithPrior(Combine(parts), prior));
}

// Each separate fit includes its own prior on a parameter that is not shared; their weighted mean needs no further
// prior.
TEST(FitJointly, CountsAPriorOnAnUnsharedParameterOncePerRecording) {
  const Recordings recordings = {Must(SimulateRecording(Released(0.5, 1))), Must(SimulateRecording(Released(0.9, 2)))};
  FitOptions options = RigOptions();
  options.priors = {{"release_time", {1.9005, 2e-4}}};
  std::vector<Estimates> parts;
  for (const FitReport& fit : FitAlone(recordings, options)) parts.push_back(EstimatesOf(fit, kPhysical));
  ExpectSame(FitAllJointly(recordings, options).whole, kPhysical, Combine(parts));
}

// Both releases are at 1.9 s (fit_support.h). The prior for the second recording contradicts this.
TEST(FitJointly, WarnsOfPriorsThatContradictARecording) {
  const Recordings recordings = {Must(SimulateRecording(Released(0.5, 1))), Must(SimulateRecording(Released(0.9, 2)))};
  FitOptions near = RigOptions(), far = near;
  near.priors = {{"release_time", {1.9, 0.001}}};
  far.priors = {{"release_time", {1.8, 0.001}}};
  const std::vector<FitReport> alone = {Fit(recordings[0], near), Fit(recordings[1], far)};
  const std::vector<JointRun> runs = {{recordings[0], alone[0], near}, {recordings[1], alone[1], far}};
  const JointFit fit = Must(FitJointly(runs, kPhysical));
  EXPECT_FALSE(fit.runs[0].HasWarning("prior_conflict"));
  EXPECT_TRUE(fit.runs[1].HasWarning("prior_conflict"));
}

TEST(FitJointly, KeepsFixedParameters) {
  FitOptions options = RigOptions();
  options.fixed = {{"viscous", 0.0031}};
  const JointFit fit = FitAllJointly(MixedRecordings(), options);
  ExpectConverged(fit);
  const ParameterEstimate& viscous = *fit.whole.Find("viscous");
  EXPECT_TRUE(viscous.fixed);
  EXPECT_DOUBLE_EQ(viscous.estimate, 0.0031);
  EXPECT_FALSE(viscous.std_error);
  EXPECT_THAT(fit.whole.covariance_names, ElementsAre("inertia", "coulomb"));
  EXPECT_EQ(fit.parameters, 14);
}

/// Two recordings without viscous friction.
Recordings WithoutViscous(std::uint64_t seed) {
  Recordings recordings;
  for (const double angle : {0.4, 0.8}) {
    SyntheticOptions run = Released(angle, seed++);
    run.parameters[1] = 0;
    recordings.push_back(Must(SimulateRecording(run)));
  }
  return recordings;
}

// Without viscous friction, an estimate without a bound would be negative for half of all seeds. Such fits end at the
// bound 0.
TEST(FitJointly, HasAProfileIntervalAtABound) {
  FitOptions options = RigOptions();
  options.interval = IntervalMethod::kAuto;
  int at_bound = 0;
  for (const std::uint64_t seed : {1, 3, 5, 7, 9, 11}) {
    const JointFit fit = FitAllJointly(WithoutViscous(seed), options);
    ExpectConverged(fit);
    const ParameterEstimate& viscous = *fit.whole.Find("viscous");
    ASSERT_TRUE(viscous.upper95 && viscous.lower95) << Sentence(viscous.open_interval);
    EXPECT_EQ(*viscous.lower95, 0) << seed;
    EXPECT_THAT(fit.whole.interval_method, StartsWith("profile likelihood of the shared"));
    EXPECT_THAT(fit.whole.profiles, SizeIs(3));
    for (const std::string_view name : {"inertia", "coulomb"}) {
      const ParameterEstimate& other = *fit.whole.Find(name);
      EXPECT_LT(*other.lower95, other.estimate);
      EXPECT_GT(*other.upper95, other.estimate);
    }
    if (!viscous.at_bound) continue;
    ++at_bound;
    EXPECT_EQ(viscous.estimate, 0);
    EXPECT_FALSE(viscous.std_error);
    EXPECT_EQ(fit.parameters, 2 + 3 * 2 + 2);  // inertia and dry friction; two starts and two zeros; two σ
  }
  EXPECT_GE(at_bound, 1);
  EXPECT_LE(at_bound, 5);
}

// Without stiction the readings do not show the rate at which friction would fall to its sliding value.
TEST(FitJointly, HasNoErrorOfAStictionThatNoRecordingShows) {
  FitOptions options = RigOptions();
  options.model = "stribeck";
  const Recordings recordings = {Must(SimulateRecording(Released(0.5, 1))), Must(SimulateRecording(Released(0.8, 2)))};
  const JointFit fit =
      FitAllJointly(recordings, options, {"inertia", "viscous", "coulomb", "stiction", "stribeck_rate"});
  std::vector<const FitReport*> reports = {&fit.whole};
  for (const FitReport& run : fit.runs) reports.push_back(&run);
  for (const FitReport* const report : reports) {
    if (report->termination != Termination::kConverged) continue;
    for (const char* const name : {"stiction", "stribeck_rate"}) {
      EXPECT_FALSE(report->Find(name)->std_error || report->Find(name)->upper95) << name;
    }
  }
}

// ---- Recordings that cannot be fitted ------------------------------------------------------------------------------

TEST(FitJointly, DoesNotConvergeForRigsOfDifferentInertia) {
  SyntheticOptions heavy = Released(0.5, 2);
  heavy.parameters[0] *= 2;
  const Recordings recordings = {Must(SimulateRecording(Released(0.5, 1))), Must(SimulateRecording(heavy))};
  const JointFit fit = FitAllJointly(recordings, RigOptions());
  EXPECT_EQ(fit.whole.termination, Termination::kNotConverged);
  EXPECT_THAT(fit.whole.reason, StartsWith("these are not swings of one pendulum with one inertia, viscous and "
                                           "coulomb: the best joint trajectories leave "));
  EXPECT_THAT(fit.whole.reason, HasSubstr(" of the variance of recording "));
  for (const FitReport& run : fit.runs) EXPECT_EQ(run.termination, Termination::kNotConverged);
  EXPECT_THAT(fit.whole.covariance_names, IsEmpty());
  for (const ParameterEstimate& parameter : fit.whole.parameters) EXPECT_FALSE(parameter.std_error);
}

void ExpectRefused(const Result<JointFit>& refused, StatusCode code, const std::string& message) {
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, code);
  EXPECT_EQ(refused.error().message(), message);
}

TEST(FitJointly, RefusesFewerThanTwoRecordings) {
  const Recordings one = {Must(SimulateRecording(Released(0.5, 1)))};
  ExpectRefused(TryJointly(one, FitAlone(one, RigOptions()), RigOptions()), StatusCode::kInvalidArgument,
                "a joint fit needs two recordings or more; there is one");
  ExpectRefused(TryJointly({}, {}, RigOptions()), StatusCode::kInvalidArgument,
                "a joint fit needs two recordings or more; there is none");
}

TEST(FitJointly, RefusesBootstrapIntervals) {
  FitOptions options = RigOptions();
  const Recordings recordings = MixedRecordings();
  const std::vector<FitReport> alone = FitAlone(recordings, options);
  options.interval = IntervalMethod::kBootstrap;
  ExpectRefused(TryJointly(recordings, alone, options), StatusCode::kInvalidArgument,
                "bootstrap intervals are only for the fit to a single recording");
}

TEST(FitJointly, RefusesSharingAParameterTheModelLacks) {
  const Recordings recordings = MixedRecordings();
  ExpectRefused(TryJointly(recordings, FitAlone(recordings, RigOptions()), RigOptions(), {"drag", "release_angle"}),
                StatusCode::kInvalidArgument, "model coulomb has none of the shared parameters");
}

TEST(FitJointly, RefusesARecordingThatCannotBeFittedAlone) {
  const Recordings recordings = MixedRecordings();
  std::vector<FitReport> alone = FitAlone(recordings, RigOptions());
  alone[1].termination = Termination::kFailed;
  alone[1].reason = "made so";
  ExpectRefused(TryJointly(recordings, alone, RigOptions()), StatusCode::kFailedPrecondition,
                "recording 2 cannot be fitted separately: made so");
}

}  // namespace
}  // namespace pendulum::fit_jointly_test
