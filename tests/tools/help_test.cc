// SPDX-License-Identifier: Apache-2.0
#include "tools/help.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/request/run_flags.h"

namespace pendulum::help_test {
namespace {

const std::vector<FlagInfo> kFlags = {{"json", "Result."},
                                      {"data", "Recording."},
                                      {"new_flag", "Something new."},
                                      {"help", "Print this text.", "bool"},
                                      {"v", "A library's.", "string", false}};

TEST(HelpText, ShowsTheOwnFlagsUnderTheirHeadings) {
  EXPECT_EQ(HelpText("Fits.\n\n  fit run.csv\n\nExit codes: 0 done.\n\n", kFlags),
            "Fits.\n\n  fit run.csv\n"
            "\nInput:\n  --data      Recording.\n"
            "\nOutput:\n  --json      Result.\n"
            "\nAbout:\n  --help      Print this text.\n"
            "\nOther:\n  --new_flag  Something new.\n"
            "\nExit codes: 0 done.\n");
}

TEST(FullHelpText, AddsTheFlagsOfLibraries) {
  EXPECT_THAT(FullHelpText("Fits.\n", kFlags), testing::HasSubstr("\nFlags of libraries:\n  --v  A library's.\n"));
}

TEST(HelpGroup, IsGivenForEachFlagOfAFit) {
  for (const RunFlag& flag : RunFlagTable()) EXPECT_NE(HelpGroup(flag.name), "Other") << flag.name;
  for (const std::string name : {"bob_mass", "rod_length", "g", "stiffness"}) EXPECT_EQ(HelpGroup(name), "Rig");
}

}  // namespace
}  // namespace pendulum::help_test
