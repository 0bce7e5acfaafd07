// SPDX-License-Identifier: Apache-2.0
#include "tools/registered_run_flags.h"

#include <string>

#include <gflags/gflags.h>
#include <gtest/gtest.h>

namespace pendulum::registered_run_flags_test {
namespace {

TEST(RegisterRunFlags, MakesEachFlagOfTheTableKnownToGflagsOnce) {
  RegisterRunFlags();
  for (const RunFlag& flag : RunFlagTable()) {
    gflags::CommandLineFlagInfo info;
    ASSERT_TRUE(gflags::GetCommandLineFlagInfo(flag.name.data(), &info)) << flag.name;
    EXPECT_EQ(info.type, "string");
    EXPECT_EQ(info.description, flag.help);
    EXPECT_EQ(info.default_value, RunFlags().*flag.value);
  }
  gflags::SetCommandLineOption("noise", "quantized");
  EXPECT_EQ(RegisteredRunFlags().noise, "quantized");
  EXPECT_EQ(RegisteredRunFlags().model, "coulomb");
}

}  // namespace
}  // namespace pendulum::registered_run_flags_test
