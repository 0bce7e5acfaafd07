// SPDX-License-Identifier: Apache-2.0
// Tests of FitStore::AgreementOf, with fits made by hand.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/batch/fit_orders.h"
#include "tests/batch/made_outcomes.h"

namespace pendulum::batch_agreement_test {
namespace {

using fit_orders::OrdersOf;
using made_outcomes::FailureOf;
using made_outcomes::FitWithCovariance;
using made_outcomes::Json;
using made_outcomes::OutcomeOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

class BatchAgreementTest : public fit_orders::FitStoreFolder {
 protected:
  /// Stores a batch of recordings a.csv, b.csv ... with these inertias ± 0.05 and viscous friction 5 ± 0.1.
  void Add(const std::string& batch, const std::vector<double>& inertias, const std::vector<std::string>& ids) {
    ASSERT_TRUE(Store().AddBatch(batch, fit_orders::kCreated, OrdersOf(ids), {}));
    for (std::size_t k = 0; k < inertias.size(); ++k)
      ASSERT_TRUE(Store().Put(ids[k], OutcomeOf({FitWithCovariance(inertias[k], 0.05, 5, 0.1)})));
  }

  BatchAgreement AgreementOf(const std::string& batch) {
    const auto agreement = Store().AgreementOf(batch);
    EXPECT_TRUE(agreement) << agreement.error().message();
    return agreement.value_or(BatchAgreement());
  }
};

// The mean of four equal errors has half of one; χ² = 2 · 0.02² / 0.05² is far below its 6 degrees of freedom.
TEST_F(BatchAgreementTest, GivesTheMeansOfRecordingsThatAgree) {
  Add("batch", {10, 10.02, 9.98, 10}, {"a", "b", "c", "d"});
  Add("other", {20, 20}, {"e", "f"});
  const BatchAgreement agreement = AgreementOf("batch");
  EXPECT_EQ(agreement.law, "viscous");
  EXPECT_EQ(agreement.level, "good");
  EXPECT_THAT(agreement.text, StartsWith("The 4 recordings agree under the law viscous (p "));
  EXPECT_THAT(agreement.outliers, IsEmpty());
  ASSERT_THAT(agreement.means, SizeIs(2));
  EXPECT_EQ(agreement.means[0].parameter, "inertia");
  EXPECT_EQ(agreement.means[0].unit, "kg m^2");
  EXPECT_NEAR(agreement.means[0].mean, 10, 1e-12);
  EXPECT_NEAR(agreement.means[0].total_std_error, 0.025, 1e-12);
  EXPECT_EQ(agreement.means[0].runs, 4u);
  EXPECT_NEAR(agreement.means[1].total_std_error, 0.05, 1e-12);
}

// The rig's error is the same in all recordings, so that it does not average out.
TEST_F(BatchAgreementTest, KeepsTheErrorsThatAllShare) {
  Add("batch", {}, {"a", "b", "c", "d"});
  for (const char* id : {"a", "b", "c", "d"}) {
    Json fit = FitWithCovariance(10, 0.05, 5, 0.1);
    fit["parameters"]["inertia"]["total_std_error"] = std::hypot(0.05, 0.3);
    ASSERT_TRUE(Store().Put(id, OutcomeOf({fit})));
  }
  EXPECT_NEAR(AgreementOf("batch").means[0].total_std_error, std::hypot(0.025, 0.3), 1e-12);
}

TEST_F(BatchAgreementTest, NamesTheOddOneAndLeavesItOut) {
  Add("batch", {10, 10, 10, 10.3}, {"a", "b", "c", "d"});
  const BatchAgreement agreement = AgreementOf("batch");
  EXPECT_EQ(agreement.level, "caution");
  EXPECT_EQ(agreement.text,
            "One recording disagrees with the others of the same pendulum: d.csv (inertia 10.3, the others 10: 3 % "
            "more). The means leave it out.");
  ASSERT_THAT(agreement.outliers, SizeIs(1));
  EXPECT_EQ(agreement.outliers[0].id, "d");
  EXPECT_NEAR(agreement.means[0].mean, 10, 1e-12);
  EXPECT_EQ(agreement.means[0].runs, 3u);
}

// Values 10 ± 1 % of two recordings: their mean's error is half the difference, not 0.05 / √2.
TEST_F(BatchAgreementTest, AddsTheScatterToTheErrorsOfTheMeans) {
  Add("batch", {9.9, 10.1, 9.9, 10.1}, {"a", "b", "c", "d"});
  Add("wide", {9.8, 10.2, 9.8, 10.2}, {"e", "f", "g", "h"});
  EXPECT_GT(AgreementOf("batch").means[0].total_std_error, 0.049);  // 0.1 / √4
  const BatchAgreement wide = AgreementOf("wide");
  EXPECT_EQ(wide.level, "caution");
  EXPECT_THAT(wide.text, HasSubstr("differ by more than their errors under the law viscous (p "));
  EXPECT_GT(wide.means[0].total_std_error, 0.099);
}

TEST_F(BatchAgreementTest, DoesNotCompareDifferentPendulums) {
  Add("batch", {10, 11, 12, 13}, {"a", "b", "c", "d"});
  const BatchAgreement agreement = AgreementOf("batch");
  EXPECT_EQ(agreement.law, "");
  EXPECT_THAT(agreement.text,
              StartsWith("The 4 recordings are not taken for one pendulum: their inertia scatters by "));
  EXPECT_THAT(agreement.means, IsEmpty());
}

TEST_F(BatchAgreementTest, HasNothingToCompareInOneRecording) {
  Add("batch", {10}, {"a", "b"});
  ASSERT_TRUE(Store().Put("b", FailureOf({"b.csv", "all values are equal"}, 5)));
  EXPECT_EQ(AgreementOf("batch").text, "Fewer than two recordings were fitted: there is nothing to compare.");
}

TEST_F(BatchAgreementTest, KnowsNoOtherBatch) {
  EXPECT_EQ(Store().AgreementOf("none").error().code, StatusCode::kNotFound);
}

}  // namespace
}  // namespace pendulum::batch_agreement_test
