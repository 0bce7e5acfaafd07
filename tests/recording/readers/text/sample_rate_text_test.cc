// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/text/sample_rate_text.h"

#include <string>

#include <gtest/gtest.h>

#include "tests/recording/rows.h"

namespace pendulum::sample_rate_text_test {
namespace {

TEST(SampleRateIn, ReadsRatesAndIntervals) {
  for (const char* const line : {"fs: 50 Hz", " fs = 50", "Sample Rate (Hz),50", "Abtastrate: 0,05 kHz", "FPS: 50",
                                 "Frame rate;50", "sample_rate_hz: 50", "dt = 0.02 s", "dt: 0.02", "interval_ms: 20",
                                 "Sampling interval [ms]\t20", "Abtastintervall: 20 ms", "\"fs\": 50"}) {
    EXPECT_DOUBLE_EQ(csv::SampleRateIn(line), 50) << line;
  }
  for (const char* const line : {"fs", "fs: fast", "fs: 50 m", "fs: -50", "dt: 0", "rate: 50", "Date: 2024", ""}) {
    EXPECT_EQ(csv::SampleRateIn(line), 0) << line;
  }
}

TEST(SampleRateIn, IsUsedForRowsWithoutTimes) {
  for (const std::string above : {"# fs: 100 Hz\n", "Operator: Jane\nSample Rate (Hz),100\n", "# dt = 10 ms\n"}) {
    const Recording recording = RecordingOf(above + "angle_deg\n" + Rows("{v}"));
    ExpectTheRows(recording, kDegree);
    ASSERT_EQ(recording.warnings.size(), 1) << above;
    EXPECT_EQ(recording.warnings[0].code, "sample_rate_from_text");
  }
  ExpectTheRows(RecordingOf("# fs: 5 Hz\ntime_ms,angle_deg\n" + Rows("{t},{v}")), kDegree);
  // An oscilloscope's times, in columns whose names say nothing, count more than its line; a number of the row does
  // not.
  for (const std::string name : {"X", "Abscissa", "col1"}) {
    const Recording recording = RecordingOf("Sample Interval,0.2\n" + name + ",angle_deg\n" + Rows("0.0{t},{v}"));
    ExpectTheRows(recording, kDegree);
    EXPECT_EQ(recording.warnings.back().code, "rate_disagrees");
  }
  std::string numbered = "Sample Interval,0.01\nX,angle_deg\n";
  for (int i = 0; i < 8; ++i) numbered += std::to_string(i) + "," + std::to_string(100 + i) + "\n";
  ExpectTheRows(RecordingOf(numbered), kDegree);
  ExpectTheRows(RecordingOf("{\"fs\": 100, \"angle_rad\": [100, 101, 102, 103, 104, 105, 106, 107]}"));
}

}  // namespace
}  // namespace pendulum::sample_rate_text_test
