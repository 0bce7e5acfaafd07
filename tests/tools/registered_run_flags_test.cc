// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <variant>

#include <gflags/gflags.h>
#include <gtest/gtest.h>

#include "tools/run_tool.h"

namespace pendulum::registered_run_flags_test {
namespace {

TEST(RegisterRunFlags, RegistersEachFlagOfTheTableOnce) {
  static RunFlags values, defaults;  // gflags keeps pointers to both
  RegisterRunFlags(values, defaults);
  for (const RunFlag& flag : RunFlagTable()) {
    gflags::CommandLineFlagInfo info;
    ASSERT_TRUE(gflags::GetCommandLineFlagInfo(flag.name.data(), &info)) << flag.name;
    EXPECT_EQ(info.type, flag.name == "closed_form_only" ? "bool" : "string");
    EXPECT_EQ(info.description, flag.help);
    RunFlags unset;
    const auto value = flag.In(unset);
    const auto* text = std::get_if<std::string*>(&value);
    EXPECT_EQ(info.default_value, text != nullptr ? **text : "false") << flag.name;
  }
  gflags::SetCommandLineOption("noise", "quantized");
  EXPECT_EQ(values.noise, "quantized");
  EXPECT_EQ(values.model, "");
}

}  // namespace
}  // namespace pendulum::registered_run_flags_test
