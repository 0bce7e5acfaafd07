// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/choose_swings.h"

#include <cstddef>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"

namespace pendulum::choose_swings_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::Ge;
using testing::Le;
using testing::Lt;
using testing::SizeIs;

/// Two recordings in sequence on one clock of 100 Hz; in between a hand moves the pendulum for 4 s.
Recording OneAfterTheOther(const Recording& first, const Recording& second) {
  constexpr Eigen::Index kMove = 400;
  const Eigen::ArrayXd share = Eigen::ArrayXd::LinSpaced(kMove, 1, kMove) / (kMove + 1);
  const double from = first.value[first.size() - 1];
  const Eigen::ArrayXd move = from + (second.value[0] - from) * share.square() * (3 - 2 * share);
  Recording both = first;
  both.value.resize(first.size() + kMove + second.size());
  both.value << first.value, move.matrix(), second.value;
  both.time = Eigen::ArrayXd::LinSpaced(both.value.size(), 0, static_cast<double>(both.value.size() - 1)) / 100;
  return both;
}

/// Released at 1.9 s and in free swing until 9 s; held again from 13 s on, released at 14.9 s from `angle` [rad],
/// recorded until 28 s.
Recording TwoReleases(double angle = 0.6) {
  SyntheticOptions second = NoisyRun("coulomb", 2);
  second.release_angle = angle;
  second.duration = 15;
  SyntheticOptions first = NoisyRun("coulomb", 1);
  first.duration = 9;
  return OneAfterTheOther(Must(SimulateRecording(first)), Must(SimulateRecording(second)));
}

ChosenSwings Choose(const SwingChoice& choice) { return Must(ChooseSwings(TwoReleases(), choice)); }

FreeSwing ChosenOne(const SwingChoice& choice) {
  const ChosenSwings swings = Choose(choice);
  EXPECT_THAT(swings.chosen, SizeIs(1));
  return swings.found.at(static_cast<std::size_t>(swings.chosen.front() - 1));
}

SwingChoice Between(double from, double to) { return {.from = from, .to = to}; }

constexpr double kOpen = std::numeric_limits<double>::quiet_NaN();

TEST(ChooseSwings, ChoosesTheSwingThatTellsMostByDefault) {
  const ChosenSwings swings = Choose({});
  EXPECT_THAT(swings.found, SizeIs(2));
  EXPECT_THAT(swings.chosen, ElementsAre(2));
  constexpr double kSmall = 0.1;  // rad; in the same noise its 13 s tell less than the 7 s of the first
  const ChosenSwings beside_small = Must(ChooseSwings(TwoReleases(kSmall), {}));
  EXPECT_THAT(beside_small.found, SizeIs(2));
  EXPECT_THAT(beside_small.chosen, ElementsAre(1));
}

TEST(ChooseSwings, ChoosesTheRequestedSwingOrAll) {
  EXPECT_THAT(Choose({.release = 1}).chosen, ElementsAre(1));
  EXPECT_THAT(Choose({.release = 2}).chosen, ElementsAre(2));
  EXPECT_THAT(Choose({.release = SwingChoice::kAll}).chosen, ElementsAre(1, 2));
}

TEST(ChooseSwings, RefusesTheNumberOfAMissingSwing) {
  const auto swings = ChooseSwings(TwoReleases(), {.release = 3});
  ASSERT_FALSE(swings);
  EXPECT_EQ(swings.error().code, StatusCode::kInvalidArgument);
  EXPECT_EQ(swings.error().message(), "there is no free swing 3 in the recording; it has 2");
  Recording named = TwoReleases();
  named.path = "two.csv";
  EXPECT_EQ(ChooseSwings(named, {.release = 3}).error().message(),
            "two.csv: there is no free swing 3 in the recording; it has 2");
}

TEST(ChooseSwings, BeginsOrEndsASwingAtAGivenBound) {
  const FreeSwing from = ChosenOne(Between(2.5, kOpen));
  EXPECT_THAT(from.from, AllOf(Ge(2.5), Lt(2.511)));
  EXPECT_THAT(from.to, Le(9.0));
  EXPECT_TRUE(from.from_given && !from.to_given);
  EXPECT_EQ(Sentence(from.begins), "as asked");
  const FreeSwing to = ChosenOne(Between(kOpen, 25));
  EXPECT_THAT(to.from, Ge(12.9));
  EXPECT_THAT(to.to, DoubleNear(25, 0.01));
  EXPECT_TRUE(!to.from_given && to.to_given);
  EXPECT_EQ(Sentence(to.ends), "as asked");
}

TEST(ChooseSwings, CountsReleasesWithinTheWindow) {
  EXPECT_THAT(Choose({.from = 11, .release = 1}).found, SizeIs(1));
  const FreeSwing second = ChosenOne({.from = 11, .release = 1});
  EXPECT_THAT(second.from, Ge(12.9));
  EXPECT_FALSE(second.from_given);
}

TEST(ChooseSwings, SkipsTheSearchIfBothBoundsAreGiven) {
  // The window includes the motion by hand and the second hold, which a search would exclude.
  const ChosenSwings swings = Choose(Between(3, 20));
  ASSERT_THAT(swings.found, SizeIs(1));
  EXPECT_THAT(swings.chosen, ElementsAre(1));
  EXPECT_THAT(swings.found[0].from, AllOf(Ge(3.0), Lt(3.011)));
  EXPECT_THAT(swings.found[0].to, DoubleNear(20, 0.01));
  EXPECT_TRUE(swings.found[0].from_given && swings.found[0].to_given);
  EXPECT_EQ(Sentence(swings.found[0].begins), "as asked");
  EXPECT_EQ(Sentence(swings.found[0].ends), "as asked");
}

TEST(ChooseSwings, RefusesAnEmptyWindow) {
  const auto swings = ChooseSwings(TwoReleases(), Between(5, 4));
  ASSERT_FALSE(swings);
  EXPECT_EQ(swings.error().code, StatusCode::kInvalidArgument);
  EXPECT_EQ(swings.error().message(), "the window [5, 4] s is empty; its start must be before its end");
}

TEST(ChooseSwings, NamesTheFileWithoutASwing) {
  Recording constant = Must(SimulateRecording(NoisyRun()));
  constant.path = "run.csv";
  constant.value.setConstant(0.3);
  const auto swings = ChooseSwings(constant, {});
  ASSERT_FALSE(swings);
  EXPECT_EQ(swings.error().code, StatusCode::kFailedPrecondition);
  EXPECT_EQ(swings.error().message(),
            "run.csv: the reading is constant, so there is no swing; check the sensor, or choose another column");
}

}  // namespace
}  // namespace pendulum::choose_swings_test
