// SPDX-License-Identifier: Apache-2.0
#include "service/live_rows.h"

#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::live_rows_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Optional;

/// The result of reading lines of a recording.
struct Read {
  explicit Read(const std::vector<std::string>& lines) {
    for (const std::string& line : lines) {
      const auto point = rows.Read(line);
      if (!point) continue;
      times.push_back(point->time);
      values.push_back(point->value);
    }
  }

  LiveRows rows;
  std::vector<double> times, values;
};

std::string CalibrationLine(const std::string& unit, const std::string& input) {
  return "# calibration: {\"schema_version\":1,\"input\":\"" + input + "\",\"angle_unit\":\"" + unit +
         "\",\"coefficients\":[-20,1.5]}";
}

TEST(LiveRows, SkipsInvalidRows) {
  const Read read({"time_s,adc_counts",
                   "0,1",
                   "nan,2",
                   "0.1,",
                   "0.1",
                   ",3",
                   "0.1,inf",
                   "0.1,4x",
                   "",
                   "# 0.1,4",
                   "x,y",
                   "1e999,4",
                   "0,5",
                   "-1,5",
                   "0.2,6,7",
                   " 0.3 , 8 ",
                   std::string("0.4\0,9", 6),
                   "0.5,1e3\r",
                   "\xFF",
                   ","});
  EXPECT_THAT(read.times, ElementsAre(0, 0.2, 0.3, 0.5));
  EXPECT_THAT(read.values, ElementsAre(1, 6, 8, 1000));
}

TEST(LiveRows, StartsAtTheColumnNames) {
  LiveRows rows;
  EXPECT_FALSE(rows.Read("# range: 0,1023"));
  EXPECT_FALSE(rows.Read("\r"));
  EXPECT_FALSE(rows.has_begun());
  EXPECT_FALSE(rows.Read("time_s,adc_counts"));
  EXPECT_TRUE(rows.has_begun());
  EXPECT_TRUE(rows.Read("0,1"));
}

TEST(LiveRows, ReadsTheUnitFromTheColumn) {
  const auto unit = [](const std::string& names) { return Read({names}).rows.unit(); };
  EXPECT_EQ(unit("time_s,adc_counts"), "counts");
  EXPECT_EQ(unit("time_s,angle_deg"), "deg");
  EXPECT_EQ(unit("time_s, angle_rad ,quality"), "rad");
  EXPECT_EQ(unit("time_s,rate_rad_s"), "rad/s");
  EXPECT_EQ(unit("time_s,rate_deg_s\r"), "deg/s");
  EXPECT_EQ(unit("time_s,angle"), "");
  EXPECT_EQ(unit("time_s"), "");
}

TEST(LiveRows, ReadsTheSamplingRateFromTheFile) {
  const auto rate = [](const std::string& line) { return Read({line, "time_s,adc_counts"}).rows.rate(); };
  EXPECT_THAT(rate("# sample_rate_hz: 200"), Optional(200.0));
  EXPECT_THAT(rate("#sample_rate_hz:62.5\r"), Optional(62.5));
  for (const char* line : {"# sample_rate_hz: 0", "# sample_rate_hz: -1", "# sample_rate_hz: nan",
                           "# sample_rate_hz:", "# sample_rate_hz: 200 Hz", "# rate: 200", "#"}) {
    EXPECT_FALSE(rate(line)) << line;
  }
  EXPECT_FALSE(Read({"time_s,adc_counts", "# sample_rate_hz: 200"}).rows.rate());
}

// Expected values: the angle is 1.5 counts - 20, in degrees or radians; 130 rad = 130 * 180 / pi deg = 7448.4513 deg.
TEST(LiveRows, ShowsCalibratedCountsInDegrees) {
  const Read deg({CalibrationLine("deg", "counts"), "time_s,adc_counts", "0,100", "1,0"});
  EXPECT_EQ(deg.rows.unit(), "deg");
  EXPECT_THAT(deg.values, ElementsAre(testing::DoubleNear(130, 1e-9), testing::DoubleNear(-20, 1e-9)));
  const Read rad({CalibrationLine("rad", "counts"), "time_s,adc_counts", "0,100"});
  EXPECT_EQ(rad.rows.unit(), "deg");
  EXPECT_THAT(rad.values, ElementsAre(testing::DoubleNear(7448.4513, 1e-3)));
}

TEST(LiveRows, ShowsCountsWithAnInvalidCalibration) {
  for (const std::string& line : {CalibrationLine("deg", "volts"), CalibrationLine("grad", "counts"),
                                  std::string("# calibration: {\"input\":"), std::string("# calibration:")}) {
    const Read read({line, "time_s,adc_counts", "0,100"});
    EXPECT_EQ(read.rows.unit(), "counts") << line;
    EXPECT_THAT(read.values, ElementsAre(100)) << line;
  }
  EXPECT_THAT(Read({CalibrationLine("deg", "counts"), "time_s,adc_counts", "0,1.7e308"}).values, IsEmpty());
}

}  // namespace
}  // namespace pendulum::live_rows_test
