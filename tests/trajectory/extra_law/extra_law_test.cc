// SPDX-License-Identifier: Apache-2.0
// A law that was added by the recipe of CONTRIBUTING.md: one header and one entry. This program compiles the floors
// model and trajectory with it, and runs their tests of every law.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/model/motion_model.h"
#include "pendulum/trajectory/synthetic.h"

namespace pendulum::extra_law_test {
namespace {

TEST(ExtraLaw, IsAModelWithItsParameters) {
  const Result<MotionModel> model = FindMotionModel("wind");
  ASSERT_TRUE(model) << model.error().message();
  std::vector<std::string> names;
  for (const ParameterInfo& parameter : PhysicalParameters(*model)) names.emplace_back(parameter.name);
  EXPECT_THAT(names, testing::ElementsAre("inertia", "viscous", "drag"));
}

// Drag takes 8/3 c A³ ω² from the energy 1/2 I ω² A² in an oscillation, so the amplitude falls by 8/3 (c/I) A²: after n
// of them it is A / (1 + n 8/3 (c/I) A), for small swings.
TEST(ExtraLaw, IsSimulatedWithoutDryFriction) {
  SyntheticOptions run;
  run.model = *FindMotionModel("wind");
  const double inertia = 0.05, drag = 0.001, amplitude = 0.1;
  run.parameters = {inertia, 0, drag};
  run.release_angle = amplitude;
  run.release_time = 0;
  run.noise = run.resolution = 0;
  run.sample_rate = 1000;
  run.duration = 20;
  const Result<Recording> recording = SimulateRecording(run);
  ASSERT_TRUE(recording) << recording.error().message();
  const double period = 2 * 3.14159265358979 * std::sqrt(inertia);
  const double swings = 10 / period;  // until the middle of the samples that follow
  const double expected = amplitude / (1 + swings * 8.0 / 3 * drag / inertia * amplitude);
  const Eigen::Index from = 10000 - 700;
  EXPECT_NEAR(recording->value.segment(from, 1400).cwiseAbs().maxCoeff() / expected, 1, 0.01);
}

}  // namespace
}  // namespace pendulum::extra_law_test
