// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/calibration/calibration_table.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recording/calibration_examples.h"

namespace pendulum::calibration_table_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::string FaultOf(const std::string& text) {
  const Result<CalibrationTable> table = ParseCalibrationTable(text, "table.csv");
  EXPECT_FALSE(table.has_value()) << text;
  if (table) return "";
  EXPECT_EQ(table.error().code, StatusCode::kDataLoss);
  return table.error().message();
}

void ExpectReadings(const std::string& text, const std::string& input, const std::string& angle_unit) {
  const CalibrationTable table = TableOf(text);
  EXPECT_EQ(table.input, input) << text;
  EXPECT_EQ(table.angle_unit, angle_unit) << text;
  EXPECT_THAT(table.reading, ElementsAre(1.5, 2.5)) << text;
  EXPECT_THAT(table.angle, ElementsAre(-3, 4)) << text;
}

TEST(ParseCalibrationTable, ReadsReadingsAnglesAndTheirLines) {
  const CalibrationTable table = TableOf(std::string("# by hand\n\n") + kReferenceTable);
  EXPECT_EQ(table.path, "table.csv");
  EXPECT_EQ(table.input, "counts");
  EXPECT_EQ(table.angle_unit, "deg");
  EXPECT_THAT(table.reading, ElementsAre(19, 97, 177, 261, 324, 396, 475));
  EXPECT_THAT(table.angle, ElementsAre(-45, -30, -15, 0, 15, 30, 45));
  EXPECT_THAT(table.line, ElementsAre(4, 5, 6, 7, 8, 9, 10));
  EXPECT_EQ(table.Place(3), "table.csv:7");
}

TEST(ParseCalibrationTable, IdentifiesColumnsByUnitInAnyOrder) {
  ExpectReadings("counts,angle_deg\n1.5,-3\n2.5,4\n", "counts", "deg");
  ExpectReadings("angle_rad,adc_counts\n-3,1.5\n4,2.5\n", "counts", "rad");
  ExpectReadings("Pot (volts),Angle [°]\n1.5,-3\n2.5,4\n", "volts", "deg");
  ExpectReadings("note,volts,who,deg\nfirst,1.5,A,-3\n\"second, again\",2.5,B,4\n", "volts", "deg");
}

TEST(ParseCalibrationTable, AcceptsTheSeparatorsOfRecordings) {
  ExpectReadings("counts;angle_deg\r\n1,5;-3\r\n2,5;4\r\n", "counts", "deg");
  ExpectReadings(
      "\xEF\xBB\xBF"
      "counts\tangle_deg\n1.5\t-3\n# pause\n2.5\t4",
      "counts", "deg");
  ExpectReadings("counts  angle_deg\n  1.5  -3\n  2.5   4\n", "counts", "deg");
  ExpectReadings("sep=;\n\"counts\";\"angle_deg\"\n\"1.5\";-3\n;\n2.5;4\n", "counts", "deg");
}

TEST(ParseCalibrationTable, AcceptsRowsInAnyOrderAndFallingAngles) {
  const CalibrationTable table = TableOf("counts,angle_deg\n300,-20\n100,20\n200,0\n");
  EXPECT_THAT(table.reading, ElementsAre(300, 100, 200));
  EXPECT_THAT(table.ByReading(), ElementsAre(1, 2, 0));
}

TEST(ParseCalibrationTable, AcceptsEqualAnglesAtAdjacentReadings) {
  EXPECT_EQ(TableOf("volts,angle_deg\n1,0\n1.01,0\n2,10\n1.99,10\n").size(), 4);  // set from both sides
}

TEST(ParseCalibrationTable, NamesTheMissingColumn) {
  EXPECT_EQ(FaultOf("counts,angle\n1,2\n"),
            "table.csv:1:1: no column's name shows that it is the angle; end the name in its unit, _deg or _rad");
  EXPECT_EQ(
      FaultOf("# x\nreading,angle_deg\n1,2\n"),
      "table.csv:2:1: no column's name shows that it is the reading; end the name in its unit, _counts or _volts");
  EXPECT_THAT(FaultOf("19,-45\n97,-30\n"),
              StartsWith("table.csv:1:1: the first row has numbers instead of column names; put "
                         "a header above it that gives the units, such as counts,angle_deg"));
}

TEST(ParseCalibrationTable, RefusesAmbiguousColumns) {
  EXPECT_EQ(FaultOf("counts,angle_deg,counts\n1,2,3\n"),
            "table.csv:1:18: columns \"counts\" and \"counts\" could both be the reading; delete one of them");
  EXPECT_EQ(FaultOf("counts,angle_deg,angle_rad\n1,2,3\n"),
            "table.csv:1:18: columns \"angle_deg\" and \"angle_rad\" could both be the angle; delete one of them");
  EXPECT_THAT(FaultOf("counts,pot_volts,angle_deg\n1,2,3\n"), HasSubstr("could both be the reading"));
  EXPECT_THAT(FaultOf("counts,angle_deg [rad]\n1,2\n"),
              HasSubstr("column \"angle_deg [rad]\" names two units, deg and rad; keep the unit of"));
}

TEST(ParseCalibrationTable, RefusesColumnsOfOtherUnits) {
  for (const std::string name : {"time_s", "delay_ms", "rate_deg_s", "x_px"}) {
    EXPECT_THAT(FaultOf("counts,angle_deg," + name + "\n1,2,3\n"),
                StartsWith("table.csv:1:18: column \"" + name + "\" is in "));
  }
}

TEST(ParseCalibrationTable, NamesTheFaultyField) {
  const std::string header = "counts,angle_deg\n1,2\n";
  EXPECT_EQ(FaultOf(header + "x,3\n"),
            "table.csv:3:1: column \"counts\" holds \"x\", which is not a number; correct the field or delete the row");
  EXPECT_THAT(FaultOf(header + "2,nan\n"), StartsWith("table.csv:3:3: column \"angle_deg\" holds \"nan\", and a "));
  EXPECT_THAT(FaultOf(header + "1e999,3\n"), HasSubstr("which is outside the range of numbers"));
  EXPECT_THAT(FaultOf(header + "5,\n"), HasSubstr("is empty where a number is needed"));
  EXPECT_EQ(FaultOf(header + "5\n"), "table.csv:3:2: the row ends after 1 of 2 fields; complete the row or delete it");
  EXPECT_THAT(FaultOf(header + "1,5,3\n"), HasSubstr("field 3 holds \"3\" beyond the header's 2 columns"));
}

TEST(ParseCalibrationTable, RefusesATableWithoutRows) {
  EXPECT_THAT(FaultOf(""), StartsWith("table.csv:1:1: the file is empty; a calibration table has a header such as "));
  EXPECT_THAT(FaultOf("# nothing\n\n"), StartsWith("table.csv:2:1: the file names no column; "));
  EXPECT_THAT(FaultOf("counts,angle_deg\n"), StartsWith("table.csv:1:1: the header is followed by no row; "));
  EXPECT_EQ(FaultOf("counts,angle_deg\n1,2\n"), "table.csv:2: points found: 1; a calibration needs at least 2 of them");
}

TEST(ParseCalibrationTable, RefusesBytesThatAreNotText) {
  EXPECT_THAT(FaultOf(std::string("counts,angle_deg\n1,\0\n", 21)), StartsWith("table.csv:2:3: there is a NUL byte"));
  EXPECT_THAT(FaultOf(std::string(2'000'000, 'x')), HasSubstr("this line is longer than 1 MiB"));
}

TEST(ParseCalibrationTable, RefusesARecording) {
  std::string text = "counts,angle_deg\n";
  for (int i = 0; i <= kMaxCalibrationPoints; ++i) text += std::to_string(i) + "," + std::to_string(i) + "\n";
  EXPECT_EQ(FaultOf(text),
            "table.csv:10002:1: there are more than 10000 rows; a calibration table has one row for each angle");
}

TEST(ParseCalibrationTable, RefusesARepeatedReading) {
  EXPECT_EQ(FaultOf("counts,angle_deg\n1,0\n3,20\n2,10\n3,30\n"),
            "table.csv:5: the reading 3 counts (line 3) is repeated with another angle; give their mean, or "
            "correct or delete one of "
            "the rows");
  EXPECT_EQ(FaultOf("counts,angle_deg\n1,0\n3,20\n2,10\n3,20\n"),
            "table.csv:5: the reading 3 counts (line 3) is repeated with the same angle; give their mean, or "
            "delete one of the rows");
}

TEST(ParseCalibrationTable, RefusesAnglesThatGoBack) {
  EXPECT_EQ(FaultOf("counts,angle_deg\n19,-45\n97,-30\n177,15\n261,0\n324,16\n"),
            "table.csv:5: the angle is 0 deg at 261 counts (line 5) and 15 at 177 counts (line 4), but elsewhere it "
            "rises as the reading rises; correct or delete one of these rows");
  EXPECT_THAT(FaultOf("volts,angle_rad\n4,1\n3,2\n2,1.5\n1,3\n"),
              StartsWith("table.csv:4: the angle is 1.5 rad at 2 volts (line 4) and 2 at 3 volts (line 3), but "
                         "elsewhere it falls"));
  EXPECT_EQ(FaultOf("counts,angle_deg\n1,5\n2,5\n3,5\n"),
            "table.csv:4: all angles up to here are the same; set different angles");
}

TEST(MakeCalibrationTable, RefusesNonFiniteNumbers) {
  const auto made = MakeCalibrationTable(TableOf("counts", "deg", {1, 2}, {0, std::nan("")}));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().message(), "table.csv: readings and angles must be finite");
}

TEST(ReadCalibrationTable, NamesAMissingFile) {
  const auto table = ReadCalibrationTable("none/table.csv");
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().code, StatusCode::kNotFound);
  EXPECT_EQ(table.error().message(), "none/table.csv: there is no such file; check the path");
}

}  // namespace
}  // namespace pendulum::calibration_table_test
