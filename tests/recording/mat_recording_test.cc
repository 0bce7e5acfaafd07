// SPDX-License-Identifier: Apache-2.0
#include "recording/mat_recording.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pendulum/base/sha256.h"
#include "tests/recording/mat_files.h"
#include "tests/recording/rows.h"

namespace pendulum::mat_recording_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// The values of ExpectTheRows.
std::vector<double> Times(double unit = 1) {
  std::vector<double> times;
  for (int i = 0; i < 8; ++i) times.push_back(i / 100.0 * unit);
  return times;
}

std::vector<double> Values() { return {100, 101, 102, 103, 104, 105, 106, 107}; }

std::vector<double> Both() {
  std::vector<double> both = Times();
  for (const double value : Values()) both.push_back(value);
  return both;
}

ReadOptions Value(const std::string& column, const std::string& unit = "") { return TimeAndValue("", column, unit); }

// ---- Vectors and matrices ----------------------------------------------------------------------------------------

class OfEveryVersion : public testing::TestWithParam<mat_ft> {};

TEST_P(OfEveryVersion, TwoVectorsAreReadByTheirNames) {
  for (const char* const time : {"t", "time", "tout", "Time", "t_s"}) {
    for (const bool is_packed : {false, true}) {
      const std::string bytes = MatOf(
          {Matrix(time, 8, Times()), Matrix("angle_deg", 8, Values()), Matrix("gain", 1, {2})}, GetParam(), is_packed);
      ExpectTheRows(RecordingOf(bytes), kDegree);
      EXPECT_EQ(RecordingOf(bytes).sha256, Sha256(bytes).value());
    }
  }
  ExpectTheRows(
      RecordingOf(MatOf({Matrix("t_ms", 1, Times(1000)), Matrix("y", 1, Values())}, GetParam()), Unit("rad")));
}

TEST_P(OfEveryVersion, AMatrixWhoseFirstColumnIncreasesHasItsTimeThere) {
  ExpectTheRows(RecordingOf(MatOf({Matrix("angle_rad", 8, Both())}, GetParam())));
  ExpectTheRows(RecordingOf(MatOf({Matrix("run", 8, Both())}, GetParam()), Unit("deg")), kDegree);
  ExpectTheRows(RecordingOf(MatOf({Matrix("run", 8, Both())}, GetParam()), Value("run(:,2)", "deg")), kDegree);
  std::vector<double> rows;  // As the block "To File" writes them.
  for (int i = 0; i < 8; ++i) rows.insert(rows.end(), {i / 100.0, 100.0 + i});
  ExpectTheRows(RecordingOf(MatOf({Matrix("angle_rad", 2, rows)}, GetParam())));
}

TEST_P(OfEveryVersion, AStructureWithTimeIsOneRun) {
  const auto simulink = [](const char* name, const char* label, double slower) {
    matvar_t* signals =
        Structure("signals", {{"values", Matrix("values", 8, Values())}, {"label", Text("label", label)}});
    return Structure(name, {{"time", Matrix("time", 8, Times(slower))}, {"signals", signals}});
  };
  ExpectTheRows(RecordingOf(MatOf({simulink("angle_rad", "", 1)}, GetParam())));
  ExpectTheRows(RecordingOf(MatOf({simulink("out", "pot_deg", 1)}, GetParam())), kDegree);
  const std::string two = MatOf({simulink("a", "a_rad", 2), simulink("b", "b_rad", 1)}, GetParam());
  EXPECT_THAT(FaultOf(two), HasSubstr("\"a.signals.values\" and \"b.signals.values\" could both be the quantity"));
  ExpectTheRows(RecordingOf(two, Value("b.signals.values")));
}

TEST_P(OfEveryVersion, WhatIsNoColumnIsSaidByItsKind) {
  EXPECT_EQ(
      FaultOf(MatOf({Text("note", "hello")}, GetParam())),
      "run.csv: no variable of this MAT-file is a vector or a matrix of real numbers (\"note\" is text); save the "
      "times as t and the angles as angle_deg");
  const std::string more = MatOf({Text("note", "hello"), Matrix("t", 8, Times())}, GetParam());
  EXPECT_EQ(FaultOf(more, Value("note", "deg")),
            "run.csv: variable \"note\" is text; a column is a vector of real numbers, or a matrix's or a structure's");
  EXPECT_THAT(WrongFlag(more, {}), StartsWith("run.csv: column \"t\" cannot be both the time and the quantity"));
  EXPECT_THAT(FaultOf(MatOf({}, GetParam())), StartsWith("run.csv: "));
  EXPECT_THAT(FaultOf(MatOf({Matrix("x", 0, {})}, GetParam())), HasSubstr("no variable of this MAT-file"));
}

TEST_P(OfEveryVersion, WhatIsCutOffIsNeverARecording) {
  const std::string whole = MatOf({Matrix("t", 8, Times()), Matrix("angle_deg", 8, Values())}, GetParam());
  for (std::size_t size = 128; size < whole.size(); size += 1 + whole.size() / 40) {
    const Result<Recording> recording = ParseRecording(whole.substr(0, size), "run.csv");
    ASSERT_FALSE(recording.has_value()) << size;
    EXPECT_EQ(recording.error().code, StatusCode::kDataLoss);
    EXPECT_THAT(recording.error().message, StartsWith("run.csv:"));
  }
}

INSTANTIATE_TEST_SUITE_P(ReadMat, OfEveryVersion, testing::Values(MAT_FT_MAT5, MAT_FT_MAT73));

TEST(ReadMat, NumbersMayBeOfAnyType) {
  ExpectTheRows(
      RecordingOf(MatOf({Matrix("t", 8, Times()), Vector<std::int16_t>("adc_counts", MAT_C_INT16, MAT_T_INT16,
                                                                       {100, 101, 102, 103, 104, 105, 106, 107})})));
  ExpectTheRows(RecordingOf(MatOf({Matrix("t", 8, Times()), Vector<float>("angle_rad", MAT_C_SINGLE, MAT_T_SINGLE,
                                                                          {100, 101, 102, 103, 104, 105, 106, 107})})));
  ExpectTheRows(
      RecordingOf(MatOf({Vector<std::uint32_t>("t_ms", MAT_C_UINT32, MAT_T_UINT32, {0, 10, 20, 30, 40, 50, 60, 70}),
                         Matrix("angle_rad", 8, Values())})));
}

TEST(ReadMat, LeavesOutRowsThatAreNoNumbers) {
  std::vector<double> times = Times(), values = Values();
  times.insert(times.begin(), -1);
  values.insert(values.begin(), std::numeric_limits<double>::quiet_NaN());
  const Recording recording = RecordingOf(MatOf({Matrix("t_s", 9, times), Matrix("angle_rad", 9, values)}));
  ExpectTheRows(recording);
  ASSERT_EQ(recording.warnings.size(), 1);
  EXPECT_EQ(recording.warnings[0].message,
            "run.csv: 1 row was left out, with no number in column \"angle_rad\" or in its time");
}

TEST(ReadMat, WholeNumbersOfATimeNeedAUnit) {
  const std::string vectors = MatOf({Matrix("t", 8, Times(1000)), Matrix("angle_rad", 8, Values())});
  EXPECT_EQ(WrongFlag(vectors, {}),
            "run.csv: column \"t\" holds whole numbers and does not tell its unit; give --time_column with :s, :ms or "
            ":us after the column");
  ExpectTheRows(RecordingOf(vectors, TimeAndValue("t:ms", "")));
  EXPECT_THAT(WrongFlag(vectors, TimeAndValue("t", "")), HasSubstr("holds whole numbers"));
  std::vector<double> both = Times(1000);
  for (const double value : Values()) both.push_back(value);
  const std::string matrix = MatOf({Matrix("run_rad", 8, both)});
  EXPECT_THAT(WrongFlag(matrix, {}), HasSubstr("column \"run_rad(:,1)\" holds whole numbers"));
  ExpectTheRows(RecordingOf(matrix, TimeAndValue("run_rad(:,1):ms", "run_rad(:,2)")));
  ExpectTheRows(RecordingOf(MatOf({Matrix("t_ms", 8, Times(1000)), Matrix("angle_rad", 8, Values())})));
}

TEST(ReadMat, SaysThatATimeIsTakenAsSeconds) {
  const auto codes = [](const MatVariables& variables) {
    std::string list;
    for (const Warning& warning : RecordingOf(MatOf(variables)).warnings) list += warning.code + ' ';
    return list;
  };
  EXPECT_EQ(codes({Matrix("t", 8, Times()), Matrix("angle_rad", 8, Values())}), "time_unit_assumed ");
  EXPECT_EQ(codes({Matrix("t_s", 8, Times()), Matrix("angle_rad", 8, Values())}), "");
  EXPECT_EQ(codes({Matrix("tout", 8, Times(1000)), Matrix("angle_rad", 8, Values())}), "");
  const auto structure = [](const char* signals) {
    matvar_t* inner =
        Structure(signals, {{"values", Matrix("values", 8, Values())}, {"label", Text("label", "a_rad")}});
    return Structure("out", {{"time", Matrix("time", 8, Times(1000))}, {signals, inner}});
  };
  EXPECT_EQ(codes({structure("signals")}), "");  // as Simulink writes it: seconds, which may be whole
  EXPECT_THAT(WrongFlag(MatOf({structure("mine")}), TimeAndValue("", "out.mine.values")), HasSubstr("whole numbers"));
}

TEST(ReadMat, RefusesColumnsOfDifferentLengths) {
  EXPECT_EQ(FaultOf(MatOf({Matrix("t", 8, Times()), Matrix("angle_rad", 2, {1, 2})})),
            "run.csv: column \"t\" has 8 numbers and column \"angle_rad\" 2; choose the time of this quantity with "
            "--time_column");
  EXPECT_EQ(
      FaultOf(MatOf({Matrix("t", 2, {1, 2}), Matrix("angle_rad", 2, {1, 2})}), {}, StatusCode::kFailedPrecondition),
      "run.csv: column \"angle_rad\" has 2 numbers; at least 8 are needed: record for longer");
}

TEST(ReadMat, RefusesTwoCandidatesAndTwoTimes) {
  const std::string two = MatOf({Matrix("t", 8, Times()), Matrix("a_rad", 8, Values()), Matrix("b_deg", 8, Values())});
  EXPECT_EQ(FaultOf(two),
            "run.csv: columns \"a_rad\" and \"b_deg\" could both be the quantity; choose one with --value_column");
  ExpectTheRows(RecordingOf(two, Value("a_rad")));
  EXPECT_THAT(FaultOf(MatOf({Matrix("t", 8, Times()), Matrix("tout", 8, Times()), Matrix("a_rad", 8, Values())})),
              HasSubstr("could both be the time"));
}

TEST(ReadMat, ComplexAndSparseAreNoColumns) {
  std::vector<double> zeros(8);
  mat_complex_split_t complex{Values().data(), zeros.data()};
  std::vector<double> values = Values();
  complex.Re = values.data();
  std::size_t sizes[] = {8, 1};
  EXPECT_THAT(FaultOf(MatOf({Matrix("t", 8, Times()),
                             Mat_VarCreate("z_rad", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, sizes, &complex, MAT_F_COMPLEX)}),
                      Value("z_rad")),
              HasSubstr("variable \"z_rad\" is complex"));
}

TEST(ReadMat, ASampleRateReplacesTheTime) {
  ExpectTheRows(RecordingOf(MatOf({Matrix("angle_deg", 8, Values())}), Unit("", 100)), kDegree);
}

TEST(ReadMat, RefusesFlagsThatContradictTheFile) {
  const std::string bytes = MatOf({Matrix("t", 8, Times()), Matrix("angle_deg", 8, Values())});
  EXPECT_THAT(WrongFlag(bytes, Unit("rad")), HasSubstr("run.csv: column \"angle_deg\" is in deg"));
  EXPECT_THAT(WrongFlag(bytes, Value("phi")), HasSubstr("none of the 2 columns \"t\", \"angle_deg\""));
}

// ---- Damage ------------------------------------------------------------------------------------------------------

TEST(ReadMat, SaysWhereItIsCutOff) {
  const std::string whole = MatOf({Matrix("t", 8, Times()), Matrix("angle_deg", 8, Values())}, MAT_FT_MAT5, false);
  EXPECT_THAT(
      FaultOf(whole.substr(0, whole.size() - 5)),
      AllOf(StartsWith("run.csv: the file is cut off: the variable at byte "), HasSubstr("save or copy it again")));
}

TEST(ReadMat, SurvivesBytesThatAreChanged) {
  for (const mat_ft version : {MAT_FT_MAT5, MAT_FT_MAT73}) {
    const std::string whole = MatOf({Matrix("t", 8, Times()), Matrix("angle_deg", 8, Values())}, version, false);
    for (std::size_t at = 128; at < whole.size(); at += 1 + whole.size() / 60) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ 0xFF);
      const Result<Recording> recording = ParseRecording(bytes, "run.csv");
      if (recording) continue;
      EXPECT_THAT(recording.error().message, StartsWith("run.csv:"));
      EXPECT_NE(recording.error().code, StatusCode::kInternal);
    }
  }
}

TEST(ReadMat, SaysWhyThereIsNoCopyForMatio) {
  const std::string bytes = MatOf({Matrix("t", 8, Times()), Matrix("angle_deg", 8, Values())});
  const char* const before = std::getenv("TMPDIR");
  const std::string folder = before == nullptr ? "" : before;
  ::setenv("TMPDIR", "/proc", 1);  // where nobody makes a file
  EXPECT_EQ(FaultOf(bytes, {}, StatusCode::kTryAgain),
            "run.csv: there can be no copy of this MAT-file in \"/proc\" (No such file or directory); make room there, "
            "or name another folder in TMPDIR");
  before == nullptr ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", folder.c_str(), 1);
}

// ---- Files that would have others read --------------------------------------------------------------------------

/// A file of version 7.3, made by HDF5, whose counts are the bytes of another file: by external storage, or by a link
/// to a variable there. Its path has many slashes before it, which leave room for another.
std::string WithOtherFile(const std::string& corpus_file, const std::string& other) {
  const std::string exe = "/proc/self/exe";  // Its first bytes are 0x7F 'E' 'L' 'F' (elf(5)).
  std::ifstream stream("tests/fuzz/corpus/mat/" + corpus_file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  const std::size_t end = bytes.find(exe) + exe.size();
  EXPECT_LT(end, bytes.size());
  const std::size_t begin = bytes.find_last_not_of('/', end - exe.size()) + 1;
  return bytes.replace(begin, end - begin, std::string(end - begin - other.size(), '/') + other);
}

constexpr const char* kOneFile =
    "run.csv: this MAT-file says that numbers of it are in another file, which is not opened; save all in one";

TEST(ReadMat, ReadsNoOtherFile) {
  for (const char* const file : {"other_file.mat", "other_file_link.mat"}) {
    EXPECT_EQ(FaultOf(WithOtherFile(file, "/proc/self/exe"), Unit("", 100)), kOneFile);
    EXPECT_EQ(FaultOf(WithOtherFile(file, "/nowhere/at/all"), Unit("", 100)), kOneFile);
  }
}

TEST(ReadMat, WaitsForNoPipeThatAFileNames) {
  const std::string pipe = (std::filesystem::temp_directory_path() / ("pipe_" + std::to_string(::getpid()))).string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const char* const file : {"other_file.mat", "other_file_link.mat"}) {
    EXPECT_EQ(FaultOf(WithOtherFile(file, pipe), Unit("", 100)), kOneFile);
  }
  std::filesystem::remove(pipe);
}

}  // namespace
}  // namespace pendulum::mat_recording_test
