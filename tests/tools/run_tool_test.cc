// SPDX-License-Identifier: Apache-2.0
#include "tools/run_tool.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::run_tool_test {
namespace {

using Work = std::function<Result<int>(const std::vector<std::string>&)>;

/// The exit code of a tool that does `work`, and its standard error.
std::pair<int, std::string> RunOf(const Work& work, std::vector<std::string> arguments = {}) {
  std::string program = "/somewhere/swing";
  std::vector<char*> argv = {program.data()};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  const auto count = static_cast<int>(argv.size());
  argv.push_back(nullptr);
  testing::internal::CaptureStderr();
  const int code = RunTool({"swing", __FILE__, "Usage.\n", work}, count, argv.data());
  return {code, testing::internal::GetCapturedStderr()};
}

TEST(RunTool, ReturnsTheExitCodeOfTheWork) {
  EXPECT_EQ(RunOf([](const auto&) { return 0; }), std::pair(0, std::string()));
  EXPECT_EQ(RunOf([](const auto&) { return 1; }), std::pair(1, std::string()));
}

TEST(RunTool, PrintsAnErrorAndExitsWithItsCode) {
  const auto missing = [](const auto&) -> Result<int> { return Error(StatusCode::kNotFound, "no such file"); };
  EXPECT_EQ(RunOf(missing), std::pair(3, std::string("swing: no such file\n")));
}

TEST(RunTool, TreatsAnExceptionAsABug) {
  const auto broken = [](const auto&) -> Result<int> { throw std::runtime_error("out of bounds"); };
  EXPECT_EQ(RunOf(broken), std::pair(70, std::string("swing: internal error: out of bounds\n")));
}

TEST(RunTool, PassesArgumentsAndRefusesUnknownFlags) {
  std::vector<std::string> seen;
  const auto work = [&](const std::vector<std::string>& positional) {
    seen = positional;
    return 0;
  };
  EXPECT_EQ(RunOf(work, {"run.csv"}).first, 0);
  EXPECT_THAT(seen, testing::ElementsAre("run.csv"));
  EXPECT_EQ(RunOf(work, {"--nonsense", "1"}).first, 2);
}

}  // namespace
}  // namespace pendulum::run_tool_test
