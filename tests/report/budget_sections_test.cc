// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/budget_sections.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/report/layout.h"
#include "pendulum/report/section_text.h"
#include "tests/identify/example_identification.h"

namespace pendulum::budget_sections_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// An inertia of 0.08 kg m² with errors of 0.0001 by noise, 0.0008 by the clock and 0.0001 by a change.
FitReport FitWithBudget() {
  FitReport fit;
  fit.termination = Termination::kConverged;
  fit.model = {"viscous", "viscous", Gravity::kSine};
  ParameterEstimate inertia;
  inertia.info = kInertia;
  inertia.unit = "kg m^2";
  inertia.estimate = 0.08;
  inertia.std_error = 0.0001;
  inertia.systematic.Add(ErrorSource::kClock, 0.0008);
  inertia.systematic.Add(ErrorSource::kInconstancy, 0.0001);
  fit.parameters.push_back(inertia);
  fit.budget.push_back({ErrorSource::kClock, EvaluationType::kB, "clock", "assumed for times on an exact grid", true,
                        0.005, "1", Eigen::VectorXd::Constant(1, 0.0008)});
  return fit;
}

TEST(BudgetSections, ListEachLineWithSizeTypeAndOrigin) {
  const std::string text = ToText(BudgetSections(FitWithBudget()), TextStyle{});
  EXPECT_THAT(text, HasSubstr("Error budget"));
  for (const char* const part :
       {"noise", "clock", "0.5 %", "assumed for times on an exact grid", "inconstancy", "total"})
    EXPECT_THAT(text, HasSubstr(part));
  EXPECT_TRUE(BudgetSections(FitReport()).empty());
}

TEST(BudgetJson, HasThePartsOfEachParameter) {
  const nlohmann::ordered_json budget = BudgetJson(FitWithBudget());
  ASSERT_EQ(budget.size(), 3);
  EXPECT_EQ(budget[0]["name"], "noise");
  EXPECT_EQ(budget[0]["type"], "A");
  EXPECT_EQ(budget[1]["type"], "B");
  EXPECT_EQ(budget[1]["assumed"], true);
  EXPECT_EQ(budget[1]["std_dev"], 0.005);
  EXPECT_EQ(budget[1]["parts"]["inertia"], 0.0008);
  EXPECT_EQ(budget[2]["source"], "inconstancy");
  EXPECT_EQ(budget[2]["type"], "A");
}

// By hand: the root of 1² + 8² + 1² is 8.12, so 1.0 % of 0.08; without the clock 0.18 %.
TEST(LargestErrorText, SaysWhatLessOfItWouldGive) {
  EXPECT_EQ(WithBlanks(LargestErrorText(FitWithBudget())),
            "Improve first: clock; compare the recorder's clock with a watch (--sensor): inertia ± 1 %, at "
            "best ± 0.18 %.");
}

TEST(LargestErrorText, IsEmptyIfNothingCanBeDone) {
  FitReport fit = FitWithBudget();
  fit.parameters[0].std_error = 0.01;  // noise makes nearly all of it
  EXPECT_THAT(LargestErrorText(fit), IsEmpty());
}

}  // namespace
}  // namespace pendulum::budget_sections_test
