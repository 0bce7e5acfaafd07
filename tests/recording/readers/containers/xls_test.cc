// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/xls.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/format.h"
#include "recording/readers/containers/compound_file.h"
#include "tests/recording/rows.h"
#include "tests/recording/xls_files.h"

namespace pendulum::xls_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::size_t kMaxBytes = 1'000'000;

/// The text of the first sheet.
std::string TextOfSheet(const std::string& records, const std::string& globals = "") {
  const Workbook workbook = ReadXls(XlsOf({{"Sheet1", records}}, globals), kMaxBytes);
  EXPECT_EQ(workbook.complaint, "");
  return workbook.sheets.empty() ? "" : workbook.sheets.front().text;
}

std::string Xf(int format) { return BiffRecordOf(0x00E0, U16(0) + U16(format) + std::string(16, '\0')); }
std::string Format(int number, const std::string& code) { return BiffRecordOf(0x041E, U16(number) + BiffText(code)); }

/// The result of a formula that is no number.
std::string OtherResult(int kind, int value = 0) {
  return std::string(1, static_cast<char>(kind)) + '\0' + static_cast<char>(value) + std::string(3, '\0') + "\xFF\xFF";
}

TEST(ReadXls, ReadsNumbersExactly) {
  const double odd = 0.1 + 0.2;
  EXPECT_EQ(TextOfSheet(NumberRecord(0, 0, odd) + NumberRecord(0, 1, -1e-300) + NumberRecord(1, 0, 7)),
            "0.30000000000000004;-1e-300\n7;\n");
}

/// The examples of [MS-XLS] 2.5.217: the two lowest bits tell whether the number is an integer, and in hundredths.
TEST(ReadXls, ReadsCompressedNumbers) {
  EXPECT_EQ(TextOfSheet(RkRecord(0, 0, (5U << 2) | 2) + RkRecord(0, 1, (static_cast<std::uint32_t>(-5) << 2) | 2) +
                        RkRecord(0, 2, (12345U << 2) | 3) + RkRecord(0, 3, 0x3FF80000)),
            "5;-5;123.45;1.5\n");
  const std::string several =
      BiffRecordOf(0x00BD, U16(0) + U16(1) + U16(0) + U32(10) + U16(0) + U32(14) + U16(2));  // 2 and 3 from column 1
  EXPECT_EQ(TextOfSheet(several), ";2;3\n");
}

TEST(ReadXls, ReadsTextsOfAllKinds) {
  const std::string strings = BiffRecordOf(0x00FC, U32(2) + U32(2) + BiffText("Time (s)") + U16(2) + '\1' +
                                                       std::string("\xB8\x03\x31\x00", 4));  // θ1 in two bytes each
  const auto shared = [](int column, int index) { return BiffRecordOf(0x00FD, At(0, column) + U32(index)); };
  EXPECT_EQ(TextOfSheet(shared(0, 0) + shared(1, 1) + LabelRecord(0, 2, "a;b"), strings), "Time (s);θ1;\"a;b\"\n");
}

TEST(ReadXls, ReadsSharedStringsThatContinueInTheNextRecord) {
  const std::string first = U32(3) + U32(3) + BiffText("one") + U16(6) + '\0' + "abc";
  // The characters go on with two bytes each; rich text has a list of runs after it, which is cut too.
  const std::string second = '\1' + std::string("d\0e\0f\0", 6) + U16(2) + '\x8' + U16(2) + "xy" + std::string(5, 'r');
  const std::string third(3, 'r');
  const std::string strings = BiffRecordOf(0x00FC, first) + BiffRecordOf(0x003C, second) + BiffRecordOf(0x003C, third);
  std::string cells;
  for (int i = 0; i < 3; ++i) cells += BiffRecordOf(0x00FD, At(0, i) + U32(i));
  EXPECT_EQ(TextOfSheet(cells, strings), "one;abcdef;xy\n");
}

TEST(ReadXls, ReadsTheResultsOfFormulas) {
  const std::string cells = FormulaRecord(0, 0, LittleEndian(0.25)) + FormulaRecord(0, 1, OtherResult(0)) +
                            BiffRecordOf(0x0207, BiffText("text")) + FormulaRecord(0, 2, OtherResult(1, 1)) +
                            FormulaRecord(0, 3, OtherResult(2, 0x2A)) + NumberRecord(0, 4, 9);
  EXPECT_EQ(TextOfSheet(cells), "0.25;text;TRUE;;9\n");
}

TEST(ReadXls, LeavesErrorsEmpty) {
  const std::string error = BiffRecordOf(0x0205, At(0, 0) + std::string("\x2A\1", 2));
  const std::string truth = BiffRecordOf(0x0205, At(0, 1) + std::string("\1\0", 2));
  EXPECT_EQ(TextOfSheet(error + truth), ";TRUE\n");
}

/// 45352 is 1 March 2024: Excel's day 1 is 1 January 1900, and it has a day 60 too many.
TEST(ReadXls, ReadsTimesWithTheirFormat) {
  const double moment = 45352 + (16 * 3600 + 4 * 60 + 31.273) / 86400;
  const std::string globals = Format(164, "yyyy\\-mm\\-dd hh:mm:ss.000") + Xf(0) + Xf(164) + Xf(21) + Xf(2);
  EXPECT_EQ(
      TextOfSheet(NumberRecord(0, 0, moment, 1) + NumberRecord(0, 1, moment - 45352, 2) + NumberRecord(0, 2, moment, 3),
                  globals),
      "2024-03-01T16:04:31.273;16:04:31.273;" + NumberText(moment) + "\n");
  const std::string mode_1904 = BiffRecordOf(0x0022, U16(1)) + Xf(22);
  EXPECT_EQ(TextOfSheet(NumberRecord(0, 0, 45352 - 1462, 0), mode_1904), "2024-03-01T00:00:00\n");
}

TEST(ReadXls, SortsCellsAndIgnoresEmbeddedCharts) {
  const std::string chart = BeginRecord(0x20) + NumberRecord(0, 0, 99) + EndRecord();
  EXPECT_EQ(TextOfSheet(NumberRecord(1, 0, 3) + chart + NumberRecord(0, 1, 2) + NumberRecord(0, 0, 1)), "1;2\n3;\n");
}

TEST(ReadXls, ReadsTheStringsOfExcel5) {
  const std::string label = BiffRecordOf(0x0204, At(0, 0) + U16(2) +
                                                     "\xB0"
                                                     "C");
  const std::string sheet = BeginRecord(0x10, 0x0500) + label + EndRecord();
  std::string globals = BeginRecord(5, 0x0500);
  const std::size_t offset = globals.size() + BiffRecordOf(0, std::string(7 + 3, 0)).size() + EndRecord().size();
  globals += BiffRecordOf(0x0085, U32(static_cast<std::uint32_t>(offset)) + std::string("\0\0\3", 3) + "Run");
  const Workbook workbook = ReadXls(CompoundFileOf({{"Book", globals + EndRecord() + sheet}}), kMaxBytes);
  ASSERT_EQ(workbook.sheets.size(), 1) << workbook.complaint;
  EXPECT_EQ(workbook.sheets[0].name, "Run");
  EXPECT_EQ(workbook.sheets[0].text, "°C\n");
}

TEST(ReadXls, SkipsChartsAndSaysSoIfThereIsNothingElse) {
  const Workbook both = ReadXls(XlsOf({{"Chart1", "", 2}, {"Sheet1", NumberRecord(0, 0, 1)}}), kMaxBytes);
  ASSERT_EQ(both.sheets.size(), 1);
  EXPECT_EQ(both.sheets[0].name, "Sheet1");
  EXPECT_THAT(FaultOf(XlsOf({{"Chart1", "", 2}})), StartsWith("run.csv: this workbook has no sheet with cells"));
  EXPECT_THAT(FaultOf(XlsOf({{"Sheet1", ""}})), HasSubstr("has no cells with numbers"));
}

TEST(ReadXls, RefusesEncryptedWorkbooks) {
  EXPECT_EQ(FaultOf(XlsOf({{"Sheet1", NumberRecord(0, 0, 1)}}, BiffRecordOf(0x002F, std::string(54, 'x')))),
            "run.csv: this workbook is encrypted; save it without a password");
}

TEST(ReadXls, RefusesACutOffWorkbook) {
  std::string cells;
  for (int i = 0; i < 2000; ++i) cells += NumberRecord(i, 0, i);
  const std::string whole = XlsOf({{"Sheet1", cells}});
  for (std::size_t size = 8; size < whole.size(); size += 977) {
    EXPECT_THAT(FaultOf(whole.substr(0, size)), StartsWith("run.csv: this ")) << size;
  }
}

TEST(ReadXls, LimitsTheText) {
  std::string cells;
  for (int i = 0; i < 2000; ++i) cells += NumberRecord(i, 0, i);
  EXPECT_TRUE(ReadXls(XlsOf({{"Sheet1", cells}}), 1000).is_too_large);
}

TEST(CompoundFile, SurvivesDamage) {
  const std::string whole = XlsOf({{"Sheet1", NumberRecord(0, 0, 1)}});
  for (std::size_t at = 24; at < whole.size(); at += at < 512 ? 1 : 61) {
    for (const char byte : {'\0', '\1', '\x7F', '\xFF'}) {
      std::string damaged = whole;
      damaged[at] = byte;
      const CompoundFile file(damaged);
      if (const auto stream = file.Read("Workbook")) {
        EXPECT_LE(stream->size(), damaged.size());
      }
    }
  }
}

TEST(ReadXls, GivesTheSameRecordingAsCsv) {
  std::string cells = LabelRecord(0, 0, "time_s") + LabelRecord(0, 1, "angle_rad"), csv = "time_s,angle_rad\n";
  for (int i = 0; i < 200; ++i) {
    const double time = i / 30.0, angle = 0.4 * std::cos(4.9 * time);
    cells += NumberRecord(i + 1, 0, time) + NumberRecord(i + 1, 1, angle);
    csv += NumberText(time) + "," + NumberText(angle) + "\n";
  }
  const Recording expected = RecordingOf(csv), recording = RecordingOf(XlsOf({{"Sheet1", cells}}));
  EXPECT_EQ(recording.time, expected.time);
  EXPECT_EQ(recording.value, expected.value);
  EXPECT_EQ(recording.resolution, expected.resolution);
}

}  // namespace
}  // namespace pendulum::xls_test
