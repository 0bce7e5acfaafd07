// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_recording.h"

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

/// The times and values that ExpectTheRows expects.
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

constexpr std::size_t kClassAt = 144;  // Position of the class of the first variable, after header and two tags.

ReadOptions Value(const std::string& column, const std::string& unit = "") { return TimeAndValue("", column, unit); }

// ---- Vectors and matrices ----------------------------------------------------------------------------------------

class OfEveryVersion : public testing::TestWithParam<mat_ft> {};

TEST_P(OfEveryVersion, ReadsTwoVectorsByName) {
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

TEST_P(OfEveryVersion, TheIncreasingFirstColumnOfAMatrixIsTheTime) {
  ExpectTheRows(RecordingOf(MatOf({Matrix("angle_rad", 8, Both())}, GetParam())));
  ExpectTheRows(RecordingOf(MatOf({Matrix("run", 8, Both())}, GetParam()), Unit("deg")), kDegree);
  ExpectTheRows(RecordingOf(MatOf({Matrix("run", 8, Both())}, GetParam()), Value("run(:,2)", "deg")), kDegree);
  std::vector<double> rows;  // As written by the block "To File".
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

TEST_P(OfEveryVersion, NamesTheKindOfAVariableThatIsNotAColumn) {
  EXPECT_EQ(
      FaultOf(MatOf({Text("note", "hello")}, GetParam())),
      "run.csv: no variable of this MAT-file is a vector or a matrix of real numbers (\"note\" is text); save the "
      "times as t and the angles as angle_deg");
  const std::string more = MatOf({Text("note", "hello"), Matrix("t", 8, Times())}, GetParam());
  EXPECT_EQ(FaultOf(more, Value("note", "deg")),
            "run.csv: variable \"note\" is text; a column must be a vector of real numbers, or part of a matrix or a "
            "structure");
  EXPECT_THAT(FaultOf(more), StartsWith("run.csv: no variable of this MAT-file but the time is a vector"));
  EXPECT_THAT(FaultOf(MatOf({}, GetParam())), StartsWith("run.csv: "));
  EXPECT_THAT(FaultOf(MatOf({Matrix("x", 0, {})}, GetParam())), HasSubstr("no variable of this MAT-file"));
}

TEST_P(OfEveryVersion, NeverReadsATruncatedFile) {
  const std::string whole = MatOf({Matrix("t", 8, Times()), Matrix("angle_deg", 8, Values())}, GetParam());
  for (std::size_t size = 128; size < whole.size(); size += 1 + whole.size() / 40) {
    const Result<Recording> recording = ParseRecording(whole.substr(0, size), "run.csv");
    ASSERT_FALSE(recording.has_value()) << size;
    EXPECT_EQ(recording.error().code, StatusCode::kDataLoss);
    EXPECT_THAT(recording.error().message(), StartsWith("run.csv:"));
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

TEST(ReadMat, RemovesRowsWithNaN) {
  std::vector<double> times = Times(), values = Values();
  times.insert(times.begin(), -1);
  values.insert(values.begin(), std::numeric_limits<double>::quiet_NaN());
  const Recording recording = RecordingOf(MatOf({Matrix("t_s", 9, times), Matrix("angle_rad", 9, values)}));
  ExpectTheRows(recording);
  ASSERT_EQ(recording.warnings.size(), 1);
  EXPECT_EQ(MessageText(recording.warnings[0]),
            "run.csv: 1 row was left out, with no number in column \"angle_rad\" or in its time");
}

TEST(ReadMat, WholeNumbersOfATimeAreMilliseconds) {
  const std::string vectors = MatOf({Matrix("t", 8, Times(1000)), Matrix("angle_rad", 8, Values())});
  ExpectTheRows(RecordingOf(vectors));
  ExpectTheRows(RecordingOf(vectors, TimeAndValue("t:ms", "")));
  EXPECT_EQ(RecordingOf(vectors, TimeAndValue("t", "")).warnings.at(0).code, "time_unit_assumed");
  std::vector<double> both = Times(1000);
  for (const double value : Values()) both.push_back(value);
  const std::string matrix = MatOf({Matrix("run_rad", 8, both)});
  ExpectTheRows(RecordingOf(matrix));
  ExpectTheRows(RecordingOf(matrix, TimeAndValue("run_rad(:,1):ms", "run_rad(:,2)")));
  ExpectTheRows(RecordingOf(MatOf({Matrix("t_ms", 8, Times(1000)), Matrix("angle_rad", 8, Values())})));
}

TEST(ReadMat, WarnsThatATimeIsTakenAsSeconds) {
  const auto codes = [](const MatVariables& variables) {
    std::string list;
    for (const Warning& warning : RecordingOf(MatOf(variables)).warnings)
      list += std::string(warning.code.text()) + ' ';
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
  EXPECT_EQ(codes({structure("signals")}), "");  // written by Simulink: seconds, which may be whole
  EXPECT_EQ(codes({structure("mine")}), "time_unit_assumed ");
}

TEST(ReadMat, RefusesColumnsOfDifferentLengths) {
  EXPECT_EQ(FaultOf(MatOf({Matrix("t", 8, Times()), Matrix("angle_rad", 2, {1, 2})})),
            "run.csv: column \"t\" has 8 numbers and column \"angle_rad\" 2; choose the time of this quantity with "
            "--time_column");
  EXPECT_EQ(
      FaultOf(MatOf({Matrix("t", 2, {1, 2}), Matrix("angle_rad", 2, {1, 2})}), {}, StatusCode::kFailedPrecondition),
      "run.csv: column \"angle_rad\" has 2 numbers; at least 8 are needed: record for longer");
}

TEST(ReadMat, RefusesTwoCandidatesAndChoosesOneOfTwoTimes) {
  const std::string two = MatOf({Matrix("t", 8, Times()), Matrix("a_rad", 8, Values()), Matrix("b_deg", 8, Values())});
  EXPECT_EQ(FaultOf(two),
            "run.csv: columns \"a_rad\" and \"b_deg\" could both be the quantity, and none of them shows a swing by "
            "itself; choose one with --value_column");
  ExpectTheRows(RecordingOf(two, Value("a_rad")));
  const std::string times = MatOf({Matrix("t", 8, Times()), Matrix("tout", 8, Times()), Matrix("a_rad", 8, Values())});
  EXPECT_EQ(MessageText(RecordingOf(times).warnings.at(0)),
            "run.csv: column \"tout\" was taken as the time, not \"t\"; --time_column chooses another");
}

matvar_t* Complex(const char* name) {
  std::vector<double> zeros(8), values = Values();
  mat_complex_split_t complex{values.data(), zeros.data()};
  std::size_t sizes[] = {8, 1};
  return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, sizes, &complex, MAT_F_COMPLEX);
}

matvar_t* CellArray(const char* name) {
  std::size_t sizes[] = {1, 1};
  matvar_t* cell = Matrix(nullptr, 8, Values());
  return Mat_VarCreate(name, MAT_C_CELL, MAT_T_CELL, 2, sizes, &cell, 0);
}

/// A sparse vector with one number, in the first row.
matvar_t* Sparse(const char* name) {
  double value = 1;
  mat_uint32_t row = 0, begins[] = {0, 1};
  mat_sparse_t sparse{1, &row, 1, begins, 2, 1, &value};
  std::size_t sizes[] = {8, 1};
  return Mat_VarCreate(name, MAT_C_SPARSE, MAT_T_DOUBLE, 2, sizes, &sparse, 0);
}

TEST_P(OfEveryVersion, CellsAndComplexOrSparseNumbersAreNotColumns) {
  const auto sentence = [](const std::string& name, const std::string& kind) {
    return "run.csv: variable \"" + name + "\" is " + kind +
           "; a column must be a vector of real numbers, or part of a matrix or a structure";
  };
  for (const ReadOptions& options : {ReadOptions(), Unit("rad"), Value("z_rad")}) {
    EXPECT_EQ(FaultOf(MatOf({Matrix("t", 8, Times()), Complex("z_rad")}, GetParam()), options),
              sentence("z_rad", "complex"));
    EXPECT_EQ(FaultOf(MatOf({Matrix("t", 8, Times()), CellArray("z_rad")}, GetParam()), options),
              sentence("z_rad", "a cell array"));
    EXPECT_EQ(FaultOf(MatOf({Matrix("t", 8, Times()), Sparse("z_rad")}, GetParam()), options),
              sentence("z_rad", "sparse"));
  }
  EXPECT_EQ(FaultOf(MatOf({Matrix("t", 8, Times()), CellArray("phi")}, GetParam())), sentence("phi", "a cell array"));
  EXPECT_EQ(FaultOf(MatOf({Matrix("t", 8, Times()), CellArray("phi"), Complex("z_rad")}, GetParam())),
            sentence("z_rad", "complex"));
}

TEST_P(OfEveryVersion, IgnoresCellsBesideAColumn) {
  ExpectTheRows(
      RecordingOf(MatOf({Matrix("t", 8, Times()), CellArray("phi"), Matrix("y_rad", 8, Values())}, GetParam())));
  ExpectTheRows(RecordingOf(MatOf({Matrix("t", 8, Times()), CellArray("phi"), Matrix("y", 8, Values())}, GetParam()),
                            Unit("rad")));
}

/// A variable of class mxOPAQUE, built as MATLAB writes a timeseries. Its elements are tag, size and bytes.
std::string Timeseries(const std::string& name) {
  const auto number = [](std::uint32_t value) {
    std::string bytes;
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift);
    return bytes;
  };
  const auto element = [&](std::uint32_t type, const std::string& bytes) {
    return number(type) + number(static_cast<std::uint32_t>(bytes.size())) + bytes +
           std::string((8 - bytes.size() % 8) % 8, '\0');
  };
  constexpr std::uint32_t kInt8 = 1, kInt32 = 5, kUint32 = 6, kMatrix = 14, kUint32Class = 13, kOpaqueClass = 17;
  const std::string numbers = element(kUint32, number(kUint32Class) + number(0)) +
                              element(kInt32, number(2) + number(1)) + element(kInt8, "") +
                              element(kUint32, number(0xDD000000) + number(2));
  const std::string called = name.size() > 4 ? element(kInt8, name)  // shorter ones share a word with size and type
                                             : number(static_cast<std::uint32_t>(name.size() << 16 | kInt8)) + name +
                                                   std::string(4 - name.size(), '\0');
  return element(kMatrix, element(kUint32, number(kOpaqueClass) + number(0)) + called + element(kInt8, "MCOS") +
                              element(kInt8, "timeseries") + element(kMatrix, numbers));
}

TEST(ReadMat, ExplainsHowToSaveATimeseries) {
  const std::string advice =
      "; save its numbers in MATLAB, for a timeseries ts: t = ts.Time; angle_deg = ts.Data; "
      "save('run.mat', 't', 'angle_deg')";
  for (const std::string name : {"ts", "pendulum"}) {
    const std::string fault = "run.csv: variable \"" + name +
                              "\" is a timeseries that is damaged, or from an unknown version of MATLAB" +
                              advice;  // the file contains no objects
    EXPECT_EQ(FaultOf(MatOf({}) + Timeseries(name)), fault);
    EXPECT_EQ(FaultOf(MatOf({Matrix("t_s", 8, Times())}) + Timeseries(name)), fault);
  }
  std::string object = MatOf({Matrix("ts", 8, Values()), Matrix("t_s", 8, Times())}, MAT_FT_MAT5, false);
  object[kClassAt] = 3;  // mxOBJECT
  EXPECT_EQ(FaultOf(object), "run.csv: variable \"ts\" is an object" + advice);
  EXPECT_EQ(FaultOf(object, Value("ts", "deg")), "run.csv: variable \"ts\" is an object" + advice);
}

TEST(ReadMat, AcceptsAnObjectBesideVectors) {
  const MatVariables vectors = {Matrix("odd", 8, Values()), Matrix("t_s", 8, Times()),
                                Matrix("angle_deg", 8, Values())};
  std::string bytes = MatOf(vectors, MAT_FT_MAT5, false);
  bytes[kClassAt] = 3;
  ExpectTheRows(RecordingOf(bytes), kDegree);
  ExpectTheRows(RecordingOf(MatOf({Matrix("t_s", 8, Times()), Matrix("angle_deg", 8, Values())}) + Timeseries("ts")),
                kDegree);
}

TEST(ReadMat, LimitsTheUnpackedSize) {
  std::vector<double> times, zeros(100'000);
  for (int i = 0; i < 100'000; ++i) times.push_back(i + 0.5);
  const std::string bytes = MatOf({Matrix("t_s", 100'000, times), Matrix("angle_deg", 100'000, zeros)});
  ReadOptions options;
  options.most_unpacked_bytes = 1'600'000;
  EXPECT_EQ(FaultOf(bytes, options),
            "run.csv: this MAT-file unpacks to more than 1600000 bytes, too many for a recording; save only the times "
            "and the angles, or export them as CSV");
  options.most_unpacked_bytes = 1'601'000;  // leaves room for their names
  EXPECT_TRUE(ParseRecording(bytes, "run.csv", options).has_value());
}

TEST(ReadMat, ASampleRateReplacesTheTime) {
  ExpectTheRows(RecordingOf(MatOf({Matrix("angle_deg", 8, Values())}), Unit("", 100)), kDegree);
}

TEST(ReadMat, RefusesFlagsThatContradictTheFile) {
  const std::string bytes = MatOf({Matrix("t", 8, Times()), Matrix("angle_deg", 8, Values())});
  EXPECT_THAT(WrongFlag(bytes, Unit("volts")), HasSubstr("run.csv: column \"angle_deg\" is in deg"));
  EXPECT_THAT(WrongFlag(bytes, Value("phi")), HasSubstr("none of the 2 columns \"t\", \"angle_deg\""));
}

// ---- Damage ------------------------------------------------------------------------------------------------------

TEST(ReadMat, ReportsTheTruncationPoint) {
  const std::string whole = MatOf({Matrix("t", 8, Times()), Matrix("angle_deg", 8, Values())}, MAT_FT_MAT5, false);
  EXPECT_THAT(
      FaultOf(whole.substr(0, whole.size() - 5)),
      AllOf(StartsWith("run.csv: the file is cut off: the variable at byte "), HasSubstr("save or copy it again")));
}

TEST(ReadMat, AcceptsChangedBytesWithoutACrash) {
  for (const mat_ft version : {MAT_FT_MAT5, MAT_FT_MAT73}) {
    const std::string whole = MatOf({Matrix("t", 8, Times()), Matrix("angle_deg", 8, Values())}, version, false);
    for (std::size_t at = 128; at < whole.size(); at += 1 + whole.size() / 30) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ 0xFF);
      const Result<Recording> recording = ParseRecording(bytes, "run.csv");
      if (recording) continue;
      EXPECT_THAT(recording.error().message(), StartsWith("run.csv:"));
      EXPECT_NE(recording.error().code, StatusCode::kInternal);
    }
  }
}

TEST(ReadMat, ExplainsThatTheFileCannotBeCopied) {
  const std::string bytes = MatOf({Matrix("t", 8, Times()), Matrix("angle_deg", 8, Values())});
  const char* const before = std::getenv("TMPDIR");
  const std::string folder = before == nullptr ? "" : before;
  ::setenv("TMPDIR", "/proc", 1);  // no file can be created there
  EXPECT_EQ(FaultOf(bytes, {}, StatusCode::kTryAgain),
            "run.csv: cannot copy this MAT-file to \"/proc\" (No such file or directory); free space "
            "there, or name another folder in TMPDIR");
  before == nullptr ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", folder.c_str(), 1);
}

// ---- Files that refer to other files ----------------------------------------------------------------------------

/// A file of version 7.3, made by HDF5, whose counts are in another file, by external storage or by a link to a
/// variable of that file. In the corpus file, many slashes before the other file's path leave room for another path.
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
    "run.csv: this MAT-file refers to numbers in another file, which is not opened; save all in one file";

TEST(ReadMat, ReadsNoOtherFileThatTheFileRefersTo) {
  for (const char* const file : {"other_file.mat", "other_file_link.mat"}) {
    EXPECT_EQ(FaultOf(WithOtherFile(file, "/proc/self/exe"), Unit("", 100)), kOneFile);
    EXPECT_EQ(FaultOf(WithOtherFile(file, "/nowhere/at/all"), Unit("", 100)), kOneFile);
  }
}

TEST(ReadMat, IgnoresAPipeNamedInAFile) {
  const std::string pipe = (std::filesystem::temp_directory_path() / ("pipe_" + std::to_string(::getpid()))).string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const char* const file : {"other_file.mat", "other_file_link.mat"}) {
    EXPECT_EQ(FaultOf(WithOtherFile(file, pipe), Unit("", 100)), kOneFile);
  }
  std::filesystem::remove(pipe);
}

}  // namespace
}  // namespace pendulum::mat_recording_test
