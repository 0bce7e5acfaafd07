// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/closed_form_check.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/closed_form/period.h"
#include "tests/analysis/checked_run.h"

namespace pendulum::closed_form_check_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Le;
using testing::Not;

constexpr const char* kFiniteAmplitude = "finite amplitude";
constexpr const char* kFormulasFriction = "the formula's friction";
constexpr const char* kSampling = "too few samples";
constexpr const char* kResolution = "the sensor's resolution";
constexpr const char* kFrictionLaw = "the friction law";

/// The part of a row's difference that is attributed to a cause: the number before " by " and the cause.
double PartBy(const std::string& cause, const ClosedFormRow& row) {
  const std::size_t by = row.why.find(" by " + cause);
  if (by == std::string::npos) return std::numeric_limits<double>::quiet_NaN();
  const std::size_t number = row.why.find_last_of(' ', by - 1) + 1;
  return std::strtod(row.why.c_str() + number, nullptr);
}

/// Number of half swings from the release to the first turning point of the linear formulas.
int HalfSwingsBefore(const CheckedRun& checked) {
  const LogDecrement& linear = *checked.forms.linear;
  const double since = checked.forms.table.points[linear.first].time - 1.9;
  return static_cast<int>(std::lround(since / checked.forms.table.half_period));
}

// ---- Known causes --------------------------------------------------------------------------------------------------

// The formula attributes the longer period of large swings to inertia: I0 times the squared mean of T(A) / T(0). A is
// computed from the release angle.
TEST(CheckClosedForms, AttributesTheInertiaDifferenceOfLargeSwingsToFiniteAmplitude) {
  const CheckedRun checked = CheckRun(NoisyTextbookRun("viscous"), "viscous", TextbookRig());
  const double decay = std::exp(-kPi * 0.003 / (2 * std::sqrt(0.079 * kTextbookTorque)));
  const int half_swings = 2 * checked.forms.linear->periods;
  double ratio = 0;
  for (int i = 0; i < half_swings; ++i) {
    ratio += SineGravity::PeriodRatio(0.423 * std::pow(decay, HalfSwingsBefore(checked) + i + 0.5)) / half_swings;
  }
  const ClosedFormRow& row = checked.Row("inertia_small_angle");
  const double bias = 0.079 * (ratio * ratio - 1);
  EXPECT_EQ(row.agrees, false);
  EXPECT_THAT(PartBy(kFiniteAmplitude, row) / bias, DoubleNear(1, 0.05));
  EXPECT_THAT((row.closed_form - row.fit) / bias, DoubleNear(1, 0.05));
  for (const char* other : {kFormulasFriction, kSampling, kResolution, kFrictionLaw, "noise"}) {
    EXPECT_THAT(row.why, Not(HasSubstr(other)));
  }
  EXPECT_EQ(checked.Row("inertia_elliptic_period").agrees, true);
  EXPECT_EQ(checked.Row("inertia_turning_points").agrees, true);
}

TEST(CheckClosedForms, AgreesCompletelyAtSmallAngles) {
  SyntheticOptions run = TextbookRun("viscous");
  run.release_angle = 0.05;
  run.noise = 0.0002;
  const CheckedRun checked = CheckRun(run, "viscous");
  for (const ClosedFormRow& row : checked.check.rows) {
    EXPECT_EQ(row.agrees, true) << row.quantity << " " << row.why;
    EXPECT_EQ(row.why, "") << row.quantity;
  }
  EXPECT_EQ(checked.check.summary,
            "7 of 7 closed forms agree with the fit within 3 standard deviations of the difference");
}

// With viscous and dry friction the amplitude of small swings changes by A -> (A - τ) e^(-π ζ) - τ per half swing
// (Feeny & Liang 1996). The log decrement attributes all of the loss to viscous friction.
TEST(CheckClosedForms, AttributesDryFrictionsDecrementToTheFormula) {
  const CheckedRun checked = CheckRun(NoisyTextbookRun("coulomb"), "coulomb");
  const double sticking = 0.004 / kTextbookTorque;
  const double damping = 0.003 / (2 * std::sqrt(0.079 * kTextbookTorque));
  std::vector<double> amplitudes = {0.423};
  for (int i = 0; i < 40; ++i)
    amplitudes.push_back((amplitudes.back() - sticking) * std::exp(-kPi * damping) - sticking);
  const int first = HalfSwingsBefore(checked);
  const int periods = checked.forms.linear->periods;
  const double decrement = std::log(amplitudes.at(static_cast<std::size_t>(first)) /
                                    amplitudes.at(static_cast<std::size_t>(first + 2 * periods))) /
                           periods;
  const ClosedFormRow& row = checked.Row("damping_ratio_log_decrement");
  EXPECT_EQ(row.agrees, false);
  EXPECT_THAT(PartBy(kFormulasFriction, row) / (decrement / (2 * kPi) - damping), DoubleNear(1, 0.03));
  EXPECT_THAT(checked.Row("viscous_log_decrement").why, HasSubstr(kFormulasFriction));
  for (const char* exact : {"viscous_turning_points", "coulomb_turning_points", "inertia_turning_points"}) {
    EXPECT_EQ(checked.Row(exact).agrees, true) << exact;
  }
  EXPECT_THAT(checked.check.summary, Not(HasSubstr("wrong friction law")));
  EXPECT_EQ(checked.check.unexplained, "");
}

TEST(CheckClosedForms, NamesAWrongFrictionLaw) {
  const CheckedRun checked = CheckRun(NoisyTextbookRun("coulomb"), "viscous");
  for (const char* quantity : {"viscous_log_decrement", "damping_ratio_log_decrement"}) {
    const ClosedFormRow& row = checked.Row(quantity);
    EXPECT_EQ(row.agrees, false) << quantity;
    EXPECT_THAT(row.why, AllOf(HasSubstr(kFrictionLaw), HasSubstr("with viscous friction"))) << quantity;
  }
  EXPECT_THAT(checked.check.summary, HasSubstr("; wrong friction law: chi2/dof of the turning points is"));
  EXPECT_THAT(checked.check.unexplained, HasSubstr("the turning points follow another friction law: chi2/dof"));
  EXPECT_THAT(checked.Row("inertia_small_angle").why, HasSubstr(kFiniteAmplitude));
}

// Levels of 2 deg, noise of 1/70 of a level. Turning points stay on one level for many periods and scatter by more than
// the noise; the errors must include that.
TEST(CheckClosedForms, HasLargerErrorsForCoarseLevels) {
  SyntheticOptions run = TextbookRun("viscous");
  run.noise = 0.0005;
  run.resolution = 2 * kPi / 180;
  const ClosedFormRow coarse = CheckRun(run, "viscous").Row("damping_ratio_log_decrement");
  EXPECT_EQ(coarse.agrees, true);
  run.resolution = 0.001;
  const ClosedFormRow fine = CheckRun(run, "viscous").Row("damping_ratio_log_decrement");
  EXPECT_GT(*coarse.std_error, 5 * *fine.std_error);
}

// 12 samples per small-angle period: a polynomial over a third of a period cannot follow a swing of 1.5 rad.
TEST(CheckClosedForms, AttributesTheInertiaDifferenceOfSparseSamplesToSampling) {
  SyntheticOptions run = TextbookRun("viscous");
  run.release_angle = 1.5;
  run.noise = 0.0001;
  run.sample_rate = 12 / (2 * kPi * std::sqrt(0.079 / kTextbookTorque));
  const CheckedRun checked = CheckRun(run, "viscous");
  const ClosedFormRow& row = checked.Row("inertia_turning_points");
  EXPECT_EQ(row.agrees, false);
  EXPECT_THAT(PartBy(kSampling, row) / (row.closed_form - row.fit), DoubleNear(1, 0.3)) << row.why;
  EXPECT_THAT(row.why, AllOf(Not(HasSubstr(kResolution)), Not(HasSubstr(kFiniteAmplitude))));
}

TEST(CheckClosedForms, AttributesTheEffectOfAFixedParameterToTheRecording) {
  FitOptions options = ModelOptions("viscous");
  options.fixed["viscous"] = 1.1 * 0.003 / kTextbookTorque;
  const CheckedRun checked = CheckFit(FitTo(Must(SimulateRecording(NoisyTextbookRun("viscous"))), options));
  const ClosedFormRow& row = checked.Row("viscous_turning_points");
  EXPECT_EQ(row.agrees, false);
  EXPECT_THAT(row.why, HasSubstr("by features of the recording that the fitted motion lacks"));
  EXPECT_THAT(checked.check.unexplained, HasSubstr("standard deviations from the fit, and "));
}

// Noise autocorrelated over 0.2 s, 8 s at 50 Hz: the law is right, but its turning points are not independent.
TEST(CheckClosedForms, RarelyExcludesTheRightLawForAutocorrelatedNoise) {
  constexpr int kCount = 40;
  int excluded = 0, far = 0;
  SyntheticOptions run = TextbookRun("viscous");
  run.release_angle = 1;
  run.parameters[1] *= 4;
  run.duration = 8;
  run.sample_rate = 50;
  run.noise = 0.002;
  run.noise_correlation = 0.9;
  for (run.seed = 1; run.seed <= kCount; ++run.seed) {
    const CheckedRun checked = CheckRun(run, "viscous");
    if (!checked.forms.wrong_law.empty()) ++excluded;
    if (std::abs(checked.Row("viscous_turning_points").z.value()) > 3) ++far;
  }
  EXPECT_THAT(excluded, Le(1));
  EXPECT_THAT(far, Le(1));
}

// The zero drifts by 10 mrad in 20 s and the fit includes the drift; only viscous friction acts.
TEST(CheckClosedForms, DoesNotAttributeADriftingZeroToFriction) {
  Recording recording = Must(SimulateRecording(NoisyTextbookRun("viscous")));
  recording.value.array() += 0.0005 * recording.time.array();
  FitOptions options = ModelOptions("viscous");
  options.initial["zero_drift"] = 0;
  const CheckedRun checked = CheckFit(FitTo(recording, options));
  ASSERT_NE(checked.run.fit.Find("zero_drift"), nullptr);
  for (const ClosedFormRow& row : checked.check.rows) {
    EXPECT_THAT(row.why, Not(HasSubstr("the formula's friction"))) << row.quantity;
  }
}

// For a release from 2.6 rad the corrected formula has an error of 0.05 %. Small angles are not the cause: the formula
// uses the amplitude in the middle of a half swing for all of it.
TEST(CheckClosedForms, DoesNotNameSmallAnglesAsTheCauseForTheEllipticPeriod) {
  SyntheticOptions run = NoisyTextbookRun("viscous");
  run.release_angle = 2.6;
  const CheckedRun checked = CheckRun(run, "viscous");
  EXPECT_THAT(checked.Row("inertia_elliptic_period").why, Not(HasSubstr("while the formula assumes small angles")));
}

// ---- Rows ----------------------------------------------------------------------------------------------------------

TEST(CheckClosedForms, HasARowForEachFormula) {
  const CheckedRun checked = CheckRun(NoisyTextbookRun("drag"), "drag", TextbookRig());
  std::vector<std::string> quantities;
  for (const ClosedFormRow& row : checked.check.rows) quantities.push_back(row.quantity);
  EXPECT_THAT(quantities, ElementsAre("damping_ratio_log_decrement", "inertia_small_angle", "viscous_log_decrement",
                                      "inertia_elliptic_period", "zero_angle_turning_points", "inertia_turning_points",
                                      "viscous_turning_points", "coulomb_turning_points", "drag_turning_points",
                                      "inertia_geometry", "inertia_point_mass"));
}

TEST(CheckClosedForms, HasUnitsOfTheTorqueWithoutARigAndSiUnitsWithARig) {
  const CheckedRun relative = CheckRun(NoisyTextbookRun("coulomb"), "coulomb");
  const CheckedRun si = CheckRun(NoisyTextbookRun("coulomb"), "coulomb", TextbookRig());
  const std::vector<std::pair<std::string, std::string>> units = {
      {"s^2", "kg m^2"}, {"s", "N m s/rad"}, {"1", "N m"}, {"1", "1"}, {"rad", "rad"}};
  for (const ClosedFormRow& row : relative.check.rows) {
    const ClosedFormRow& with_rig = si.Row(row.quantity);
    const bool is_ratio = row.quantity.starts_with("damping_ratio") || row.quantity.starts_with("zero_angle");
    const double torque = is_ratio ? 1 : kTextbookTorque;
    EXPECT_THAT(with_rig.closed_form / row.closed_form, DoubleNear(torque, 1e-6)) << row.quantity;
    EXPECT_THAT(*with_rig.std_error / *row.std_error, DoubleNear(torque, 1e-6)) << row.quantity;
    EXPECT_THAT(with_rig.fit / row.fit, DoubleNear(torque, 1e-4)) << row.quantity;
    EXPECT_THAT(*with_rig.z, DoubleNear(*row.z, 0.02 * std::abs(*row.z) + 0.01)) << row.quantity;
    EXPECT_THAT(units, testing::Contains(std::pair(row.unit, with_rig.unit))) << row.quantity;
  }
}

// ζ = b / (2 sqrt(I G))
TEST(CheckClosedForms, ComparesTheDampingRatioOfTheFit) {
  const CheckedRun checked = CheckRun(NoisyTextbookRun("viscous"), "viscous", TextbookRig());
  const double inertia = checked.run.fit.Find("inertia")->estimate;
  const double viscous = checked.run.fit.Find("viscous")->estimate;
  EXPECT_THAT(checked.Row("damping_ratio_log_decrement").fit,
              DoubleNear(viscous / (2 * std::sqrt(inertia * kTextbookTorque)), 1e-9));
}

TEST(CheckClosedForms, ChecksARateSensor) {
  SyntheticOptions run = TextbookRun("viscous");
  run.quantity = Quantity::kRate;
  run.zero = 0.02;
  run.noise = 0.01;
  const CheckedRun checked = CheckRun(run, "viscous");
  EXPECT_EQ(checked.Row("rate_bias_turning_points").unit, "rad/s");
  for (const char* exact : {"rate_bias_turning_points", "inertia_turning_points", "viscous_turning_points"}) {
    EXPECT_EQ(checked.Row(exact).agrees, true) << exact;
  }
  EXPECT_THAT(PartBy(kFiniteAmplitude, checked.Row("inertia_small_angle")) /
                  (checked.Row("inertia_small_angle").closed_form - checked.Row("inertia_small_angle").fit),
              DoubleNear(1, 0.05));
  EXPECT_FALSE(checked.Has("zero_angle_turning_points"));
}

// A linear pendulum has one time scale and one damping ratio in any unit of the angle.
TEST(CheckClosedForms, NeedsNoCalibrationForTheLinearModel) {
  SyntheticOptions run = NoisyTextbookRun("linear");
  run.zero = 0;
  const Recording calibrated = Must(SimulateRecording(run));
  Recording counts = calibrated;
  counts.value = calibrated.value.array() / kCount + 512;
  counts.unit = "counts";
  const CheckedRun in_rad = CheckFit(FitTo(calibrated, ModelOptions("linear")));
  const CheckedRun in_counts = CheckFit(FitTo(counts, ModelOptions("linear")));
  EXPECT_EQ(in_counts.Row("zero_angle_turning_points").unit, "counts");
  EXPECT_THAT(in_counts.Row("zero_angle_turning_points").closed_form, DoubleNear(512, 0.2));
  EXPECT_FALSE(in_counts.Has("inertia_elliptic_period"));
  for (const char* quantity : {"damping_ratio_log_decrement", "inertia_small_angle", "viscous_log_decrement",
                               "inertia_turning_points", "viscous_turning_points"}) {
    const ClosedFormRow& row = in_counts.Row(quantity);
    EXPECT_THAT(row.closed_form / in_rad.Row(quantity).closed_form, DoubleNear(1, 1e-6)) << quantity;
    EXPECT_THAT(*row.std_error / *in_rad.Row(quantity).std_error, DoubleNear(1, 1e-4)) << quantity;
    EXPECT_EQ(row.agrees, true) << quantity;
  }
}

// A slow clock: k true seconds per second of the file. Inertia changes with k², viscous friction with k, and z stays
// the same.
TEST(CheckClosedForms, UsesTrueSeconds) {
  const Recording recording = Must(SimulateRecording(NoisyTextbookRun("viscous")));
  Recording slow = recording;
  slow.clock_scale = 1.5;
  const CheckedRun file = CheckFit(FitTo(recording, ModelOptions("viscous")));
  const CheckedRun checked = CheckFit(FitTo(slow, ModelOptions("viscous")));
  for (const ClosedFormRow& row : file.check.rows) {
    const double power = row.unit == "s^2" ? 2 : row.unit == "s" ? 1 : 0;
    const ClosedFormRow& there = checked.Row(row.quantity);
    EXPECT_THAT(there.closed_form / row.closed_form, DoubleNear(std::pow(1.5, power), 1e-6)) << row.quantity;
    EXPECT_THAT(*there.z, DoubleNear(*row.z, 0.02 * std::abs(*row.z) + 0.01)) << row.quantity;
  }
  const auto part = [](const CheckedRun& run) { return PartBy(kFiniteAmplitude, run.Row("inertia_small_angle")); };
  EXPECT_THAT(part(checked) / part(file), DoubleNear(2.25, 0.03));  // printed with three digits
}

// ---- Overlay of the textbook ---------------------------------------------------------------------------------------

/// The noise-free recording of a pendulum with the linear formulas' numbers and the fit's start.
Eigen::VectorXd TextbookSwing(const CheckedRun& checked, Gravity gravity) {
  SyntheticOptions run = TextbookRun("viscous");
  run.model.gravity = gravity;
  run.parameters = {checked.forms.linear->inertia.value, checked.forms.linear->viscous.value};
  run.release_angle = checked.run.fit.Find("release_angle")->estimate;
  run.release_time = checked.run.fit.Find("release_time")->estimate;
  run.zero = checked.run.fit.Find("zero_angle")->estimate;
  return Must(SimulateRecording(run)).value;
}

TEST(TextbookOverlay, UsesTheLinearFormulasFromTheFitsStart) {
  for (const std::optional<Rig>& rig : {std::optional<Rig>(), std::optional(TextbookRig())}) {
    const CheckedRun checked = CheckRun(NoisyTextbookRun("coulomb"), "coulomb", rig);
    const TextbookOverlay& overlay = checked.check.overlay;
    ASSERT_EQ(overlay.linear.size(), checked.run.recording.size());
    EXPECT_LT((overlay.linear - TextbookSwing(checked, Gravity::kLinear)).cwiseAbs().maxCoeff(), 1e-7);
    EXPECT_LT((overlay.nonlinear - TextbookSwing(checked, Gravity::kSine)).cwiseAbs().maxCoeff(), 1e-7);
  }
}

// With parameters from small-angle formulas, the small-angle model fits better.
TEST(TextbookOverlay, ExplainsTheLinearModelsAdvantageAtLargeAngles) {
  const CheckedRun checked = CheckRun(NoisyTextbookRun("viscous"), "viscous");
  const TextbookOverlay& overlay = checked.check.overlay;
  EXPECT_LT(overlay.linear_rms, 0.25 * overlay.nonlinear_rms);
  EXPECT_LT(overlay.fitted_rms, 0.5 * overlay.linear_rms);
  EXPECT_THAT(overlay.fitted_rms, DoubleNear(0.002, 0.0001));
  const Eigen::VectorXd error = checked.run.recording.value - TextbookSwing(checked, Gravity::kSine);
  EXPECT_THAT(overlay.nonlinear_rms, DoubleNear(error.norm() / std::sqrt(2000.0), 1e-6));
  EXPECT_THAT(overlay.summary, HasSubstr("the linear model looks better because its parameters were found with it"));
  EXPECT_THAT(overlay.summary, HasSubstr(" rad rms"));
}

TEST(TextbookOverlay, HasNoExplanationAtSmallAngles) {
  SyntheticOptions run = TextbookRun("viscous");
  run.release_angle = 0.05;
  run.noise = 0.0002;
  const TextbookOverlay overlay = CheckRun(run, "viscous").check.overlay;
  EXPECT_THAT(overlay.linear_rms, DoubleNear(overlay.nonlinear_rms, 0.5 * overlay.nonlinear_rms));
  EXPECT_THAT(overlay.summary, AllOf(HasSubstr("rms"), Not(HasSubstr("looks better"))));
}

TEST(TextbookOverlay, IsEmptyWithoutTheLinearFormulas) {
  CheckedRun checked = CheckRun(NoisyTextbookRun("viscous"), "viscous");
  checked.forms.linear.reset();
  const ClosedFormCheck check = CheckClosedForms(checked.run.recording, checked.forms, checked.run.fit, {});
  EXPECT_EQ(check.overlay.linear.size(), 0);
  EXPECT_EQ(check.overlay.summary, "");
  EXPECT_EQ(check.rows.size(), 3);
  checked.forms.decrement.reset();
  EXPECT_THAT(CheckClosedForms(checked.run.recording, checked.forms, checked.run.fit, {}).rows, IsEmpty());
}

}  // namespace
}  // namespace pendulum::closed_form_check_test
