// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/start/start_values.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/likelihood/fit_parameters.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::start_values_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;

constexpr int kSeeds = 20;
const double kFrequency = std::sqrt(kTextbookTorque / 0.079);  // rad/s
const double kPeriod = 2 * kPi / kFrequency;                   // s

StartValues StartOf(const SyntheticOptions& options, std::optional<StartKind> choice = std::nullopt) {
  return Must(EstimateStartValues(Must(SimulateRecording(options)), options.model, choice));
}

/// One count of noise, then rounded to counts, like a 10-bit potentiometer; for a rate, the same share of its peak.
SyntheticOptions Noisy(SyntheticOptions options, std::uint64_t seed) {
  options.noise = options.quantity == Quantity::kAngle ? kCount : 5 * kCount;
  if (options.quantity == Quantity::kAngle) options.resolution = kCount;
  options.seed = seed;
  return options;
}

/// The parameter with this name in a start's list.
double Parameter(const StartValues& start, const SyntheticOptions& options, std::string_view name) {
  const std::vector<ParameterInfo> infos = FitParameters(options.model, start.start, options.quantity);
  for (std::size_t i = 0; i < infos.size(); ++i) {
    if (infos[i].name == name) return start.parameters.at(i);
  }
  throw std::runtime_error("no parameter " + std::string(name));
}

// ---- Frequency, friction, zero -------------------------------------------------------------------------------------

TEST(EstimateStartValues, FindsTheFrequencyWithinOnePercentOnThreeCycles) {
  for (const Quantity quantity : {Quantity::kAngle, Quantity::kRate}) {
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      SyntheticOptions options = Noisy(MovingRun("coulomb"), seed);
      options.quantity = quantity;
      if (quantity == Quantity::kRate) options = Noisy(options, seed), options.resolution = 0;
      options.duration = 3 * kPeriod;
      EXPECT_THAT(StartOf(options).natural_frequency / kFrequency, DoubleNear(1, 0.01)) << "seed " << seed;
    }
  }
}

TEST(EstimateStartValues, CorrectsTheFrequencyForLargeSwings) {
  for (const double degrees : {30.0, 90.0, 150.0}) {
    SyntheticOptions options = TextbookRun("coulomb");
    options.release_angle = degrees * kRadFromDeg;
    EXPECT_THAT(StartOf(options).natural_frequency / kFrequency, DoubleNear(1, 0.005)) << degrees;
    options.quantity = Quantity::kRate;
    EXPECT_THAT(StartOf(options).natural_frequency / kFrequency, DoubleNear(1, 0.005)) << degrees << " rate";
  }
}

TEST(EstimateStartValues, FindTheFrequencyIfHalfTheRecordingIsAtRest) {
  SyntheticOptions options = TextbookRun("coulomb");
  options.parameters[2] *= 2;  // at rest after some 27 s
  options.duration = 60;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    EXPECT_THAT(StartOf(Noisy(options, seed)).natural_frequency / kFrequency, DoubleNear(1, 0.002)) << "seed " << seed;
  }
}

TEST(EstimateStartValues, GiveInertiaFrictionAndZeroInUnitsOfGravityTorque) {
  SyntheticOptions options = TextbookRun("drag");
  options.release_angle = 1.5;
  const StartValues start = StartOf(options);
  ASSERT_EQ(start.parameters.size(), 7);
  EXPECT_THAT(start.parameters[0] * kTextbookTorque / 0.079, DoubleNear(1, 0.01));
  EXPECT_THAT(start.parameters[1] * kTextbookTorque / 0.003, DoubleNear(1, 0.3));
  EXPECT_THAT(start.parameters[2] * kTextbookTorque / 0.004, DoubleNear(1, 0.1));
  EXPECT_THAT(start.parameters[3] * kTextbookTorque / 0.0005, DoubleNear(1, 0.3));
  EXPECT_THAT(start.parameters[6], DoubleNear(0.012, 1e-3));
  EXPECT_THAT(start.amplitude, DoubleNear(1.5, 0.1));
}

// ---- Held, then released -------------------------------------------------------------------------------------------

TEST(EstimateStartValues, FindTheReleaseWithinTwentyMilliseconds) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const SyntheticOptions options = Noisy(TextbookRun("coulomb"), seed);
    const StartValues start = StartOf(options);
    ASSERT_EQ(start.start, StartKind::kRelease) << "seed " << seed;
    EXPECT_THAT(Parameter(start, options, "release_time"), DoubleNear(1.9, 0.02)) << "seed " << seed;
    EXPECT_THAT(Parameter(start, options, "release_angle"), DoubleNear(0.423, 0.005)) << "seed " << seed;
    // Trials may be released up to the first sample visibly in motion: after the true release, before the first turn.
    EXPECT_THAT(start.latest_release, AllOf(Ge(1.9), Le(1.9 + 0.25 * kPeriod))) << "seed " << seed;
  }
}

TEST(EstimateStartValues, FindTheReleaseOfAnAngleThatIsNegativeOrLarge) {
  for (const double degrees : {-24.0, -120.0, 90.0, 170.0}) {
    SyntheticOptions options = TextbookRun("coulomb");
    options.release_angle = degrees * kRadFromDeg;
    const StartValues start = StartOf(options);
    ASSERT_EQ(start.start, StartKind::kRelease) << degrees;
    EXPECT_THAT(Parameter(start, options, "release_time"), DoubleNear(1.9, 0.02)) << degrees;
    EXPECT_THAT(Parameter(start, options, "release_angle"), DoubleNear(degrees * kRadFromDeg, 0.02)) << degrees;
  }
}

TEST(EstimateStartValues, FindTheReleaseSeenByARateSensor) {
  for (const double release_angle : {0.423, -0.423}) {
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      SyntheticOptions options = TextbookRun("coulomb");
      options.quantity = Quantity::kRate;
      options.release_angle = release_angle;
      const StartValues start = StartOf(Noisy(options, seed));
      ASSERT_EQ(start.start, StartKind::kRelease) << "seed " << seed;
      EXPECT_THAT(Parameter(start, options, "release_time"), DoubleNear(1.9, 0.02)) << "seed " << seed;
      EXPECT_THAT(Parameter(start, options, "release_angle"), DoubleNear(release_angle, 0.04)) << "seed " << seed;
      EXPECT_THAT(Parameter(start, options, "rate_bias"), DoubleNear(0.012, 0.02)) << "seed " << seed;
    }
  }
}

TEST(EstimateStartValues, FindTheReleaseSeenByANoisyRateSensor) {
  for (const double noise : {0.02, 0.06, 0.1, 0.2}) {  // the rate reaches 2 rad/s
    SyntheticOptions options = TextbookRun("coulomb");
    options.quantity = Quantity::kRate;
    options.release_time = 3;
    options.noise = noise;
    const StartValues start = Must(EstimateStartValues(Must(SimulateRecording(options)), options.model, std::nullopt));
    ASSERT_EQ(start.start, StartKind::kRelease) << noise;
    EXPECT_THAT(start.parameters[4], DoubleNear(3, 0.03)) << noise;
  }
}

TEST(EstimateStartValues, AcceptAnyHoldIfAReleaseIsRequested) {
  SyntheticOptions options = TextbookRun("coulomb");
  options.release_time = 0.05;  // 4 % of a period
  const Recording recording = Must(SimulateRecording(options));
  EXPECT_EQ(Must(EstimateStartValues(recording, options.model, std::nullopt)).start, StartKind::kMoving);
  const StartValues start = Must(EstimateStartValues(recording, options.model, StartKind::kRelease));
  EXPECT_EQ(start.start, StartKind::kRelease);
  EXPECT_THAT(start.parameters[4], DoubleNear(0.05, 0.02));
  EXPECT_TRUE(start.short_hold);
}

TEST(EstimateStartValues, MeasureTimeFromTheFirstSample) {
  SyntheticOptions options = TextbookRun("coulomb");
  options.start_time = 1000;
  options.release_time = 1001.9;
  const StartValues start = StartOf(options);
  EXPECT_THAT(Parameter(start, options, "release_time"), DoubleNear(1.9, 0.02));
  EXPECT_LT(start.latest_release, 3);
}

TEST(EstimateStartValues, TreatAShortHoldAsARelease) {
  SyntheticOptions options = TextbookRun("coulomb");
  options.release_time = 0.15 * kPeriod;
  EXPECT_EQ(StartOf(options).start, StartKind::kRelease);
  options.release_time = 0.05 * kPeriod;
  EXPECT_EQ(StartOf(options).start, StartKind::kMoving);
}

// ---- In motion -----------------------------------------------------------------------------------------------------

TEST(EstimateStartValues, FindAngleAndRateOfAStartInMotion) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const SyntheticOptions options = Noisy(MovingRun("coulomb"), seed);
    const StartValues start = StartOf(options);
    ASSERT_EQ(start.start, StartKind::kMoving) << "seed " << seed;
    EXPECT_EQ(start.latest_release, 0);
    EXPECT_THAT(Parameter(start, options, "initial_angle"), DoubleNear(-0.2, 0.02)) << "seed " << seed;
    EXPECT_THAT(Parameter(start, options, "initial_rate"), DoubleNear(1.5, 0.25)) << "seed " << seed;
  }
}

TEST(EstimateStartValues, FindAngleAndRateSeenByARateSensor) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SyntheticOptions options = MovingRun("coulomb");
    options.quantity = Quantity::kRate;
    const StartValues start = StartOf(Noisy(options, seed));
    ASSERT_EQ(start.start, StartKind::kMoving) << "seed " << seed;
    EXPECT_THAT(Parameter(start, options, "initial_angle"), DoubleNear(-0.2, 0.05)) << "seed " << seed;
    EXPECT_THAT(Parameter(start, options, "initial_rate"), DoubleNear(1.5, 0.05)) << "seed " << seed;
  }
}

TEST(EstimateStartValues, FindAnAngleBeyondTheHorizontalSeenByARateSensor) {
  for (const double degrees : {-150.0, -100.0, 60.0, 120.0, 150.0}) {
    SyntheticOptions options = MovingRun("viscous");
    options.quantity = Quantity::kRate;
    options.initial_angle = degrees * kRadFromDeg;
    options.initial_rate = 0.5;
    options.noise = 0.01;
    const StartValues start = Must(EstimateStartValues(Must(SimulateRecording(options)), options.model, std::nullopt));
    ASSERT_EQ(start.start, StartKind::kMoving) << degrees;
    EXPECT_THAT(start.parameters[2], DoubleNear(degrees * kRadFromDeg, 0.15)) << degrees;
  }
}

TEST(EstimateStartValues, TreatAStartAtATurningPointAsMotion) {
  SyntheticOptions options = MovingRun("coulomb");
  options.initial_angle = 0.4;
  options.initial_rate = 0;
  const StartValues start = StartOf(Noisy(options, 1));
  EXPECT_EQ(start.start, StartKind::kMoving);
  EXPECT_THAT(Parameter(start, options, "initial_angle"), DoubleNear(0.4, 0.01));
}

// ---- A start kind that the user requests ----------------------------------------------------------------------------

TEST(EstimateStartValues, RefuseAReleaseWithoutAHold) {
  const Recording recording = Must(SimulateRecording(MovingRun("coulomb")));
  const auto start = EstimateStartValues(recording, MovingRun("coulomb").model, StartKind::kRelease);
  ASSERT_FALSE(start);
  EXPECT_EQ(start.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(start.error().message(), HasSubstr("the recording does not begin with a hold"));
  EXPECT_THAT(start.error().message(), HasSubstr("--start moving"));
}

TEST(EstimateStartValues, UseTheRequestedStart) {
  EXPECT_EQ(StartOf(TextbookRun("coulomb"), StartKind::kRelease).start, StartKind::kRelease);
  EXPECT_EQ(StartOf(TextbookRun("coulomb"), StartKind::kMoving).start, StartKind::kMoving);
  EXPECT_EQ(StartOf(MovingRun("coulomb"), StartKind::kMoving).start, StartKind::kMoving);
}

TEST(EstimateStartValues, RefuseARecordingWithoutASwing) {
  SyntheticOptions options = TextbookRun("coulomb");
  options.duration = 2.2;  // released at 1.9 s, before the first turn
  const auto start = EstimateStartValues(Must(SimulateRecording(options)), options.model, std::nullopt);
  ASSERT_FALSE(start);
  EXPECT_EQ(start.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(start.error().message(), HasSubstr("are needed"));
}

}  // namespace
}  // namespace pendulum::start_values_test
