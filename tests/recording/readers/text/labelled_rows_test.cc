// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/text/labelled_rows.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/readers/read_recording.h"
#include "tests/recording/rows.h"

namespace pendulum::labelled_rows_test {
namespace {

using csv::HasLabelledRows, csv::TableOfLabelledRows;
using testing::HasSubstr;

TEST(LabelledRows, AreReadAsTheSameRowsWithoutLabels) {
  for (const char* row : {"time_ms:{t},adc_counts:{v}", "time={t} ms  adc={v} counts", "time: {t} ms; adc: {v} counts",
                          "14:03:22.123 -> time_ms:{t}, adc_counts:{v}", "time:{t}ms\tadc:{v}counts"}) {
    SCOPED_TRACE(row);
    ExpectTheRows(RecordingOf(Rows(row)));
  }
}

TEST(LabelledRows, GiveTheHeaderTheUnits) {
  EXPECT_EQ(TableOfLabelledRows("hello\nt=10 ms pot=-6.5e2\nt=20 ms pot=+7\n"),
            "hello\nt (ms),pot\n10,-6.5e2\n20,+7\n");
}

TEST(LabelledRows, MayHaveOtherLinesAmongThem) {
  std::string text = "booting\n" + Rows("time_ms:{t},adc_counts:{v}");
  text.insert(text.rfind("time_ms"), "WARN battery low\n");
  const Recording recording = RecordingOf(text);
  ExpectTheRows(recording);
  ASSERT_FALSE(recording.warnings.empty());
  EXPECT_THAT(recording.warnings[0].message, HasSubstr("WARN battery low"));
}

TEST(LabelledRows, AreNotSeenInOtherTexts) {
  const std::string labelled = Rows("t:{t},v:{v}");
  EXPECT_TRUE(HasLabelledRows(labelled));
  for (const std::string& text : {std::string(), std::string("t:1,v:2\n"), Rows("{t},{v}"), Rows("12:00:{t} {v}"),
                                  Rows("v:{v}"), Rows("t:{t},v:"), Rows("t:{t} {v}"),
                                  "Duration: 10 s, Rate: 5 Hz\n" + Rows("{t},{v}"), Rows("t{t}:{t},v:{v}")}) {
    EXPECT_FALSE(HasLabelledRows(text)) << text;
  }
}

}  // namespace
}  // namespace pendulum::labelled_rows_test
