// SPDX-License-Identifier: Apache-2.0
// Tests of files as people and spreadsheets write them, and of options that add the missing information.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/format.h"
#include "pendulum/recording/readers/read_recording.h"
#include "tests/recording/rows.h"

namespace pendulum::foreign_formats_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// ---- Separators and decimal commas -------------------------------------------------------------------------------

TEST(ForeignFormats, ReadDecimalCommasWithAnotherSeparator) {
  ExpectTheRows(RecordingOf("time_ms;angle_rad\n" + Rows("{t},0;{v},0")));
  ExpectTheRows(RecordingOf("time_ms\tangle_rad\n" + Rows("+{t},\t\"{v},0\"")));
  ExpectTheRows(RecordingOf("time_ms angle_rad\n" + Rows("  {t}   {v},0 ")));
  const Recording recording = RecordingOf("time_s;angle_rad\n0,5;-,25\n1;1,5E1\n2;2\n3;3\n4;4\n5;5\n6;6\n7;7,125\n");
  EXPECT_EQ(recording.time[0], 0.5);
  EXPECT_EQ(recording.value[0], -0.25);
  EXPECT_EQ(recording.value[1], 15);
  EXPECT_EQ(recording.value[7], 7.125);
}

TEST(ForeignFormats, RefuseTwoKindsOfDecimalsInOneFile) {
  EXPECT_EQ(FaultOf("time_s;angle_rad\n0,5;1\n1.5;2\n2,5;3\n"),
            "run.csv:3:1: column \"time_s\" holds \"1.5\", a number with a decimal point in a file of decimal commas; "
            "write decimals with a comma");
  EXPECT_EQ(FaultOf("time_s;angle_rad\n0.5;1\n1.5;1,234\n2.5;3\n"),
            "run.csv:3:5: column \"angle_rad\" holds \"1,234\", a number with a decimal comma in a file of decimal "
            "points; write decimals with a point");
  EXPECT_THAT(FaultOf("time_s;angle_rad\n0;1.234,5\n1;2\n"), HasSubstr("holds \"1.234,5\""));
  EXPECT_THAT(FaultOf("time_s;angle_rad\n0;1,234,5\n1;2\n"), HasSubstr("holds \"1,234,5\""));
}

TEST(ForeignFormats, ReadSpreadsheetExports) {
  ExpectTheRows(RecordingOf("\xEF\xBB\xBFsep=;\r\nTime (ms);Angle [deg]\r\n" + Rows("{t},0;{v},0\r")), kDegree);
  ExpectTheRows(RecordingOf("sep=\t\nTime (ms)\tAngle, smoothed [deg]\n" + Rows("{t}\t{v}")), kDegree);
}

TEST(ForeignFormats, ReadColumnsSeparatedByBlanks) {
  ExpectTheRows(RecordingOf("Time (ms)   Angle [deg]\n" + Rows(" {t}  {v}")), kDegree);
  ExpectTheRows(RecordingOf("n time_ms angle_deg\n" + Rows("{v} {t} {v}")), kDegree);
}

// ---- Which column ------------------------------------------------------------------------------------------------

TEST(ForeignFormats, TheUserChoosesAmongColumns) {
  const std::string text = "time_ms,time_s,angle_rad,pot_volts\n" + Rows("{t},9,9,{v}");
  EXPECT_EQ(RecordingOf(text).unit, "rad");
  ExpectTheRows(RecordingOf(text, TimeAndValue("", "pot_volts")));  // time_s does not increase
  ExpectTheRows(RecordingOf(text, TimeAndValue("time_ms", "pot_volts")));
  ExpectTheRows(RecordingOf(text, TimeAndValue("1", "4")));
  ExpectTheRows(RecordingOf(text, TimeAndValue("1", "", "volts")));
  EXPECT_EQ(RecordingOf(text, TimeAndValue("1", "4")).unit, "volts");
}

TEST(ForeignFormats, ColumnsWithoutAUnitTakeTheUnitFlag) {
  const std::string text = "t,x\n" + Rows("{t},{v}");
  EXPECT_EQ(
      MessageText(RecordingOf(text, TimeAndValue("t:ms", "x")).warnings.at(0)),
      "run.csv: column \"x\" does not give its unit and was assumed to be in px, a length of unknown scale; --unit "
      "says otherwise");
  ExpectTheRows(RecordingOf(text, TimeAndValue("t:ms", "x", "deg")), kDegree);
  ExpectTheRows(RecordingOf(text, TimeAndValue("t:ms", "", "deg")), kDegree);
  ExpectTheRows(RecordingOf("t_ms,x\n" + Rows("{t},{v}"), TimeAndValue("t_ms", "", "deg")), kDegree);
  EXPECT_EQ(RecordingOf("t,x\n" + Rows("{t},{v}"), TimeAndValue("t:ms", "x", "rad_s")).quantity, Quantity::kRate);
}

TEST(ForeignFormats, FractionalTimesWithoutAUnitAreSeconds) {
  const Recording recording = RecordingOf("t,angle_rad\n" + Rows("0.{t}5,{v}"), TimeAndValue("t", ""));
  ASSERT_EQ(recording.warnings.size(), 1);
  EXPECT_EQ(recording.warnings[0].code, "time_unit_assumed");
  EXPECT_EQ(
      MessageText(recording.warnings[0]),
      "run.csv: column \"t\" does not give its unit and was assumed to be in s (the rows are then 0.0936 s apart); "
      "--time_column t:ms or :us says otherwise");
}

TEST(ForeignFormats, WholeTimesWithoutAUnitAreMilliseconds) {
  const std::string text = "t,angle_rad\n" + Rows("{t},{v}");
  ExpectTheRows(RecordingOf(text));
  EXPECT_EQ(RecordingOf(text).warnings.at(0).code, "time_unit_assumed");
  EXPECT_EQ(RecordingOf(text, TimeAndValue("t:s", "")).time[1], 10);
}

TEST(ForeignFormats, RefuseMissingColumns) {
  const std::string text = "time_s,angle_deg\n" + Rows("{t},{v}");
  EXPECT_EQ(
      WrongFlag(text, TimeAndValue("", "angle")),
      "run.csv:1:1: --value_column is \"angle\", which is none of the 2 columns \"time_s\", \"angle_deg\"; give a "
      "name, or a number from 1 on");
  for (const char* const number : {"0", "3", "1.5", "-1", "1e400"}) {
    EXPECT_THAT(WrongFlag(text, TimeAndValue(number, "")), HasSubstr("which is none of the 2 columns")) << number;
  }
  EXPECT_EQ(WrongFlag(text, TimeAndValue("2:s", "2")),
            "run.csv:1:8: column \"angle_deg\" cannot be both the time and the quantity; choose another with "
            "--value_column");
}

TEST(ForeignFormats, TakeTheUnitOfAFlagBeforeThatOfAName) {
  const std::string text = "time_s,angle_deg\n" + Rows("{t},{v}");
  const Recording recording = RecordingOf(text, TimeAndValue("time_s:ms", "", "rad"));
  EXPECT_EQ(recording.unit, "rad");
  EXPECT_NEAR(recording.time[1] - recording.time[0], (RecordingOf(text).time[1] - RecordingOf(text).time[0]) / 1000,
              1e-12);
  EXPECT_EQ(MessageText(recording.warnings.at(0)),
            "run.csv: column \"time_s\" names s, but --time_column says ms, which was used");
  EXPECT_EQ(MessageText(recording.warnings.at(1)),
            "run.csv: column \"angle_deg\" names deg, but --unit says rad, which was used");
}

TEST(ForeignFormats, RefuseFlagsThatContradictTheFile) {
  const std::string text = "time_s,angle_deg\n" + Rows("{t},{v}");
  EXPECT_EQ(
      WrongFlag(text, Unit("volts")),
      "run.csv:1:8: column \"angle_deg\" is in deg, so --unit volts contradicts it; leave the flag out, or choose "
      "another column with --value_column");
  EXPECT_EQ(WrongFlag(text, Unit("brad")),
            "run.csv:1:8: --unit is \"brad\"; it must be rad, deg, mrad, rev, gon, rad_s, deg_s, rpm, rev_s, counts, "
            "volts, mv, m_s2, g, mg, px, m, cm or mm");
  EXPECT_EQ(
      WrongFlag(text, Unit("", 50)),
      "run.csv:1:1: column \"time_s\" holds the times, so --sample_rate_hz 50 contradicts it; leave the flag out, "
      "or add --time_column none to ignore the column");
  ReadOptions both = Unit("", 50);
  both.time_column = "time_s";
  EXPECT_THAT(WrongFlag(text, both), HasSubstr("--time_column and --sample_rate_hz both define the times"));
  EXPECT_THAT(WrongFlag(text, TimeAndValue("none", "")), HasSubstr("there are no times; give --sample_rate_hz"));
}

TEST(ForeignFormats, RefuseANameWithTwoUnits) {
  EXPECT_EQ(FaultOf("time_s,angle_deg [rad]\n" + Rows("{t},{v}")),
            "run.csv:1:8: column \"angle_deg [rad]\" names two units, deg and rad; keep the unit of its values");
  EXPECT_THAT(FaultOf("time_s,angle_deg\n" + Rows("{t},{v} deg")),
              HasSubstr("holds \"100 deg\", a number followed by \" deg\""));
}

// ---- Files without header, without times -------------------------------------------------------------------------

TEST(ForeignFormats, NameTheFlagsAFileWithoutHeaderNeeds) {
  const std::string three = Rows("{t},{v},1");
  const std::string several = "columns 2 and 3 could both be the quantity, and none of them shows a swing by itself";
  EXPECT_THAT(FaultOf(three), HasSubstr(several));
  EXPECT_THAT(FaultOf(three, TimeAndValue("1:ms", "")), HasSubstr(several));
  EXPECT_THAT(
      FaultOf(three, TimeAndValue("1:ms", "2")),
      HasSubstr("column 2 does not give its unit, and its name does not say whether it is an angle, a voltage or "
                "a length: give it with --unit"));
  const Recording recording = RecordingOf(three, TimeAndValue("", "2", "deg"));
  ExpectTheRows(recording, kDegree);
  EXPECT_EQ(MessageText(recording.warnings.at(0)),
            "run.csv: column 1 increases and was assumed to be the time; --time_column chooses another");
  ExpectTheRows(RecordingOf(three, TimeAndValue("1:ms", "2", "deg")), kDegree);
}

TEST(ForeignFormats, TheColumnThatIsNotTheTimeIsTheValue) {
  ExpectTheRows(RecordingOf(Rows("{t},{v}"), TimeAndValue("1:ms", "", "deg")), kDegree);
  ExpectTheRows(RecordingOf(Rows("{t} {v}"), TimeAndValue("1:ms", "", "deg")), kDegree);
  ExpectTheRows(RecordingOf(Rows("{t},0;{v},0"), TimeAndValue("1:ms", "", "deg")), kDegree);
}

TEST(ForeignFormats, TheOnlyColumnIsTheValue) {
  ExpectTheRows(RecordingOf(Rows("{v}"), Unit("deg", 100)), kDegree);
  ExpectTheRows(RecordingOf("angle_deg\n" + Rows("{v}"), Unit("", 100)), kDegree);
  ExpectTheRows(RecordingOf("Angle of the rod (deg)\n" + Rows("{v}"), Unit("", 100)), kDegree);
  ExpectTheRows(RecordingOf("reading\n" + Rows("{v}"), Unit("deg", 100)), kDegree);
}

TEST(ForeignFormats, TheFilesSampleRateReplacesMissingTimes) {
  ExpectTheRows(RecordingOf("# sample_rate_hz: 100\nangle_deg\n" + Rows("{v}")), kDegree);
  ExpectTheRows(RecordingOf("# sample_rate_hz: 7\nangle_deg\n" + Rows("{v}"), Unit("", 100)), kDegree);
  ExpectTheRows(RecordingOf("# sample_rate_hz: 7\ntime_ms,angle_deg\n" + Rows("{t},{v}")), kDegree);
}

TEST(ForeignFormats, ASampleRateReplacesUnwantedTimes) {
  ReadOptions options = Unit("", 100);
  options.time_column = "none";
  ExpectTheRows(RecordingOf("time_s,angle_deg\n" + Rows("0,{v}"), options), kDegree);
}

TEST(ForeignFormats, WarnOfLostSamplesIfTimesComeFromTheSampleRate) {
  const Recording counted = RecordingOf("# sample_rate_hz: 100\n# lost_samples: 3\nangle_deg\n" + Rows("{v}"));
  ASSERT_EQ(counted.warnings.size(), 1);
  EXPECT_EQ(counted.warnings[0].code, "lost_samples");
  EXPECT_THAT(MessageText(counted.warnings[0]), HasSubstr("that 3 samples were lost"));
  EXPECT_TRUE(RecordingOf("# sample_rate_hz: 9\n# lost_samples: 0\nangle_deg\n" + Rows("{v}")).warnings.empty());
}

// ---- Counts, volts and calibrations ------------------------------------------------------------------------------

Calibration Line(const std::string& input = "counts") {
  return ParseCalibration(R"({"angle_unit": "deg", "coefficients": [-49.6077, 0.1985], "input_range": [0, 1023], )"
                          R"("input": ")" +
                              input + "\"}",
                          "cal.json")
      .value();
}

ReadOptions Calibrated(const std::string& input = "counts") {
  ReadOptions options;
  options.calibration = Line(input);
  return options;
}

TEST(ForeignFormats, CountsAndVoltsStayUncalibrated) {
  for (const std::string name : {"adc_counts", "counts", "pot_volts", "volts"}) {
    const Recording recording = RecordingOf("# range: 0,1023\ntime_ms," + name + "\n" + Rows("{t},{v}"));
    ExpectTheRows(recording);
    const bool is_counts = name.ends_with("counts");
    EXPECT_EQ(recording.unit, is_counts ? "counts" : "volts");
    EXPECT_EQ(recording.quantity, Quantity::kAngle);
    EXPECT_FALSE(recording.is_calibrated());
    EXPECT_EQ(recording.resolution, is_counts ? 1 : 0);
    EXPECT_EQ(recording.range->high, 1023);
  }
}

TEST(ForeignFormats, ACalibrationConvertsCountsToAngles) {
  const Recording recording = RecordingOf("time_ms,adc_counts\n" + Rows("{t},{v}"), Calibrated());
  EXPECT_TRUE(recording.is_calibrated());
  EXPECT_EQ(recording.unit, "counts");
  EXPECT_DOUBLE_EQ(recording.value[0], (19.85 - 49.6077) * kDegree);  // 0.1985 x - 49.6077 at 100
  EXPECT_DOUBLE_EQ(recording.resolution, 0.1985 * kDegree);
  EXPECT_DOUBLE_EQ(recording.range->low, -49.6077 * kDegree);
  EXPECT_DOUBLE_EQ(recording.range->high, 153.4578 * kDegree);  // 0.1985 * 1023 - 49.6077
  EXPECT_EQ(recording.calibration->source, Line().source);
}

TEST(ForeignFormats, TheFileGivesResolutionAndRangeInItsUnit) {
  const std::string text = "# resolution: 4\n# range: 10,200\ntime_ms,adc_counts\n" + Rows("{t},{v}");
  const Recording recording = RecordingOf(text, Calibrated());
  EXPECT_DOUBLE_EQ(recording.resolution, 4 * 0.1985 * kDegree);
  EXPECT_DOUBLE_EQ(recording.range->low, (1.985 - 49.6077) * kDegree);
  EXPECT_EQ(RecordingOf("time_ms,adc_counts\n" + Rows("{t},{v}.5"), Calibrated()).resolution, 0);
}

TEST(ForeignFormats, AFallingCalibrationHasARangeThatIncreases) {
  ReadOptions options = Calibrated();
  options.calibration->coefficients = {90, -0.5};
  const Recording recording = RecordingOf("time_ms,adc_counts\n" + Rows("{t},{v}"), options);
  EXPECT_DOUBLE_EQ(recording.range->low, (90 - 511.5) * kDegree);
  EXPECT_DOUBLE_EQ(recording.range->high, 90 * kDegree);
  EXPECT_DOUBLE_EQ(recording.resolution, 0.5 * kDegree);
}

TEST(ForeignFormats, TheResolutionOfACurveIsComputedInTheMiddleOfTheReadings) {
  ReadOptions options = Calibrated();
  options.calibration->coefficients = {0, 1, 0.01};
  const Recording recording = RecordingOf("time_ms,adc_counts\n" + Rows("{t},{v}"), options);
  EXPECT_DOUBLE_EQ(recording.resolution, (1 + 0.02 * 103.5) * kDegree);
}

const std::string kInline =
    "# calibration: {\"input\": \"counts\", \"angle_unit\": \"rad\", \"coefficients\": [0, 2]}\n";

TEST(ForeignFormats, TheUsersCalibrationOverridesTheFiles) {
  const std::string text = kInline + "time_ms,adc_counts\n" + Rows("{t},{v}");
  EXPECT_EQ(RecordingOf(text).value[0], 200);
  EXPECT_DOUBLE_EQ(RecordingOf(text, Calibrated()).value[0], (19.85 - 49.6077) * kDegree);
}

TEST(ForeignFormats, RefuseACalibrationOfAnotherSensor) {
  EXPECT_EQ(FaultOf("time_ms,adc_counts\n" + Rows("{t},{v}"), Calibrated("volts")),
            "run.csv:1:1: column \"adc_counts\" is in counts, but the calibration is for volts; give the calibration "
            "of this sensor");
  EXPECT_EQ(FaultOf("time_ms,angle_deg\n" + Rows("{t},{v}"), Calibrated()),
            "run.csv:1:1: column \"angle_deg\" is in deg, but the calibration is for counts; leave --calibration out");
  EXPECT_THAT(FaultOf(kInline + "time_ms,pot_volts\n" + Rows("{t},{v}")), HasSubstr("the calibration is for counts"));
}

TEST(ForeignFormats, DoNotApplyTheFilesCalibrationToAnAngle) {
  const Recording recording = RecordingOf(kInline + "time_ms,angle_rad\n" + Rows("{t},{v}"));
  ExpectTheRows(recording);
  ASSERT_EQ(recording.warnings.size(), 1);
  EXPECT_EQ(recording.warnings[0].code, "metadata_not_applied");
  EXPECT_EQ(MessageText(recording.warnings[0]),
            "run.csv:1: the metadata calibration is not applied to column \"angle_rad\", which is in rad already");
}

TEST(ForeignFormats, RefuseAnInvalidInlineCalibration) {
  EXPECT_THAT(FaultOf("\n# calibration: {\"input\": \"px\"}\ntime_ms,adc_counts\n" + Rows("{t},{v}")),
              StartsWith("run.csv:2: # calibration: \"angle_unit\" is missing"));
}

TEST(ForeignFormats, AddsTheUncertaintyOfCoarseStampsToTheClockScale) {
  std::string rows;
  for (int i = 0; i < 901; ++i) {  // 30 Hz for 30 s: the rate is uncertain by 0.1115 % each way, see clock_test.cc.
    rows += NumberText(std::round(i / 3.0) / 10, 6) + "," + NumberText(std::sin(i), 6) + "\n";
  }
  const double std_dev = (1.0 / 896 + 1.0 / 898) / 2 / std::sqrt(3.0);
  EXPECT_NEAR(RecordingOf(std::string("time_s,angle_rad\n") + rows).clock_scale_std_dev, std_dev, 1e-3 * std_dev);
  const Recording stated =
      RecordingOf("# clock_scale: 1.01\n# clock_scale_std_dev: 1e-3\n" + std::string("time_s,angle_rad\n") + rows);
  EXPECT_NEAR(stated.clock_scale_std_dev, std::hypot(1e-3, 1.01 * std_dev), 1e-6);
}

}  // namespace
}  // namespace pendulum::foreign_formats_test
