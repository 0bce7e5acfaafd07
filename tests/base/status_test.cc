// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/status.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::status_test {
namespace {

// The table of exit codes that every tool documents.
TEST(ExitCode, MatchesTheDocumentedTable) {
  EXPECT_EQ(ExitCode(StatusCode::kInvalidArgument), 2);
  EXPECT_EQ(ExitCode(StatusCode::kNotFound), 3);
  EXPECT_EQ(ExitCode(StatusCode::kDataLoss), 4);
  EXPECT_EQ(ExitCode(StatusCode::kFailedPrecondition), 5);
  EXPECT_EQ(ExitCode(StatusCode::kInternal), 70);     // EX_SOFTWARE of sysexits.h
  EXPECT_EQ(ExitCode(StatusCode::kCannotWrite), 73);  // EX_CANTCREAT
  EXPECT_EQ(ExitCode(StatusCode::kTryAgain), 75);     // EX_TEMPFAIL
}

TEST(ExitCode, IsTheExitCodeOfABugForAnUnknownStatus) { EXPECT_EQ(ExitCode(static_cast<StatusCode>(99)), 70); }

TEST(Error, ConvertsToAResultOfAnyType) {
  const Result<int> number = Error(StatusCode::kDataLoss, "swing.csv:3: no number");
  const Result<std::vector<std::string>> words = Error(StatusCode::kNotFound, "swing.csv: no such file");
  ASSERT_FALSE(number);
  ASSERT_FALSE(words);
  EXPECT_EQ(number.error().code, StatusCode::kDataLoss);
  EXPECT_EQ(number.error().message(), "swing.csv:3: no number");
  EXPECT_EQ(words.error().code, StatusCode::kNotFound);
  EXPECT_EQ(words.error().message(), "swing.csv: no such file");
}

TEST(Error, BeginsItsMessageWithItsPlace) {
  const Result<int> number = Fault("swing.csv:3", "no number");
  EXPECT_EQ(number.error().code, StatusCode::kDataLoss);
  EXPECT_EQ(number.error().message(), "swing.csv:3: no number");
  EXPECT_EQ(ErrorAt(StatusCode::kNotFound, "", "no such file").value().message(), "no such file");
}

TEST(Within, PutsTheOuterPlaceFirst) {
  const Status part{StatusCode::kDataLoss, "no number"};
  EXPECT_EQ(Within("", part).value().message(), "no number");
  EXPECT_EQ(Within("run.csv", part).value().message(), "run.csv: no number");
  EXPECT_EQ(Within("run.csv", Within("column a", part).value()).value().message(), "run.csv: column a: no number");
}

TEST(WithTry, AddsFlagsThatAPartKeeps) {
  const Result<int> part = WithTry(Error(StatusCode::kDataLoss, "no unit"), {"--unit deg"});
  const Result<double> whole = Within("run.csv", part.error());
  EXPECT_EQ(whole.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(whole.error().try_flags, testing::ElementsAre("--unit deg"));
}

TEST(Result, HoldsTheValueWithoutAnError) {
  const Result<int> number = 7;
  ASSERT_TRUE(number);
  EXPECT_EQ(*number, 7);
}

}  // namespace
}  // namespace pendulum::status_test
