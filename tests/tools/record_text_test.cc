// SPDX-License-Identifier: Apache-2.0
#include "tools/record_text.h"

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::record_text_test {
namespace {

namespace wire = pendulum_logger;

using testing::AllOf;
using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

wire::Info Uno() {
  wire::Info info{};
  info.firmware = 0x0100;
  info.board = wire::kUno;
  info.reference = 1;
  info.run = 41;
  return info;
}

/// A complete recording of these readings at 200 Hz.
RecordedRun Recorded(const std::vector<int>& counts = {500, 540, 460, 500}) {
  RecordedRun recorded(SamplingRate{10000, 1});
  for (const int reading : counts) {
    wire::Data frame{};
    frame.tick = static_cast<std::uint32_t>(10000 * recorded.run.size());
    frame.count = 1;
    frame.sums[0] = static_cast<std::uint16_t>(reading);
    EXPECT_TRUE(recorded.run.AddFrame(frame, 0));
  }
  recorded.end = RunEnd::kSeconds;
  recorded.description.logger = Uno();
  recorded.description.run = 42;
  recorded.description.losses.emplace().is_end_known = true;
  return recorded;
}

Calibration QuarterDegree() {
  Calibration calibration;
  calibration.input = "counts";
  calibration.angle_unit = "deg";
  calibration.coefficients = {-135, 0.25};
  return calibration;
}

std::vector<std::string> CodesOf(const RecordedRun& recorded) {
  std::vector<std::string> codes;
  for (const Warning& warning : RecordWarnings(recorded)) codes.emplace_back(warning.code.text());
  return codes;
}

/// A text with every run of blanks and line ends replaced by one blank, so that line breaks do not matter.
std::string Flat(const std::string& text) {
  std::istringstream words(text);
  std::string flat;
  for (std::string word; words >> word;) flat += (flat.empty() ? "" : " ") + word;
  return flat;
}

std::string FlatText(const RecordedRun& recorded) { return Flat(RecordText(recorded, "run.csv")); }

/// Columns of the widest line; a multi-byte character such as ± counts once.
std::size_t Width(const std::string& text) {
  std::istringstream lines(text);
  std::size_t width = 0;
  for (std::string line; std::getline(lines, line);) {
    const auto columns = std::ranges::count_if(line, [](char c) { return (c & 0xC0) != 0x80; });
    width = std::max(width, static_cast<std::size_t>(columns));
  }
  return width;
}

// ---- RecordText --------------------------------------------------------------------------------------------------

TEST(RecordText, DescribesTheRecording) {
  const std::string text = FlatText(Recorded());
  EXPECT_THAT(text, AllOf(HasSubstr("file run.csv"), HasSubstr("pendulum_logger version 1.0, Arduino Uno, run 42"),
                          HasSubstr("4 at 200 Hz, 0.02 s; none lost"), HasSubstr("460 to 540 of 0 to 1023 counts"),
                          HasSubstr("ended after the time asked for")));
  EXPECT_THAT(text, Not(AnyOf(HasSubstr("Warnings"), HasSubstr("deg"), HasSubstr("mean of"))));
}

// -135 + 0.25 * 460 = -20 and -135 + 0.25 * 540 = 0.
TEST(RecordText, ShowsAnglesIfCalibrated) {
  RecordedRun recorded = Recorded();
  recorded.description.calibration = QuarterDegree();
  EXPECT_THAT(FlatText(recorded), HasSubstr("460 to 540 of 0 to 1023 counts, -20 to 0 deg"));
}

TEST(RecordText, DescribesOnlyTheSamplesThatAreKept) {
  RecordedRun recorded = Recorded({500, 510, 520, 1023, 0});
  recorded.run.KeepFirst(3);
  EXPECT_THAT(FlatText(recorded), AllOf(HasSubstr("3 at 200 Hz, 0.015 s"), HasSubstr("500 to 520 of")));
  EXPECT_THAT(CodesOf(recorded), IsEmpty());
}

TEST(RecordText, ShowsOversampling) {
  RecordedRun recorded(SamplingRate{1250, 16});
  wire::Data frame{};
  frame.count = 1;
  frame.sums[0] = 16 * 500 + 4;
  ASSERT_TRUE(recorded.run.AddFrame(frame, 0));
  recorded.description.logger = Uno();
  EXPECT_THAT(FlatText(recorded), AllOf(HasSubstr("1 at 100 Hz, 0.01 s, each the mean of 16 conversions"),
                                        HasSubstr("500.25 to 500.25 of")));
}

// A second of the logger is 1.0005 true seconds: its clock is slow by 500 ppm.
TEST(RecordText, ShowsTheMeasuredClock) {
  RecordedRun recorded = Recorded();
  EXPECT_THAT(FlatText(recorded), HasSubstr("± 0.3 %"));
  recorded.description.clock = {.scale = 1.0005, .std_dev = 12e-6, .is_measured = true};
  EXPECT_THAT(FlatText(recorded), HasSubstr("500 ± 12 ppm slow"));
  recorded.description.clock.scale = 0.997;  // 1 / 0.997 = 1.003009
  EXPECT_THAT(FlatText(recorded), HasSubstr("3009 ± 12 ppm fast"));
}

TEST(RecordText, ShowsWhyTheRecordingEnded) {
  RecordedRun recorded = Recorded();
  recorded.end = RunEnd::kRest;
  EXPECT_THAT(FlatText(recorded), HasSubstr("ended at rest"));
  recorded.end = RunEnd::kStopped;
  EXPECT_THAT(FlatText(recorded), HasSubstr("ended by hand"));
  recorded.end = RunEnd::kLost;
  recorded.loss_reason = "the logger stopped sending";
  EXPECT_THAT(FlatText(recorded), HasSubstr("ended too early: the logger stopped sending"));
}

TEST(RecordText, FitsATerminal) {
  RecordedRun recorded = Recorded({0, 1023, 1023, 500});
  recorded.description.calibration = QuarterDegree();
  recorded.description.losses = {123456, 100000, 20000, 3456, 7, false};
  recorded.description.clock.is_implausible = true;
  recorded.part_file_error = "cannot write run.csv.part: No space left on device";
  const std::string text = RecordText(recorded, "run.csv");
  EXPECT_THAT(Flat(text), HasSubstr("[[Warnings]]"));
  EXPECT_LE(Width(text), 80);
}

TEST(RecordText, ContainsNoTerminalControlCharacters) {
  RecordedRun recorded = Recorded();
  recorded.part_file_error = "cannot write \x1b[2Jrun.csv.part";
  EXPECT_THAT(RecordText(recorded, "\x1b[2Jrun.csv"), Not(HasSubstr("\x1b")));
}

// ---- RecordWarnings ----------------------------------------------------------------------------------------------

TEST(RecordWarnings, AreEmptyForAGoodRecording) {
  EXPECT_THAT(RecordWarnings(Recorded()), IsEmpty());
  EXPECT_TRUE(IsComplete(Recorded()));
}

TEST(RecordWarnings, ReportLostSamples) {
  RecordedRun recorded = Recorded();
  recorded.description.losses->samples = 30;
  recorded.description.losses->dropped = 20;
  recorded.description.losses->on_line = 10;
  recorded.description.losses->late = 5;
  const auto warnings = RecordWarnings(recorded);
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_EQ(warnings[0].code, "lost_samples");
  EXPECT_THAT(MessageText(warnings[0]),
              AllOf(HasSubstr("30 samples"), HasSubstr("20 did not fit"), HasSubstr("--rate_hz"),
                    HasSubstr("10 were damaged"), HasSubstr("5 conversions")));
  EXPECT_THAT(FlatText(recorded), HasSubstr("; 30 lost"));
  EXPECT_FALSE(IsComplete(recorded));
}

TEST(RecordWarnings, ReportAMissingEnd) {
  RecordedRun recorded = Recorded();
  recorded.description.losses->is_end_known = false;
  EXPECT_THAT(CodesOf(recorded), ElementsAre("end_message_missing"));
  EXPECT_FALSE(IsComplete(recorded));
}

TEST(RecordWarnings, ReportALostLogger) {
  RecordedRun recorded = Recorded();
  recorded.end = RunEnd::kLost;
  recorded.loss_reason = "/dev/ttyACM0 is gone";
  recorded.description.losses->is_end_known = false;
  const auto warnings = RecordWarnings(recorded);
  ASSERT_THAT(warnings, SizeIs(1));  // none for the End frame, which is missing too
  EXPECT_EQ(warnings[0].code, "recording_interrupted");
  EXPECT_THAT(MessageText(warnings[0]), HasSubstr("/dev/ttyACM0 is gone"));
  EXPECT_FALSE(IsComplete(recorded));
}

TEST(RecordWarnings, CountSaturatedReadings) {
  const auto warnings = RecordWarnings(Recorded({0, 1, 1022, 1023, 1023}));
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_EQ(warnings[0].code, "saturated");
  EXPECT_THAT(MessageText(warnings[0]), HasSubstr("3 readings"));
  EXPECT_TRUE(IsComplete(Recorded({0, 1, 1022, 1023, 1023})));
}

TEST(RecordWarnings, ReportAllOtherProblems) {
  RecordedRun recorded = Recorded();
  recorded.description.losses->contradicting_frames = 2;
  recorded.description.clock.is_implausible = true;
  recorded.part_file_error = "cannot write run.csv.part: No space left on device";
  EXPECT_THAT(CodesOf(recorded), ElementsAre("contradicting_frames", "clock_implausible", "part_file_not_written"));
  EXPECT_THAT(FlatText(recorded), AllOf(HasSubstr("2 frames"), HasSubstr("No space left on device")));
}

// ---- Loggers and ports -------------------------------------------------------------------------------------------

TEST(LoggerText, DescribesTheLogger) {
  const std::string text = Flat(LoggerText(Uno(), "/dev/ttyACM0"));
  EXPECT_THAT(text, AllOf(HasSubstr("port /dev/ttyACM0"), HasSubstr("version 1.0"), HasSubstr("board Arduino Uno"),
                          HasSubstr("reference supply voltage"), HasSubstr("41 so far"), HasSubstr("no calibration")));
}

TEST(LoggerText, ShowsTheCalibration) {
  wire::Info info = Uno();
  info.has_calibration = 1;
  info.calibration = {-135.1F, 0.2637F, 0, 0, 0};
  EXPECT_THAT(Flat(LoggerText(info, "p")), HasSubstr("angle = -135.1 + 0.2637 x deg, x in counts"));
  info.calibration = {135, -0.25F, 0.04F, -6e-5F, 1.25e-7F};
  EXPECT_THAT(Flat(LoggerText(info, "p")), HasSubstr("angle = 135 - 0.25 x deg, x in counts, with its covariance"));
}

TEST(PortsText, ListsOnePortPerLine) {
  const std::vector<PortName> ports = {{"/dev/ttyACM0", "Arduino \x1b[2JUno", true}, {"/dev/ttyUSB1", "", false}};
  const std::string text = PortsText(ports);
  std::istringstream lines(text);
  std::string first, second;
  std::getline(lines, first);
  std::getline(lines, second);
  EXPECT_THAT(first,
              AllOf(HasSubstr("/dev/ttyACM0"), HasSubstr("Arduino"), HasSubstr("board's"), Not(HasSubstr("\x1b"))));
  EXPECT_EQ(second, "/dev/ttyUSB1");
  EXPECT_TRUE(lines.get() == EOF);
}

TEST(PortsText, ReportsMissingPorts) { EXPECT_THAT(PortsText({}), HasSubstr("no USB serial port")); }

}  // namespace
}  // namespace pendulum::record_text_test
