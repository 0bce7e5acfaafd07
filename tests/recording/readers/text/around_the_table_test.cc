// SPDX-License-Identifier: Apache-2.0
// Tests of tables with text below and beside them, and of headers with line breaks.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/readers/read_recording.h"
#include "tests/recording/rows.h"

namespace pendulum::around_the_table_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

std::vector<std::string> MessagesOf(const Recording& recording) {
  std::vector<std::string> messages;
  for (const Warning& warning : recording.warnings) messages.push_back(MessageText(warning));
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
  EXPECT_THAT(MessagesOf(RecordingOf(kTable + "\nMean,0.5\nStd,3.5\n2026-11-05 14:03\n")),
              ElementsAre("run.csv:11: the table ends here, at the text \"Mean,0.5\"; this line and all below it were "
                          "not read"));
}

TEST(AroundTheTable, TextBelowIsNoRowIfItsFirstColumnIsNotRead) {
  const std::string table = "n,time_ms,angle_deg\n" + Rows("{t},{t},{v}");
  for (const std::string text : {"N,2000,2000\n", "Mean,3.5,0.02\n"}) {
    const Recording recording = RecordingOf(table + text);
    ExpectTheRows(recording, kDegree);
    EXPECT_EQ(recording.warnings.at(0).code, "text_below_table");
  }
}

TEST(AroundTheTable, RowsMayBeginWithText) {
  ExpectTheRows(RecordingOf("state,time_ms,angle_deg\n" + Rows("fine,{t},{v}") + "Mean,3.5\n"), kDegree);
}

TEST(AroundTheTable, OneLineOfTextMayStandAboveRowsWithoutNames) {
  const Recording recording = RecordingOf("Ready\n" + Rows("{t}\t{v}"), TimeAndValue("1:ms", "2", "deg"));
  ExpectTheRows(recording, kDegree);
}

// A Tektronix oscilloscope's lines; its label is above the names.
TEST(AroundTheTable, TimesOfRowsCountMoreThanAnIntervalAbove) {
  for (const auto& [interval, has_warning] : {std::pair("0.01", false), {"0.0102", false}, {"0.03", true}}) {
    for (const char* label : {"Label,,", "Label,pendulum,"}) {
      const std::string head =
          std::string("Model,DPO2014\nSample Interval,") + interval + "\nRecord Length,8\n" + label;
      const Recording recording = RecordingOf(head + "\nTIME (ms),angle_rad\n" + Rows("{t},{v}"));
      ExpectTheRows(recording);
      const Warning* const found = FindWarning(recording.warnings, "rate_disagrees");
      EXPECT_EQ(found != nullptr, has_warning) << interval;
      if (!has_warning) continue;
      EXPECT_THAT(
          MessageText(*found),
          AllOf(HasSubstr("column \"TIME (ms)\" are 0.01 s apart, but the lines above say 0.03 s; the times are used"),
                HasSubstr("--time_column none --sample_rate_hz 33.3333")));
    }
  }
}

TEST(AroundTheTable, ListsOfDifferentLengthsAreRefused) {
  const std::string angles = R"("angle_deg": [1, 2, 3, 4, 5, 6, 7, 8, 9])";
  EXPECT_THAT(FaultOf(R"({"time_s": [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10], )" + angles + "}"),
              HasSubstr("the last 2 rows have only one of time and reading: if some were lost before them, the times "
                        "after that are wrong; look for the missing ones at their source"));
}

TEST(AroundTheTable, RowsWithATimeAloneAtTheEndAreSaid) {
  const std::string others = "time_ms,angle_deg,torque\n" + Rows("{t},{v},1");
  for (const std::string more : {"80,\n90,\n100,\n", ",108\n,109\n,110\n", "\"80\",\"\"\n\"90\",\"\"\n100,\n"}) {
    const Recording recording = RecordingOf(kTable + more);
    ExpectTheRows(recording, kDegree);
    EXPECT_THAT(MessagesOf(recording),
                ElementsAre("run.csv: the last 3 rows have only one of time and reading: if some were lost before "
                            "them, the times after that are wrong; these rows were left out"));
  }
  for (const std::string more : {"80,\n", ",\n,\n,\n"}) EXPECT_THAT(MessagesOf(RecordingOf(kTable + more)), IsEmpty());
  EXPECT_THAT(MessagesOf(RecordingOf(others + "80,,1\n90,,1\n")), IsEmpty());  // the other sensor ran on
}

TEST(AroundTheTable, RowsMayHaveNamesThatTheHeaderOmits) {
  std::string text = "\"time_ms\" \"angle_deg\"\n";
  for (int i = 0; i < 8; ++i) {
    text += "\"" + std::to_string(i + 1) + "\" " + std::to_string(10 * i) + " " + std::to_string(100 + i) + "\n";
  }
  ExpectTheRows(RecordingOf(text), kDegree);
}

/// Forty rows with a line after every tenth.
std::string WithLines(const std::string& header, const std::string& pattern, const std::vector<std::string>& lines) {
  std::string text = header;
  for (int i = 0; i < 40; ++i) {
    std::string row = Rows(pattern, i + 1);
    text += row.substr(row.rfind('\n', row.size() - 2) + 1);
    if (i % 10 == 9 && i / 10 < static_cast<int>(lines.size())) text += lines[i / 10] + "\n";
  }
  return text;
}

TEST(AroundTheTable, LinesBetweenRowsAreCountedAndNamedOnce) {
  const std::vector<std::string> lines = {"Temp: 23 C", "110", "09:14:09 -> # battery"};
  for (const char separator : {',', '\t', ';', ' '}) {
    const std::string pattern = std::string("{t}") + separator + "{v}";
    const Recording recording =
        RecordingOf(WithLines(std::string("time_ms") + separator + "angle_deg\n", pattern, lines));
    ASSERT_EQ(recording.size(), 40);
    EXPECT_DOUBLE_EQ(recording.time[39], 0.39);
    EXPECT_THAT(MessagesOf(recording),
                ElementsAre("run.csv:12: 3 lines that are no rows, the first is \"Temp: 23 C\", were left out; rows "
                            "that are cut off: 1"));
  }
  EXPECT_THAT(MessagesOf(RecordingOf(kTable + "pause\r\n80,108\r\n")),
              ElementsAre("run.csv:10: 1 line that is no row, \"pause\", was left out"));
}

TEST(AroundTheTable, TwoRowsInOneLineAreLeftOut) {
  for (const char separator : {',', ' '}) {
    const std::string pattern = std::string("{t}") + separator + "{v}";
    const std::string merged = std::string("300") + separator + "130310" + separator + "131";
    const Recording recording =
        RecordingOf(WithLines(std::string("time_ms") + separator + "angle_deg\n", pattern, {"", "", merged}));
    ASSERT_EQ(recording.size(), 40);
    EXPECT_THAT(MessagesOf(recording), ElementsAre(HasSubstr("1 line that is no row, \"" + merged + "\"")));
  }
}

TEST(AroundTheTable, ARemarkAboveRowsWithoutAHeaderIsNoRow) {
  const std::string text = WithLines("Ready v1\n", "{t},{v}", {"OK", "Temp: 23 C"});
  const Recording recording = RecordingOf(text, TimeAndValue("1:ms", "2", "deg"));
  ASSERT_EQ(recording.size(), 40);
  EXPECT_THAT(MessagesOf(recording),
              testing::Contains(HasSubstr("3 lines that are no rows, the first is \"Ready v1\"")));
}

TEST(AroundTheTable, RemarksMayBeginWithATimeOfDay) {
  for (const char separator : {',', '\t', ' '}) {
    const std::string pattern = std::string("{t}") + separator + "{v}",
                      header = std::string("time_ms") + separator + "angle_deg\n";
    const Recording recording = RecordingOf(WithLines(header, pattern, {"12:04:33 temp=23", "12:04:34,battery low"}));
    ASSERT_EQ(recording.size(), 40);
    EXPECT_DOUBLE_EQ(recording.time[39], 0.39);
    EXPECT_THAT(MessagesOf(recording), ElementsAre("run.csv:12: 2 lines that are no rows, the first is \"12:04:33 "
                                                   "temp=23\", were left out"));
  }
}

// One that stood for a row shifts all later times then.
TEST(AroundTheTable, LinesBetweenRowsWithoutTimesMustBeRemarks) {
  const std::string header = "# sample_rate_hz: 100\nangle_deg\n";
  EXPECT_THAT(MessagesOf(RecordingOf(WithLines(header, "{v}", {"Temp: 23 C", "low battery, again"}))),
              ElementsAre(HasSubstr("2 lines that are no rows, the first is \"Temp: 23 C\", were left out; the rows "
                                    "have no times, so a line that stood for a row makes later times wrong")));
  EXPECT_THAT(FaultOf(WithLines(header, "{v}", {"ovf"})),
              StartsWith("run.csv:13:1: the text \"ovf\" stands between rows that have no times"));
  const std::string pair = "# sample_rate_hz: 100\ntorque,angle_deg\n";
  EXPECT_THAT(FaultOf(WithLines(pair, "{t},{v}", {"110"})), HasSubstr("the row ends after 1 of 2 fields"));
  for (const std::string message : {"out of range", "sensor timeout error", "I2C read failed"}) {
    EXPECT_THAT(FaultOf(WithLines(header, "{v}", {message})), HasSubstr("stands between rows that have no times"));
  }
  EXPECT_THAT(FaultOf(WithLines(pair, "{t},{v}", {"bad value,110"})), HasSubstr("stands between rows that have no"));
}

TEST(AroundTheTable, ManyLinesBetweenRowsAreRefused) {
  EXPECT_THAT(FaultOf(kTable + "a\n80,108\nb\n90,109\nc\n100,110\nd\n110,111\n"),
              StartsWith("run.csv:10:1: between 12 rows stand 4 lines that are no rows, the first is \"a\": too many"));
  std::string block;
  for (int i = 0; i < 11; ++i) block += "pause\n";
  EXPECT_THAT(FaultOf(WithLines("time_ms,angle_deg\n", "{t},{v}", {block})),
              StartsWith("run.csv:12:1: this line and 10 below it are no rows"));
  // A column that ends early.
  std::string cut_off;
  for (int i = 40; i < 52; ++i) cut_off += std::to_string(10 * i) + "\n";
  EXPECT_THAT(FaultOf(WithLines("time_ms,angle_deg\n", "{t},{v}", {}) + cut_off),
              StartsWith("run.csv:42:1: this line and 11 below it are no rows"));
}

TEST(AroundTheTable, OtherTablesAndFaultyRowsAreNoStrayLines) {
  EXPECT_THAT(
      FaultOf(kTable + "time_ms,temp\n80,108\n"),
      StartsWith("run.csv:10:1: the text \"time_ms,temp\" stands between rows and may be the header of another"));
  EXPECT_THAT(FaultOf(kTable + "80,1.5x\n90,1\n"), StartsWith("run.csv:10:4: column \"angle_deg\" holds \"1.5x\""));
  EXPECT_THAT(FaultOf(kTable + "pause\n80,1.5x\n90,1\n"), HasSubstr("holds \"1.5x\""));
}

TEST(AroundTheTable, ASecondStartIsNotHidden) {
  EXPECT_THAT(FaultOf(kTable + "Ready\n" + Rows("{t},9")), HasSubstr("two recordings in one file"));
  const Recording recording = RecordingOf(kTable + "8\nReady v1\ntime_ms,angle_deg\n" + Rows("{t},9"));
  ExpectTheRows(recording, kDegree);
  EXPECT_THAT(MessagesOf(recording), ElementsAre("run.csv:10: the row \"8\" is incomplete; it was left out",
                                                 HasSubstr("the header stands again")));
}

TEST(AroundTheTable, RemarksBesideTheHeaderAreNoNames) {
  for (const std::string above : {"Ready v1\n", "Hello, world\n", "Ready\n\nv 1.2\n"}) {
    for (const std::string below : {"", "Calibrating...\nDone\n", "Calibrating gyro...\n", "Start time\n"}) {
      const Recording recording = RecordingOf(above + "millis,ADC\n" + below + Rows("{t},{v}"));
      ExpectTheRows(recording);
      EXPECT_TRUE(recording.warnings.empty()) << above << below << MessageText(recording.warnings.at(0));
    }
  }
  ExpectTheRows(RecordingOf("Ready v1\nmillis ADC\nTemp: 23 C\n" + Rows("{t} {v}")));
  // Names in a language that is not known here, above their units.
  ExpectTheRows(RecordingOf("Ido;Szog\nms;deg\n" + Rows("{t};{v}"), TimeAndValue("Ido", "Szog")), kDegree);
}

TEST(AroundTheTable, NamesMayBeSeparatedByAnotherMarkThanRows) {
  for (const auto& [header, pattern] : {std::pair("t (ms),cmd,phi (deg)", "{t}\t0\t{v}"),
                                        {"t (ms),cmd,phi (deg)", "{t};0;{v}"},
                                        {"\"t (ms),cmd,phi (deg)\"", "{t}\t0\t{v}"},
                                        {"t (ms), cmd, phi (deg)", "{t} 0 {v}"},
                                        {"# t (ms), cmd, phi (deg)", "{t} 0 {v}"},
                                        {"t (ms)\tcmd\tphi (deg)", "{t};0;{v}"},
                                        {"t (ms);cmd;phi (deg)", "{t},0,{v}"},
                                        {"t (ms) cmd phi (deg)", "{t},0,{v}"},
                                        {"t,cmd,phi\nms,V,deg", "{t}\t0\t{v}"}}) {
    const std::string phi = std::string(header).starts_with("t,") ? "phi" : "phi (deg)";
    for (const std::string above : {"", "# a\n", "--- pendolo, oggi ---\n"}) {
      if (header[0] == '#' && above.starts_with('-')) continue;
      const Recording recording =
          RecordingOf(above + header + "\n" + Rows(pattern), TimeAndValue(phi == "phi" ? "t" : "t (ms)", phi));
      ExpectTheRows(recording, kDegree);
      EXPECT_TRUE(recording.warnings.empty()) << header;
    }
  }
  std::string commas = "Tempo (s),Comando,Angolo (gradi)\r\n";
  for (int i = 0; i < 8; ++i) commas += "0,0" + std::to_string(i) + "\t0,5\t" + std::to_string(100 + i) + ",0\r\n";
  ExpectTheRows(RecordingOf(commas), kDegree);
}

// LabVIEW with `X_Columns No`: X_Value is empty, and the interval stands above.
TEST(AroundTheTable, AnEmptyColumnOfTimesIsReplacedByTheInterval) {
  for (const auto& [separator, word] : {std::pair('\t', "Tab"), {',', "Comma"}}) {
    for (const std::string step : {"0.01", "0,01"}) {
      if (separator == ',' && step == "0,01") continue;
      std::string text = std::string("LabVIEW Measurement\nSeparator|") + word +
                         "\nX_Columns|No\n***End_of_Header***\n\nChannels|1\nSamples|8\nX0|0\nDelta_X|" + step +
                         "\n***End_of_Header***\nX_Value|angle_deg|Comment\n";
      for (int i = 0; i < 8; ++i) text += "|" + std::to_string(100 + i) + step.substr(1, 1) + "0\n";
      std::ranges::replace(text, '|', separator);
      const Recording recording = RecordingOf(text);
      ExpectTheRows(recording, kDegree);
      EXPECT_TRUE(recording.warnings.empty());
    }
  }
}

TEST(AroundTheTable, AShortTableWithTextBelowHasTooFewRows) {
  EXPECT_THAT(FaultOf("time_ms,angle_deg\n" + Rows("{t},{v}", 5) + "End\n", {}, StatusCode::kFailedPrecondition),
              HasSubstr("rows of data found: 5; at least 8 are needed"));
}

const std::string kSecond = "time_ms,angle_deg\n" + Rows("{t},9");

TEST(AroundTheTable, ASecondTableIsLeftOut) {
  for (const std::string between : {"", "\n\n", "Run 2\n", "# range: [0, 1]\n"}) {
    const Recording recording = RecordingOf(kTable + between + kSecond + "End\n");
    ExpectTheRows(recording, kDegree);
    EXPECT_EQ(recording.warnings.at(0).code, "second_table") << between;
    EXPECT_FALSE(recording.range) << between;
  }
  EXPECT_THAT(MessagesOf(RecordingOf(kTable + kSecond)),
              ElementsAre("run.csv:2: the header stands again, and the times begin again; of these tables the longest "
                          "was read, 8 rows from this line on, and not: 8 from line 11; save each table in a file of "
                          "its own to fit the others"));
  EXPECT_THAT(FaultOf("time_ms,angle_deg\n" + Rows("{t},{v}", 5) + "time_ms,angle_deg\n" + Rows("{t},9", 4), {},
                      StatusCode::kFailedPrecondition),
              HasSubstr("rows of data found: 5 in the longest of 2 tables with this header"));
}

/// As of a logger that was started, and started again.
TEST(AroundTheTable, TheLongestOfSeveralTablesIsRead) {
  const std::string header = "time_ms,angle_deg\n", false_start = header + Rows("{t},7", 5);
  for (const std::string& text : {false_start + kTable, false_start + false_start + kTable,
                                  false_start + kTable + header + Rows("{t},9", 6) + "80,fault\n"}) {
    const Recording recording = RecordingOf(text);
    ExpectTheRows(recording, kDegree);
    EXPECT_EQ(recording.warnings.at(0).code, "second_table") << text;
    EXPECT_THAT(MessageText(recording.warnings.at(0)), HasSubstr("8 rows from this line on, and not: 5 from line 2"));
    EXPECT_FALSE(recording.warnings.at(0).assumed.empty());
  }
  // A fault in the longest table is none of the others'.
  EXPECT_THAT(FaultOf(false_start + kTable + "80,fault\n90,1\n"), HasSubstr("\"fault\""));
}

TEST(AroundTheTable, AHeaderAmongRowsIsSkipped) {
  const Recording recording = RecordingOf("time_ms,angle_deg\n" + Rows("{t},{v}", 3) +
                                          "time_ms,angle_deg\n30,103\n40,104\n50,105\n60,106\n70,107\n");
  ExpectTheRows(recording, kDegree);
  EXPECT_TRUE(recording.warnings.empty());
  const std::string stamped = "14:03:22.113 -> time_ms,adc_counts\n" + Rows("14:03:22.123 -> {t},{v}");
  EXPECT_EQ(RecordingOf(stamped + stamped).warnings.at(0).code, "second_table");
}

TEST(AroundTheTable, CommentsBelowTheRowsBelongToTheTable) {
  EXPECT_EQ(RecordingOf(kTable + "# resolution: 0.5\n").resolution, 0.5 * kDegree);
}

TEST(AroundTheTable, NotesBesideItAreLeftOut) {
  const Recording recording = RecordingOf("time_ms,angle_deg\n" + Rows("{t},{v},released", 1) +
                                          "10,101\n20,102,\"swings\"\n" + "30,103\n40,104\n50,105\n60,106\n70,107\n");
  ExpectTheRows(recording, kDegree);
  EXPECT_THAT(MessagesOf(recording),
              ElementsAre("run.csv:2: this row has text after its last column, \"released\"; such text was left out in "
                          "all rows; if it is a reading, name its column in the header"));
}

TEST(AroundTheTable, NamesMayHaveLineBreaks) {
  for (const std::string header : {"\"Time\n(ms)\",\"Angle\n(deg)\"\n", "\"Time\r\n(ms)\",\"Angle\r\n(deg)\"\r\n"}) {
    const Recording recording = RecordingOf(header + Rows("{t},{v}"));
    ExpectTheRows(recording, kDegree);
    EXPECT_TRUE(recording.warnings.empty()) << header;
    ExpectTheRows(RecordingOf(header + Rows("{t},{v}"), TimeAndValue("", "Angle (deg)")), kDegree);
    EXPECT_THAT(FaultOf(header + Rows("{t},{v}") + "80,x\n90,1\n"), StartsWith("run.csv:12:4: column \"Angle (deg)\""));
  }
  ExpectTheRows(RecordingOf("pipe of 5\"\n\"Time\n(ms)\",\"Angle\n(deg)\"\n" + Rows("{t},{v}")), kDegree);
}

std::string WithLineEnds(const std::string& text, const std::string& line_end) {
  std::string changed;
  for (const char c : text) changed += c == '\n' ? line_end : std::string(1, c);
  return changed;
}

TEST(AroundTheTable, LinesMayEndWithOtherCharacters) {
  ExpectTheRows(RecordingOf(WithLineEnds(kTable, "\r")), kDegree);
  ExpectTheRows(RecordingOf(WithLineEnds(kTable, "\r\r\n")), kDegree);  // Python's csv on Windows without newline=''
}

}  // namespace
}  // namespace pendulum::around_the_table_test
