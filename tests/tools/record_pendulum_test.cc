// SPDX-License-Identifier: Apache-2.0
#include "tools/record_pendulum.h"

#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pendulum/acquisition/port.h"
#include "pendulum/base/status.h"
#include "tests/acquisition/scripted_logger.h"

namespace pendulum::record_pendulum_test {
namespace {

/// Runs the tool in a new process, because it registers its flags once in a process.
class RecordPendulumTest : public testing::Test {
 protected:
  RecordPendulumTest() { testing::FLAGS_gtest_death_test_style = "threadsafe"; }

  [[noreturn]] static void Exit(const OpenPort& open, std::vector<std::string> words) {
    words.insert(words.begin(), "record_pendulum");
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    std::exit(RecordPendulum(open, static_cast<int>(arguments.size()), arguments.data()));
  }
};

TEST_F(RecordPendulumTest, RecordsFromThePortThatIsOpened) {
  const auto open = [](const std::string& path, unsigned baud) -> Result<std::unique_ptr<Port>> {
    if (path != "any name" || baud != 500000) return Error(StatusCode::kInternal, "another port");
    return std::make_unique<ScriptedLogger>(LoggerScript());
  };
  EXPECT_EXIT(Exit(open, {"--port", "any name", "--baud", "500000", "--out", "-", "--seconds", "3"}),
              testing::ExitedWithCode(0), "600 at 200 Hz, 3 s; none lost");
}

TEST_F(RecordPendulumTest, ReportsAPortThatCannotBeOpened) {
  const auto open = [](const std::string& path, unsigned) -> Result<std::unique_ptr<Port>> {
    return Error(StatusCode::kNotFound, "there is no " + path);
  };
  EXPECT_EXIT(Exit(open, {"--port", "/dev/none", "--info"}), testing::ExitedWithCode(3),
              "record_pendulum: there is no /dev/none");
}

}  // namespace
}  // namespace pendulum::record_pendulum_test
