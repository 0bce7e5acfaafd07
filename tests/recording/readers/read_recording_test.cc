// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/readers/read_recording.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"

namespace pendulum::read_recording_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// Rows `0.5 i <separator> i` for i = 0 to count - 1, each with a line end.
std::string Rows(int count = 8, const std::string& separator = ",") {
  std::string rows;
  for (int i = 0; i < count; ++i) {
    rows += std::to_string(i / 2) + (i % 2 == 0 ? ".0" : ".5") + separator + std::to_string(i) + "\n";
  }
  return rows;
}

const std::string kHeader = "time_s,angle_rad\n";

Recording RecordingOf(const std::string& text) {
  const Result<Recording> recording = ParseRecording(text, "run.csv");
  EXPECT_TRUE(recording.has_value()) << text << (recording ? "" : recording.error().message());
  return recording.value_or(Recording());
}

/// Expects that the text gives the times and values of Rows().
void ExpectTheRows(const std::string& text) {
  const Recording recording = RecordingOf(text);
  ASSERT_EQ(recording.size(), 8) << text;
  EXPECT_EQ(recording.time, Eigen::VectorXd::LinSpaced(8, 0.0, 3.5)) << text;
  EXPECT_EQ(recording.value, Eigen::VectorXd::LinSpaced(8, 0.0, 7.0)) << text;
}

Status ErrorOf(const std::string& text) {
  const Result<Recording> recording = ParseRecording(text, "run.csv");
  EXPECT_FALSE(recording.has_value()) << text;
  return recording ? Status{StatusCode::kInternal, "no fault"} : recording.error();
}

/// The message of an error; expects the code kDataLoss.
std::string FaultOf(const std::string& text) {
  const Status error = ErrorOf(text);
  EXPECT_EQ(error.code, StatusCode::kDataLoss) << error.message();
  return error.message();
}

/// The message if the eighth row (line 9) is `row`.
std::string FaultOfRow(const std::string& row) { return FaultOf(kHeader + Rows(7) + row + "\n"); }

// ---- Valid files -------------------------------------------------------------------------------------------------

TEST(ParseRecording, ReadsTimeAndAngle) {
  ExpectTheRows(kHeader + Rows());
  const Recording recording = RecordingOf(kHeader + Rows());
  EXPECT_EQ(recording.path, "run.csv");
  EXPECT_EQ(recording.quantity, Quantity::kAngle);
  EXPECT_EQ(recording.unit, "rad");
  EXPECT_EQ(recording.resolution, 0);
  EXPECT_TRUE(recording.warnings.empty());
}

TEST(ParseRecording, HashesTheBytes) {
  // From Python's hashlib for the same text.
  EXPECT_EQ(RecordingOf(kHeader + Rows()).sha256, "c515710e2595eda778ddfc7a95ac90bce7cf9d874020fd7f820e239ec47c8371");
}

TEST(ParseRecording, TakesQuantityAndUnitFromTheColumnName) {
  struct Case {
    const char* name;
    Quantity quantity;
    const char* unit;
    double si;  // One unit in SI; a degree is 0.017453292519943295 rad (NIST SP 811, table 6).
  };
  for (const Case& each :
       {Case{"angle_rad", Quantity::kAngle, "rad", 1},
        Case{"pot_angle_deg", Quantity::kAngle, "deg", 0.017453292519943295},
        Case{"gyro_rad_s", Quantity::kRate, "rad/s", 1},
        Case{"gyro_deg_s", Quantity::kRate, "deg/s", 0.017453292519943295},
        Case{"Angle [deg]", Quantity::kAngle, "deg", 0.017453292519943295},
        Case{"gyro (rad/s)", Quantity::kRate, "rad/s", 1}, Case{"Gyroscope z ( RAD / S )", Quantity::kRate, "rad/s", 1},
        Case{"\"ANGLE_DEG\"", Quantity::kAngle, "deg", 0.017453292519943295},
        Case{"rate [°/s]", Quantity::kRate, "deg/s", 0.017453292519943295}}) {
    const Recording recording = RecordingOf("time_s," + std::string(each.name) + "\n" + Rows());
    EXPECT_EQ(recording.quantity, each.quantity) << each.name;
    EXPECT_EQ(recording.unit, each.unit) << each.name;
    ASSERT_EQ(recording.size(), 8) << each.name;
    EXPECT_DOUBLE_EQ(recording.value[5], 5 * each.si) << each.name;
  }
}

TEST(ParseRecording, ConvertsTimesToRoundSeconds) {
  std::string rows;
  for (int i = 1; i <= 50; ++i) rows += std::to_string(i * 33) + ",1\n";
  for (const char* const name : {"time_ms", "Time (ms)", "time[MS]"}) {
    const Recording recording = RecordingOf(name + std::string(",angle_rad\n") + rows);
    ASSERT_EQ(recording.size(), 50);
    EXPECT_EQ(recording.time[0], 0.033);
    EXPECT_EQ(recording.time[49], 1.650);
  }
  for (const char* const name : {"time_us", "Time (us)", "time (µs)"}) {
    EXPECT_EQ(RecordingOf(name + std::string(",angle_rad\n") + rows).time[49], 0.00165) << name;
  }
  EXPECT_EQ(RecordingOf("time [s],angle_rad\n" + rows).time[49], 1650);
}

TEST(ParseRecording, TakesTheSeparatorFromTheHeader) {
  ExpectTheRows("time_s;angle_rad\n" + Rows(8, ";"));
  ExpectTheRows("time_s\tangle_rad\n" + Rows(8, "\t"));
  ExpectTheRows("Time (s);\"Angle; smoothed (rad)\"\n" + Rows(8, ";"));
  ExpectTheRows("Time (s);Angle, smoothed (rad)\n" + Rows(8, ";"));
}

TEST(ParseRecording, IgnoresOtherColumns) {
  ExpectTheRows(
      "n,time_s,note,angle_rad,delay_s\n"
      "1,0,,0,x\n2,.5,\"a, \"\"b\"\",c\",1,\n3,1,,2,\n4,1.5,#,3,nan\n5,2,,4,\n6,2.5,,5,\n7,3,,6\n8,3.5,,7,\n");
  ExpectTheRows("angle_rad,time_s\n0,0\n1,.5\n2,1\n3,1.5\n4,2\n5,2.5\n6,3\n7,3.5\n");
}

TEST(ParseRecording, AcceptsTextThatProgramsAddToNumbers) {
  std::string crlf = kHeader + Rows();
  for (std::size_t at = 0; (at = crlf.find('\n', at)) != std::string::npos; at += 2) crlf.replace(at, 1, "\r\n");
  ExpectTheRows(crlf);
  ExpectTheRows("\xEF\xBB\xBF" + kHeader + Rows());
  ExpectTheRows("\n  \n# a comment\n" + kHeader + "\t\n#another: one\n" + Rows() + "\n\n , \r\n  # and a last one");
  ExpectTheRows("\"time_s\" , \"angle_rad\"\n" + Rows());
  ExpectTheRows((kHeader + Rows()).substr(0, (kHeader + Rows()).size() - 1));
  ExpectTheRows("time_s,angle_rad,\n" + Rows(8, " , ") + ",,\n");
}

TEST(ParseRecording, AcceptsAllNumberFormats) {
  const Recording recording = RecordingOf(
      kHeader +
      "-1,-0\n0, +1.5\n1e0,1e-3\n 2 ,\"-.5\"\n+3,5.\n\" 4 \",+2E+2\n5,007\n6,0.1000000000000000055511151231257827\n");
  ASSERT_EQ(recording.size(), 8);
  EXPECT_EQ(recording.time, (Eigen::VectorXd(8) << -1, 0, 1, 2, 3, 4, 5, 6).finished());
  EXPECT_EQ(recording.value, (Eigen::VectorXd(8) << 0, 1.5, 1e-3, -.5, 5, 200, 7, .1).finished());
}

TEST(ParseRecording, KeepsATimeGapAndAConstantSignal) {
  EXPECT_EQ(RecordingOf(kHeader + Rows(7) + "5000,0\n").time[7], 5000);
  EXPECT_EQ(RecordingOf(kHeader + "0,1\n1,1\n2,1\n3,1\n4,1\n5,1\n6,1\n7,1\n").value, Eigen::VectorXd::Ones(8));
}

TEST(ParseRecording, ConvertsTheResolutionFromTheFilesUnit) {
  EXPECT_DOUBLE_EQ(RecordingOf("# resolution: 0.5\ntime_s,angle_deg\n" + Rows()).resolution, 0.5 * kPi / 180);
  EXPECT_EQ(RecordingOf(kHeader + Rows() + "#resolution:0.5").resolution, 0.5);
  EXPECT_EQ(RecordingOf("# resolution: 0\n" + kHeader + Rows()).resolution, 0);
}

TEST(ParseRecording, PassesOnMetadata) {
  const Recording recording = RecordingOf(
      "# lost_samples: 3\n# operator: resolution unknown\n# range: -45, 45\n# sample_rate_hz: 100\n"
      "# clock_scale: 1.0001\n# clock_scale_std_dev: 2e-5\n# rig: {\"gravity_torque\": 1.8}\n" +
      kHeader + Rows());
  ASSERT_EQ(recording.warnings.size(), 1);
  EXPECT_EQ(recording.warnings[0].code, "rate_disagrees");
  EXPECT_EQ(recording.time[1], 0.5);  // From the time column, neither scaled nor from the rate.
  EXPECT_EQ(recording.clock_scale, 1.0001);
  EXPECT_EQ(recording.clock_scale_std_dev, 2e-5);
  EXPECT_EQ(recording.rig_json, "{\"gravity_torque\": 1.8}");
  EXPECT_EQ(RecordingOf(kHeader + Rows()).clock_scale, 1);
  EXPECT_EQ(RecordingOf(kHeader + Rows()).clock_scale_std_dev, 0);
}

TEST(ParseRecording, ConvertsTheDeclaredRangeToSi) {
  EXPECT_FALSE(RecordingOf(kHeader + Rows()).range);
  const std::string values = "0,-45\n1,-44\n2,0\n3,1\n4,2\n5,44\n6,45\n7,45\n";
  const Recording recording = RecordingOf("# range: -45,45\ntime_s,angle_deg\n" + values);
  ASSERT_TRUE(recording.range);
  EXPECT_DOUBLE_EQ(recording.range->low, -0.7853981633974483);  // π/4
  EXPECT_DOUBLE_EQ(recording.range->high, 0.7853981633974483);
}

// ---- Invalid files -----------------------------------------------------------------------------------------------

TEST(ParseRecording, RefusesMalformedMetadataAtItsPosition) {
  EXPECT_EQ(FaultOf("# resolution: 0.1 deg\n" + kHeader + Rows()),
            "run.csv:1:15: the metadata resolution is \"0.1 deg\"; it must be a number, 0 or more, in the unit of the "
            "file: correct or delete this line");
  for (const char* const line :
       {"resolution: -1", "resolution: nan", "range: 1", "range: 2,1", "sample_rate_hz: 0",
        "clock_scale:", "clock_scale_std_dev: -1", "lost_samples: 1.5", "rig: my_rig.json", "calibration: [1]"}) {
    EXPECT_THAT(FaultOf(kHeader + Rows() + "# " + line), StartsWith("run.csv:10:")) << line;
  }
  EXPECT_THAT(FaultOf("# resolution: 1\n# resolution: 1\n" + kHeader + Rows()),
              StartsWith("run.csv:2:3: the metadata resolution is given twice"));
}

TEST(ParseRecording, RefusesAHeaderWithoutTime) {
  const Status error = ErrorOf("angle_rad,rate\n1,0\n0,2\n1,1\n0,3\n1,1\n0,2\n1,1\n0,2\n");
  EXPECT_EQ(error.message(),
            "run.csv:1:1: none of the columns \"angle_rad\", \"rate\" is a time: give the rate of the rows in "
            "Hz with --sample_rate_hz, or the column with --time_column");
  EXPECT_THAT(error.try_flags, testing::IsEmpty());  // No example is right.
}

TEST(ParseRecording, RefusesAHeaderWithoutQuantity) {
  EXPECT_THAT(FaultOf("# one\ntime_s,pressure (hPa)\n" + Rows()),
              AllOf(StartsWith("run.csv:2:1: none of the columns"),
                    HasSubstr("is an angle, a rate or another quantity of a swing by its name; choose one with "
                              "--value_column; column \"pressure (hPa)\" does not give its unit")));
}

TEST(ParseRecording, RefusesTwoCandidatesAndNamesBoth) {
  std::string rows;
  for (int i = 0; i < 100; ++i) {
    const auto number = [i](double phase) { return std::to_string(std::cos(0.3 * i + phase)); };
    rows += std::to_string(0.01 * i) + "," + number(0) + "," + number(1) + "\n";
  }
  const Status error = ErrorOf("time_s,upper_deg,lower_deg\n" + rows);
  EXPECT_THAT(error.message(), HasSubstr("no single column carries the swing: \"upper_deg\" 5"));
  EXPECT_THAT(error.try_flags, testing::ElementsAre("--value_column upper_deg"));
  // Of several quantities the angle is preferred.
  const Recording recording = RecordingOf("time_s,gyro_rad_s,angle_rad\n" + rows);
  EXPECT_EQ(recording.quantity, Quantity::kAngle);
  EXPECT_EQ(MessageText(recording.warnings.at(0)),
            "run.csv: column \"angle_rad\" was used, not \"gyro_rad_s\"; --value_column chooses another");
}

TEST(ParseRecording, AsksForTheUnitIfTheFirstRowHasNumbers) {
  const Status error = ErrorOf(Rows());
  EXPECT_THAT(error.message(), StartsWith("run.csv:1:1: column 2 does not give its unit"));
  EXPECT_THAT(error.try_flags, testing::ElementsAre("--unit counts"));
}

TEST(ParseRecording, RefusesARowThatIsTooLong) {
  EXPECT_EQ(
      FaultOfRow("3,50, 7"),
      "run.csv:9:7: field 3 holds \"7\" beyond the header's 2 columns; name every column, and write decimals with "
      "a point");
}

TEST(ParseRecording, RefusesAndShowsTextThatIsNotANumber) {
  EXPECT_EQ(
      FaultOfRow("3.5, abc "),
      "run.csv:9:6: column \"angle_rad\" holds \"abc\", which is not a number; correct the field or delete the row");
  EXPECT_THAT(FaultOfRow("3.5,1.5abc"), HasSubstr("holds \"1.5abc\", a number followed by \"abc\""));
  EXPECT_THAT(FaultOfRow("0x10,1"), StartsWith("run.csv:9:1: column \"time_s\" holds \"0x10\", a number followed by"));
  for (const char* const text : {"--1", "+-1", "+", ".", "e5", "1 2", "1e", "\"1", "1\"", "٣"}) {
    EXPECT_THAT(FaultOfRow("3.5," + std::string(text)), StartsWith("run.csv:9:5: column \"angle_rad\" holds ")) << text;
  }
}

TEST(ParseRecording, LeavesOutRowsThatSayThatANumberIsMissing) {
  for (const char* const text : {"", "NaN", "NA", "N/A", "#N/A", "null", "None"}) {
    const Recording recording = RecordingOf("time_s,angle_rad\n0,1\n0.1," + std::string(text) +
                                            "\n0.2,1\n0.3,2\n0.4,1\n0.5,2\n0.6,1\n0.7,2\n0.8,1\n");
    EXPECT_EQ(recording.size(), 8) << text;
    EXPECT_EQ(recording.warnings.at(0).code, "empty_cells") << text;
  }
}

TEST(ParseRecording, RefusesNonFiniteNumbers) {
  for (const char* const text : {"-nan", "inf", "-Infinity", "+inf", "nan(1)"}) {
    EXPECT_THAT(FaultOfRow("3.5," + std::string(text)), HasSubstr("a sample must be finite")) << text;
  }
}

TEST(ParseRecording, RefusesNumbersBeyondADouble) {
  for (const char* const text : {"1e999", "-1e309", "1e-400"}) {
    EXPECT_THAT(FaultOfRow("3.5," + std::string(text)), HasSubstr("which is outside the range of numbers")) << text;
  }
}

TEST(ParseRecording, ShortensAndEscapesShownText) {
  EXPECT_THAT(FaultOfRow("3.5,\x1B[31mred\x7F\xFF θ"), HasSubstr(R"("\x1b[31mred\x7f\xff θ")"));
  const std::string fault = FaultOfRow("3.5," + std::string(1000000, 'x'));
  EXPECT_THAT(fault, HasSubstr("\"" + std::string(40, 'x') + "...\""));
  EXPECT_LT(fault.size(), 200);
  EXPECT_LT(ErrorOf(std::string(1000000, ',') + "x\n").message().size(), 200);
}

TEST(ParseRecording, RefusesNulBytesAtTheirPosition) {
  EXPECT_THAT(FaultOf(kHeader + Rows() + std::string("8,\0\0", 4)), StartsWith("run.csv:10:3: there is a NUL byte"));
}

TEST(ParseRecording, ReportsTheNumberOfRowsAndTheMinimum) {
  for (const auto& [text, message] :
       {std::pair{kHeader + Rows(7), "run.csv:8:1: rows of data found: 7; at least 8 are needed: record for longer"},
        std::pair{kHeader, "run.csv:1:1: rows of data found: 0; at least 8 are needed: record for longer"},
        std::pair{std::string(), "run.csv:1:1: the file is empty; a header and at least 8 rows of data are needed"},
        std::pair{
            std::string("# a\n\n# b: c\n"),
            "run.csv:3:1: the file holds only comments and blank lines; a header and at least 8 rows are needed"}}) {
    EXPECT_EQ(ErrorOf(text).code, StatusCode::kFailedPrecondition);
    EXPECT_EQ(ErrorOf(text).message(), message);
  }
}

// A header of 100 kB is not read, and the message says so.
TEST(ParseRecording, SaysThatTheFirstLineIsTooLong) {
  std::string header = "t_s,theta_deg";
  while (header.size() < 100000) header += ",note_" + std::to_string(header.size());
  EXPECT_THAT(ErrorOf(header + "\n" + Rows()).message(),
              StartsWith("run.csv:1:1: the first line is longer than 64 kB and begins with \"t_s,theta_deg,note"));
  EXPECT_THAT(ErrorOf("# " + std::string(70000, 'a') + "\n" + kHeader + Rows()).message(),
              StartsWith("run.csv:1:1: the first line is longer than 64 kB and begins with \"# aaa"));
  std::string above;
  while (above.size() < 70000) above += "# a comment in a line of its own\n";
  EXPECT_EQ(ErrorOf(above + kHeader + Rows()).message(),
            "run.csv: no row of data begins in the first 64 kB: shorten the text above the table");
}

// ---- Random bytes ------------------------------------------------------------------------------------------------

/// Changes the text in one to four random places. Uses no distributions of <random>, because the standard does not
/// specify their numbers.
std::string Mutated(std::string text, std::mt19937& random) {
  for (auto edits = random() % 4 + 1; edits > 0 && !text.empty(); --edits) {
    constexpr std::string_view kSyntaxBytes = ",;\t\n\r\"#:.-+e0123456789_()[] naif\0\xC2\xFF";
    const std::size_t at = random() % text.size();
    const char byte = random() % 2 == 0 ? kSyntaxBytes[random() % kSyntaxBytes.size()] : static_cast<char>(random());
    switch (random() % 6) {
      case 0: text[at] = byte; break;
      case 1: text.insert(at, 1, byte); break;
      case 2: text.erase(at, random() % 8); break;
      case 3: text.insert(at, text.substr(random() % text.size(), random() % 40)); break;
      case 4: text.resize(at); break;
      default: text.erase(0, at % 30);
    }
  }
  return text;
}

void ExpectAValidRecordingOrAMessage(const std::string& text) {
  const Result<Recording> recording = ParseRecording(text, "fuzz.csv");
  if (recording) {
    EXPECT_TRUE(MakeRecording(*recording).has_value());
  } else {
    EXPECT_THAT(recording.error().message(), testing::MatchesRegex("fuzz\\.csv:( |[0-9]+:).+"));
    EXPECT_LT(recording.error().message().size(), 1000);
  }
}

TEST(ParseRecording, GivesARecordingOrAMessageForAnyBytes) {
  const std::string valid = "\xEF\xBB\xBF# resolution: 0.1\n# rig: {}\r\nn,\"time_ms\" ,Angle [°]\r\n" +
                            std::string("1,0,\"-1.5\"\n2,10, +1e-1\n3,20,3\n\n# a: b\n4,30,4\n5,40,5\n") +
                            "6,50,6\n\"7,\"\"\",60,7\n8,70,8\n9,80.25,-0\n,,\n";
  ASSERT_EQ(RecordingOf(valid).size(), 9);
  std::mt19937 random(20240611);
  for (int i = 0; i < 5000 && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    ExpectAValidRecordingOrAMessage(Mutated(valid, random));
    std::string noise(random() % 64, '\0');
    for (char& byte : noise) byte = static_cast<char>(random());
    ExpectAValidRecordingOrAMessage(noise);
  }
}

// ---- Files -------------------------------------------------------------------------------------------------------

TEST(ReadRecording, ReadsTheBytesOfAFile) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "read_recording_test.csv";
  std::ofstream(path, std::ios::binary) << kHeader << Rows();
  const Result<Recording> recording = ReadRecording(path);
  std::filesystem::remove(path);
  ASSERT_TRUE(recording.has_value()) << recording.error().message();
  EXPECT_EQ(recording->path, path.string());
  EXPECT_EQ(recording->sha256, RecordingOf(kHeader + Rows()).sha256);
  EXPECT_EQ(recording->value, RecordingOf(kHeader + Rows()).value);
}

TEST(ReadRecording, ReportsAMissingFile) {
  const Result<Recording> recording = ReadRecording("/nowhere/run.csv");
  ASSERT_FALSE(recording.has_value());
  EXPECT_EQ(recording.error().code, StatusCode::kNotFound);
  EXPECT_EQ(recording.error().message(), "/nowhere/run.csv: there is no such file; check the path");
}

TEST(ReadRecording, RefusesADirectory) {
  const Result<Recording> recording = ReadRecording(testing::TempDir());
  ASSERT_FALSE(recording.has_value());
  EXPECT_EQ(recording.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(recording.error().message(), HasSubstr("this is a directory"));
}

/// Numbers of samples as in src/docs/examples.md.
TEST(ReadRecording, ReadsTheSampleRecordings) {
  const char* const folder = std::getenv("PENDULUM_RECORDINGS");
  if (folder == nullptr) GTEST_SKIP() << "PENDULUM_RECORDINGS names no folder";
  const std::filesystem::path path(folder);
  EXPECT_EQ(ReadRecording(path / "multiarm_freeswing1.csv")->size(), 231757);
  EXPECT_EQ(ReadRecording(path / "pendulepi_A.csv")->size(), 5000);
  EXPECT_EQ(ReadRecording(path / "sonyneto_0312.csv")->unit, "deg");
  EXPECT_EQ(ReadRecording(path / "yfysiks_data2_25.csv")->size(), 36831);
  const Result<Recording> gyro = ReadRecording(path / "ganesh_gyro.csv");
  ASSERT_TRUE(gyro.has_value()) << gyro.error().message();
  EXPECT_EQ(gyro->size(), 17999 - 10 - 2 - 1);  // 10 duplicate rows, 2 with a shared stamp, 1 that goes back
  EXPECT_FALSE(ReadRecording(path / "cubli_PRINT_00.csv")->is_calibrated());
}

}  // namespace
}  // namespace pendulum::read_recording_test
