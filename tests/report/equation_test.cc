// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/equation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/model/friction/registry.h"
#include "tests/identify/example_identification.h"

namespace pendulum::equation_test {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(SymbolicEquation, WritesTheLawsOfFrictionAndGravity) {
  EXPECT_EQ(SymbolicEquation({"linear", "viscous", Gravity::kLinear}), "I_O th'' + b th' + G th = 0");
  EXPECT_EQ(SymbolicEquation({"coulomb", "coulomb", Gravity::kSine}), "I_O th'' + b th' + τ_c sgn(th') + G sin th = 0");
  EXPECT_EQ(SymbolicEquation({"drag", "drag", Gravity::kSine}),
            "I_O th'' + b th' + τ_c sgn(th') + c th' |th'| + G sin th = 0");
}

TEST(SymbolicEquation, NamesEveryParameterOfEveryModel) {
  for (const MotionModel& model : MotionModels()) {
    const std::string equation = SymbolicEquation(model);
    EXPECT_THAT(equation, Not(HasSubstr("{"))) << model.name;
    for (const ParameterInfo& parameter : PhysicalParameters(model)) {
      EXPECT_THAT(equation, HasSubstr(parameter.symbol)) << model.name;
    }
  }
}

TEST(FittedEquation, RoundsEachNumberByItsError) {
  FitReport fit = ExampleFit();
  fit.parameters = {ExampleParameter(kInertia, "kg m^2", 0.07902, 0.0008),
                    ExampleParameter(kViscous, "N m s/rad", 0.00302, 0.00016),
                    ExampleParameter(kCoulomb, "N m", 0.00101, 0.00025)};
  const Rig rig{{1.8034, 0.02}, std::nullopt, {}};
  EXPECT_EQ(FittedEquation(fit, rig), "0.0790 th'' + 0.00302 th' + 0.00101 sgn(th') + 1.80 sin th = 0");
}

TEST(FittedEquation, HasUnitGravityWithoutARig) {
  EXPECT_EQ(FittedEquation(ExampleRateIdentification().fits.front(), std::nullopt),
            "0.04390 th'' + 0.001700 th' + 0.0005000 sgn(th') + sin th = 0");
}

TEST(FittedEquation, KeepsTermsAtABoundAndNegativeSigns) {
  FitReport fit = ExampleFit();
  fit.parameters[1].estimate = -0.003;
  EXPECT_EQ(FittedEquation(fit, std::nullopt), "0.07900 th'' - 0.0030 th' + 0 sgn(th') + sin th = 0");
}

TEST(WithoutZeroTerms, RemovesWholeTerms) {
  EXPECT_EQ(WithoutZeroTerms("0.079 th'' + 0 th' + 0 sgn(th') + sin th = 0"), "0.079 th'' + sin th = 0");
  EXPECT_EQ(WithoutZeroTerms("1 th'' + 0 [1 + (2 + 3) th'] th' - 2 th = 0"), "1 th'' - 2 th = 0");
  EXPECT_EQ(WithoutZeroTerms("1 th'' + 0.5 th' + th = 0"), "1 th'' + 0.5 th' + th = 0");
}

}  // namespace
}  // namespace pendulum::equation_test
