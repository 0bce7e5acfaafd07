// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/recommendation.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::recommendation_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct Case {
  std::string model;
  double bic;
  double forward_rms;
};

struct Compared {
  FittedRecording fitted;
  Comparison comparison;
};

/// A comparison with these criteria, in the state that CompareModels passes to Recommend.
Compared Make(const std::vector<Case>& cases) {
  Compared made;
  double smallest = cases.front().bic;
  for (const Case& c : cases) smallest = std::min(smallest, c.bic);
  for (const Case& c : cases) {
    FitReport fit;
    fit.model = *FindMotionModel(c.model);
    fit.termination = Termination::kConverged;
    made.fitted.fits.push_back(fit);
    ComparisonRow row;
    row.model = c.model;
    row.judged = true;
    row.bic = c.bic;
    row.delta_bic = c.bic - smallest;
    row.forward.rms = c.forward_rms;
    row.forward.samples = 100;
    made.comparison.rows.push_back(row);
  }
  return made;
}

Comparison Recommended(const std::vector<Case>& cases) {
  Compared made = Make(cases);
  Recommend(made.fitted.fits, made.comparison);
  return made.comparison;
}

// Only a larger difference is "strong" evidence (Kass & Raftery, JASA 90:773, 1995).
TEST(Recommend, ChoosesTheSimplestLawUnlessTheEvidenceIsStrong) {
  EXPECT_EQ(Recommended({{"viscous", 100, 1}, {"coulomb", 55.9, 1}, {"drag", 50, 1}}).recommended, "coulomb");
  EXPECT_EQ(Recommended({{"viscous", 100, 1}, {"coulomb", 56.1, 1}, {"drag", 50, 1}}).recommended, "drag");
  EXPECT_EQ(Recommended({{"viscous", 55, 1}, {"coulomb", 55.9, 1}, {"drag", 50, 1}}).recommended, "viscous");
}

TEST(Recommend, ChoosesTheMoreCommonOfTwoEquallySimpleLaws) {
  EXPECT_EQ(Recommended({{"load", 50, 1}, {"coulomb", 55.9, 1}}).recommended, "coulomb");
  EXPECT_EQ(Recommended({{"load", 50, 1}, {"coulomb", 56.1, 1}}).recommended, "load");
  EXPECT_EQ(Recommended({{"asymmetric", 50, 1}, {"drag", 51, 1}}).recommended, "drag");
}

TEST(Recommend, GivesItsReasonInWords) {
  EXPECT_EQ(Recommended({{"coulomb", 862, 0.004}, {"drag", 50, 0.002}}).reason,
            "BIC lower by 812 than with coulomb, and predicts the last 40 % 2 times as well");
  EXPECT_THAT(Recommended({{"coulomb", 90, 0.0020}, {"drag", 50, 0.0021}}).reason, HasSubstr("equally well"));
  EXPECT_THAT(Recommended({{"coulomb", 90, 0.001}, {"drag", 50, 0.003}}).reason, HasSubstr("3 times worse"));
}

TEST(Recommend, NamesEquallyGoodModels) {
  EXPECT_THAT(Recommended({{"viscous", 90, 1}, {"coulomb", 51, 1}, {"drag", 50, 1}}).reason,
              AllOf(HasSubstr("the simplest of the laws that the readings do not distinguish; the others are drag"),
                    HasSubstr("BIC lower by 39 than with viscous")));
}

// The chosen law's BIC is 5.9 above the smallest, stribeck's 6.1: nothing tells these two apart.
TEST(Recommend, ComparesWithNoLawThatIsAsGoodAsTheChosenOne) {
  EXPECT_THAT(Recommended({{"viscous", 55.9, 1}, {"coulomb", 50, 1}, {"stribeck", 56.1, 1}}).reason,
              AllOf(HasSubstr("the others are coulomb"), Not(HasSubstr("BIC lower by"))));
}

TEST(Recommend, ReportsALackOfFit) {
  Compared made = Make({{"coulomb", 862, 0.004}, {"drag", 50, 0.002}});
  made.comparison.rows[1].lack_of_fit = true;
  made.comparison.rows[1].lag1_correlation = 0.6;
  Recommend(made.fitted.fits, made.comparison);
  EXPECT_THAT(
      made.comparison.reason,
      HasSubstr("its residuals are still more than noise (lag-1 correlation 0.6), so the model lacks something"));
}

// If more than noise is left, a smaller BIC is not enough: the law must predict readings that were not fitted.
TEST(Recommend, RefusesALawThatDoesNotPredictBetter) {
  Compared made = Make({{"drag", 60, 0.7}, {"stribeck", 50, 0.69}});
  Recommend(made.fitted.fits, made.comparison);
  EXPECT_EQ(made.comparison.recommended, "stribeck");
  for (ComparisonRow& row : made.comparison.rows) row.lack_of_fit = true;
  Recommend(made.fitted.fits, made.comparison);
  EXPECT_EQ(made.comparison.recommended, "drag");
  EXPECT_EQ(made.comparison.reason,
            "no other is better; stribeck has a smaller BIC, but residuals that are more than noise, and a "
            "prediction of the last 40 % that is missing or not better; its residuals are still more than noise "
            "(lag-1 correlation 0), so the model lacks something");
  made.comparison.rows[1].forward.rms = 0.6;
  Recommend(made.fitted.fits, made.comparison);
  EXPECT_EQ(made.comparison.recommended, "stribeck");
  made.comparison.rows[1].forward.rms = 0.69;
  made.comparison.rows[1].rms = 0.6;  // slow noise: it predicts about as well as it fits
  Recommend(made.fitted.fits, made.comparison);
  EXPECT_EQ(made.comparison.recommended, "stribeck");
}

// The penalty per parameter is ln n for BIC and 2 for AIC, so they may disagree.
TEST(Recommend, ReportsADifferentChoiceByAicc) {
  Compared made = Make({{"coulomb", 50, 1}, {"drag", 57, 1}});
  made.comparison.rows[0].aicc = 24;
  made.comparison.rows[1].aicc = 20;
  Recommend(made.fitted.fits, made.comparison);
  EXPECT_EQ(made.comparison.recommended, "coulomb");
  EXPECT_THAT(made.comparison.reason,
              HasSubstr("; by the criterion AICc, which counts parameters less, drag is better"));
}

// If a refuted law has by far the smallest AICc, Akaike's weights of all other laws may be 0 in double precision.
TEST(Recommend, UsesAiccOnlyAmongLawsNotRefuted) {
  Compared made = Make({{"viscous", 4000, 1}, {"coulomb", 3000, 1}, {"drag", 50, 1}});
  for (ComparisonRow& row : made.comparison.rows) {
    row.aicc = row.bic;
    row.akaike_weight = 0;
    row.lack_of_fit = true;
    row.rms = 0.1;  // predicts worse than it fits
  }
  made.comparison.rows[2].akaike_weight = 1;
  made.comparison.rows[1].forward.rms = 0.5;
  made.comparison.rows[2].forward.rms = 0.5;
  Recommend(made.fitted.fits, made.comparison);
  EXPECT_EQ(made.comparison.recommended, "coulomb");
  EXPECT_THAT(made.comparison.reason, Not(HasSubstr("criterion AICc")));
}

TEST(Recommend, IgnoresLawsWhoseExtraTermsAreZero) {
  Compared made = Make({{"viscous", 90, 1}, {"coulomb", 50, 1}, {"drag", 50, 1}});
  made.comparison.rows[1].log_likelihood = made.comparison.rows[2].log_likelihood = -20;
  Recommend(made.fitted.fits, made.comparison);
  EXPECT_EQ(made.comparison.recommended, "coulomb");
  EXPECT_THAT(made.comparison.reason, HasSubstr("drag gives the same fit: its added terms are 0"));
  EXPECT_THAT(made.comparison.reason, Not(HasSubstr("do not distinguish")));
}

TEST(Recommend, RecommendsNothingWithoutACriterion) {
  Compared made = Make({{"coulomb", 862, 0.004}, {"drag", 50, 0.002}});
  for (ComparisonRow& row : made.comparison.rows) row.bic = row.delta_bic = std::nullopt;
  Recommend(made.fitted.fits, made.comparison);
  EXPECT_EQ(made.comparison.recommended, "");
  EXPECT_THAT(made.comparison.reason, Not(testing::IsEmpty()));
}

}  // namespace
}  // namespace pendulum::recommendation_test
