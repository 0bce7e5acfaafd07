// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/adc_plan_text.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::adc_plan_text_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// Expected values: 270 deg / 1024 = 0.2637 deg; 3.3 V are 0.66 of 5 V, and 270 (0.66 - 0.5) = 43.2 deg.
TEST(AdcPlanText, ListsReferencesAndNamesThoseThatSaturate) {
  const std::vector<AdcSensor> sensors = {
      {.reference_voltage = 5}, {.reference_voltage = 3.3}, {.reference_voltage = 1.1}};
  EXPECT_EQ(AdcPlanText(sensors),
            R"([[Sensor]]
    Potentiometer of 270 deg across 5 V, read by 10 bits; angles in deg from the
    middle of the travel.
    reference [V]  deg per count  counts per deg   usable [deg]  about the middle [deg]     counts
                5         0.2637           3.793    -135 to 135                   ± 135  0 to 1023
              3.3          0.174           5.746   -135 to 43.2                  ± 43.2  0 to 1023
              1.1        0.05801           17.24  -135 to -75.6                    none  0 to 1023
    With a reference of 3.3 V, below the 5 V that the potentiometer gives, all
    angles above 43.2 deg read 1023. --divider 0.66 would keep the voltage of
    the whole travel below the reference, at 0.2637 deg per count.
    With a reference of 1.1 V, below the 5 V that the potentiometer gives, all
    angles above -75.6 deg read 1023, the middle of the travel among them.
    --divider 0.22 would keep the voltage of the whole travel below the
    reference, at 0.2637 deg per count.
)");
}

TEST(AdcPlanText, NamesTheExistingDivider) {
  const std::vector<AdcSensor> sensors = {{.bits = 12, .reference_voltage = 3.3, .divider = 0.5}};
  EXPECT_THAT(AdcPlanText(sensors), AllOf(HasSubstr("across 5 V, divided by 2, read by 12 bits"),
                                          HasSubstr("0 to 3103"), Not(HasSubstr("With a reference"))));
}

TEST(AdcPlanText, IsEmptyWithoutSensors) { EXPECT_EQ(AdcPlanText({}), ""); }

}  // namespace
}  // namespace pendulum::adc_plan_text_test
