// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/ambiguities.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/fitted_run.h"

namespace pendulum::ambiguities_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

constexpr double kGravity = 9.81;  // m/s²

/// The lowest eigenfrequency² [1/s²] of a pendulum with inertia I and first moment p on a massless support of stiffness
/// k that moves sideways: det [G - I w, -p w; -p w, k - m w] = 0 with w = ω².
double SquaredFrequencyOnSupport(double inertia, double first_moment, double mass, double stiffness) {
  const double gravity_torque = first_moment * kGravity;
  const double a = inertia * mass - first_moment * first_moment;
  const double b = -(inertia * stiffness + gravity_torque * mass);
  const double c = gravity_torque * stiffness;
  return 2 * c / (-b + std::sqrt(b * b - 4 * a * c));
}

// The pendulum of the textbook: 0.475 kg, G 1.803 N m, I_O 0.079 kg m². The frequency of the two coupled bodies gives
// the effective inertia G/ω².
TEST(InertiaOfYieldingSupport, IsThatOfTwoCoupledBodies) {
  const double mass = 0.475, gravity_torque = kTextbookTorque, inertia = 0.079;
  const double first_moment = gravity_torque / kGravity;
  for (const double stiffness : {1e5, 1e4}) {  // N/m
    const double squared = SquaredFrequencyOnSupport(inertia, first_moment, mass, stiffness);
    const double excess = gravity_torque / squared / inertia - 1;
    const double compliance = 1 / (stiffness - mass * squared);
    EXPECT_NEAR(InertiaOfYieldingSupport(gravity_torque, gravity_torque / inertia, kGravity, compliance) / excess, 1,
                2e-3);
    EXPECT_GT(excess, 0);
  }
}

// ∮ dθ / ω by the midpoint rule over θ = A sin φ.
double PeriodWithSpring(double amplitude, double spring) {
  constexpr int kSteps = 20000;
  const auto potential = [&](double angle) { return 2 * (1 - std::cos(angle)) + spring * angle * angle; };
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double phi = (i + 0.5) / kSteps * kPi / 2;
    const double angle = amplitude * std::sin(phi);
    sum += amplitude * std::cos(phi) / std::sqrt(potential(amplitude) - potential(angle)) * kPi / 2 / kSteps;
  }
  return 4 * sum;
}

// A spring of the share r of G changes T²(A) / T²(0) by r A²/8 to first order, which is compared with three standard
// deviations of the difference of two inertias, 3 √2 u.
TEST(SmallestVisibleSpring, IsTheOneThatChangesTheInertiaByThreeErrors) {
  constexpr double kError = 1e-4, kAmplitude = 0.5;
  const double spring = SmallestVisibleSpring(kError, kAmplitude);
  const auto ratio = [&](double share) {
    return std::pow(PeriodWithSpring(kAmplitude, share) / PeriodWithSpring(1e-3, share), 2);
  };
  EXPECT_NEAR((ratio(0) - ratio(spring)) / (3 * std::sqrt(2.0) * kError), 1, 0.1);
}

TEST(AmbiguitiesOf, HaveNumbersOfThePendulum) {
  const FitOfRun run = FitTo(NoisyRun("viscous"), "viscous", TextbookRig());
  const auto ambiguities = AmbiguitiesOf(run.fit, run.rig);
  ASSERT_THAT(ambiguities, SizeIs(testing::Ge(4u)));
  // G ω⁴ c / g² = 1.803 · (22.83)² · 1e-5 / 96.2 = 9.8e-5
  EXPECT_THAT(ambiguities[0].meaning, HasSubstr("a support that moves by 0.01 mm per newton adds 0.0098 % here"));
  EXPECT_THAT(ambiguities[1].experiment, HasSubstr("a swing of 90 deg beside a small one shows a spring from "));
  for (const Ambiguity& one : ambiguities) {
    EXPECT_FALSE(one.cause.empty() || one.meaning.empty() || one.experiment.empty());
  }
}

TEST(AmbiguitiesOf, SayThatGIsUnknownWithoutARig) {
  const auto ambiguities = AmbiguitiesOf(FitTo(NoisyRun("viscous"), "viscous", {}).fit, {});
  ASSERT_THAT(ambiguities, SizeIs(testing::Ge(4u)));
  EXPECT_THAT(ambiguities[0].meaning, Not(HasSubstr("here")));
  EXPECT_THAT(ambiguities[2].meaning, HasSubstr("no rig is given"));
}

// Without gravity the period depends on no amplitude, so nothing shows the sensor's gain.
TEST(AmbiguitiesOf, NameTheGainOfASpringsSensor) {
  SyntheticOptions run = NoisyRun("linear");
  const FitReport fit = FitTo(run, "linear", {}).fit;
  ASSERT_EQ(fit.termination, Termination::kConverged) << fit.reason;
  EXPECT_EQ(AmbiguitiesOf(fit, {}).back().cause, "a wrong gain of the sensor");
}

TEST(AmbiguitiesOf, AreEmptyWithoutAResult) {
  FitReport fit = FitTo(NoisyRun("viscous"), "viscous", {}).fit;
  fit.termination = Termination::kNotConverged;
  EXPECT_THAT(AmbiguitiesOf(fit, {}), IsEmpty());
}

}  // namespace
}  // namespace pendulum::ambiguities_test
