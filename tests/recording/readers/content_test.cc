// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/content.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/readers/read_recording.h"
#include "tests/recording/mat_files.h"
#include "tests/recording/rows.h"
#include "tests/recording/zip_files.h"

namespace pendulum::content_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using std::string_literals::operator""s;

const std::string kRows = "time_s,angle_deg\n" + Rows("0.0{t},{v}");

TEST(Content, IsDetectedFromTheFirstBytes) {
  EXPECT_EQ(ContentOf(""), Content::kText);
  EXPECT_EQ(ContentOf(kRows), Content::kText);
  EXPECT_EQ(ContentOf("MATLAB course, run 3\ntime_s,angle_deg\n"), Content::kText);
  EXPECT_EQ(ContentOf(ZipOf({{"a.csv", kRows}})), Content::kZip);
  for (const mat_ft version : {MAT_FT_MAT5, MAT_FT_MAT73}) {
    EXPECT_EQ(ContentOf(MatOf({Matrix("t", 1, {1, 2})}, version)), Content::kMat);
  }
}

TEST(Content, ARowWithAStampInBracketsIsNoJson) {
  for (const char* const row : {"[12:00:01.123] 0.5\n", "[0.5] 3\n", "[0.5], 3\n", "[Header]\n", "[s],[deg]\n"}) {
    EXPECT_EQ(ContentOf(row), Content::kText) << row;
  }
  for (const char* const list : {"[0.5, 3]", "[ -1e-3 ]\n", "[\n 0,\n 1]", "[[0, 1], [2, 3]]", "[{\"t\": 0}]"}) {
    EXPECT_EQ(ContentOf(list), Content::kJson) << list;
  }
}

TEST(Content, NamesTheFormatOfAnUnreadableFile) {
  EXPECT_THAT(FaultOf("\x89HDF\r\n\x1A\n"s), StartsWith("run.csv: this is an HDF5 file without MATLAB's header;"));
  EXPECT_THAT(FaultOf("\x1F\x8B\x08"s), StartsWith("run.csv: this is a gzip file; unpack it"));
  EXPECT_THAT(FaultOf("<?xml version=\"1.0\"?>\n"),
              HasSubstr("this is XML, which is not read; export the data as CSV"));
  EXPECT_EQ(FaultOf("# Created by Octave 8.4.0, Tue Nov 24 12:00:00 2026 UTC <a@b>\n# name: t\n# type: matrix\n"),
            "run.csv: this is Octave's text format; save the variables with save -7 run.mat t angle_deg");
  EXPECT_THAT(FaultOf("Octave-1-L\0"s), HasSubstr("this is Octave's binary format; save the variables with save -7"));
  EXPECT_THAT(FaultOf("PK\5\6"s + std::string(18, '\0')), HasSubstr("this zip file is empty"));
}

/// Reads these bytes from a file whose name does not indicate its format.
Recording ReadFileOf(const std::string& bytes) {
  const std::string path = testing::TempDir() + "/content_test";
  std::ofstream(path, std::ios::binary) << bytes;
  const Result<Recording> recording = ReadRecording(path);
  EXPECT_TRUE(recording.has_value()) << (recording ? "" : recording.error().message());
  std::filesystem::remove(path);
  if (recording) {
    EXPECT_EQ(recording->path, path);
  }
  return recording.value_or(Recording());
}

TEST(Content, IgnoresTheFileName) {
  ExpectTheRows(ReadFileOf(kRows), kDegree);
  ExpectTheRows(ReadFileOf(ZipOf({{"a.csv", kRows}})), kDegree);
  std::vector<double> times, values;
  for (int i = 0; i < 8; ++i) times.push_back(i / 100.0), values.push_back(100 + i);
  ExpectTheRows(ReadFileOf(MatOf({Matrix("t", 8, times), Matrix("angle_deg", 8, values)})), kDegree);
}

TEST(Content, DetectsALargeForeignFileFromItsFirstBytes) {
  const std::string path = testing::TempDir() + "/content_test.bag";
  std::ofstream(path, std::ios::binary) << "#ROSBAG V2.0\n";
  std::filesystem::resize_file(path, std::uintmax_t{1} << 33);  // sparse: it uses almost no disk space
  const Result<Recording> recording = ReadRecording(path);
  std::filesystem::remove(path);
  ASSERT_FALSE(recording.has_value());
  EXPECT_EQ(recording.error().message(),
            path + ": this is a ROS bag; export the topic as CSV (rostopic echo -p) and give the CSV file");
}

TEST(Content, FindsAMatFileInAZipFile) {
  const std::string mat = MatOf({Matrix("t", 2, {1, 2}), Matrix("angle_deg", 2, {1, 2})});
  EXPECT_THAT(FaultOf(ZipOf({{"run.mat", mat}}), {}, StatusCode::kFailedPrecondition),
              StartsWith("run.csv:run.mat: column \"angle_deg\" has 2 numbers"));
}

}  // namespace
}  // namespace pendulum::content_test
