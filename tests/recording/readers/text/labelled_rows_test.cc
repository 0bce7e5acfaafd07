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
  EXPECT_EQ(
      TableOfLabelledRows("hello\nt=10 ms pot=-6.5e2\nt=20 ms pot=+7\n" + Rows("t={t} ms  pot = {v}", 3), "run.csv"),
      "hello\nt (ms),pot\n10,-6.5e2\n20,+7\n" + Rows("{t},{v}", 3));
}

TEST(LabelledRows, MayHaveOtherLinesAmongThem) {
  std::string text = "booting\n" + Rows("time_ms:{t},adc_counts:{v}");
  text.insert(text.rfind("time_ms"), "WARN battery low\n");
  const Recording recording = RecordingOf(text);
  ExpectTheRows(recording);
  ASSERT_FALSE(recording.warnings.empty());
  EXPECT_THAT(MessageText(recording.warnings[0]), HasSubstr("WARN battery low"));
}

TEST(LabelledRows, MayBeginWithARowThatIsCutOffOrWithOtherLabels) {
  for (const char* first : {"ms:99,adc_counts:99\n", "kp:1.0,ki:2.0\n", "\xEF\xBB\xBF"}) {
    ExpectTheRows(RecordingOf(first + Rows("time_ms:{t},adc_counts:{v}")));
  }
  ExpectTheRows(RecordingOf(Rows("t={t} ms θ={v}°\r")), kDegree);
}

TEST(LabelledRows, MayHaveOneValueBesideAStamp) {
  EXPECT_EQ(TableOfLabelledRows(Rows("14:03:22.123 -> pot: {v}", 5), "run.csv").value(),
            "14:03:22.123 ->pot\n" + Rows("14:03:22.123 ->{v}", 5));
  EXPECT_FALSE(HasLabelledRows("t: 0\n" + Rows("v: {v}\nt: {t}", 20)));
  EXPECT_THAT(FaultOf(Rows("adc_counts:{v}")), HasSubstr("give the rate of the rows in Hz with --sample_rate_hz"));
}

TEST(LabelledRows, WithOtherUnitsAreNotMixed) {
  const std::string text = Rows("t={t} ms adc={v} counts", 100);
  const std::size_t middle = text.find("t=500 ms");
  EXPECT_THAT(FaultOf(text.substr(0, middle) + Rows("t={t} us adc={v} counts", 100)),
              HasSubstr("run.csv:1: the units of \"t=0 ms adc=100 counts\" are not those of the other rows"));
}

TEST(LabelledRows, AreNotSeenInOtherTexts) {
  const std::string labelled = Rows("t:{t},v:{v}");
  EXPECT_TRUE(HasLabelledRows(labelled));
  for (const std::string& text : {std::string(), std::string("t:1,v:2\n"), Rows("{t},{v}"), Rows("12:00:{t} {v}"),
                                  Rows("t:{t},v:"), Rows("t:{t} {v}"), Rows("t:12:00:{t} v:{v}"), Rows("t:{t} v:0x{v}"),
                                  "Duration: 10 s, Rate: 5 Hz\n" + Rows("{t},{v}"), Rows("t{t}:{t},v:{v}")}) {
    EXPECT_FALSE(HasLabelledRows(text)) << text;
  }
}

}  // namespace
}  // namespace pendulum::labelled_rows_test
