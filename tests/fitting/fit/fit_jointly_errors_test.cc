// SPDX-License-Identifier: Apache-2.0
// Errors of joint fits beyond the covariance: profiles, systematic errors of rig and clock, posteriors.
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/fit/fit_jointly.h"
#include "tests/fitting/joint_recordings.h"

namespace pendulum::fit_jointly_errors_test {
namespace {

using testing::DoubleNear;

/// The rig released at several angles, with noise and without quantization.
Recordings SeveralReleases(std::size_t count, std::uint64_t seed = 1) {
  Recordings recordings;
  for (std::size_t k = 0; k < count; ++k) {
    recordings.push_back(Must(SimulateRecording(Released(0.5 + 0.1 * static_cast<double>(k), seed + k))));
  }
  return recordings;
}

// ---- Profiles ------------------------------------------------------------------------------------------------------

FitOptions ProfileOptions() {
  FitOptions options = RigOptions();
  options.interval = IntervalMethod::kProfile;
  return options;
}

/// 2 (log L of the estimate - log L) with one shared parameter fixed in a separate joint fit.
double DevianceRise(const Recordings& recordings, const JointFit& best, const std::string& name, double value) {
  FitOptions options = RigOptions();
  options.fixed = {{name, value}};
  const JointFit held = FitAllJointly(recordings, options);
  return 2 * (best.whole.statistics.log_likelihood - held.whole.statistics.log_likelihood);
}

// For independent residuals the interval ends where the deviance has risen by 1.96² = 3.8415. Fits with a fixed
// parameter still estimate σ, which makes the rise for 1000 samples larger by less than a hundredth.
TEST(JointProfile, EndsAtTheChiSquareRiseOfTheJointDeviance) {
  const Recordings recordings = SeveralReleases(2);
  const JointFit best = FitAllJointly(recordings, ProfileOptions());
  ExpectConverged(best);
  for (const std::string& name : kPhysical) {
    SCOPED_TRACE(name);
    const ParameterEstimate& parameter = *best.whole.Find(name);
    ASSERT_TRUE(parameter.lower95 && parameter.upper95) << Sentence(parameter.open_interval);
    EXPECT_THAT(DevianceRise(recordings, best, name, *parameter.upper95), DoubleNear(3.8415, 0.08));
    if (*parameter.lower95 == 0) continue;
    EXPECT_THAT(DevianceRise(recordings, best, name, *parameter.lower95), DoubleNear(3.8415, 0.08));
  }
}

TEST(JointProfile, IsTheSameInEveryReport) {
  const JointFit fit = FitAllJointly(SeveralReleases(3), ProfileOptions());
  for (const std::string& name : kPhysical) {
    for (const FitReport& run : fit.runs) {
      EXPECT_EQ(run.Find(name)->lower95, fit.whole.Find(name)->lower95) << name;
      EXPECT_EQ(run.Find(name)->upper95, fit.whole.Find(name)->upper95) << name;
    }
  }
}

// ---- Rig and clock -------------------------------------------------------------------------------------------------

/// Systematic error of a shared parameter from rig and clock, relative to its estimate.
double RelativeSystematic(const JointFit& fit, const std::string& name) {
  const ParameterEstimate& parameter = *fit.whole.Find(name);
  return parameter.systematic.Total().value_or(0) / parameter.estimate;
}

// Torques and inertia are in units of the restoring torque G: an error of 1 % in G is an error of 1 % in each of
// them, for any number of recordings.
TEST(JointSystematic, IsACommonFactorForARig) {
  FitOptions options = RigOptions();
  options.rig = RigOfTorque(0.01 * kTextbookTorque);
  for (const std::size_t count : {2, 5}) {
    const JointFit fit = FitAllJointly(SeveralReleases(count), options);
    for (const std::string& name : kPhysical) {
      EXPECT_THAT(RelativeSystematic(fit, name), DoubleNear(0.01, 1e-9)) << name << ", " << count;
    }
  }
}

/// The recordings with clock errors of 1e-3. If `apart`, each recording has a different clock scale, that is, its own
/// clock.
Recordings WithClocks(Recordings recordings, bool apart) {
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    recordings[k].clock_scale_std_dev = 1e-3;
    if (!apart || k == 0) continue;
    recordings[k].clock_scale = 1 + 1e-4 * static_cast<double>(k);
    recordings[k].time /= recordings[k].clock_scale;
  }
  return recordings;
}

// Inertia scales with time squared, viscous friction with time, dry friction not at all: 2, 1 and 0 thousandths.
TEST(JointSystematic, FollowsThePowerOfTimeForACommonClock) {
  for (const std::size_t count : {2, 4}) {
    const JointFit fit = FitAllJointly(WithClocks(SeveralReleases(count), false), RigOptions());
    EXPECT_THAT(RelativeSystematic(fit, "inertia"), DoubleNear(2e-3, 1e-8)) << count;
    EXPECT_THAT(RelativeSystematic(fit, "viscous"), DoubleNear(1e-3, 1e-8)) << count;
    EXPECT_THAT(RelativeSystematic(fit, "coulomb"), DoubleNear(0, 1e-8)) << count;
  }
}

// Two clocks have independent errors: for two recordings of about equal weight, the error of inertia is 2e-3 / √2.
TEST(JointSystematic, IsSmallerForTwoClocks) {
  const Recording recording = Must(SimulateRecording(Released(0.5, 3)));
  const JointFit fit = FitAllJointly(WithClocks({recording, recording}, true), RigOptions());
  EXPECT_THAT(RelativeSystematic(fit, "inertia") / 2e-3, DoubleNear(std::sqrt(0.5), 0.01));
  const JointFit uneven = FitAllJointly(WithClocks(SeveralReleases(2), true), RigOptions());
  EXPECT_LT(RelativeSystematic(uneven, "inertia"), 1.8e-3);
  EXPECT_GT(RelativeSystematic(uneven, "inertia"), 1.35e-3);
}

/// An angle and a rate recording with little noise, both with clock scale `scale`, in either order. The rate recording
/// swings by only about 0.1 rad, because its estimates follow powers of the clock scale only where sin θ ≈ θ.
Recordings AngleAndRate(double scale, bool rate_first) {
  SyntheticOptions angle = Released(0.8, 1), gyro = MovingRun("coulomb");
  gyro.quantity = Quantity::kRate;
  gyro.initial_angle = -0.05;
  gyro.initial_rate = 0.4;
  gyro.duration = 10;
  angle.noise = gyro.noise = 1e-4;
  Recordings recordings = {Must(SimulateRecording(angle)), Must(SimulateRecording(gyro))};
  if (rate_first) std::swap(recordings[0], recordings[1]);
  for (Recording& recording : recordings) {
    recording.clock_scale = scale;
    recording.clock_scale_std_dev = 1e-3;
  }
  return recordings;
}

// A wrong clock scale changes the estimates from an angle and those from a gyro's rate by different powers. The
// systematic error must match the change of the estimates between fits with a faster and a slower clock, in either
// order of the recordings.
TEST(JointSystematic, MatchesFitsWithOtherClocksForAngleAndRate) {
  for (const bool rate_first : {false, true}) {
    SCOPED_TRACE(rate_first ? "rate first" : "angle first");
    const JointFit fit = FitAllJointly(AngleAndRate(1, rate_first), RigOptions());
    const JointFit fast = FitAllJointly(AngleAndRate(1.0005, rate_first), RigOptions());
    const JointFit slow = FitAllJointly(AngleAndRate(0.9995, rate_first), RigOptions());
    for (const std::string& name : kPhysical) {
      // Change of the estimate for a relative change of the clock by 1e-3.
      const double moved = std::abs(fast.whole.Find(name)->estimate - slow.whole.Find(name)->estimate);
      const ParameterEstimate& parameter = *fit.whole.Find(name);
      EXPECT_THAT(parameter.systematic.Total().value_or(0),
                  DoubleNear(moved, 0.05 * moved + 0.1 * *parameter.std_error))
          << name;
    }
  }
}

// ---- Posteriors ----------------------------------------------------------------------------------------------------

/// Noise-free recordings in counts, released at several angles. Their zeros lie at different places between two counts.
Recordings QuietRecordings(std::size_t count, std::uint64_t seed) {
  Recordings recordings;
  for (std::size_t k = 0; k < count; ++k) {
    SyntheticOptions run = Released(0.4 + 0.1 * static_cast<double>(k), seed + k);
    run.noise = 0;
    run.resolution = kCount;
    run.zero += 0.13 * kCount * static_cast<double>(seed + k);
    run.release_time += 0.0013 * static_cast<double>(k);
    recordings.push_back(Must(SimulateRecording(run)));
  }
  return recordings;
}

FitOptions QuietOptions() {
  FitOptions options = RigOptions();
  options.interval = IntervalMethod::kAuto;
  return options;
}

TEST(JointPosterior, CombinesPosteriorsOfQuietRecordings) {
  for (const std::uint64_t seed : {1, 4}) {
    const JointFit fit = FitAllJointly(QuietRecordings(3, seed), QuietOptions());
    ExpectConverged(fit);
    EXPECT_EQ(fit.whole.std_error_method, "posteriors of the separate recordings, combined as parabolas");
    for (const double deviation : Deviations(fit.whole, kTruthInSi)) EXPECT_LT(std::abs(deviation), 4) << seed;
  }
}

std::vector<Estimates> PartsOf(const std::vector<FitReport>& alone) {
  std::vector<Estimates> parts;
  for (const FitReport& fit : alone) parts.push_back(EstimatesOf(fit, kPhysical));
  return parts;
}

void ExpectCombined(const FitReport& joint, const Estimates& expected, double allowed) {
  for (std::size_t i = 0; i < kPhysical.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double error = std::sqrt(expected.covariance(row, row));
    const ParameterEstimate& parameter = *joint.Find(kPhysical[i]);
    EXPECT_THAT(parameter.estimate, DoubleNear(expected.value[row], allowed * error)) << kPhysical[i];
    ASSERT_TRUE(parameter.std_error);
    EXPECT_THAT(*parameter.std_error / error, DoubleNear(1, allowed)) << kPhysical[i];
  }
}

TEST(JointPosterior, IsTheWeightedMeanOfPosteriors) {
  const Recordings recordings = QuietRecordings(3, 1);
  const std::vector<FitReport> alone = FitAlone(recordings, QuietOptions());
  const JointFit fit = Must(TryJointly(recordings, alone, QuietOptions()));
  ExpectCombined(fit.whole, Combine(PartsOf(alone)), 1e-4);
}

// A prior as narrow as the joint error of inertia, at the joint estimate, reduces the error by √2. The factor
// would be √(1 + K) if the prior counted once for each of the K recordings.
TEST(JointPosterior, CountsAPriorOnASharedParameterOnce) {
  const Recordings recordings = QuietRecordings(3, 1);
  const Estimates combined = Combine(PartsOf(FitAlone(recordings, QuietOptions())));
  const double error = std::sqrt(combined.covariance(0, 0));
  FitOptions options = QuietOptions();
  options.priors = {{"inertia", {combined.value[0], error}}};
  const JointFit fit = FitAllJointly(recordings, options);
  EXPECT_EQ(fit.whole.std_error_method, "posteriors of the separate recordings, combined as parabolas");
  ASSERT_TRUE(fit.whole.Find("inertia")->std_error);
  // Posteriors are not exact parabolas, so a prior cannot be removed exactly. If counted twice it would leave 0.58.
  EXPECT_THAT(*fit.whole.Find("inertia")->std_error / error, DoubleNear(std::sqrt(0.5), 0.06));
}

}  // namespace
}  // namespace pendulum::fit_jointly_errors_test
