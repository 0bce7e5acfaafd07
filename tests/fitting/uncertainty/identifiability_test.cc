// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/identifiability.h"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/solve/fit_problem.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::identifiability_test {
namespace {

using testing::HasSubstr;

TEST(VerdictName, DistinguishesThreeVerdicts) {
  using enum Identifiability::Verdict;
  const std::set<std::string_view> names = {VerdictName(kIdentifiable), VerdictName(kWeakly),
                                            VerdictName(kNotIdentifiable)};
  EXPECT_EQ(names.size(), 3);
}

TEST(MeasurementFor, ExistsForEveryParameterOfEveryModel) {
  for (const MotionModel& model : MotionModels()) {
    for (const StartKind start : {StartKind::kRelease, StartKind::kMoving}) {
      for (const Quantity quantity : {Quantity::kAngle, Quantity::kRate}) {
        for (const ParameterInfo& info : FitParameters(model, start, quantity, ZeroMotion::kDrifts)) {
          EXPECT_FALSE(MeasurementFor(info.name).empty()) << info.name;
        }
      }
    }
  }
}

TEST(MeasurementFor, SuggestsOtherAmplitudesForFriction) {
  for (const char* const name : {"viscous", "coulomb", "drag"}) {
    EXPECT_THAT(MeasurementFor(name), HasSubstr("a larger angle")) << name;
  }
  EXPECT_THAT(MeasurementFor("inertia"), HasSubstr("periods"));
}

}  // namespace
}  // namespace pendulum::identifiability_test
