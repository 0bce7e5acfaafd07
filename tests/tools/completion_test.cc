// SPDX-License-Identifier: Apache-2.0
#include "tools/completion.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::completion_test {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::vector<FlagInfo> kFlags = {{"data", "Recording: [CSV]. It may be long.", "string", true, {}, true},
                                      {"model", "The 'model'; default viscous.", "string", true, {"viscous", "drag"}},
                                      {"from", "Start, s.", "string"},
                                      {"plan", "Plans.", "bool"},
                                      {"minloglevel", "A library's.", "string", false}};

std::string Script(const std::string& shell) { return CompletionScript(shell, "fit", kFlags).value_or("refused"); }

// tests/tools/completion_cli_test.py runs the scripts in the shells.
TEST(CompletionScript, HasTheFlagsOfTheTool) {
  EXPECT_THAT(Script("bash"), HasSubstr("--data --model --from --plan"));
  EXPECT_THAT(Script("zsh"), HasSubstr("'--data=[Recording]:data:_files'"));
  EXPECT_THAT(Script("zsh"), HasSubstr("'--model=[The model]:model:(viscous drag)'"));
  EXPECT_THAT(Script("zsh"), HasSubstr("'--plan[Plans]'"));
  EXPECT_THAT(Script("fish"), HasSubstr("complete -c fit -l model -x -a 'viscous drag' -d 'The model'\n"));
  EXPECT_THAT(Script("fish"), HasSubstr("complete -c fit -l plan -d 'Plans'\n"));
  for (const char* const shell : {"bash", "zsh", "fish"}) EXPECT_THAT(Script(shell), Not(HasSubstr("minloglevel")));
}

TEST(CompletionScript, RefusesOtherShells) {
  EXPECT_EQ(CompletionScript("tcsh", "fit", kFlags).error().message(),
            "--completion is 'tcsh'; it must be bash, zsh or fish");
}

}  // namespace
}  // namespace pendulum::completion_test
