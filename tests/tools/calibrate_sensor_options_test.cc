// SPDX-License-Identifier: Apache-2.0
#include "tools/calibrate_sensor_options.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::calibrate_sensor_options_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

CalibrateSensorFlags TableFlags() {
  CalibrateSensorFlags flags;
  flags.data = "table.csv";
  return flags;
}

CalibrateSensorFlags PlanFlags() {
  CalibrateSensorFlags flags;
  flags.plan = true;
  return flags;
}

TEST(MakeCalibrateSensorOptions, CalibratesATable) {
  CalibrateSensorFlags flags = TableFlags();
  flags.order = 3;
  flags.input_range = "0,1023.5";
  flags.json = "cal.json";
  flags.plot = "cal.svg";
  const auto options = MakeCalibrateSensorOptions(flags);
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_EQ(options->data, "table.csv");
  EXPECT_EQ(options->order, 3);
  ASSERT_TRUE(options->input_range);
  EXPECT_EQ(options->input_range->low, 0);
  EXPECT_EQ(options->input_range->high, 1023.5);
  EXPECT_FALSE(options->has_bits);
  EXPECT_THAT(options->plan, IsEmpty());
  ASSERT_EQ(options->Outputs().size(), 2);
  EXPECT_EQ(options->Outputs()[0].flag, "--json");
  EXPECT_EQ(options->Outputs()[1].path, "cal.svg");
  ASSERT_EQ(options->Inputs().size(), 1);
  EXPECT_EQ(options->Inputs()[0].flag, "--data");
}

TEST(MakeCalibrateSensorOptions, OmitsOutputsThatAreNotRequested) {
  CalibrateSensorFlags flags = TableFlags();
  flags.data = "-";
  const auto options = MakeCalibrateSensorOptions(flags);
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_EQ(options->order, 1);
  EXPECT_FALSE(options->input_range);
  EXPECT_THAT(options->Outputs(), IsEmpty());
  EXPECT_THAT(options->Inputs(), IsEmpty());
}

TEST(MakeCalibrateSensorOptions, DerivesTheConverterRangeFromItsBits) {
  CalibrateSensorFlags flags = TableFlags();
  flags.bits = 12;
  const auto options = MakeCalibrateSensorOptions(flags);
  ASSERT_TRUE(options && options->input_range);
  EXPECT_TRUE(options->has_bits);
  EXPECT_EQ(options->input_range->low, 0);
  EXPECT_EQ(options->input_range->high, 4095);
}

TEST(MakeCalibrateSensorOptions, PlansASensorForEachReference) {
  CalibrateSensorFlags flags = PlanFlags();
  flags.reference_voltage = "5,3.3,1.1";
  flags.bits = 8;
  flags.supply_voltage = 4.5;
  flags.potentiometer_range_deg = 300;
  flags.divider = 0.5;
  const auto options = MakeCalibrateSensorOptions(flags);
  ASSERT_TRUE(options) << options.error().message();
  ASSERT_EQ(options->plan.size(), 3);
  EXPECT_EQ(options->plan[1].reference_voltage, 3.3);
  for (const AdcSensor& sensor : options->plan) {
    EXPECT_EQ(sensor.bits, 8);
    EXPECT_EQ(sensor.supply_voltage, 4.5);
    EXPECT_EQ(sensor.travel_deg, 300);
    EXPECT_EQ(sensor.divider, 0.5);
  }
}

TEST(MakeCalibrateSensorOptions, PlansTheUsualBoardByDefault) {
  const auto options = MakeCalibrateSensorOptions(PlanFlags());
  ASSERT_TRUE(options) << options.error().message();
  ASSERT_EQ(options->plan.size(), 1);
  EXPECT_EQ(options->plan[0].bits, 10);
  EXPECT_EQ(options->plan[0].reference_voltage, 5);
}

struct Refusal {
  std::string message;
  void (*spoil)(CalibrateSensorFlags&);
};

void ExpectRefusals(const CalibrateSensorFlags& good, const std::vector<Refusal>& refusals) {
  for (const Refusal& refusal : refusals) {
    CalibrateSensorFlags flags = good;
    refusal.spoil(flags);
    const auto options = MakeCalibrateSensorOptions(flags);
    ASSERT_FALSE(options) << refusal.message;
    EXPECT_EQ(options.error().code, StatusCode::kInvalidArgument);
    EXPECT_THAT(options.error().message(), HasSubstr(refusal.message));
  }
}

using Flags = CalibrateSensorFlags;

TEST(MakeCalibrateSensorOptions, RefusesWrongFlagsOfATable) {
  ExpectRefusals(TableFlags(),
                 {{"no table was given: a file with counts or volts and angles", [](Flags& f) { f.data.clear(); }},
                  {"--order is 0; it must be 1 to 5", [](Flags& f) { f.order = 0; }},
                  {"--order is 6", [](Flags& f) { f.order = 6; }},
                  {"--input_range is '5'; it must be low,high", [](Flags& f) { f.input_range = "5"; }},
                  {"--input_range is '1,2,3'; it must be", [](Flags& f) { f.input_range = "1,2,3"; }},
                  {"--input_range is '1,2,'; it must be", [](Flags& f) { f.input_range = "1,2,"; }},
                  {"--input_range is 'x'; it must be two numbers", [](Flags& f) { f.input_range = "0,x"; }},
                  {"--input_range is 'nan'; it must be", [](Flags& f) { f.input_range = "nan,1"; }},
                  {"--input_range is '9,1'; low must be less than high", [](Flags& f) { f.input_range = "9,1"; }},
                  {"--bits is 33; it must be 1 to 32", [](Flags& f) { f.bits = 33; }},
                  {"--bits is -1; it must be 1 to 32", [](Flags& f) { f.bits = -1; }},
                  {"--bits and --input_range both define", [](Flags& f) { f.bits = 10, f.input_range = "0,1"; }},
                  {"--reference_voltage belongs to a plan; add --plan", [](Flags& f) { f.reference_voltage = "5"; }},
                  {"--supply_voltage belongs to a plan", [](Flags& f) { f.supply_voltage = 3; }},
                  {"--potentiometer_range_deg belongs to a plan", [](Flags& f) { f.potentiometer_range_deg = 300; }},
                  {"--divider belongs to a plan", [](Flags& f) { f.divider = 0.5; }},
                  {"'stray' does not belong to a flag; give one table", [](Flags& f) { f.positional = {"stray"}; }}});
}

TEST(MakeCalibrateSensorOptions, TakesATableWithoutAFlag) {
  Flags flags;
  flags.positional = {"table.csv"};
  const auto options = MakeCalibrateSensorOptions(flags);
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_EQ(options->data, "table.csv");
  ExpectRefusals(flags, {{"'b.csv' does not belong to a flag", [](Flags& f) { f.positional.emplace_back("b.csv"); }},
                         {"'table.csv' does not belong to a flag", [](Flags& f) { f.plan = true; }}});
}

TEST(MakeCalibrateSensorOptions, RefusesWrongFlagsOfAPlan) {
  ExpectRefusals(
      PlanFlags(),
      {{"--data belongs to the calibration of a table; leave it or --plan out", [](Flags& f) { f.data = "-"; }},
       {"--order belongs to the calibration", [](Flags& f) { f.order = 2; }},
       {"--input_range belongs to", [](Flags& f) { f.input_range = "0,1"; }},
       {"--json belongs to", [](Flags& f) { f.json = "cal.json"; }},
       {"--plot belongs to", [](Flags& f) { f.plot = "cal.svg"; }},
       {"--bits is 40; it must be 1 to 32", [](Flags& f) { f.bits = 40; }},
       {"--reference_voltage is 'x'; it must be a number of volts", [](Flags& f) { f.reference_voltage = "5,x"; }},
       {"--reference_voltage is ''; it must be", [](Flags& f) { f.reference_voltage = "5,,3"; }},
       {"--reference_voltage is '5,', which ends with a comma", [](Flags& f) { f.reference_voltage = "5,"; }},
       {"--reference_voltage is 0; it must be positive", [](Flags& f) { f.reference_voltage = "5,0"; }},
       {"--supply_voltage is -5; it must be positive", [](Flags& f) { f.supply_voltage = -5; }},
       {"--potentiometer_range_deg is 0; it must be", [](Flags& f) { f.potentiometer_range_deg = 0; }},
       {"--divider is 2; it must be positive, 0.000001 to 1", [](Flags& f) { f.divider = 2; }}});
}

}  // namespace
}  // namespace pendulum::calibrate_sensor_options_test
