// SPDX-License-Identifier: Apache-2.0
#include "tools/shell_command.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace pendulum::shell_command_test {
namespace {

using Words = std::vector<std::string>;

TEST(ShellCommand, QuotesSpecialCharacters) {
  EXPECT_EQ(ShellCommand(Words{"fit_pendulum", "my run.csv", "--unit", "deg", "", "it's"}),
            "fit_pendulum 'my run.csv' --unit deg '' 'it'\\''s'");
}

TEST(CommandToTry, AddsFlags) {
  EXPECT_EQ(CommandToTry(Words{"fit_pendulum", "run.csv"}, Words{"--time_column 1:ms", "--unit deg"}),
            "fit_pendulum run.csv --time_column 1:ms --unit deg");
  EXPECT_EQ(CommandToTry(Words{"bin/fit_pendulum", "--json=a b.json", "run.csv"},
                         Words{"--value_column Linear Acceleration y (m/s^2)"}),
            "bin/fit_pendulum '--json=a b.json' run.csv --value_column 'Linear Acceleration y (m/s^2)'");
}

TEST(CommandToTry, ReplacesTheSameFlags) {
  EXPECT_EQ(CommandToTry(Words{"f", "--unit", "mm", "-value-column=2", "run.csv", "--closed_form_only"},
                         Words{"--unit deg", "--value_column 3", "--closed_form_only"}),
            "f run.csv --unit deg --value_column 3 --closed_form_only");
  EXPECT_EQ(CommandToTry(Words{"f", "--models", "all", "run.csv"}, Words{"--model viscous"}),
            "f run.csv --model viscous");
}

TEST(CommandToTry, GivesTheDataAFlag) {
  EXPECT_EQ(CommandToTry(Words{"f", "*/*.csv", "--model", "all"}, Words{"--data */*.csv"}),
            "f --model all --data '*/*.csv'");
}

TEST(CommandToTry, PutsFlagsBeforeTheEndOfFlags) {
  EXPECT_EQ(CommandToTry(Words{"f", "--", "-run.csv"}, Words{"--unit deg"}), "f --unit deg -- -run.csv");
}

}  // namespace
}  // namespace pendulum::shell_command_test
