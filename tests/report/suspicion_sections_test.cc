// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/suspicion_sections.h"

#include <gtest/gtest.h>

#include "pendulum/report/section_text.h"
#include "tests/identify/example_identification.h"

namespace pendulum::suspicion_sections_test {
namespace {

FitReport SuspectedFit() {
  FitReport fit;
  fit.termination = Termination::kConverged;
  fit.suspicions = {{Cause::kGain, 0.01, 0.001, "1", 12, true}, {Cause::kFrictionLaw, 0.005, 0.0005, "rad", 8, false}};
  return fit;
}

TEST(SuspicionSections, ListCausesWithSizeAndAdvice) {
  const std::string text = ToText(SuspicionSections(SuspectedFit()), TextStyle{});
  for (const char* part : {"What the residuals suggest", "gain", "1.00 ± 0.10 %", "friction law", "--models all"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

TEST(SuspicionSections, SayIfNothingIsSignificant) {
  FitReport fit = SuspectedFit();
  fit.suspicions.clear();
  const std::string text = ToText(SuspicionSections(fit), TextStyle{});
  EXPECT_NE(text.find("No cause outside the law is significant"), std::string::npos) << text;
}

TEST(SuspicionSections, AreEmptyWithoutAResult) { EXPECT_TRUE(SuspicionSections(FitReport()).empty()); }

TEST(SuspicionsJson, HasOneObjectForEachCause) {
  const auto json = SuspicionsJson(SuspectedFit());
  ASSERT_EQ(json.size(), 2);
  EXPECT_EQ(json[0]["name"], "gain");
  EXPECT_EQ(json[0]["size"], 0.01);
  EXPECT_EQ(json[0]["corrected"], true);
  EXPECT_EQ(json[1]["name"], "friction_law");
}

TEST(SuspectedText, SeparatesWhatIsCorrected) {
  EXPECT_EQ(SuspectedText(SuspectedFit(), true), "gain 1.00 ± 0.10 %");
  EXPECT_EQ(SuspectedText(SuspectedFit(), false), "friction law 0.286 ± 0.029 deg (--models all)");
}

}  // namespace
}  // namespace pendulum::suspicion_sections_test
