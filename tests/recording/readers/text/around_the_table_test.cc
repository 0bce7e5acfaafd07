// SPDX-License-Identifier: Apache-2.0
// Tests of tables with text below and beside them, and of headers with line breaks.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/readers/read_recording.h"
#include "tests/recording/rows.h"

namespace pendulum::around_the_table_test {
namespace {

using testing::ElementsAre;
using testing::StartsWith;

std::vector<std::string> MessagesOf(const Recording& recording) {
  std::vector<std::string> messages;
  for (const Warning& warning : recording.warnings) messages.push_back(warning.message);
  return messages;
}

const std::string kTable = "time_ms,angle_deg\n" + Rows("{t},{v}");

TEST(AroundTheTable, TextBelowIsLeftOut) {
  for (const std::string text : {"End of data\n", "\nEnd of data\nOperator: Jane\n", "----\nMean,0.5\nStd,3.5"}) {
    const Recording recording = RecordingOf(kTable + text);
    ExpectTheRows(recording, kDegree);
    ASSERT_EQ(recording.warnings.size(), 1) << text;
    EXPECT_EQ(recording.warnings[0].code, "text_below_table") << text;
  }
  EXPECT_THAT(MessagesOf(RecordingOf(kTable + "\nMean,0.5\nStd,3.5\n")),
              ElementsAre("run.csv:11: the text \"Mean,0.5\" stands below the table; what follows was left out"));
}

TEST(AroundTheTable, TextBetweenRowsIsAFault) {
  EXPECT_THAT(FaultOf(kTable + "pause\n80,108\n"), StartsWith("run.csv:10:1: column \"time_ms\" holds \"pause\""));
  EXPECT_THAT(FaultOf(kTable + "Mean,0.5\n80,108\n"), StartsWith("run.csv:10:1: column \"time_ms\" holds \"Mean\""));
}

TEST(AroundTheTable, ASecondTableIsLeftOut) {
  const std::string second = "time_ms,angle_deg\n" + Rows("{t},9");
  for (const std::string between : {"", "\n\n", "Run 2\n"}) {
    const Recording recording = RecordingOf(kTable + between + second + "End\n");
    ExpectTheRows(recording, kDegree);
    EXPECT_EQ(recording.warnings.at(0).code, "second_table") << between;
  }
  EXPECT_THAT(MessagesOf(RecordingOf(kTable + second)),
              ElementsAre("run.csv:10: a second table begins here; only the first was read. Save each table in a file "
                          "of its own to fit the others"));
}

TEST(AroundTheTable, NotesBesideItAreLeftOut) {
  const Recording recording = RecordingOf("time_ms,angle_deg\n" + Rows("{t},{v},released", 1) +
                                          "10,101\n20,102,\"swings\"\n" + "30,103\n40,104\n50,105\n60,106\n70,107\n");
  ExpectTheRows(recording, kDegree);
  EXPECT_THAT(MessagesOf(recording),
              ElementsAre("run.csv:2: the text \"released\" stands beyond the columns; it was left out"));
}

TEST(AroundTheTable, NamesMayHaveLineBreaks) {
  for (const std::string header : {"\"Time\n(ms)\",\"Angle\n(deg)\"\n", "\"Time\r\n(ms)\",\"Angle\r\n(deg)\"\r\n"}) {
    const Recording recording = RecordingOf(header + Rows("{t},{v}"));
    ExpectTheRows(recording, kDegree);
    EXPECT_TRUE(recording.warnings.empty()) << header;
    ExpectTheRows(RecordingOf(header + Rows("{t},{v}"), TimeAndValue("", "Angle (deg)")), kDegree);
    EXPECT_THAT(FaultOf(header + Rows("{t},{v}") + "80,x\n90,1\n"), StartsWith("run.csv:12:4: column \"Angle (deg)\""));
  }
  ExpectTheRows(RecordingOf("pipe of 5\"\n" + kTable), kDegree);
}

TEST(AroundTheTable, LinesMayEndWithACarriageReturnAlone) {
  std::string text = kTable;
  for (char& c : text) c = c == '\n' ? '\r' : c;
  ExpectTheRows(RecordingOf(text), kDegree);
}

}  // namespace
}  // namespace pendulum::around_the_table_test
