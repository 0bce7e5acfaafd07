// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/warning.h"

#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::warning_test {
namespace {

using testing::HasSubstr;

/// A warning with all its parts.
Warning Whole() {
  return {.code = "time_wrapped",
          .finding = "the counter restarts",
          .explanation = "later times were corrected",
          .advice = "give --time_column",
          .flags = {"time_column"},
          .about = {
              .file = "b.csv", .line = 118, .law = "coulomb", .recording = 2, .recording_name = "recording 2 (b.csv)"}};
}

TEST(MessageText, BeginsWithWhatTheWarningIsAbout) {
  EXPECT_EQ(MessageText(Whole()),
            "recording 2 (b.csv): coulomb: b.csv:118: the counter restarts; later times were corrected; "
            "give --time_column");
  EXPECT_EQ(MessageText({"gaps", "there are gaps"}), "there are gaps");
}

TEST(TextWithoutLaw, NamesTheRecordingOnly) {
  EXPECT_EQ(TextWithoutLaw(Whole()),
            "recording 2 (b.csv): b.csv:118: the counter restarts; later times were corrected; give --time_column");
}

TEST(ShortText, HasTheAdviceIfItHasFlags) {
  EXPECT_EQ(ShortText(Whole()), "recording 2 (b.csv): line 118: the counter restarts. Give --time_column");
  EXPECT_EQ(ShortText({.code = "gaps", .finding = "there are gaps", .advice = "do better"}), "there are gaps");
}

// A line of a file in a zip file says of which file.
TEST(ShortText, NamesTheFileInTheRecording) {
  const Warning warning = {
      .code = "stray_lines", .finding = "2 lines are no rows", .about = {.file = "a.zip:run2.csv", .line = 503}};
  EXPECT_EQ(ShortText(warning, "a.zip"), "run2.csv, line 503: 2 lines are no rows");
  EXPECT_EQ(ShortText(warning, "a.zip:run2.csv"), "line 503: 2 lines are no rows");
}

TEST(WarningCode, IsOneOfTheTable) {
  const Warning warning{"lack_of_fit", "the residuals are not noise"};
  EXPECT_EQ(warning.code, "lack_of_fit");
  EXPECT_TRUE(warning.code.is_serious());
  EXPECT_FALSE(WarningCode("gaps").is_serious());
  EXPECT_EQ(FindWarning({warning}, "gaps"), nullptr);
  EXPECT_TRUE(HasWarning({warning}, "lack_of_fit"));
}

// src/docs/reference.md says what each code means.
TEST(WarningKinds, AreInTheReference) {
  std::ifstream file("src/docs/reference.md");
  std::stringstream reference;
  reference << file.rdbuf();
  for (const WarningKind& kind : kWarningKinds) {
    EXPECT_THAT(reference.str(), HasSubstr("`" + std::string(kind.code) + "`"));
  }
}

}  // namespace
}  // namespace pendulum::warning_test
