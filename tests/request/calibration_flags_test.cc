// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/calibration_flags.h"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::calibration_flags_test {
namespace {

using testing::HasSubstr;

TEST(MakeCalibrationOptions, SetsTheFullScaleOfAConverter) {
  const auto options = MakeCalibrationOptions({.order = 2, .input_range = "", .bits = 10});
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_EQ(options->order, 2);
  EXPECT_TRUE(options->has_bits);
  EXPECT_EQ(options->input_range->low, 0);
  EXPECT_EQ(options->input_range->high, 1023);  // 2^10 - 1
}

TEST(MakeCalibrationOptions, NamesTheWrongFlag) {
  const std::vector<std::pair<CalibrationFlags, std::string>> refusals = {
      {{.order = 0, .input_range = "", .bits = 0}, "--order is 0; it must be 1 to 5"},
      {{.order = 6, .input_range = "", .bits = 0}, "--order is 6; it must be 1 to 5"},
      {{.order = 1, .input_range = "", .bits = 33}, "--bits is 33; it must be 1 to 32"},
      {{.order = 1, .input_range = "0,1023", .bits = 10}, "--bits and --input_range both define the sensor's range"},
      {{.order = 1, .input_range = "5,1", .bits = 0}, "--input_range is '5,1'; low must be less than high"},
  };
  for (const auto& [flags, message] : refusals) {
    const auto options = MakeCalibrationOptions(flags);
    ASSERT_FALSE(options) << message;
    EXPECT_EQ(options.error().code, StatusCode::kInvalidArgument) << message;
    EXPECT_THAT(options.error().message(), HasSubstr(message));
  }
}

TEST(CalibrateTable, RefusesARangeOfCountsForVolts) {
  const auto table = ParseCalibrationTable("volts,angle_deg\n1,-30\n2,0\n3,30\n", "table.csv");
  ASSERT_TRUE(table) << table.error().message();
  const auto fit = CalibrateTable(*table, *MakeCalibrationOptions({.order = 1, .input_range = "", .bits = 10}));
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().message(), "--bits defines the range of counts, but table.csv has volts; give --input_range");
  EXPECT_TRUE(CalibrateTable(*table, *MakeCalibrationOptions({})));
}

}  // namespace
}  // namespace pendulum::calibration_flags_test
