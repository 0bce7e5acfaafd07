// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/zip_recording.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/sha256.h"
#include "tests/recording/rows.h"
#include "tests/recording/zip_files.h"

namespace pendulum::zip_recording_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string kMeta = "\"property\",\"value\"\n\"deviceModel\",\"a phone\"\n";
const std::string kTime =
    "\"event\",\"experiment time\",\"system time\",\"system time text\"\n\"START\",0.0,1.6E9,\"2020-09-13\"\n";

/// The file of one sensor with phyphox's names and format; `row` is the pattern of the rows.
std::string Gyroscope(const std::string& row = "0.0{t},1,{v}E0,2,3") {
  return "\"Time (s)\",\"Gyroscope x (rad/s)\",\"Gyroscope y (rad/s)\",\"Gyroscope z (rad/s)\",\"Absolute (rad/s)\"\n" +
         Rows(row);
}

const std::string kLight = "\"Time (s)\",\"Illuminance (lx)\"\n" + Rows("0.0{t},{v}");

std::string Phyphox() {
  return ZipOf(
      {{"Light.csv", kLight}, {"Gyroscope.csv", Gyroscope()}, {"meta/device.csv", kMeta}, {"meta/time.csv", kTime}});
}

ReadOptions Value(const std::string& column) { return TimeAndValue("", column); }

// ---- Which member ------------------------------------------------------------------------------------------------

TEST(ReadZip, ReadsTheNamedColumn) {
  for (const char* const name : {"Gyroscope y (rad/s)", "Gyroscope.csv/Gyroscope y (rad/s)", "Gyroscope.csv/3"}) {
    const Recording recording = RecordingOf(Phyphox(), Value(name));
    ExpectTheRows(recording);
    EXPECT_EQ(recording.quantity, Quantity::kRate);
    EXPECT_EQ(recording.path, "run.csv");
  }
}

TEST(ReadZip, CombinesTheAxesOfTheOnlyMemberThatHasSome) {
  std::string gyro = "\"Time (s)\",\"Gyroscope x (rad/s)\",\"Gyroscope y (rad/s)\"\n";
  for (int i = 0; i < 500; ++i) {
    const double rate = 2 * std::cos(0.1 * i);
    gyro += std::to_string(0.01 * i) + "," + std::to_string(0.6 * rate) + "," + std::to_string(0.8 * rate) + "\n";
  }
  const std::string angle = "time_s,angle_deg\n" + Rows("0.0{t},{v}");
  const Recording recording = RecordingOf(ZipOf({{"angle.csv", angle}, {"gyro.csv", gyro}}), Value("combined"));
  EXPECT_EQ(recording.quantity, Quantity::kRate);
  EXPECT_NEAR(recording.value[0], 2, 1e-3);
}

TEST(ReadZip, HashesThePackedBytes) {
  EXPECT_EQ(RecordingOf(Phyphox(), Value("Gyroscope y (rad/s)")).sha256, Sha256(Phyphox()).value());
}

TEST(ReadZip, RefusesTwoComponentsAndIgnoresTheVectorLength) {
  EXPECT_EQ(FaultOf(Phyphox()),
            "run.csv:Gyroscope.csv:1:1: columns \"Gyroscope x (rad/s)\", \"Gyroscope y (rad/s)\" and \"Gyroscope z "
            "(rad/s)\" could all be the quantity, and none of them shows a swing by itself; choose one with "
            "--value_column");
  EXPECT_EQ(WrongFlag(Phyphox(), Value("Absolute (rad/s)")),
            "run.csv:Gyroscope.csv:1:78: column \"Absolute (rad/s)\" is the length of a vector, which does not contain "
            "the sign of the swing; choose one of the vector's components with --value_column");
  const std::string one = "\"Time (s)\",\"Gyroscope z (rad/s)\",\"Absolute (rad/s)\"\n" + Rows("0.0{t},{v},{v}");
  ExpectTheRows(RecordingOf(ZipOf({{"Raw Data.csv", one}})));
}

TEST(ReadZip, ChoosesTheOnlyMemberWithACandidate) {
  const std::string angle = "time_s,angle_deg\n" + Rows("0.0{t},{v}");
  ExpectTheRows(RecordingOf(ZipOf({{"Light.csv", kLight}, {"runs/a/angle.csv", angle}})), kDegree);
  ExpectTheRows(RecordingOf(ZipOf({{"__MACOSX/._angle.csv", "x"}, {"angle.csv", angle}, {"sub/", ""}})), kDegree);
}

TEST(ReadZip, RefusesTwoMembersWithCandidatesAndNamesThem) {
  const std::string angle = "time_s,angle_deg\n" + Rows("0.0{t},{v}");
  const std::string two = ZipOf({{"a.csv", angle}, {"runs/b.csv", angle}});
  EXPECT_EQ(FaultOf(two),
            "run.csv: columns \"a.csv/angle_deg\" and \"runs/b.csv/angle_deg\" could both be the quantity; choose one "
            "with --value_column");
  EXPECT_THAT(ParseRecording(two, "run.csv").error().try_flags, testing::ElementsAre("--value_column a.csv/angle_deg"));
  ExpectTheRows(RecordingOf(two, Value("b.csv/angle_deg")), kDegree);
  ExpectTheRows(RecordingOf(two, Value("runs/b.csv/angle_deg")), kDegree);
  ExpectTheRows(RecordingOf(two, Value("a.csv")), kDegree);
}

TEST(ReadZip, PrefersWholePathsToFileNames) {
  const std::string other = "time_s,angle_deg\n" + Rows("0.0{t},7");
  const std::string angle = "time_s,angle_deg\n" + Rows("0.0{t},{v}");
  const std::string nested = ZipOf({{"old/run.csv", other}, {"run.csv", angle}});
  ExpectTheRows(RecordingOf(nested, Value("run.csv/angle_deg")), kDegree);
  EXPECT_EQ(RecordingOf(nested, Value("old/run.csv")).value[3], 7 * kDegree);
  const std::string two = ZipOf({{"old/run.csv", other}, {"new/run.csv", angle}});
  ExpectTheRows(RecordingOf(two, Value("new/run.csv/angle_deg")), kDegree);
  EXPECT_EQ(WrongFlag(two, Value("run.csv/angle_deg")),
            "run.csv: --value_column is \"run.csv/angle_deg\", but both \"old/run.csv\" and \"new/run.csv\" have this "
            "name; give the path within the zip file");
}

TEST(ReadZip, AcceptsAUnitAfterTheTimeColumn) {
  const std::string text = "tick,angle_deg\n" + Rows("{t},{v}");
  for (const char* const time : {"tick:ms", "1:ms"}) {
    ExpectTheRows(RecordingOf(ZipOf({{"Light.csv", kLight}, {"a.csv", text}}), TimeAndValue(time, "angle_deg")),
                  kDegree);
  }
}

TEST(ReadZip, ReadsSemicolonsAndDecimalCommasAndLeavesOutNaN) {
  std::string rows = Gyroscope("0,0{t};1;{v},0E0;2;3") + "8,000000000E-2;NaN;NaN;NaN;NaN\n";
  for (char& c : rows.replace(0, rows.find('\n'), std::string(rows, 0, rows.find('\n')))) {
    if (&c - rows.data() < static_cast<std::ptrdiff_t>(rows.find('\n')) && c == ',') c = ';';
  }
  const Recording recording = RecordingOf(ZipOf({{"Gyroscope.csv", rows}}), Value("Gyroscope y (rad/s)"));
  ExpectTheRows(recording);
  EXPECT_TRUE(recording.warnings.empty());
}

// ---- Not a recording ---------------------------------------------------------------------------------------------

TEST(ReadZip, ReportsThatNoMemberIsARecording) {
  const std::string none = FaultOf(ZipOf({{"Light.csv", kLight}, {"notes.txt", "hello\n"}}));
  EXPECT_THAT(none,
              StartsWith("run.csv: none of its files \"Light.csv\" and \"notes.txt\" has a column of times and one of "
                         "an angle or a rate; choose with --value_column \"FILE/COLUMN\", or name another recording. "
                         "The first file says: run.csv:Light.csv:1:"));
  EXPECT_THAT(none, HasSubstr("none of the columns \"Time (s)\", \"Illuminance (lx)\" is an angle"));
  std::vector<std::pair<std::string, std::string>> many;
  for (int i = 0; i < 21; ++i) many.emplace_back(std::to_string(i) + ".csv", kLight);
  EXPECT_THAT(FaultOf(ZipOf(many)), StartsWith("run.csv: it has 21 files, and no header shows which one"));
  EXPECT_THAT(FaultOf(ZipOf({{"meta/device.csv", kMeta}})), HasSubstr("this zip file contains no recording"));
  EXPECT_EQ(FaultOf(ZipOf({{"inner.zip", ZipOf({{"a.csv", kLight}})}})),
            "run.csv:inner.zip: this is a zip file in a zip file; unpack it and give the unpacked file");
}

TEST(ReadZip, ReportsThePlaceOfAFaultInAMember) {
  EXPECT_EQ(
      FaultOf(ZipOf({{"a.csv", "time_s,angle_deg\n" + Rows("0.0{t},{v}", 7) + "0.07,x\n0.08,1\n"}})),
      "run.csv:a.csv:9:6: column \"angle_deg\" holds \"x\", which is not a number; correct the field or delete the "
      "row");
}

TEST(ReadZip, RefusesATruncatedFile) {
  const std::string whole = Phyphox();
  for (std::size_t size = 4; size < whole.size(); size += 7) {
    EXPECT_THAT(FaultOf(whole.substr(0, size)), StartsWith("run.csv: this zip file cannot be opened")) << size;
  }
}

TEST(ReadZip, RefusesADamagedMember) {
  std::string bytes = ZipOf({{"a.csv", "time_s,angle_deg\n" + Rows("0.0{t},{v}", 60)}});
  for (std::size_t i = 60; i < 100; ++i) bytes[i] = static_cast<char>(bytes[i] ^ 0x55);
  EXPECT_THAT(FaultOf(bytes), StartsWith("run.csv:a.csv: it cannot be unpacked ("));
}

TEST(ReadZip, NamesAnUnreadableMember) {
  const std::string angle = "time_s,angle_deg\n" + Rows("0.0{t},{v}");
  const auto damaged = [&](const std::string& other) {
    std::string bytes = ZipOf({{"a.csv", "time_s,angle_deg\n" + Rows("0.0{t},{v}", 60)}, {"other.csv", other}});
    for (std::size_t i = 60; i < 100; ++i) bytes[i] = static_cast<char>(bytes[i] ^ 0x55);
    return bytes;
  };
  const Recording recording = RecordingOf(damaged(angle));
  ExpectTheRows(recording, kDegree);
  ASSERT_EQ(recording.warnings.size(), 1);
  EXPECT_EQ(recording.warnings[0].code, "unreadable_member");
  EXPECT_THAT(MessageText(recording.warnings[0]), StartsWith("run.csv:a.csv: it cannot be unpacked ("));
  EXPECT_TRUE(RecordingOf(damaged(angle), Value("other.csv")).warnings.empty());
  EXPECT_THAT(FaultOf(damaged(kLight)), StartsWith("run.csv:a.csv: it cannot be unpacked ("));
  EXPECT_EQ(FaultOf(ZipOf({{"a.csv", angle}, {"b.csv", angle}}, "secret")),
            "run.csv:a.csv: it is encrypted; unpack it with its password and name the file");
}

TEST(ReadZip, RefusesEncryptedMembers) {
  EXPECT_EQ(FaultOf(ZipOf({{"a.csv", "time_s,angle_deg\n" + Rows("0.0{t},{v}")}}, "secret")),
            "run.csv:a.csv: it is encrypted; unpack it with its password and name the file");
}

TEST(ReadZip, RefusesAZipBomb) {
  ReadOptions options;
  EXPECT_EQ(options.most_unpacked_bytes, 536'870'912);
  options.most_unpacked_bytes = 1'000'000;
  const std::string angle = "time_s,angle_deg\n" + Rows("0.0{t},{v}");
  const std::string most = angle + std::string(1'000'000 - angle.size(), '\n');
  ExpectTheRows(RecordingOf(ZipOf({{"a.csv", most}}), options), kDegree);
  EXPECT_EQ(FaultOf(ZipOf({{"a.csv", most + '\n'}}), options),
            "run.csv:a.csv: it unpacks to more than 1000000 bytes, too many for a recording; give a smaller file, or "
            "split it");
}

TEST(ReadZip, ShowsButNeverFollowsPathsToParentFolders) {
  EXPECT_THAT(FaultOf(ZipOf({{"../../etc/passwd", "a,b\n1,2\n"}})), StartsWith("run.csv:../../etc/passwd:1:1: "));
}

}  // namespace
}  // namespace pendulum::zip_recording_test
