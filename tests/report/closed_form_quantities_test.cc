// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/closed_form_quantities.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/format.h"
#include "tests/identify/example_identification.h"

namespace pendulum::closed_form_quantities_test {
namespace {

using testing::ElementsAre;

/// A text per estimate: name, symbol, unit, value and error.
std::vector<std::string> Lines(const std::vector<ReportedEstimate>& estimates) {
  std::vector<std::string> lines;
  for (const auto& [name, symbol, estimate, unit] : estimates) {
    lines.push_back(name + " " + symbol + " [" + unit + "] " + NumberText(estimate.value, 6) + " " +
                    NumberText(estimate.std_error, 6));
  }
  return lines;
}

const std::optional<Rig> kRig = Rig{{2, 0.01}, std::nullopt, {}};  // G = 2 N m

TEST(LinearEstimates, AreInUnitsOfGravityWithoutARig) {
  EXPECT_THAT(Lines(LinearEstimates(*ExampleClosedForms().linear, Gravity::kSine, std::nullopt)),
              ElementsAre("damped_frequency ω_d [rad/s] 4.75 0.0025", "log_decrement δ [1] 0.0265 0.0025",
                          "damping_ratio ζ [1] 0.00425 0.0004", "natural_frequency ω_n [rad/s] 4.7501 0.0025",
                          "inertia I_O [s^2] 0.0445 0.000125", "viscous b [s] 0.00175 0.00025",
                          "corrected_inertia I_O [s^2] 0.044 0.000125"));
}

TEST(LinearEstimates, AreInSiWithARig) {
  const std::vector<std::string> lines = Lines(LinearEstimates(*ExampleClosedForms().linear, Gravity::kSine, kRig));
  EXPECT_EQ(lines[0], "damped_frequency ω_d [rad/s] 4.75 0.0025");
  EXPECT_EQ(lines[4], "inertia I_O [kg m^2] 0.089 0.00025");
  EXPECT_EQ(lines[5], "viscous b [N m s/rad] 0.0035 0.0005");
  EXPECT_EQ(lines[6], "corrected_inertia I_O [kg m^2] 0.088 0.00025");
}

TEST(DecrementEstimates, HaveTheNamesOfTheFitsParameters) {
  const TurningPointFit decrement = *ExampleClosedForms().decrement;
  EXPECT_THAT(Lines(DecrementEstimates(decrement, "rad", kRig)),
              ElementsAre("zero_angle z [rad] 0.01 0.0001", "inertia I_O [kg m^2] 0.0875 0.00025",
                          "viscous b [N m s/rad] 0.003 0.0005", "coulomb τ_c [N m] 0.01 0.001"));
  EXPECT_EQ(Lines(DecrementEstimates(decrement, "rad", std::nullopt)).back(), "coulomb τ_c [1] 0.005 0.0005");
}

TEST(DecrementEstimates, KeepTheUnitOfTheReadings) {
  TurningPointFit decrement = *ExampleClosedForms().decrement;
  EXPECT_EQ(Lines(DecrementEstimates(decrement, "counts", kRig)).front(), "zero_angle z [counts] 0.01 0.0001");
  decrement.table.quantity = Quantity::kRate;
  EXPECT_EQ(Lines(DecrementEstimates(decrement, "rad/s", kRig)).front(), "rate_bias z [rad/s] 0.01 0.0001");
}

// sin 30 deg = 1/2; the derivative of asin there is 1 / cos 30 deg.
TEST(StickingAngle, IsTheAngleWhereGravityEqualsDryFriction) {
  TurningPointFit decrement = *ExampleClosedForms().decrement;
  decrement.friction[1] = {0.5, 0.01};
  const auto sticking = StickingAngle(decrement);
  ASSERT_TRUE(sticking);
  EXPECT_EQ(sticking->unit, "rad");
  EXPECT_NEAR(sticking->estimate.value, kPi / 6, 1e-15);
  EXPECT_NEAR(sticking->estimate.std_error, 0.01 / std::cos(kPi / 6), 1e-15);
}

TEST(StickingAngle, NeedsDryFrictionBelowGravity) {
  TurningPointFit decrement = *ExampleClosedForms().decrement;
  for (const double coulomb : {-0.001, 0.0, 1.0, 2.0}) {
    decrement.friction[1].value = coulomb;
    EXPECT_FALSE(StickingAngle(decrement)) << coulomb;
  }
  decrement.model = {"viscous", "viscous", Gravity::kSine};
  decrement.friction = {{0.5, 0.01}};
  EXPECT_FALSE(StickingAngle(decrement));
}

}  // namespace
}  // namespace pendulum::closed_form_quantities_test
