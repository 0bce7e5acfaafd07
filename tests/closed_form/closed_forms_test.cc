// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/closed_forms.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "tests/closed_form/reference_swing.h"

namespace pendulum::closed_forms_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr MotionModel kViscousModel = {"viscous", "viscous", Gravity::kSine};
constexpr double kTorque = 1.803;  // N m

/// The rig of the activity "Modeling of a Simple Pendulum" (Control Tutorials for MATLAB and Simulink) with its
/// published results: I_O 0.079 kg m^2, b 0.003 N m s/rad, released from 0.423 rad, 0.1985 deg per count.
Decay Published() {
  Decay decay;
  decay.natural_frequency = std::sqrt(kTorque / 0.079);
  decay.viscous = 0.003 / kTorque;
  decay.amplitude = 0.423;
  decay.duration = 18;
  return decay;
}

Recording Read(const Decay& decay) {
  Recording recording = WithNoise(SimulateDecay(decay), 1e-3, 1);
  recording.resolution = 0.1985 * kRadFromDeg;
  recording.value = recording.resolution * ((recording.value.array() + 0.01) / recording.resolution).round();
  return recording;
}

TEST(ClosedForms, ReproduceThePublishedNumbersOfTheTextbookRig) {
  const ClosedForms forms = Must(EstimateClosedForms(Read(Published()), kViscousModel));
  const auto five = ApplyLogDecrement(forms.table, Gravity::kSine, 0, 5);  // six maxima, five periods
  ASSERT_TRUE(five);
  EXPECT_NEAR(five->damped_frequency.value, 4.8, 0.1);
  EXPECT_NEAR(five->damping_ratio.value, 0.004, 0.0005);
  EXPECT_NEAR(kTorque * five->inertia.value, 0.079, 0.002);
  EXPECT_NEAR(kTorque * five->viscous.value, 0.003, 0.0005);
  // Single pairs have errors of 5 percent, five periods together 1 percent.
  EXPECT_NEAR(forms.decay[0].pair->std_error / five->damping_ratio.std_error, 5, 1.5);
}

TEST(ClosedForms, QuantifyTheFiniteAmplitudeBiasOfTheInertia) {
  const ClosedForms forms = Must(EstimateClosedForms(Read(Published()), kViscousModel));
  ASSERT_TRUE(forms.linear && forms.decrement);
  // To second order the period is longer by A²/16 and the inertia by A²/8, over amplitudes that fall from 0.42 to 0.30.
  const double last = forms.table.Amplitude(forms.linear->first + 2U * static_cast<unsigned>(forms.linear->periods));
  const double mean_square = (0.42 * 0.42 + 0.42 * last + last * last) / 3;
  const double excess = forms.linear->inertia.value / forms.decrement->inertia.value - 1;
  EXPECT_NEAR(excess, mean_square / 8, 0.05 * excess);
  EXPECT_NEAR(forms.linear->corrected_inertia.value, 0.079 / kTorque, 4 * forms.linear->corrected_inertia.std_error);
}

TEST(ClosedForms, ReportWhichLawTheEnvelopeFollows) {
  const ClosedForms forms = Must(EstimateClosedForms(Read(Published()), kViscousModel));
  EXPECT_THAT(forms.envelope, StartsWith("as exponential (viscous friction only"));
  EXPECT_THAT(forms.envelope, HasSubstr("not as straight line (coulomb"));
  EXPECT_EQ(forms.wrong_law, "");
}

TEST(ClosedForms, ReportAModelWithTheWrongFriction) {
  Decay decay = Published();
  decay.coulomb = 0.003 / kTorque;
  const ClosedForms forms = Must(EstimateClosedForms(Read(decay), kViscousModel));
  EXPECT_THAT(forms.wrong_law, HasSubstr("with viscous friction"));
  EXPECT_THAT(forms.envelope, StartsWith("no single friction term"));
}

TEST(ClosedForms, UseTrueSecondsOnAWrongClock) {
  Recording recording = Read(Published());
  const ClosedForms right = Must(EstimateClosedForms(recording, kViscousModel));
  recording.time = 100 + recording.time.array() / 1.25;  // a clock that advances 1 s in 1.25 s
  recording.clock_scale = 1.25;
  const ClosedForms forms = Must(EstimateClosedForms(recording, kViscousModel));
  EXPECT_NEAR(forms.linear->inertia.value / right.linear->inertia.value, 1, 1e-6);
  EXPECT_NEAR(forms.decrement->friction[0].value / right.decrement->friction[0].value, 1, 1e-4);
  EXPECT_NEAR(forms.table.points[3].time, 100 + right.table.points[3].time / 1.25, 1e-6);
}

TEST(ClosedForms, OmitTheDecrementForFewTurningPoints) {
  Decay decay = Published();
  decay.duration = 2.3;  // three turning points, the last one near the end
  const MotionModel drag = {"drag", "drag", Gravity::kSine};
  const ClosedForms forms = Must(EstimateClosedForms(Read(decay), drag));
  EXPECT_EQ(forms.table.points.size(), 3U);
  EXPECT_TRUE(forms.linear);
  EXPECT_FALSE(forms.decrement);
  EXPECT_THAT(forms.no_decrement, HasSubstr("too few"));
}

}  // namespace
}  // namespace pendulum::closed_forms_test
