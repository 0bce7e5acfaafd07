// SPDX-License-Identifier: Apache-2.0
#include "tools/refit_pendulums_options.h"

#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::refit_pendulums_options_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Valid flags of a refit.
RefitFlags GoodFlags() {
  RefitFlags flags;
  flags.manifest = "runs.csv";
  flags.store = "results.sqlite";
  flags.given = {"manifest", "store"};
  return flags;
}

/// The flags of a command.
RefitFlags CommandFlags(const std::vector<std::string>& positional, const std::vector<std::string>& given) {
  RefitFlags flags;
  flags.positional = positional;
  flags.given = given;
  flags.store = "results.sqlite";
  flags.out = "table.csv";
  flags.shard_dir = "out";
  flags.shard_count = 3;
  return flags;
}

std::string Refusal(const RefitFlags& flags) {
  const auto options = MakeRefitPendulumsOptions(flags);
  if (options) return "";
  EXPECT_EQ(options.error().code, StatusCode::kInvalidArgument);
  return options.error().message();
}

TEST(MakeRefitPendulumsOptions, RefitsWithoutACommand) {
  RefitFlags flags = GoodFlags();
  flags.model = "viscous,coulomb";
  flags.threads = "3";
  flags.force = true;
  const auto options = MakeRefitPendulumsOptions(flags);
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_EQ(options->command, RefitCommand::kRefit);
  EXPECT_EQ(options->manifest, "runs.csv");
  EXPECT_THAT(options->stores, ElementsAre("results.sqlite"));
  EXPECT_THAT(options->refit.run.models, ElementsAre("viscous", "coulomb"));
  EXPECT_EQ(options->refit.threads, 3);
  EXPECT_EQ(options->refit.flags, R"({"model":"viscous,coulomb"})");
  EXPECT_TRUE(options->refit.force);
  EXPECT_FALSE(options->refit.shard);
}

TEST(MakeRefitPendulumsOptions, AcceptsAShard) {
  RefitFlags flags = GoodFlags();
  flags.shard = "3/64";
  flags.scratch = "/tmp";
  flags.checkpoint_s = 5;
  const auto options = MakeRefitPendulumsOptions(flags);
  ASSERT_TRUE(options) << options.error().message();
  ASSERT_TRUE(options->refit.shard);
  EXPECT_EQ(options->refit.shard->index, 3);
  EXPECT_EQ(options->refit.shard->count, 64);
  EXPECT_EQ(options->shard.store, "results.sqlite");
  EXPECT_EQ(options->shard.scratch, "/tmp");
  EXPECT_EQ(options->shard.checkpoint, 5);
}

TEST(MakeRefitPendulumsOptions, RefusesInvalidShards) {
  for (const char* shard : {"3", "3/3", "-1/3", "a/3", "1/0", "1/3x", "/3", "0/2000000000"}) {
    RefitFlags flags = GoodFlags();
    flags.shard = shard;
    EXPECT_EQ(Refusal(flags), "--shard is '" + std::string(shard) + "'; it must be k/N, shard k from 0 to N - 1 of N");
  }
}

TEST(MakeRefitPendulumsOptions, NamesTheWrongFlagOfARefit) {
  const std::vector<std::pair<std::string, std::function<void(RefitFlags&)>>> wrong = {
      {"no store was given", [](RefitFlags& f) { f.store.clear(); }},
      {"no runs were given", [](RefitFlags& f) { f.manifest.clear(); }},
      {"--manifest and --data both name runs", [](RefitFlags& f) { f.data = "runs"; }},
      {"--release all makes several results", [](RefitFlags& f) { f.release = "all"; }},
      {"--model: there is no model 'tar'", [](RefitFlags& f) { f.model = "tar"; }},
      {"--out is not a flag of a refit", [](RefitFlags& f) { f.given.emplace_back("out"); }},
      {"--scratch is for a shard", [](RefitFlags& f) { f.given.emplace_back("scratch"); }},
      {"--checkpoint_s is for a shard", [](RefitFlags& f) { f.given.emplace_back("checkpoint_s"); }},
      {"'no-folder-*/*.csv' is a pattern and no existing file; give patterns with --data",
       [](RefitFlags& f) { f.positional = {"no-folder-*/*.csv"}; }},
      {"'refit' is not a command, nor an existing file or folder; the commands are status, export",
       [](RefitFlags& f) { f.positional = {"refit"}; }},
      {"it must be a positive number of seconds",
       [](RefitFlags& f) {
         f.shard = "0/2";
         f.checkpoint_s = 0;
       }},
      {"has an empty name between its commas",
       [](RefitFlags& f) {
         f.manifest.clear();
         f.data = "a,,b";
       }},
  };
  for (const auto& [words, change] : wrong) {
    RefitFlags flags = GoodFlags();
    change(flags);
    EXPECT_THAT(Refusal(flags), HasSubstr(words));
  }
}

TEST(MakeRefitPendulumsOptions, TakesRunsWithoutAFlag) {
  RefitFlags flags = GoodFlags();
  flags.positional = {"CMakeLists.txt"};  // any existing file
  EXPECT_THAT(Refusal(flags), HasSubstr("--manifest and 'CMakeLists.txt' both name runs"));
  flags.manifest.clear();
  EXPECT_EQ(MakeRefitPendulumsOptions(flags)->manifest, "CMakeLists.txt");
  flags.positional = {"datasets"};
  EXPECT_THAT(MakeRefitPendulumsOptions(flags)->patterns, ElementsAre("datasets"));
  flags.positional = {"a.csv", "b,c.csv"};
  EXPECT_THAT(MakeRefitPendulumsOptions(flags)->patterns, ElementsAre("a.csv", "b,c.csv"));
  RefitFlags pack = CommandFlags({"pack", "runs.csv"}, {"out"});
  EXPECT_EQ(MakeRefitPendulumsOptions(pack)->manifest, "runs.csv");
}

TEST(MakeRefitPendulumsOptions, AcceptsTheCommands) {
  const std::vector<std::pair<RefitFlags, RefitCommand>> commands = {
      {CommandFlags({"status"}, {"store"}), RefitCommand::kStatus},
      {CommandFlags({"export"}, {"store", "out"}), RefitCommand::kExport},
      {CommandFlags({"compare", "a", "b"}, {}), RefitCommand::kCompare},
      {CommandFlags({"report"}, {"store", "out", "group_by"}), RefitCommand::kReport},
      {CommandFlags({"missing"}, {"shard_dir", "shard_count"}), RefitCommand::kMissing},
      {CommandFlags({"merge"}, {"shard_dir", "shard_count", "store"}), RefitCommand::kMerge},
  };
  for (const auto& [flags, command] : commands) {
    const auto options = MakeRefitPendulumsOptions(flags);
    ASSERT_TRUE(options) << options.error().message();
    EXPECT_EQ(options->command, command);
  }
}

TEST(MakeRefitPendulumsOptions, ComparesTwoStores) {
  const auto options = MakeRefitPendulumsOptions(CommandFlags({"compare", "a", "b"}, {}));
  ASSERT_TRUE(options);
  EXPECT_THAT(options->stores, ElementsAre("a", "b"));
  EXPECT_THAT(Refusal(CommandFlags({"compare", "a"}, {})), HasSubstr("compare takes two stores"));
  EXPECT_THAT(Refusal(CommandFlags({"compare", "a", "b", "c"}, {})),
              HasSubstr("'c' does not belong to a flag of compare"));
}

TEST(MakeRefitPendulumsOptions, RefusesFlagsOfOtherCommands) {
  EXPECT_EQ(Refusal(CommandFlags({"export"}, {"store"})), "export needs --out");
  EXPECT_EQ(Refusal(CommandFlags({"status"}, {"store", "force"})), "--force is not a flag of status; leave it out");
  EXPECT_EQ(Refusal(CommandFlags({"status", "x"}, {"store"})), "'x' does not belong to a flag of status");
  RefitFlags flags = CommandFlags({"missing"}, {"shard_dir", "shard_count"});
  flags.shard_count = 0;
  EXPECT_EQ(Refusal(flags), "--shard_count is 0; it must be at least 1");
}

}  // namespace
}  // namespace pendulum::refit_pendulums_options_test
