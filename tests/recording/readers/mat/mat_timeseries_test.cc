// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_timeseries.h"

#include <cstddef>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recording/mat_objects_5.h"
#include "tests/recording/mat_objects_73.h"
#include "tests/recording/rows.h"
#include "tests/recording/timeseries_files.h"

namespace pendulum::mat_timeseries_test {
namespace {

using objects::AddSeries;
using objects::Array;
using objects::Classes;
using objects::File;
using objects::FileOf;
using objects::Letters;
using objects::Series;
using testing::ElementsAre;
using testing::HasSubstr;

// The rows that ExpectTheRows expects, in radians.
Series Angle() {
  Series series;
  series.data_unit = "rad";
  return series;
}

ReadOptions Value(const std::string& column, const std::string& unit = "") { return TimeAndValue("", column, unit); }

/// Version, byte order and compression of a file.
enum class FileForm { kLittle, kBig, kPacked, kPackedBig, kHdf5, kPackedHdf5 };

class InEveryFileForm : public testing::TestWithParam<FileForm> {
 protected:
  static std::string BytesOf(const File& file) {
    const FileForm form = GetParam();
    if (form == FileForm::kHdf5 || form == FileForm::kPackedHdf5)
      return objects::Version73(file, form == FileForm::kPackedHdf5);
    return objects::Version5(file, {form == FileForm::kBig || form == FileForm::kPackedBig,
                                    form == FileForm::kPacked || form == FileForm::kPackedBig});
  }
};

TEST_P(InEveryFileForm, ReadsATimeseriesForAnyTableVersion) {
  for (const int version : {2, 3, 4}) ExpectTheRows(RecordingOf(BytesOf(FileOf(Angle(), "ts", version))));
}

TEST_P(InEveryFileForm, TakesTheUnitFromTheDataOrAName) {
  Series series;
  ExpectTheRows(RecordingOf(BytesOf(FileOf(series, "angle_deg"))), kDegree);
  ExpectTheRows(RecordingOf(BytesOf(FileOf(series, "ts")), Unit("deg")), kDegree);
  EXPECT_THAT(FaultOf(BytesOf(FileOf(series, "ts"))), HasSubstr("column \"ts.Data\" does not give its unit"));
  series.name = "angle_deg";
  ExpectTheRows(RecordingOf(BytesOf(FileOf(series, "ts"))), kDegree);
  for (const char* const unit : {"deg", "degrees"}) {
    series.name = "phi";
    series.data_unit = unit;
    ExpectTheRows(RecordingOf(BytesOf(FileOf(series, "ts"))), kDegree);
    EXPECT_THAT(FaultOf(BytesOf(FileOf(series, "angle_rad"))), HasSubstr("names two units"));
  }
  series.data_unit = "N*m";
  EXPECT_THAT(FaultOf(BytesOf(FileOf(series, "angle_rad"))), HasSubstr("is an angle, a rate or another"));
}

TEST_P(InEveryFileForm, ReadsListedAndUniformTimes) {
  const auto expect = [](double second, const std::string& unit) {
    Series series = Angle();
    series.time_unit = unit;
    series.start = 0;
    series.increment = 0.01 * second;
    const Recording uniform = RecordingOf(BytesOf(FileOf(series)));
    for (int i = 0; i < 8; ++i) series.times.push_back(0.01 * second * i);
    const Recording listed = RecordingOf(BytesOf(FileOf(series)));
    for (const Recording& recording : {uniform, listed}) {
      ASSERT_EQ(recording.size(), 8) << unit;
      for (int i = 0; i < 8; ++i) EXPECT_NEAR(recording.time[i], i / 100.0, 1e-15) << unit;
      EXPECT_TRUE(recording.warnings.empty()) << unit;
    }
  };
  // One second in each unit (BIPM, SI brochure, tables 7 and 8).
  expect(1, "seconds");
  expect(1e3, "milliseconds");
  expect(1e6, "microseconds");
  expect(1e9, "nanoseconds");
  expect(1.0 / 60, "minutes");
  expect(1.0 / 3600, "hours");
  expect(1.0 / 86'400, "days");
  expect(1.0 / 604'800, "weeks");
}

TEST_P(InEveryFileForm, AnEmptyTimeUnitIsUnknown) {
  Series series = Angle();
  series.is_unit_emptied = true;
  const Recording recording = RecordingOf(BytesOf(FileOf(series)));
  ASSERT_EQ(recording.warnings.size(), 1);
  EXPECT_EQ(recording.warnings[0].code, "time_unit_assumed");
  series.increment = 10;
  ExpectTheRows(RecordingOf(BytesOf(FileOf(series))));
  ExpectTheRows(RecordingOf(BytesOf(FileOf(series)), TimeAndValue("ts.Time:ms", "ts.Data")));
}

TEST_P(InEveryFileForm, ReadsWholeNumbersOfATimeWithAUnit) {
  Series series = Angle();
  series.start = 5;
  series.increment = 2;
  const Recording recording = RecordingOf(BytesOf(FileOf(series)));
  EXPECT_DOUBLE_EQ(recording.time[7] - recording.time[0], 14);
}

TEST_P(InEveryFileForm, TimeIsTheThirdOrMatchingDimension) {
  Series series = Angle();
  series.sizes = {1, 1, 8};
  ExpectTheRows(RecordingOf(BytesOf(FileOf(series))));
  series.sizes = {1, 8};
  ExpectTheRows(RecordingOf(BytesOf(FileOf(series))));
  series.sizes = {8, 2};
  for (int i = 0; i < 8; ++i) series.data.push_back(-i);
  const std::string columns = BytesOf(FileOf(series));
  ExpectTheRows(RecordingOf(columns, Value("ts.Data(:,1)")));
  EXPECT_THAT(FaultOf(columns), HasSubstr("\"ts.Data(:,1)\" and \"ts.Data(:,2)\" could both be the quantity"));
  std::vector<double> mixed;
  for (int i = 0; i < 8; ++i) mixed.insert(mixed.end(), {-1.0 * i, 100.0 + i});
  series.data = mixed;
  series.sizes = {2, 1, 8};
  ExpectTheRows(RecordingOf(BytesOf(FileOf(series)), Value("ts.Data(2,1,:)")));
  series.sizes = {1, 2, 8};
  ExpectTheRows(RecordingOf(BytesOf(FileOf(series)), Value("ts.Data(1,2,:)")));
  series.sizes = {2, 8};
  ExpectTheRows(RecordingOf(BytesOf(FileOf(series)), Value("ts.Data(2,:)")));
}

TEST_P(InEveryFileForm, ReadsTheChosenOneOfTwoTimeseries) {
  File file;
  const Classes classes(file);
  const std::size_t first = AddSeries(file, classes, Angle());
  Series slow = Angle();
  slow.increment = 1;
  const std::size_t second = AddSeries(file, classes, slow);
  file.AddVariable("slow", file.Reference({second}, true));
  file.AddVariable("fast", file.Reference({first}, true));
  const std::string bytes = BytesOf(file);
  EXPECT_THAT(FaultOf(bytes), HasSubstr("\"fast.Data\" and \"slow.Data\" could both be the quantity"));
  ExpectTheRows(RecordingOf(bytes, Value("fast.Data")));
  EXPECT_DOUBLE_EQ(RecordingOf(bytes, Value("slow.Data")).time[7], 7);
}

TEST_P(InEveryFileForm, ReadsATimeseriesInAStructureArrayOrObject) {
  File file;
  const Classes classes(file);
  const std::size_t one = AddSeries(file, classes, Angle()), two = AddSeries(file, classes, Angle());
  Series named = Angle();
  named.name = "pot";
  const std::size_t three = AddSeries(file, classes, named), four = AddSeries(file, classes, Angle());
  const std::size_t container = file.AddClass("Simulink.SimulationData", "Dataset");
  const std::size_t logs = file.AddObject(container, {{"Elements_", objects::Cells({file.Reference({three})})}});
  file.AddVariable("run", objects::Struct({{"gain", objects::Number(2)},
                                           {"both", file.Reference({one, two}, true)},
                                           {"after", objects::Numbers({8, 1}, {9, 9, 9, 9, 9, 9, 9, 9})}}));
  file.AddVariable("logsout", file.Reference({logs}, true));
  const std::string bytes = BytesOf(file);
  for (const char* const name : {"run.both(1)", "run.both(2)", "pot", "timeseries 4"}) {
    ExpectTheRows(RecordingOf(bytes, Value(std::string(name) + ".Data")));
  }
  EXPECT_EQ(four, 12);
}

TEST_P(InEveryFileForm, ExplainsAnUnreadableTimeseries) {
  const std::string advice =
      "; save its numbers in MATLAB, for a timeseries ts: t = ts.Time; angle_deg = ts.Data; "
      "save('run.mat', 't', 'angle_deg')";
  const auto fault = [](const Series& series) { return FaultOf(BytesOf(FileOf(series))); };
  Series series = Angle();
  series.storage = objects::Number(1);
  EXPECT_EQ(fault(series), "run.csv: variable \"ts\" is a timeseries whose numbers are in another file" + advice);
  series = Angle();
  series.data.clear();
  series.sizes = {0, 1};
  EXPECT_EQ(fault(series), "run.csv: variable \"ts\" is a timeseries without numbers" + advice);
  series = Angle();
  series.time_unit = "years";
  EXPECT_EQ(fault(series), "run.csv: variable \"ts\" is a timeseries whose unit of time (years) is not known" + advice);
  const std::string unknown =
      "run.csv: variable \"ts\" is a timeseries that is damaged, or from an unknown version of MATLAB" + advice;
  for (const double length : {0.0, 7.0, 9.0, 7.5, 1e300}) {
    series = Angle();
    series.length = length;
    EXPECT_EQ(fault(series), unknown) << length;
  }
  for (const double increment : {0.0, -1.0}) {
    series = Angle();
    series.increment = increment;
    EXPECT_EQ(fault(series), unknown) << increment;
  }
  series = Angle();
  series.times = {1, 2, 3};
  series.length = 3;
  EXPECT_EQ(fault(series), unknown);
  series = Angle();
  series.sizes = {4, 2, 1};
  EXPECT_EQ(fault(series), unknown);
}

TEST_P(InEveryFileForm, NamesOtherObjectsByClass) {
  File file;
  const std::size_t table = file.AddClass("", "timetable");
  file.AddVariable("angles", file.Reference({file.AddObject(table, {{"any", objects::Nothing()}})}, true));
  const std::string sentence = "variable \"angles\" is an object of class timetable; save its numbers in MATLAB";
  EXPECT_THAT(FaultOf(BytesOf(file)), HasSubstr(sentence));
  file.AddVariable("t", objects::Numbers({2, 1}, {1, 2}));
  EXPECT_THAT(FaultOf(BytesOf(file)), HasSubstr(sentence));
  EXPECT_THAT(FaultOf(BytesOf(file), Value("angles", "deg")), HasSubstr(sentence));
}

TEST_P(InEveryFileForm, ReadsVectorsBesideATimeseries) {
  File file = FileOf({}, "other");
  file.AddVariable("t_s", objects::Numbers({8, 1}, {0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07}));
  file.AddVariable("angle_deg", objects::Numbers({8, 1}, {100, 101, 102, 103, 104, 105, 106, 107}));
  ExpectTheRows(RecordingOf(BytesOf(file), TimeAndValue("t_s", "angle_deg")), kDegree);
}

TEST_P(InEveryFileForm, GivesDifferentNamesToATimeseriesAndAVariable) {
  Series series = Angle();
  series.name = "run";
  File file;
  const Classes classes(file);
  const std::size_t object = objects::AddSeries(file, classes, series);
  file.AddVariable("cells", objects::Cells({objects::Cells({file.Reference({object})})}));  // numbers, not a reference
  file.AddVariable("run", objects::Struct({{"t", objects::Numbers({8, 1}, {0, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 1.05})},
                                           {"angle_deg", objects::Numbers({8, 1}, {8, 7, 6, 5, 4, 3, 2, 1})}}));
  EXPECT_DOUBLE_EQ(RecordingOf(BytesOf(file), Value("run.angle_deg")).time[1], 0.15);
  ExpectTheRows(RecordingOf(BytesOf(file), Value("timeseries 1.Data")));
}

// Numbers in an array of structures are read in the same way if the array also contains an object.
TEST(AddTimeseries, KeepsNumbersBesideOtherObjects) {
  File file;
  const std::size_t label = file.AddObject(file.AddClass("", "string"), {{"any", objects::Nothing()}});
  Array runs = objects::Struct({{"label", file.Reference({label}, true)},
                                {"t_s", objects::Numbers({8, 1}, {0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07})},
                                {"angle_deg", objects::Numbers({8, 1}, {100, 101, 102, 103, 104, 105, 106, 107})}});
  runs.sizes = {1, 2};
  const std::vector<Array> element = runs.parts;
  runs.parts.insert(runs.parts.end(), element.begin(), element.end());
  file.AddVariable("runs", runs);
  for (const bool is_big : {false, true}) {
    for (const bool is_packed : {false, true}) {
      const std::string bytes = objects::Version5(file, {is_big, is_packed});
      ExpectTheRows(RecordingOf(bytes, TimeAndValue("runs(2).t_s", "runs(2).angle_deg")), kDegree);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AddTimeseries, InEveryFileForm,
                         testing::Values(FileForm::kLittle, FileForm::kBig, FileForm::kPacked, FileForm::kPackedBig,
                                         FileForm::kHdf5, FileForm::kPackedHdf5));

// ---- Damage ------------------------------------------------------------------------------------------------------

MatTable TableOf(const std::string& bytes) {
  MatTable table;
  AddTimeseries(SubsystemOf(bytes), table);
  return table;
}

TEST(AddTimeseries, GivesTheSameNumbersOrNoneAfterAChangedByte) {
  for (const bool is_big : {false, true}) {
    const std::string whole = objects::Version5(FileOf(Angle()), {is_big, false});
    const std::vector<double> values = Angle().data;
    std::size_t same = 0, other = 0;
    for (std::size_t at = 0; at < whole.size(); ++at) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ 0xFF);
      const MatTable table = TableOf(bytes);
      if (table.columns.empty()) continue;
      ASSERT_EQ(table.columns.size(), 2) << at;
      ASSERT_EQ(table.columns[0].values.size(), 8) << at;
      (table.columns[1].values == values ? same : other) += 1;
    }
    EXPECT_GT(same, 0);
    EXPECT_EQ(other, 64);  // changes of the bytes of the eight numbers
  }
}

TEST(AddTimeseries, ReturnsNothingForATruncatedFile) {
  for (const bool is_packed : {false, true}) {
    const std::string whole = objects::Version5(FileOf(Angle()), {false, is_packed});
    for (std::size_t size = 0; size < whole.size(); ++size) {
      ASSERT_TRUE(TableOf(whole.substr(0, size)).columns.empty()) << size;
    }
  }
}

TEST(AddTimeseries, GivesTheSameNumbersOrNoneAfterAChangedPackedByte) {
  const std::string whole = objects::Version5(FileOf(Angle()), {false, true});
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0xFF);
    const MatTable table = TableOf(bytes);
    if (table.columns.empty()) continue;
    EXPECT_EQ(table.columns[1].values, Angle().data) << at;
  }
}

}  // namespace
}  // namespace pendulum::mat_timeseries_test
