// SPDX-License-Identifier: Apache-2.0
// The shares of the losses that a fit reports, against the energy balance of simulated swings.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"

namespace pendulum::loss_shares_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::Ge;
using testing::Le;

/// A constant torque takes the torque times the path: its true share from the turning points of the simulated motion
/// alone. The motion is known at instants so close that a turning point is missed by less than 1e-9 rad.
class EnergyBalance {
 public:
  explicit EnergyBalance(const SyntheticOptions& run) : dry_(run.parameters[2]) {
    TraceOptions until;
    until.end = run.duration - 1 / run.sample_rate;
    const Trajectory motion = Must(MakeTrajectory(
        run.model, run.parameters, {StartKind::kRelease, run.release_time, run.release_angle, 0}, until));
    constexpr double kStep = 2e-5;  // s
    double last = run.release_angle, start = run.release_angle;
    bool rises = run.release_angle < 0;
    for (double time = run.release_time; time <= until.end; time += kStep) {
      const double angle = motion.Angle(time);
      if (angle != last && (angle > last) != rises) {  // `last` is a turning point
        AddHalfSwing(start, last);
        start = last;
        rises = !rises;
      }
      last = angle;
    }
    const double rate = motion.Rate(until.end), end = motion.Angle(until.end);
    path_ += std::abs(end - start);
    lost_ = -std::cos(run.release_angle) - (0.5 * run.parameters[0] * rate * rate - std::cos(end));
  }

  double whole() const { return dry_ * path_ / lost_; }
  double first_half_swing() const { return first_; }

 private:
  void AddHalfSwing(double from, double to) {
    if (path_ == 0) first_ = dry_ * std::abs(to - from) / (std::cos(to) - std::cos(from));
    path_ += std::abs(to - from);
  }

  double dry_ = 0, path_ = 0, lost_ = 0, first_ = 0;
};

const DerivedQuantity& Find(const FitReport& fit, const std::string& name) {
  return *std::ranges::find(fit.derived, name, &DerivedQuantity::name);
}

FitReport FitWithLosses(const SyntheticOptions& run) {
  FitOptions options = ModelOptions(run.model.name);
  options.with_losses = true;
  return Fit(Must(SimulateRecording(run)), options);
}

TEST(LossShares, AreThoseOfTheEnergyBalanceWithoutNoise) {
  SyntheticOptions run = TextbookRun("coulomb");
  const EnergyBalance balance(run);
  run.noise = 1e-7;
  const FitReport fit = FitWithLosses(run);
  EXPECT_THAT(Find(fit, "dry_loss_share").estimate, DoubleNear(balance.whole(), 1e-5));
  EXPECT_THAT(Find(fit, "dry_loss_share_first_half_swing").estimate, DoubleNear(balance.first_half_swing(), 1e-5));
}

TEST(LossShares, LieWithinTheirIntervalsIn95PercentOfSwings) {
  constexpr int kSwings = 1000;
  const EnergyBalance balance(NoisyRun());
  int whole = 0, first = 0;
  for (int seed = 1; seed <= kSwings; ++seed) {
    const FitReport fit = FitWithLosses(NoisyRun("coulomb", static_cast<std::uint64_t>(seed)));
    const auto contains = [&](const std::string& name, double truth) {
      const DerivedQuantity& share = Find(fit, name);
      return share.lower95 && *share.lower95 <= truth && truth <= *share.upper95;
    };
    whole += contains("dry_loss_share", balance.whole()) ? 1 : 0;
    first += contains("dry_loss_share_first_half_swing", balance.first_half_swing()) ? 1 : 0;
  }
  EXPECT_THAT(whole, AllOf(Ge(0.93 * kSwings), Le(0.97 * kSwings)));
  EXPECT_THAT(first, AllOf(Ge(0.93 * kSwings), Le(0.97 * kSwings)));
}

}  // namespace
}  // namespace pendulum::loss_shares_test
