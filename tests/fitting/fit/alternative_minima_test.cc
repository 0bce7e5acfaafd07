// SPDX-License-Identifier: Apache-2.0
// Two solutions of an accelerometer across the rod: both are reported, and prior knowledge of the radius decides.
#include "pendulum/fitting/fit/alternative_minima.h"

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/fitting/fit/fit_jointly.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::alternative_minima_test {
namespace {

using testing::HasSubstr;

FitReport Fit(const SyntheticOptions& options, const FitOptions& fit) {
  return Must(FitRecording(Must(SimulateRecording(options)), fit));
}

/// MODEL.md eq. (14.6): 2 g / ω0² - 0.3 m = 0.5915 m gives the same readings except for friction, which is small here.
SyntheticOptions WithLittleFriction(std::uint64_t seed) {
  SyntheticOptions options = MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0, 1, 0, 0.3}, 0.05);
  options.model = FindMotionModel("viscous").value();
  options.parameters = {1 / 22.0, 0.0003};
  options.duration = 20;
  options.seed = seed;
  return options;
}

TEST(AlternativeSolutions, ReportBothRadiiOfAnAccelerationAcrossTheRod) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    FitOptions viscous;
    viscous.model = "viscous";
    const FitReport fit = Fit(WithLittleFriction(seed), viscous);
    EXPECT_EQ(fit.termination, Termination::kNotIdentifiable) << seed;
    EXPECT_TRUE(fit.HasWarning("ambiguous_sensor"));
    std::smatch match;
    ASSERT_TRUE(std::regex_search(fit.reason, match, std::regex("with radius (\\S+) m instead of (\\S+) m")));
    const auto [nearer, farther] = std::minmax({std::stod(match[1]), std::stod(match[2])});
    EXPECT_NEAR(nearer, 0.3, 0.02);
    EXPECT_NEAR(nearer + farther, 2 * kStandardGravity / 22, 0.01);
    EXPECT_THAT(fit.reason, HasSubstr("give --prior radius=r:std_dev"));
    EXPECT_FALSE(fit.Find("radius")->std_error);
    EXPECT_FALSE(fit.Find("viscous")->std_error);
    for (const Identifiability& known : fit.identifiability) {
      EXPECT_EQ(known.verdict == Identifiability::Verdict::kNotIdentifiable, known.parameter == "radius");
    }
  }
}

// With friction of another law than the fitted one the residuals, not the friction, choose between the two radii.
TEST(AlternativeSolutions, AreNotResolvedByAutocorrelatedResiduals) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SyntheticOptions options = MeasuredSwing(Quantity::kAcceleration, SensorKind::kAcceleration, {0, 1, 0, 0.63}, 0.03);
    options.model = FindMotionModel("drag").value();
    options.parameters = {1 / 22.2, 0.00135, 0.0009, 0.00225};
    options.duration = 20;
    options.seed = seed;
    FitOptions coulomb;
    coulomb.model = "coulomb";
    const FitReport fit = Fit(options, coulomb);
    const ParameterEstimate& radius = *fit.Find("radius");
    const bool is_right = radius.std_error && std::abs(radius.estimate - 0.63) < 4 * *radius.std_error;
    EXPECT_TRUE(is_right || fit.HasWarning("ambiguous_sensor")) << seed << ": " << radius.estimate;
  }
}

TEST(AlternativeSolutions, AreResolvedByAPriorOnTheRadius) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    FitOptions known;
    known.model = "viscous";
    known.priors["radius"] = {0.31, 0.02};
    ExpectTruth(WithLittleFriction(seed), Fit(WithLittleFriction(seed), known));
    // A prior wide enough for both radii does not decide.
    known.priors["radius"] = {0.45, 0.2};
    EXPECT_EQ(Fit(WithLittleFriction(seed), known).termination, Termination::kNotIdentifiable);
    known.priors.clear();
    known.fixed["radius"] = 0.3;
    EXPECT_EQ(Fit(WithLittleFriction(seed), known).termination, Termination::kConverged);
  }
}

// The other radius has the same small-angle frequency, so a second recording with the same ambiguity does not decide.
TEST(AlternativeSolutions, AreNotResolvedByASimilarSecondRecording) {
  FitOptions viscous;
  viscous.model = "viscous";
  const Recording first = Must(SimulateRecording(WithLittleFriction(1)));
  const Recording second = Must(SimulateRecording(WithLittleFriction(2)));
  const FitReport first_alone = Must(FitRecording(first, viscous)), second_alone = Must(FitRecording(second, viscous));
  const std::vector<JointRun> runs = {{first, first_alone, viscous}, {second, second_alone, viscous}};
  const JointFit fit = Must(FitJointly(runs, {"inertia", "viscous"}));
  EXPECT_EQ(fit.whole.termination, Termination::kNotIdentifiable) << fit.whole.reason;
  EXPECT_THAT(fit.whole.reason, HasSubstr("recording 1: with radius"));
}

}  // namespace
}  // namespace pendulum::alternative_minima_test
