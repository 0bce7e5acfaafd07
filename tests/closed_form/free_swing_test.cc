// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/free_swing.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/closed_form/reference_swing.h"

namespace pendulum::free_swing_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::Each;
using testing::Field;
using testing::Ge;
using testing::Gt;
using testing::Le;
using testing::Lt;
using testing::SizeIs;
using testing::StartsWith;

constexpr double kRate = 100;                 // Hz
constexpr double kOmega = 5;                  // rad/s
constexpr double kHalfPeriod = kPi / kOmega;  // s, of a small swing
constexpr double kNoise = 0.002;              // rad
constexpr char kHeld[] = "held, then released";
constexpr char kInMotion[] = "in motion";
constexpr char kAfterAMove[] = "first turning point after the pendulum was moved";
constexpr char kUnsteady[] = "after the release: the hold before it is not steady";
constexpr char kToTheEnd[] = "end of recording";
constexpr char kBeforeAMove[] = "last turning point before the pendulum is moved";

// ---- Pieces of recordings -----------------------------------------------------------------------------------------

Recording Still(double angle, double duration) {
  return Sample([=](double) { return angle; }, duration, kRate);
}

/// A hand moves the pendulum from one angle to another, smoothly at both ends.
Recording Guided(double from, double to, double duration) {
  const auto share = [=](double t) { return t / duration * t / duration * (3 - 2 * t / duration); };
  return Sample([=](double t) { return from + (to - from) * share(t); }, duration, kRate);
}

/// Released at `amplitude`. It loses 5 % of its amplitude per second by viscous friction, and 0.004 rad per half swing
/// by dry friction.
Recording Swing(double amplitude, double duration, Quantity quantity = Quantity::kAngle) {
  Decay decay{kOmega, 0.004, 0.002, 0, std::abs(amplitude), duration, quantity};
  Recording recording = SimulateDecay(decay);
  if (amplitude < 0) recording.value *= -1;
  return recording;
}

/// The part with from <= t < to; its clock starts at 0.
Recording Part(const Recording& recording, double from, double to = 1e9) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    if (recording.time[i] > from - 1e-9 && recording.time[i] < to - 1e-9) kept.push_back(i);
  }
  Recording part = recording;
  part.time = recording.time(kept).array() - recording.time[kept.front()];
  part.value = recording.value(kept).eval();
  return part;
}

/// The pieces in sequence on one clock, with noise.
Recording Joined(const std::vector<Recording>& pieces, double noise = kNoise, std::uint64_t seed = 1) {
  std::vector<double> values;
  for (const Recording& piece : pieces) values.insert(values.end(), piece.value.begin(), piece.value.end());
  Recording joined = pieces.front();
  const auto count = static_cast<Eigen::Index>(values.size());
  joined.time = Eigen::ArrayXd::LinSpaced(count, 0, static_cast<double>(count - 1)) / kRate;
  joined.value = Eigen::Map<const Eigen::VectorXd>(values.data(), count);
  return WithNoise(Must(MakeRecording(std::move(joined))), noise, seed);
}

/// Time of the k-th passage through zero (k from 0).
double Crossing(const Recording& recording, int k) {
  for (Eigen::Index i = 1; i < recording.size(); ++i) {
    if (recording.value[i] * recording.value[i - 1] <= 0 && k-- == 0) return recording.time[i];
  }
  throw std::runtime_error("too few passages");
}

FreeSwing OnlySwing(const Recording& recording) {
  const std::vector<FreeSwing> swings = Must(FindFreeSwings(recording));
  EXPECT_THAT(swings, SizeIs(1));
  return swings.front();
}

double LastTime(const Recording& recording) { return recording.time[recording.size() - 1]; }

void ExpectWhole(const Recording& recording, const FreeSwing& swing) {
  EXPECT_EQ(swing.from, recording.time[0]);
  EXPECT_EQ(swing.to, LastTime(recording));
  EXPECT_EQ(Sentence(swing.ends), kToTheEnd);
  EXPECT_FALSE(swing.has_beats);
}

// ---- Where a swing begins -----------------------------------------------------------------------------------------

TEST(FindFreeSwings, IncludesAHoldAndItsRelease) {
  const Recording recording = Joined({Still(0.5, 2), Swing(0.5, 15)});
  const FreeSwing swing = OnlySwing(recording);
  ExpectWhole(recording, swing);
  EXPECT_EQ(Sentence(swing.begins), kHeld);
  EXPECT_FALSE(swing.from_given || swing.to_given);
}

TEST(FindFreeSwings, GivesTurningPointsHalfPeriodAndAmplitude) {
  const FreeSwing swing = OnlySwing(Joined({Still(0.5, 2), Swing(0.5, 15)}));
  EXPECT_THAT(swing.half_period, DoubleNear(kHalfPeriod, 0.005 * kHalfPeriod));
  EXPECT_THAT(swing.amplitude, DoubleNear(0.5, 0.01));
  ASSERT_THAT(swing.turns, SizeIs(Ge(22U)));  // 15 s of half swings of 0.63 to 0.64 s, and the hold
  for (std::size_t i = 2; i < swing.turns.size(); ++i) {
    EXPECT_THAT(swing.turns[i] - swing.turns[i - 1], DoubleNear(kHalfPeriod, 0.05 * kHalfPeriod)) << i;
  }
}

TEST(FindFreeSwings, IncludesAStartInMotionFromTheFirstSample) {
  for (const double from : {0.1, 0.25, 0.4, 0.55}) {  // of 0.64 s between the first two turning points
    SCOPED_TRACE(from);
    const Recording recording = Joined({Part(Swing(0.5, 15), from)});
    const FreeSwing swing = OnlySwing(recording);
    ExpectWhole(recording, swing);
    EXPECT_EQ(Sentence(swing.begins), kInMotion);
  }
}

TEST(FindFreeSwings, BeginsAtTheFirstTurningPointAfterAPush) {
  const Recording pushed = Part(Swing(0.5, 16), Crossing(Swing(0.5, 16), 0));  // at full speed
  const FreeSwing swing = OnlySwing(Joined({Still(0, 3), pushed}));
  EXPECT_EQ(Sentence(swing.begins), kAfterAMove);
  EXPECT_THAT(swing.from, DoubleNear(3 + kHalfPeriod / 2, 0.05));
}

TEST(FindFreeSwings, ExcludesDisturbancesBeforeAndAfter) {
  // Moved from rest to 0.5 rad in 0.8 s, held for 2 s, and caught after 12 s and put down.
  const Recording swing = Swing(0.5, 12);
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const FreeSwing found = OnlySwing(Joined(
        {Still(0, 1), Guided(0, 0.5, 0.8), Still(0.5, 2), swing, Guided(swing.value.tail(1)[0], 0.9, 1), Still(0.9, 3)},
        kNoise, seed));
    EXPECT_EQ(Sentence(found.begins), kHeld);
    EXPECT_THAT(found.from, AllOf(Ge(1.5), Lt(3.0)));
    EXPECT_THAT(found.to, AllOf(Ge(14.5), Le(15.9)));
  }
}

TEST(FindFreeSwings, DropsAHoldThatDrifts) {
  const auto creep = [](double t) { return 0.472 + 0.014 * t; };
  const FreeSwing creeping = OnlySwing(Joined({Sample(creep, 2, kRate), Swing(0.5, 15)}, 1e-4));
  EXPECT_EQ(Sentence(creeping.begins), kUnsteady);
  EXPECT_THAT(creeping.from, AllOf(Ge(1.99), Le(2.15)));
}

TEST(FindFreeSwings, DropsAHoldThatTrembles) {
  const auto trembling = [](double t) { return 0.5 + 0.01 * std::sin(40 * t); };
  const FreeSwing swing = OnlySwing(Joined({Sample(trembling, 2, kRate), Swing(0.5, 15)}));
  EXPECT_EQ(Sentence(swing.begins), kUnsteady);
  EXPECT_THAT(swing.from, AllOf(Ge(1.99), Le(2.15)));
}

TEST(FindFreeSwings, BeginsAtTheNextTurningPointAfterAReleaseNearTheUpright) {
  const double upright = 170 * kRadFromDeg;
  const FreeSwing swing = OnlySwing(Joined({Still(upright, 2), Swing(upright, 20)}));
  EXPECT_EQ(Sentence(swing.begins),
            "after the fall from 170 deg: so near the top the smallest push determines when it falls, so the release "
            "is not used");
  EXPECT_THAT(swing.from, AllOf(Ge(2 + kHalfPeriod), Le(2 + 4 * kHalfPeriod)));  // half a period from 165 deg: 1.7 s
  EXPECT_THAT(swing.turns.front(), DoubleNear(swing.from, 0.02));
  EXPECT_EQ(swing.heights.size() + 1, swing.turns.size());
  const double lower = 160 * kRadFromDeg;
  EXPECT_EQ(Sentence(OnlySwing(Joined({Still(lower, 2), Swing(lower, 20)})).begins), kHeld);
}

TEST(FindFreeSwings, FindsTheHoldOfARateSensor) {
  const Recording recording =
      Joined({Still(0, 2), Swing(0.5, 15, Quantity::kRate)}, 0.01);  // Joined takes the quantity from Still
  Recording rate = recording;
  rate.quantity = Quantity::kRate;
  const FreeSwing swing = OnlySwing(rate);
  ExpectWhole(rate, swing);
  EXPECT_EQ(Sentence(swing.begins), kHeld);
}

// ---- Where a swing ends -------------------------------------------------------------------------------------------

/// Dry friction stops a swing of 0.29 rad after seven half swings; each reduces the amplitude by 2 τ_c = 0.04 rad.
constexpr double kStop = 1 + 7 * kHalfPeriod;
Recording SwingToRest(double rest) {
  const Recording swing = SimulateDecay({kOmega, 0, 0.02, 0, 0.29, 7 * kHalfPeriod});
  return Joined({Still(0.29, 1), swing, Still(-0.01, rest)});
}

TEST(FindFreeSwings, EndsOnePeriodAfterTheMotion) {
  const FreeSwing swing = OnlySwing(SwingToRest(60));
  EXPECT_THAT(swing.to, AllOf(Ge(kStop + kHalfPeriod), Le(kStop + 5 * kHalfPeriod)));
  EXPECT_EQ(swing.ends.reason, WindowEnd::Reason::kAtRest);
  EXPECT_THAT(swing.ends.time, DoubleNear(swing.to - 2 * kHalfPeriod, 0.05));
}

TEST(FindFreeSwings, IncludesAShortStandstill) {
  const Recording recording = SwingToRest(2);
  ExpectWhole(recording, OnlySwing(recording));
}

TEST(FindFreeSwings, KeepsMotionBelowTheNoise) {
  // The amplitude at the end is 0.7 of the noise; one period of 126 samples shows it with five and a half standard
  // errors. Turning points can be detected up to 14 s. By chance a later one is found in the wrong place and ends the
  // swing.
  const auto decaying = [](double t) { return 0.5 * std::exp(-0.12 * t) * std::cos(kOmega * t); };
  int whole = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Recording recording = Joined({Sample(decaying, 30, kRate)}, 0.02, seed);
    const FreeSwing swing = Must(FindFreeSwings(recording)).front();
    EXPECT_EQ(swing.from, 0) << seed;
    EXPECT_THAT(swing.to, Ge(14.0)) << seed;
    whole += swing.to == LastTime(recording) ? 1 : 0;
  }
  EXPECT_THAT(whole, Ge(10));
}

TEST(FindFreeSwings, KeepsASwingWithNoise) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const Recording recording = Joined({Still(0.5, 2), Swing(0.5, 20)}, 0.04, seed);
    ExpectWhole(recording, OnlySwing(recording));
  }
}

TEST(FindFreeSwings, EndsASwingIfAHandBrakesThePendulum) {
  // At its thirteenth passage through the bottom it is slowed to the speed of a swing of 0.2 rad.
  const Recording swing = Swing(0.5, 20);
  const double brake = Crossing(swing, 12);
  const Recording after = Part(Swing(0.2, 12), Crossing(Swing(0.2, 12), 0));
  const std::vector<FreeSwing> swings = Must(FindFreeSwings(Joined({Part(swing, 0, brake), after})));
  ASSERT_THAT(swings, SizeIs(2));
  EXPECT_THAT(swings[0].to, AllOf(Gt(brake - kHalfPeriod), Lt(brake)));
  EXPECT_EQ(Sentence(swings[0].ends), kBeforeAMove);
  EXPECT_THAT(swings[1].from, AllOf(Gt(brake), Lt(brake + kHalfPeriod)));
}

TEST(FindFreeSwings, EndsASwingIfAHandStopsThePendulum) {
  const Recording swing = Swing(0.5, 20);
  const double stop = Crossing(swing, 12);
  const FreeSwing found = OnlySwing(Joined({Part(swing, 0, stop), Still(0, 6)}));
  EXPECT_EQ(Sentence(found.ends), "last turning point before the pendulum is stopped");
  EXPECT_THAT(found.to, AllOf(Gt(stop - kHalfPeriod), Lt(stop)));
}

// ---- Several swings, and disturbances within a swing --------------------------------------------------------------

TEST(FindFreeSwings, FindsEveryRelease) {
  const Recording recording = Joined({Still(0.5, 2), Swing(0.5, 12), Guided(Swing(0.5, 12).value.tail(1)[0], -0.8, 1),
                                      Still(-0.8, 2), Swing(-0.8, 10)});
  const std::vector<FreeSwing> swings = Must(FindFreeSwings(recording));
  ASSERT_THAT(swings, SizeIs(2));
  for (const FreeSwing& swing : swings) EXPECT_EQ(Sentence(swing.begins), kHeld);
  EXPECT_EQ(swings[0].from, 0);
  EXPECT_THAT(swings[0].to, AllOf(Gt(13.0), Lt(14.6)));
  EXPECT_THAT(swings[1].from, AllOf(Gt(14.5), Lt(16.5)));
  EXPECT_EQ(swings[1].to, LastTime(recording));
  EXPECT_THAT(swings[1].amplitude, DoubleNear(0.8, 0.01));
}

TEST(FindFreeSwings, KeepsASwingAcrossGaps) {
  const Recording whole = Joined({Still(0.5, 2), Swing(0.5, 25)});
  for (const auto& [from, to] : {std::pair(6.0, 6.5), std::pair(6.3, 8.0), std::pair(9.1, 13.3)}) {
    SCOPED_TRACE(to);
    const Recording recording = WithoutSamples(whole, from, to);
    const FreeSwing swing = OnlySwing(recording);
    ExpectWhole(recording, swing);
    EXPECT_EQ(Sentence(swing.begins), kHeld);
  }
}

TEST(FindFreeSwings, EndsASwingAtAGapOfManySwings) {
  // The gap begins at any phase and lasts for longer than the readings and for more than 20 half swings.
  for (double gap = 15; gap < 15 + 2 * kHalfPeriod; gap += 0.1) {
    SCOPED_TRACE(gap);
    Recording recording = Joined({Still(0.5, 2), Swing(0.5, 25)});
    for (Eigen::Index i = 0; i < recording.size(); ++i) recording.time[i] += recording.time[i] > gap ? 36000 : 0;
    const std::vector<FreeSwing> swings = Must(FindFreeSwings(recording));
    ASSERT_THAT(swings, SizeIs(2));
    EXPECT_THAT(swings[0].to, DoubleNear(gap, 0.02));
    EXPECT_EQ(Sentence(swings[0].ends), "a gap of 3.6e+04 s follows, which hides too many swings to bridge");
    EXPECT_THAT(swings[1].from, DoubleNear(36000 + gap, 0.02));
    EXPECT_EQ(swings[1].begins.reason, WindowBegin::Reason::kAfterGap);
    EXPECT_EQ(swings[1].to, LastTime(recording));
  }
}

TEST(FindFreeSwings, TreatsEqualGapsAlike) {
  // Every 60 s the logger records 3 s.
  Recording recording = Swing(0.5, 40);
  for (Eigen::Index i = 0; i < recording.size(); ++i) recording.time[i] += 57.02 * std::floor(recording.time[i] / 3);
  const std::vector<FreeSwing> swings = Must(FindFreeSwings(recording));
  EXPECT_THAT(swings, SizeIs(Ge(10)));
  for (const FreeSwing& swing : swings) EXPECT_THAT(swing.to - swing.from, Le(3.0));
}

TEST(FindFreeSwings, EndsASwingAtAGapOfManySwingsBeforeAFewReadings) {
  Recording recording = Joined({Still(0.5, 2), Swing(0.5, 25)});
  recording.time.tail(20).array() += 36000;
  const FreeSwing swing = OnlySwing(recording);
  EXPECT_EQ(swing.ends.reason, WindowEnd::Reason::kBeforeGap);
  EXPECT_EQ(swing.to, recording.time[recording.size() - 21]);
}

TEST(FindFreeSwings, EndsASwingAtATimeSlip) {
  // Between two turning points, two samples are lost without a gap in the time stamps: a thirtieth of a half swing.
  const Recording swing = Joined({Still(0.5, 2), Swing(0.5, 25)}, 0.0005);
  Recording slipped = WithoutSamples(swing, 14.2, 14.225);
  ASSERT_EQ(slipped.size(), swing.size() - 2);
  slipped.time = Eigen::ArrayXd::LinSpaced(slipped.size(), 0, static_cast<double>(slipped.size() - 1)) / kRate;
  const std::vector<FreeSwing> swings = Must(FindFreeSwings(slipped));
  ASSERT_THAT(swings, SizeIs(2));
  EXPECT_THAT(swings[0].to, AllOf(Gt(14.2 - 1.1 * kHalfPeriod), Le(14.21)));
  EXPECT_THAT(swings[1].from, AllOf(Ge(14.19), Lt(14.2 + 1.1 * kHalfPeriod)));
}

TEST(FindFreeSwings, KeepsASwingWithOneOutlyingTurningPoint) {
  const Recording whole = Joined({Still(0.5, 2), Swing(0.5, 25)});
  for (const double further : {0.15, -0.15}) {
    SCOPED_TRACE(further);
    Recording recording = whole;
    const double turn = OnlySwing(whole).turns.at(12);
    for (Eigen::Index i = 0; i < recording.size(); ++i) {
      const double share = std::min(std::abs(recording.time[i] - turn) / 0.3, 1.0);
      recording.value[i] *= 1 + further * std::pow(std::cos(0.5 * kPi * share), 2);
    }
    ExpectWhole(recording, OnlySwing(recording));
  }
}

TEST(FindFreeSwings, MarksABeatingSwing) {
  // Two modes with nearly the same frequency: the amplitude rises and falls every 6.3 s and decays.
  const auto two = [](double t) {
    return std::exp(-0.03 * t) * (0.3 * std::cos(kOmega * t) + 0.2 * std::cos(1.2 * kOmega * t));
  };
  const Recording recording = Joined({Sample(two, 40, kRate)});
  const FreeSwing swing = OnlySwing(recording);
  EXPECT_TRUE(swing.has_beats);
  EXPECT_THAT(swing.from, Le(kHalfPeriod));
  EXPECT_THAT(swing.to, Ge(39.0));
}

// ---- What is not a free swing -------------------------------------------------------------------------------------

std::string ErrorMessage(const Recording& recording) {
  const auto swings = FindFreeSwings(recording);
  if (swings) return "accepted";
  EXPECT_EQ(swings.error().code, StatusCode::kFailedPrecondition);
  return swings.error().message();
}

TEST(FindFreeSwings, RefusesAConstantReading) {
  EXPECT_EQ(ErrorMessage(Still(0.3, 10)),
            "the reading is constant, so there is no swing; check the sensor, or choose another column");
}

TEST(FindFreeSwings, RefusesAReadingWithoutTurningPoints) {
  EXPECT_EQ(ErrorMessage(Joined({Still(0.3, 2), Guided(0.3, 0, 1), Still(0, 5)})),
            "turning points above the noise between neighbouring samples: 0; at least three turning points, with five "
            "samples or more between them, are needed: choose a window of free swing, or record for longer");
}

TEST(FindFreeSwings, RefusesADrivenSwing) {
  const auto growing = [](double t) { return 0.1 * std::exp(0.05 * t) * std::sin(kOmega * t); };
  EXPECT_EQ(ErrorMessage(Joined({Sample(growing, 30, kRate)})),
            "the amplitude rises repeatedly: the pendulum is driven; choose a window of free swing with --from and "
            "--to");
  const auto steady = [](double t) { return 0.4 * std::sin(kOmega * t); };
  EXPECT_EQ(ErrorMessage(Joined({Sample(steady, 20, kRate)})),
            "the amplitude does not decay over 31 half swings: the pendulum is driven, or its friction is too small to "
            "see; give --from and --to to fit this window anyway");
}

/// Driven at resonance for 30 s, steadily or from rest; then the drive ends and the swing decays by `rate` [1/s].
Recording DrivenThenFree(double rate, bool from_rest) {
  const auto angle = [=](double t) {
    const double amplitude = from_rest ? 0.8 * (1 - std::exp(-rate * std::min(t, 30.0))) : 0.8;
    return amplitude * std::exp(-rate * std::max(t - 30, 0.0)) * std::cos(kOmega * t);
  };
  return Joined({Sample(angle, 30 + 30 * std::max(1.0, 0.02 / rate), kRate)});
}

TEST(FindFreeSwings, BeginsAfterASteadyDrive) {
  for (const double rate : {0.01, 0.015, 0.02, 0.05, 0.2}) {
    const auto swings = FindFreeSwings(DrivenThenFree(rate, false), true);
    ASSERT_TRUE(swings.has_value()) << swings.error().message();
    ASSERT_THAT(*swings, SizeIs(1));
    EXPECT_EQ(swings->front().begins.reason, WindowBegin::Reason::kAfterDrive) << rate;
    EXPECT_THAT(swings->front().from, AllOf(Ge(30.0 - kHalfPeriod), Le(30 + 4 * kHalfPeriod + 0.01 / rate))) << rate;
  }
}

TEST(FindFreeSwings, ProposesTheDecayAfterADriveFromRest) {
  const auto swings = FindFreeSwings(DrivenThenFree(0.1, true), true);
  ASSERT_FALSE(swings.has_value());
  EXPECT_THAT(swings.error().message(),
              StartsWith("the amplitude rises repeatedly: the pendulum is driven; if the drive "
                         "ends at "));
  ASSERT_THAT(swings.error().try_flags, SizeIs(1));
  EXPECT_THAT(std::stod(swings.error().try_flags.front().substr(7)),
              AllOf(Ge(30.0 - kHalfPeriod), Le(30 + 4 * kHalfPeriod)));
}

/// Beside a gap, turning points lie too far out.
TEST(FindFreeSwings, TakesNoOutliersForADrive) {
  Recording recording = SimulateDecay({kOmega, 0.004, 0, 0, 0.8, 60});
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    if (std::abs(recording.time[i] - 12) < 1.5 * kHalfPeriod) recording.value[i] *= 1.3;
  }
  const auto swings = FindFreeSwings(recording);
  ASSERT_TRUE(swings.has_value()) << swings.error().message();
  for (const FreeSwing& swing : *swings) EXPECT_NE(swing.begins.reason, WindowBegin::Reason::kAfterDrive);
}

TEST(FindFreeSwings, TakesNoFreeSwingForADrive) {
  for (const auto& decay :
       {Decay{kOmega, 0, 0.004, 0, 0.8, 60}, Decay{kOmega, 0.01, 0, 0, 0.8, 60}, Decay{kOmega, 0, 0, 0.004, 0.8, 60}}) {
    const auto swings = FindFreeSwings(SimulateDecay(decay));
    ASSERT_TRUE(swings.has_value()) << swings.error().message();
    EXPECT_NE(swings->front().begins.reason, WindowBegin::Reason::kAfterDrive);
  }
}

TEST(FindFreeSwings, DoesNotTreatAStartInMotionAsARiseOfTheAmplitude) {
  // It loses about 0.4 % of its amplitude per half swing, and starts where it passes its rest position.
  const Recording swing = SimulateDecay({kOmega, 0, 0.001, 0, 0.5, 9});
  const Recording recording = Joined({Part(swing, Crossing(swing, 0))}, 0.01);
  ExpectWhole(recording, OnlySwing(recording));
}

TEST(FindFreeSwings, RefusesAPendulumMovedByHand) {
  const double angles[] = {0.0, 0.5, -0.3, 0.8, 0.1, 0.6, -0.5, 0.7, -0.1, 0.9, 0.2};
  std::vector<Recording> pieces;
  for (std::size_t i = 1; i < std::size(angles); ++i) {
    pieces.push_back(Still(angles[i - 1], 1.5 + 0.4 * static_cast<double>(i % 3)));
    pieces.push_back(Guided(angles[i - 1], angles[i], 0.6 + 0.2 * static_cast<double>(i % 4)));
  }
  EXPECT_EQ(
      ErrorMessage(Joined(pieces)),
      "of 10 turning points no more than 3 in a row belong to a free swing, with equal times between them and "
      "decreasing amplitude: the pendulum was moved by hand or motor, or held at one angle after another; choose a "
      "window of free swing with --from and --to");
}

TEST(FindFreeSwings, AsksForTheUnitIfASwingExceedsTheUpright) {
  const Recording in_degrees =
      Sample([](double t) { return 25 * std::exp(-0.02 * t) * std::cos(kOmega * t); }, 20, kRate);
  EXPECT_THAT(ErrorMessage(in_degrees),
              testing::HasSubstr("to both sides, but beyond 180 deg a pendulum goes over the top; "
                                 "check the unit of the column in the header or in"));
  EXPECT_THAT(FindFreeSwings(in_degrees, true).value(), testing::SizeIs(1));  // a torsion wire
}

TEST(FindFreeSwings, AsksForTheUnitIfARateExceedsTheUpright) {
  Recording rate = Sample([](double t) { return 125 * std::exp(-0.02 * t) * std::cos(kOmega * t); }, 20, kRate);
  rate.quantity = Quantity::kRate;
  EXPECT_THAT(ErrorMessage(rate), testing::AllOf(testing::StartsWith("a rate of 1"),
                                                 testing::HasSubstr("means that the pendulum swings by 2"),
                                                 testing::HasSubstr("check the unit of the column")));
}

TEST(FindFreeSwings, DoesNotTreatCountsAsAnAngle) {
  Recording counts = Joined({Still(0.4, 1), Swing(0.4, 10)});
  counts.value = 500 + 300 * counts.value.array();
  counts.unit = "counts";
  EXPECT_EQ(Sentence(OnlySwing(counts).begins), kHeld);
}

}  // namespace
}  // namespace pendulum::free_swing_test
