// SPDX-License-Identifier: Apache-2.0
#include "tools/refit_text.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace pendulum::refit_text_test {
namespace {

using testing::HasSubstr;
using testing::Not;

StoreComparison SomeMoved() {
  StoreComparison comparison;
  comparison.fits = 12;
  comparison.only_after = 2;
  comparison.identical = 30;
  comparison.moved = 1;
  comparison.most_moved = {{"run_7", "coulomb", "inertia", "kg m^2", 0.079, 0.0814, 24.5}};
  comparison.changed_status = 1;
  comparison.status_changes = {{"run_8", "drag", "converged", "failed"}};
  comparison.cpus_before = comparison.cpus_after = {"a processor"};
  return comparison;
}

TEST(ComparisonText, CountsAndNamesChangedParameters) {
  const std::string text = ComparisonText(SomeMoved(), "a.sqlite", "b.sqlite");
  EXPECT_THAT(text, HasSubstr("    in both                         12\n"));
  EXPECT_THAT(text, HasSubstr("    in b.sqlite only                2\n"));
  EXPECT_THAT(text, HasSubstr("    identical                       30\n"));
  EXPECT_THAT(text, HasSubstr("run_7  coulomb  inertia     0.079  0.0814  kg m^2    24.5\n"));
  EXPECT_THAT(text, HasSubstr("run_8  drag   converged  failed\n"));
  EXPECT_THAT(text, Not(HasSubstr("CPU")));
}

TEST(ComparisonText, NamesDifferingCpuTypes) {
  StoreComparison comparison = SomeMoved();
  comparison.cpus_after = {"another"};
  EXPECT_THAT(ComparisonText(comparison, "a", "b"),
              HasSubstr("[[Types of CPU]]\n    a: a processor\n    b: another\n"));
}

TEST(ComparisonText, ContainsNoTerminalControlCharacters) {
  StoreComparison comparison = SomeMoved();
  comparison.most_moved[0].id = "a\x1b[2Jb\nc";
  EXPECT_THAT(ComparisonText(comparison, "a", "b"), Not(HasSubstr("\x1b")));
}

/// A store of three runs: the first could not be fitted, and the last is pending.
Store StoreOfThree(const std::string& path) {
  auto store = Store::Open(path, Store::Mode::kWrite);
  const Source source = {"three",
                         [](const EntrySink& take) -> Result<void> {
                           for (std::int64_t k = 0; k < 3; ++k) {
                             ManifestEntry entry;
                             entry.position = k;
                             entry.id = entry.path = "run" + std::to_string(k) + ".csv";
                             if (auto taken = take(entry); !taken) return taken;
                           }
                           return {};
                         },
                         {}};
  EXPECT_TRUE(store->Begin(source, std::nullopt, "{}"));
  RunOutcome outcome;
  outcome.exit_code = 4;
  outcome.models = {"viscous", "coulomb"};
  outcome.reason = {"run0.csv:7", "a row\x1b[2J of 3 fields"};
  EXPECT_TRUE(store->Put("run0.csv", outcome));
  outcome.exit_code = 5;
  outcome.reason = {"run1.csv", "no swing"};
  EXPECT_TRUE(store->Put("run1.csv", outcome));
  EXPECT_TRUE(store->Commit());
  return *std::move(store);
}

TEST(StatusText, CountsRunsFitsAndReasons) {
  const std::string path = testing::TempDir() + "refit_text_test_" + std::to_string(getpid()) + ".sqlite";
  {
    Store store = StoreOfThree(path);
    const auto text = StatusText(store);
    ASSERT_TRUE(text) << text.error().message();
    EXPECT_THAT(*text, HasSubstr("    in the store                    3\n"));
    EXPECT_THAT(*text, HasSubstr("    not refitted yet                1\n"));
    EXPECT_THAT(*text, HasSubstr("    recording missing               0\n    refused                         2\n"));
    EXPECT_THAT(*text, HasSubstr("    viscous     2          0              0                 0       2\n"));
    EXPECT_THAT(*text, HasSubstr("    2 x failed: no swing (run1.csv)\n"));
    EXPECT_THAT(*text, HasSubstr(" of 3 fields (run0.csv)\n"));
    EXPECT_THAT(*text, Not(HasSubstr("\x1b")));
    EXPECT_THAT(*text, Not(HasSubstr("Recommended")));
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace pendulum::refit_text_test
