// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/effects/effect_columns.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/fitting/fitted.h"

namespace pendulum::effect_columns_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

std::vector<Index> AllOf(const Fitted& fitted) {
  std::vector<Index> all(static_cast<std::size_t>(fitted.recording.size()));
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

SensorErrors Errors(double size) {
  SensorErrors errors;
  errors.kind = "angle sensor";
  for (const SensorEffect effect : kSensorEffects) errors.Of(effect).std_dev = size;
  return errors;
}

EffectColumns ColumnsAt(const Fitted& fitted, const SensorErrors& errors) {
  return EffectColumnsAt(errors, *fitted.problem, *fitted.cost, fitted.solution, AllOf(fitted));
}

Index CountOf(const EffectColumns& columns, Cause cause) {
  return std::ranges::count(columns.effects, cause, &Effect::cause);
}

VectorXd FirstOf(const EffectColumns& columns, Cause cause) {
  const auto found = std::ranges::find(columns.effects, cause, &Effect::cause);
  return columns.columns.col(found - columns.effects.begin());
}

Fitted ReleasedFit() { return FitWithInternals(Must(SimulateRecording(NoisyRun())), ModelOptions("coulomb")); }

TEST(EffectColumns, OfGainAndLagAreTheSwingAndMinusItsRate) {
  const Fitted fitted = ReleasedFit();
  const EffectColumns columns = ColumnsAt(fitted, Errors(0.01));
  const double zero = fitted.solution.parameters.back();
  const VectorXd swing = fitted.solution.readings.array() - zero;
  EXPECT_LT((FirstOf(columns, Cause::kGain) - swing).cwiseAbs().maxCoeff(), 1e-9);
  const VectorXd lag = FirstOf(columns, Cause::kLag);
  const VectorXd& time = fitted.recording.time;
  for (Index i = 400; i + 1 < swing.size(); i += 37) {
    const double rate = (swing[i + 1] - swing[i - 1]) / (time[i + 1] - time[i - 1]);
    EXPECT_NEAR(lag[i], -rate, 0.01);
  }
}

// The reading stays until the pendulum has crossed the gap, then follows at half the gap's width behind.
TEST(EffectColumns, OfAPlayFollowAtTheEndsOfTheGap) {
  constexpr double kWidth = 0.02;  // rad
  const Fitted fitted = ReleasedFit();
  const VectorXd column = FirstOf(ColumnsAt(fitted, Errors(kWidth)), Cause::kBacklash);
  const VectorXd swing = fitted.solution.readings.array() - fitted.solution.parameters.back();
  const VectorXd shown = swing + kWidth * column;
  Index turns = 0, jumps = 0, stays = 0;
  for (Index i = 1; i + 1 < swing.size(); ++i) {
    EXPECT_LE(std::abs(column[i]), 0.5 + 1e-9);
    const bool is_released = fitted.recording.time[i] > 2;
    if (!is_released) continue;
    if ((swing[i] - swing[i - 1]) * (swing[i + 1] - swing[i]) < 0) ++turns;
    const double moved = std::abs(shown[i] - shown[i - 1]);
    if (moved < 1e-12) ++stays;
    if (moved > 1e-12 && std::abs(column[i]) < 0.5 - 1e-9) ++jumps;  // from before a turning point to after it
  }
  EXPECT_GT(turns, 10);
  EXPECT_LE(jumps, turns);
  EXPECT_GE(stays, turns);
}

TEST(EffectColumns, OfAPlayAreZeroInAHold) {
  const Fitted fitted = ReleasedFit();
  const VectorXd column = FirstOf(ColumnsAt(fitted, Errors(0.02)), Cause::kBacklash);
  for (Index i = 0; fitted.recording.time[i] < 1.8; ++i) EXPECT_EQ(column[i], 0) << i;
}

TEST(EffectColumns, OfAnIdealSensorAreThoseOfHandAndFrictionAlone) {
  const EffectColumns columns = ColumnsAt(ReleasedFit(), Errors(0));
  for (const Effect& effect : columns.effects) EXPECT_FALSE(IsOfSensor(effect.cause)) << CauseName(effect.cause);
  EXPECT_EQ(CountOf(columns, Cause::kPush), 1);
  EXPECT_EQ(CountOf(columns, Cause::kHold), 2);
}

TEST(EffectColumns, OfTheHoldEndAtTheRelease) {
  const Fitted fitted = ReleasedFit();
  const VectorXd hold = FirstOf(ColumnsAt(fitted, Errors(0)), Cause::kHold);
  for (Index i = 0; i < hold.size(); ++i) {
    const double since_release = fitted.recording.time[i] - 1.9;
    if (std::abs(since_release) > 1e-3) {
      EXPECT_EQ(hold[i], since_release < 0 ? 1 : 0) << i;
    }
  }
}

TEST(EffectColumns, LeaveOutFrictionThatTheLawHas) {
  const auto law_columns = [](std::string_view model) {
    const Fitted fitted = FitWithInternals(Must(SimulateRecording(NoisyRun("coulomb"))), ModelOptions(model));
    return CountOf(ColumnsAt(fitted, Errors(0)), Cause::kFrictionLaw);
  };
  EXPECT_EQ(law_columns("viscous"), law_columns("coulomb") + 1);  // dry friction
  EXPECT_EQ(law_columns("coulomb"), law_columns("drag") + 1);     // the square of the rate
}

TEST(EffectColumns, OfNonlinearityAreAtMostOne) {
  const EffectColumns columns = ColumnsAt(ReleasedFit(), Errors(0.01));
  EXPECT_EQ(CountOf(columns, Cause::kNonlinearity), 6);
  for (std::size_t k = 0; k < columns.effects.size(); ++k) {
    if (columns.effects[k].cause != Cause::kNonlinearity) continue;
    EXPECT_LE(columns.columns.col(static_cast<Index>(k)).cwiseAbs().maxCoeff(), 1 + 1e-12);
  }
}

}  // namespace
}  // namespace pendulum::effect_columns_test
