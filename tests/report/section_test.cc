// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/section.h"

#include <gtest/gtest.h>

namespace pendulum::section_test {
namespace {

TEST(FullTitle, NamesTheLawAndTheRecording) {
  Section section{"Constancy"};
  EXPECT_EQ(FullTitle(section), "Constancy");
  section.recording = 2;
  EXPECT_EQ(FullTitle(section), "Constancy: recording 2");
  section.law = "drag";
  EXPECT_EQ(FullTitle(section), "Constancy of drag: recording 2");
}

}  // namespace
}  // namespace pendulum::section_test
