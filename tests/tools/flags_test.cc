// SPDX-License-Identifier: Apache-2.0
#include "tools/flags.h"

#include <gflags/gflags.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

DEFINE_string(shape, "round", "Shape of the bob.");
DEFINE_double(width, 1, "Width, m.");

namespace pendulum::flags_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class FlagsTest : public testing::Test {
 protected:
  static Result<ParsedFlags> Parse(std::vector<std::string> arguments) {
    std::string program = "/usr/bin/weigh_pendulum";
    std::vector<char*> argv = {program.data()};
    for (std::string& argument : arguments) argv.push_back(argument.data());
    return ParseFlags(static_cast<int>(argv.size()), argv.data(), __FILE__, "Weighs.\n");
  }

 private:
  gflags::FlagSaver saver_;  // restores all flags after each test
};

TEST(IsOwnFlag, ComparesFoldersOfRelativeAndAbsolutePaths) {
  EXPECT_TRUE(IsOwnFlag("src/tools/b.h", "src/tools/a_main.cc"));
  EXPECT_TRUE(IsOwnFlag("../../src/tools/b.h", "/home/me/pendulum/src/tools/a_main.cc"));
  EXPECT_FALSE(IsOwnFlag("./src/logging.cc", "src/tools/a_main.cc"));
  EXPECT_FALSE(IsOwnFlag("gflags.cc", "src/tools/a_main.cc"));
}

TEST_F(FlagsTest, SetsFlagsAndLeavesOtherArguments) {
  const auto parsed = Parse({"--shape=flat", "--width", "-0.5", "bob"});
  ASSERT_TRUE(parsed);
  EXPECT_EQ(FLAGS_shape, "flat");
  EXPECT_EQ(FLAGS_width, -0.5);
  EXPECT_EQ(parsed->answer, "");
  EXPECT_THAT(parsed->positional, ElementsAre("bob"));
}

TEST_F(FlagsTest, RefusesBadFlagsWithoutSettingAnything) {
  const auto parsed = Parse({"--width=2", "--shap=flat"});
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().code, StatusCode::kInvalidArgument);
  EXPECT_EQ(parsed.error().message(), "--shap is not a flag of this tool; did you mean --shape?");
  EXPECT_EQ(FLAGS_width, 1);
}

TEST_F(FlagsTest, AnswersHelpWithTheToolsFlags) {
  const auto parsed = Parse({"--help"});
  ASSERT_TRUE(parsed);
  EXPECT_THAT(parsed->answer, HasSubstr("\nOther:\n  --shape       Shape of the bob.\n  --width       Width, m.\n"));
  EXPECT_THAT(parsed->answer, HasSubstr("  --version     Print the version.\n"));
  EXPECT_THAT(parsed->answer, Not(HasSubstr("flagfile")));
}

TEST_F(FlagsTest, AnswersVersion) {
  const auto parsed = Parse({"--version"});
  ASSERT_TRUE(parsed);
  EXPECT_THAT(parsed->answer, testing::MatchesRegex("weigh_pendulum [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

// Only gflags itself detects errors in a file of flags.
TEST_F(FlagsTest, ExitsWithTwoWhenGflagsRefuses) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(Parse({"--flagfile=/nonexistent/flags"}), testing::ExitedWithCode(2), "");
}

}  // namespace
}  // namespace pendulum::flags_test
