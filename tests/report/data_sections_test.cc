// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/data_sections.h"

#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/report/section_text.h"
#include "tests/identify/example_joint_identification.h"

namespace pendulum::data_sections_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> Titles(const Sections& sections) {
  std::vector<std::string> titles;
  for (const Section& section : sections) titles.push_back(FullTitle(section));
  return titles;
}

/// The section with this title, as text.
std::string TextOf(const Identification& report, const std::string& title) {
  for (const Section& section : DataSections(report)) {
    if (FullTitle(section) == title) return ToText(Sections{section});
  }
  return "";
}

TEST(DataSections, HaveATableOnlyForSeveralRecordings) {
  EXPECT_THAT(Titles(DataSections(ExampleIdentification())), ElementsAre("Data", "Sampling", "Rig"));
  EXPECT_THAT(Titles(DataSections(ExampleJointIdentification())),
              ElementsAre("Recordings", "Data: recording 1", "Sampling: recording 1", "Data: recording 2",
                          "Sampling: recording 2", "Rig"));
}

TEST(DataSections, ShowTheRigWithItsUnits) {
  EXPECT_EQ(TextOf(ExampleIdentification(), "Rig"), R"([[Rig]]
    name             value ± std dev  unit    std dev
    gravity_torque   1.800 ± 0.010    N m     stated
    inertia         0.0760 ± 0.0005   kg m^2  stated
)");
}

TEST(DataSections, SayWhatTheWindowLeavesOut) {
  Identification report = ExampleIdentification();
  EXPECT_THAT(TextOf(report, "Data"), testing::Not(HasSubstr("left out")));
  report.recordings.front().data.left_out = LeftOut{12, 47, true, 1.8};
  EXPECT_THAT(TextOf(report, "Data"), HasSubstr("left out    12 of 47 half swings, also the largest: the"));
}

// 0.25 rad = 14.3 deg, 0.125 rad = 7.16 deg.
TEST(DataSections, NumberTheRecordings) {
  EXPECT_EQ(TextOf(ExampleJointIdentification(), "Recordings"), R"([[Recordings]]
       file
    1  run.csv
    2  b c.csv
            samples  window            rate [Hz]  starts     amplitude [deg]
    1  1801 of 2000  1.5 s to 19.5 s         100  held                  14.3
    2   901 of 2000  10.5 s to 19.5 s        100  in motion             7.16
    Amplitudes are root mean squares over the motion.
)");
}

TEST(DataSections, DistinguishReleasesOfOneFile) {
  Identification report = ExampleJointIdentification();
  report.recordings[1].data.path = "run.csv";
  report.recordings[1].data.release = 2;
  EXPECT_THAT(TextOf(report, "Recordings"), HasSubstr("    1  run.csv, swing 1\n    2  run.csv, swing 2\n"));
}

TEST(DataSections, ShowADashForARecordingWithoutAFile) {
  Identification report = ExampleJointIdentification();
  report.recordings[0].data.path.clear();
  EXPECT_THAT(TextOf(report, "Recordings"), HasSubstr("    1  -\n    2  b c.csv\n"));
}

// The amplitude of a recording whose separate fit failed.
TEST(DataSections, ShowADashForAnUnknownAmplitude) {
  Identification report = ExampleJointIdentification();
  report.across[0].amplitudes[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(TextOf(report, "Recordings"), testing::ContainsRegex("    1 .* held +-\n"));
}

}  // namespace
}  // namespace pendulum::data_sections_test
