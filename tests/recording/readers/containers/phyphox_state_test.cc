// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/phyphox_state.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recording/rows.h"

namespace pendulum::phyphox_state_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string State(const std::string& containers, const std::string& sets) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?><phyphox version=\"1.14\" locale=\"en\"><title>Pendulum</title>"
         "<data-containers>" +
         containers + "</data-containers><views><view label=\"Raw\"><value label=\"x\"/></view></views>" +
         (sets.empty() ? "" : "<export>" + sets + "</export>") + "</phyphox>";
}

std::string Container(const std::string& name, const std::string& numbers) {
  return "<container size=\"0\" init=\"" + numbers + "\">\n  " + name + "\n</container>";
}

const std::string kTime = Container("gyr_time", "0.0E+00,1.0E-02,2.0E-02,3.0E-02,4.0E-02,5.0E-02,6.0E-02,7.0E-02");
const std::string kRate = Container("gyrZ", "1.00E+02,101,102,103,104,105,106,107");
const std::string kSet =
    "<set name=\"Raw Data\"><data name=\"Time (s)\">gyr_time</data>"
    "<data name=\"Rotation z (rad/s)\">gyrZ</data></set>";

TEST(ReadPhyphoxState, ReadsTheExportedColumns) {
  const Recording recording = RecordingOf(State(kTime + kRate + Container("count", "8"), kSet));
  ExpectTheRows(recording);
  EXPECT_EQ(recording.quantity, Quantity::kRate);
}

TEST(ReadPhyphoxState, LeavesMissingNumbersEmpty) {
  const std::string rate = Container("gyrZ", "100,NaN, 102");
  const Workbook workbook = ReadPhyphoxState(State(kTime + rate, kSet), 10'000);
  ASSERT_EQ(workbook.sheets.size(), 1);
  EXPECT_EQ(workbook.sheets[0].name, "Raw Data");
  EXPECT_THAT(workbook.sheets[0].text, StartsWith("Time (s);Rotation z (rad/s)\n0;100\n0.01;\n0.02;102\n0.03;\n"));
}

TEST(ReadPhyphoxState, ChoosesAmongItsSets) {
  const std::string light =
      "<set name=\"Light\"><data name=\"Time (s)\">gyr_time</data>"
      "<data name=\"Illuminance (lx)\">gyrZ</data></set>";
  ExpectTheRows(RecordingOf(State(kTime + kRate, light + kSet)));
}

TEST(ReadPhyphoxState, ReadsItsBuffersWithoutExport) {
  ExpectTheRows(RecordingOf(State(kTime + kRate, ""), TimeAndValue("gyr_time:s", "gyrZ", "rad_s")));
}

TEST(ReadPhyphoxState, NamesAnExperimentWithoutRecording) {
  for (const std::string numbers : {"", "0"}) {
    EXPECT_THAT(FaultOf(State(Container("gyr_time", numbers) + Container("gyrZ", numbers), kSet)),
                StartsWith("run.csv: this is a phyphox experiment without a recording; run it in phyphox"));
  }
  EXPECT_THAT(FaultOf(State(kTime, kSet).substr(0, 300)),
              StartsWith("run.csv: this saved state of phyphox is damaged (line "));
}

}  // namespace
}  // namespace pendulum::phyphox_state_test
