// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/likelihood/fit_parameters.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"

namespace pendulum::fit_parameters_test {
namespace {

using testing::ElementsAre;

std::vector<std::string> Names(const std::vector<ParameterInfo>& infos) {
  std::vector<std::string> names;
  for (const ParameterInfo& info : infos) names.emplace_back(info.name);
  return names;
}

TEST(FitParameters, AreInTheDocumentedOrder) {
  const MotionModel drag = Must(FindMotionModel("drag"));
  EXPECT_THAT(Names(FitParameters(drag, StartKind::kRelease, Quantity::kAngle)),
              ElementsAre("inertia", "viscous", "coulomb", "drag", "release_angle", "release_time", "zero_angle"));
  EXPECT_THAT(Names(FitParameters(drag, StartKind::kMoving, Quantity::kRate)),
              ElementsAre("inertia", "viscous", "coulomb", "drag", "initial_angle", "initial_rate", "rate_bias"));
}

TEST(FitParameters, EndWithTheZeroMotionOfADirectSensor) {
  const MotionModel viscous = Must(FindMotionModel("viscous"));
  EXPECT_EQ(FitParameters(viscous, StartKind::kMoving, Quantity::kAngle, ZeroMotion::kDrifts).back().name,
            "zero_drift");
  EXPECT_EQ(FitParameters(viscous, StartKind::kMoving, Quantity::kRate, ZeroMotion::kDrifts).back().name, "bias_drift");
  EXPECT_EQ(FitParameters(viscous, StartKind::kMoving, Quantity::kAngle, ZeroMotion::kLags).back().name, "hysteresis");
}

TEST(IsDrift, IsTrueForDriftsOfAnglesAndRates) {
  EXPECT_TRUE(IsDrift("zero_drift"));
  EXPECT_TRUE(IsDrift("bias_drift"));
  EXPECT_FALSE(IsDrift("zero_angle"));
}

}  // namespace
}  // namespace pendulum::fit_parameters_test
