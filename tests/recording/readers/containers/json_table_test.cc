// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/json_table.h"

#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/format.h"
#include "tests/recording/rows.h"

namespace pendulum::json_table_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// The text of the only table.
std::string TextOf(const std::string& json) {
  const Workbook workbook = ReadJsonTables(json, 100'000);
  EXPECT_EQ(workbook.complaint, "");
  EXPECT_EQ(workbook.sheets.size(), 1);
  return workbook.sheets.empty() ? "" : workbook.sheets.front().text;
}

/// [0, 0.01, ..., 0.07] and [100, ..., 107] as in ExpectTheRows, in a pattern of two numbers for each row.
std::string Items(const std::string& pattern, const std::string& separator = ", ") {
  std::string items;
  for (int i = 0; i < 8; ++i) {
    std::string item = pattern;
    for (const auto& [mark, text] :
         {std::pair{"{i}", std::to_string(i)}, {"{t}", "0.0" + std::to_string(i)}, {"{v}", std::to_string(100 + i)}}) {
      for (std::size_t at = 0; (at = item.find(mark)) != std::string::npos;) item.replace(at, 3, text);
    }
    items += (i == 0 ? "" : separator) + item;
  }
  return items;
}

const std::string kTimes = "[" + Items("{t}") + "]", kAngles = "[" + Items("{v}") + "]";

TEST(ReadJsonTables, ReadsEveryForm) {
  for (const std::string& json :
       {R"({"time_s": )" + kTimes + R"(, "angle_rad": )" + kAngles + "}",
        "\xEF\xBB\xBF \n {\n  \"time_s\": " + kTimes + ",\n  \"angle_rad\": " + kAngles + "\n}\n",
        "[" + Items(R"({"time_s": {t}, "angle_rad": {v}})") + "]",
        "[" + Items(R"({"time_s": {t}, "angle_rad": {v}})", ",\n") + "]\n",
        Items(R"({"time_s": {t}, "angle_rad": {v}})", "\n"),
        Items(R"({"time_s": {t}, "angle_rad": {v}})", "\r\n\r\n") + "\r\n",
        R"([["time_s", "angle_rad"], )" + Items("[{t}, {v}]") + "]",
        R"({"time_s": {)" + Items(R"("{i}": {t})") + R"(}, "angle_rad": {)" + Items(R"("{i}": {v})") + "}}",
        "{" + Items(R"("{i}": {"time_s": {t}, "angle_rad": {v}})") + "}",
        R"({"columns": ["time_s", "angle_rad"], "index": [0, 1], "data": [)" + Items("[{t}, {v}]") + "]}",
        R"({"schema": {"fields": []}, "data": [)" + Items(R"({"time_s": {t}, "angle_rad": {v}})") + "]}",
        R"({"device": "x", "data": {"time_s": )" + kTimes + R"(, "angle_rad": )" + kAngles + "}}",
        R"({"samples": [)" + Items(R"({"time_s": {t}, "angle_rad": {v}})") + "]}",
        R"({"buffer": {"time_s": {"size": 0, "updateMode": "full", "buffer": )" + kTimes +
            R"(}, "angle_rad": {"size": 0, "buffer": )" + kAngles + R"(}}, "status": {"measuring": false}})"}) {
    SCOPED_TRACE(json);
    ExpectTheRows(RecordingOf(json));
  }
}

TEST(ReadJsonTables, ReadsRowsWithoutNames) {
  for (const std::string& json : {"[" + Items("[{t}, {v}]") + "]", Items("[{t}, {v}]", "\n")}) {
    ExpectTheRows(RecordingOf(json, TimeAndValue("1", "2", "rad")));
  }
  ReadOptions options = Unit("rad", 100);
  ExpectTheRows(RecordingOf(kAngles, options));
}

TEST(ReadJsonTables, AFewLongListsAreColumns) {
  ExpectTheRows(
      RecordingOf("[[0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07], " + kAngles + "]", TimeAndValue("1:s", "2", "rad")));
}

TEST(ReadJsonTables, ReadsMetadataBesideTheArrays) {
  const Recording recording =
      RecordingOf(R"({"device": "esp32", "sample_rate_hz": 100, "resolution": 0.5, "range": [0, 1023], )"
                  R"("rig": {"gravity_torque": 1.8}, "angle_rad": )" +
                  kAngles + "}");
  ExpectTheRows(recording);
  EXPECT_EQ(recording.resolution, 0.5);
  EXPECT_EQ(recording.range->high, 1023);
  EXPECT_EQ(recording.rig_json, R"({"gravity_torque":1.8})");
  EXPECT_TRUE(RecordingOf(R"({"resolution": "1920x1080", "time_s": )" + kTimes + R"(, "angle_rad": )" + kAngles + "}")
                  .warnings.empty());
}

TEST(ReadJsonTables, WritesCellsAsTheyAre) {
  EXPECT_EQ(TextOf(R"({"a": [1, 0.1, null], "b c": ["x;y", true, -5e-300], "n": [1709302471273000000]})"),
            "a;b c;n\n1;\"x;y\";1709302471273000000\n0.1;TRUE;\n;-5e-300;\n");
  EXPECT_EQ(TextOf("{\"a\": [NaN, 1, Infinity, -Infinity], \"b\": [\"NaN\", 2, 3, 4]}"), "a;b\n;NaN\n1;2\n;3\n;4\n");
  EXPECT_EQ(TextOf(R"([{"t": 0, "gyro": {"x": 1, "y": 2}}, {"t": 1, "gyro": {"y": 3}, "acc": [4, 5]}])"),
            "t;gyro.x;gyro.y;acc.0;acc.1\n0;1;2;;\n1;;3;4;5\n");
}

TEST(ReadJsonTables, NamesTheTablesOfAnObject) {
  const std::string two = R"({"gyro": {"time_s": )" + kTimes + R"(, "rate_rad_s": )" + kAngles +
                          R"(}, "encoder": {"time_s": )" + kTimes + R"(, "angle_rad": )" + kAngles + "}}";
  EXPECT_EQ(
      FaultOf(two),
      "run.csv: columns \"gyro/rate_rad_s\" and \"encoder/angle_rad\" could both be the quantity; choose one with "
      "--value_column");
  ExpectTheRows(RecordingOf(two, TimeAndValue("", "encoder/angle_rad")));
}

TEST(ReadJsonTables, LeavesOutALineThatIsCutOff) {
  const std::string cut = Items(R"({"time_s": {t}, "angle_rad": {v}})", "\n") + "\n{\"time_s\": 0.08, \"ang";
  const Recording recording = RecordingOf(cut);
  ExpectTheRows(recording);
  ASSERT_EQ(recording.warnings.size(), 1);
  EXPECT_EQ(recording.warnings[0].code, "incomplete_row");
}

TEST(ReadJsonTables, ReportsTheLineAndColumnOfAFault) {
  EXPECT_THAT(FaultOf("{\"t\": [0, 1],\n \"angle_deg\": [0, oops]}"), StartsWith("run.csv:2:19: this is not JSON ("));
  EXPECT_THAT(FaultOf("{\"t\": 0}\n{\"t\": 1\n{\"t\": 2}\n"), StartsWith("run.csv:2:"));
  EXPECT_THAT(FaultOf("{\"t\": [0, 1"), StartsWith("run.csv:1:"));
  EXPECT_THAT(FaultOf("{\"t\": [1e999, 1]}"), HasSubstr("this is not JSON (a number is out of range)"));
  EXPECT_EQ(FaultOf("{\"name\": \"x\"}"),
            "run.csv: this JSON has no arrays of numbers; a recording is {\"t\": [0, 0.01], \"angle_deg\": [10, 9.9]}");
  EXPECT_THAT(FaultOf("{\"rows\": []}"), HasSubstr("no arrays of numbers"));
}

TEST(ReadJsonTables, LimitsDepthAndSize) {
  EXPECT_THAT(FaultOf(std::string(100'000, '[')), HasSubstr("more than 32 nested brackets"));
  std::string objects;
  for (int i = 0; i < 50'000; ++i) objects += "{\"a\":";
  EXPECT_THAT(FaultOf(objects), HasSubstr("more than 32 nested brackets"));
  ReadOptions options;
  options.most_unpacked_bytes = 50;
  EXPECT_THAT(FaultOf("{\"time_s\": " + kTimes + ", \"angle_rad\": " + kAngles + "}", options),
              HasSubstr("too many for a recording"));
}

/// Objects of pandas have a key for each row; the time must not grow with its square.
TEST(ReadJsonTables, ReadsALongObjectQuickly) {
  std::string times, angles;
  constexpr int kRows = 200'000;
  for (int i = 0; i < kRows; ++i) {
    const std::string key = (i == 0 ? "\"" : ",\"") + std::to_string(i) + "\":";
    times += key + NumberText(i / 100.0);
    angles += key + NumberText(0.4 * std::cos(0.049 * i));
  }
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(RecordingOf("{\"time_s\":{" + times + "},\"angle_rad\":{" + angles + "}}").size(), kRows);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST(ReadJsonTables, LeavesTablesInBracketsToTheTextReader) {
  ExpectTheRows(RecordingOf("time [s],angle [rad]\n" + Rows("0.0{t},{v}")));
  EXPECT_THAT(FaultOf("[Header]\nx\n"), StartsWith("run.csv:1:1: none of the columns"));
}

}  // namespace
}  // namespace pendulum::json_table_test
