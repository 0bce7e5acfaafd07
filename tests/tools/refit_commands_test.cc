// SPDX-License-Identifier: Apache-2.0
#include "tools/refit_commands.h"

#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "pendulum/batch/store_lock.h"

namespace pendulum::refit_commands_test {
namespace {

namespace fs = std::filesystem;

using testing::HasSubstr;
using testing::internal::CaptureStderr;
using testing::internal::CaptureStdout;
using testing::internal::GetCapturedStderr;
using testing::internal::GetCapturedStdout;

/// A batch of one existing and one missing recording.
class RefitCommandsTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "runs.csv") << "path,id\n"
                                        << fs::absolute("datasets/runs_1.csv").string() << ",one\n"
                                        << "missing.csv,two\n";
  }
  void TearDown() override { fs::remove_all(folder_); }

  RefitPendulumsOptions Options(RefitCommand command) const {
    RefitPendulumsOptions options;
    options.command = command;
    options.manifest = folder_ / "runs.csv";
    options.stores = {folder_ / "a.sqlite"};
    options.refit.run.models = {"coulomb"};
    return options;
  }

  /// Runs the command and returns its exit code, or the exit code of its error; stores the output.
  int Run(const RefitPendulumsOptions& options) {
    CaptureStderr();
    CaptureStdout();
    const auto code = RunRefitCommand(options);
    stdout_text_ = GetCapturedStdout();
    stderr_text_ = GetCapturedStderr();
    if (!code) stderr_text_ += code.error().message();
    return code ? *code : ExitCode(code.error().code);
  }

  const fs::path folder_ = testing::TempDir() + "refit_commands_test_" + std::to_string(getpid());
  std::string stdout_text_, stderr_text_;
};

TEST_F(RefitCommandsTest, ExitsWithThreeWhenARecordingIsMissing) {
  EXPECT_EQ(Run(Options(RefitCommand::kRefit)), 3);
  EXPECT_THAT(stderr_text_, HasSubstr("2 runs tried, 0 were current; 1 could not be fitted; the recording, rig or "
                                      "calibration of 1 run is missing\n"));
  EXPECT_THAT(stdout_text_, HasSubstr("    1 of 2 recordings fitted; 1 "));
  RefitPendulumsOptions details = Options(RefitCommand::kStatus);
  details.details = true;
  EXPECT_EQ(Run(details), 0);
  EXPECT_THAT(stdout_text_, HasSubstr("in the store                    2\n"));
  EXPECT_THAT(stdout_text_, HasSubstr("    coulomb     2          1              0                 0       1\n"));
  EXPECT_THAT(stdout_text_, HasSubstr("    1 of 2 recordings fitted; 1 "));
}

TEST_F(RefitCommandsTest, ExitsWithThreeWhenNoRunHasAResult) {
  std::ofstream(folder_ / "bad.csv") << "no recording\n";
  std::ofstream(folder_ / "runs.csv") << "path\nbad.csv\n";
  EXPECT_EQ(Run(Options(RefitCommand::kRefit)), 3);
  EXPECT_THAT(stderr_text_,
              HasSubstr("1 run tried, 0 were current; 1 could not be fitted; no run has a current result\n"));
  EXPECT_THAT(stdout_text_, HasSubstr("    0 of 1 recording fitted; 1 refused."));
  EXPECT_EQ(Run(Options(RefitCommand::kStatus)), 0);
}

TEST_F(RefitCommandsTest, ExitsWithZeroWhenARecordingIsRefused) {
  std::ofstream(folder_ / "bad.csv") << "no recording\n";
  std::ofstream(folder_ / "runs.csv") << "path\nbad.csv\n" << fs::absolute("datasets/runs_1.csv").string() << "\n";
  EXPECT_EQ(Run(Options(RefitCommand::kRefit)), 0);
  EXPECT_THAT(stderr_text_, HasSubstr("2 runs tried, 0 were current; 1 could not be fitted\n"));
}

TEST_F(RefitCommandsTest, ExitsWithThreeWhenARigIsMissing) {
  const std::string recording = fs::absolute("datasets/runs_1.csv").string();
  std::ofstream(folder_ / "runs.csv") << "path,id,rig\n" << recording << ",one,\n" << recording << ",two,no.json\n";
  EXPECT_EQ(Run(Options(RefitCommand::kRefit)), 3);
  EXPECT_THAT(stderr_text_, HasSubstr("; the recording, rig or calibration of 1 run is missing\n"));
  EXPECT_THAT(stdout_text_, HasSubstr("1 of 2 recordings fitted; 1 with a missing rig or calibration."));
}

TEST_F(RefitCommandsTest, ExitsWithThreeWhenAResultStaysBecauseAFitTakesTooLong) {
  ASSERT_EQ(Run(Options(RefitCommand::kRefit)), 3);
  RefitPendulumsOptions slow = Options(RefitCommand::kRefit);
  slow.refit.run.fit.interval = IntervalMethod::kBootstrap;
  slow.refit.fit_time = std::chrono::milliseconds(1);
  for (const bool is_tried : {true, false}) {
    EXPECT_EQ(Run(slow), 3);
    EXPECT_THAT(stderr_text_, HasSubstr(is_tried ? "2 runs tried, 0 were current" : "0 runs tried, 1 was current"));
    EXPECT_THAT(stderr_text_, HasSubstr("; 1 keeps a former result (--replace_by_failures replaces it)"));
    EXPECT_THAT(stdout_text_, HasSubstr("0 of 2 recordings fitted; 1 missing, 1 with a former result only."));
    EXPECT_THAT(stdout_text_, HasSubstr("the fit took longer than 0.001 s"));
  }
}

TEST_F(RefitCommandsTest, PrunesWhatItSaid) {
  RefitPendulumsOptions options = Options(RefitCommand::kRefit), prune = Options(RefitCommand::kPrune);
  EXPECT_EQ(Run(prune), 3);  // there is no store
  EXPECT_FALSE(fs::exists(folder_ / "a.sqlite"));
  options.refit.run.models = {"viscous", "coulomb"};
  ASSERT_EQ(Run(options), 3);
  ASSERT_EQ(Run(Options(RefitCommand::kRefit)), 3);
  prune.dry_run = true;
  for (int again = 0; again < 2; ++again) {
    EXPECT_EQ(Run(prune), 0);
    EXPECT_EQ(stdout_text_,
              "[[Would be removed]]\n    1 fit of a model that the last refit did not ask for: viscous\n");
  }
  prune.dry_run = false;
  EXPECT_EQ(Run(prune), 0);
  EXPECT_THAT(stdout_text_, HasSubstr("[[Removed]]\n    1 fit of a model"));
  EXPECT_EQ(Run(prune), 0);
  EXPECT_EQ(stdout_text_, "Nothing to remove.\n");
}

TEST_F(RefitCommandsTest, RefusesAWrongCommonRigBeforeAnyFit) {
  RefitPendulumsOptions options = Options(RefitCommand::kRefit);
  options.rig = folder_ / "rig.json";
  EXPECT_EQ(Run(options), 3);
  std::ofstream(options.rig) << "{}";
  EXPECT_EQ(Run(options), 4);
  EXPECT_THAT(stderr_text_, HasSubstr("rig.json"));
  EXPECT_FALSE(fs::exists(folder_ / "a.sqlite"));
}

TEST_F(RefitCommandsTest, RefusesAnUnknownColumnBeforeAnyFit) {
  RefitPendulumsOptions options = Options(RefitCommand::kRefit);
  options.summary.group_by = "nonsense";
  EXPECT_EQ(Run(options), 2);
  EXPECT_THAT(stderr_text_, HasSubstr("--group_by: the manifest has no column 'nonsense'"));
  EXPECT_EQ(Run(Options(RefitCommand::kStatus)), 0);
  EXPECT_THAT(stderr_text_ + stdout_text_, HasSubstr("in the store                    0\n"));
}

TEST_F(RefitCommandsTest, ExportsInTheFormatOfTheFileName) {
  ASSERT_EQ(Run(Options(RefitCommand::kRefit)), 3);
  RefitPendulumsOptions options = Options(RefitCommand::kExport);
  options.out = "-";
  EXPECT_EQ(Run(options), 0);
  EXPECT_THAT(stdout_text_, HasSubstr("id,path,rig,calibration,model,recommended,stale,status,"));
  options.out = folder_ / "a.jsonl";
  EXPECT_EQ(Run(options), 0);
  std::string line;
  std::getline(std::ifstream(options.out) >> std::ws, line);
  EXPECT_THAT(line, HasSubstr(R"({"id":"one","manifest":{)"));
  options.out = folder_ / "a.txt";
  EXPECT_EQ(Run(options), 2);
}

TEST_F(RefitCommandsTest, ExportsIntoANamedPipe) {
  ASSERT_EQ(Run(Options(RefitCommand::kRefit)), 3);
  RefitPendulumsOptions options = Options(RefitCommand::kExport);
  options.out = folder_ / "pipe.csv";
  ASSERT_EQ(::mkfifo(options.out.c_str(), 0600), 0);
  std::ostringstream text;
  std::thread reader([&] { text << std::ifstream(options.out).rdbuf(); });
  EXPECT_EQ(Run(options), 0) << stderr_text_;
  reader.join();
  EXPECT_THAT(text.str(), HasSubstr("id,path,rig"));
  EXPECT_TRUE(fs::is_fifo(options.out));
}

TEST_F(RefitCommandsTest, ReportsChangesByExitCode) {
  ASSERT_EQ(Run(Options(RefitCommand::kRefit)), 3);
  RefitPendulumsOptions other = Options(RefitCommand::kRefit);
  other.stores = {folder_ / "b.sqlite"};
  other.refit.run.fit.fixed["coulomb"] = 0;  // viscous friction takes over the torque of coulomb
  ASSERT_EQ(Run(other), 3);
  RefitPendulumsOptions compare = Options(RefitCommand::kCompare);
  compare.stores = {folder_ / "a.sqlite", folder_ / "a.sqlite"};
  EXPECT_EQ(Run(compare), 0);
  compare.stores[1] = folder_ / "b.sqlite";
  EXPECT_EQ(Run(compare), 1);
}

TEST_F(RefitCommandsTest, ListsMissingShardsAndMergesThem) {
  RefitPendulumsOptions options = Options(RefitCommand::kRefit);
  options.refit.shard = Shard{1, 2};
  fs::create_directories(folder_ / "out");
  options.stores = {folder_ / "out/shard-1.sqlite"};
  options.shard.store = options.stores[0];
  EXPECT_EQ(Run(options), 0);
  RefitPendulumsOptions shards = Options(RefitCommand::kMissing);
  shards.shard_dir = folder_ / "out";
  shards.shard_count = 2;
  EXPECT_EQ(Run(shards), 0);
  EXPECT_EQ(stdout_text_, "0\n");
  shards.command = RefitCommand::kMerge;
  EXPECT_EQ(Run(shards), 3);
  EXPECT_THAT(stderr_text_, HasSubstr("of 2 shards these are missing: 0"));
}

TEST_F(RefitCommandsTest, MergesCompleteShards) {
  for (const std::int64_t k : {0, 1}) {
    RefitPendulumsOptions options = Options(RefitCommand::kRefit);
    options.refit.shard = Shard{k, 2};
    options.shard.store = ShardPath(folder_, k);
    options.stores = {options.shard.store};
    ASSERT_EQ(Run(options), 0) << stderr_text_;
  }
  RefitPendulumsOptions merge = Options(RefitCommand::kMerge);
  merge.shard_dir = folder_;
  merge.shard_count = 2;
  EXPECT_EQ(Run(merge), 3);
  EXPECT_THAT(stderr_text_, HasSubstr("2 runs of 2 shards merged into " + merge.stores[0]));
  EXPECT_EQ(Run(Options(RefitCommand::kRefit)), 3);
  EXPECT_THAT(stderr_text_, HasSubstr("0 runs tried, 2 were current"));
  merge.command = RefitCommand::kMissing;
  EXPECT_EQ(Run(merge), 0);
  EXPECT_EQ(stdout_text_, "");
}

TEST_F(RefitCommandsTest, ReportsInTheFormatOfTheFileName) {
  RefitPendulumsOptions options = Options(RefitCommand::kReport);
  options.out = folder_ / "summary.json";
  EXPECT_EQ(Run(options), 3);  // the store does not exist
  EXPECT_THAT(stderr_text_, HasSubstr("a.sqlite: there is no such store"));
  ASSERT_EQ(Run(Options(RefitCommand::kRefit)), 3);
  EXPECT_EQ(Run(options), 0) << stderr_text_;
  std::ifstream file(options.out);
  const auto json = nlohmann::json::parse(file);
  EXPECT_EQ(json["store"]["runs"], 2);
  options.out = folder_ / "summary.html";
  EXPECT_EQ(Run(options), 0) << stderr_text_;
  std::string line;
  std::getline(std::ifstream(options.out) >> std::ws, line);
  EXPECT_THAT(line, HasSubstr("<!"));
  options.out = folder_ / "summary.pdf";
  EXPECT_EQ(Run(options), 2);
  EXPECT_THAT(stderr_text_, HasSubstr("the name must end with .html for a page"));
  options.out = folder_ / "summary.html";
  options.summary.group_by = "room";
  EXPECT_EQ(Run(options), 2);
  EXPECT_THAT(stderr_text_, HasSubstr("--group_by: the manifest has no column 'room'"));
  options.out = options.stores[0];
  EXPECT_EQ(Run(options), 2);  // the output is the store itself
}

TEST_F(RefitCommandsTest, RefitsNothingFromAPackOfTheSameRuns) {
  RefitPendulumsOptions pack = Options(RefitCommand::kPack);
  pack.out = folder_ / "runs.pack";
  ASSERT_EQ(Run(pack), 0) << stderr_text_;
  ASSERT_EQ(Run(Options(RefitCommand::kRefit)), 3);
  RefitPendulumsOptions packed = Options(RefitCommand::kRefit);
  packed.manifest = pack.out;
  EXPECT_EQ(Run(packed), 3);
  EXPECT_THAT(stderr_text_, HasSubstr("0 runs tried, 2 were current"));
  pack.out = pack.manifest;
  EXPECT_EQ(Run(pack), 2);
}

TEST_F(RefitCommandsTest, NeverOverwritesARecordingWithAPack) {
  fs::copy("datasets/runs_1.csv", folder_ / "one.csv");
  RefitPendulumsOptions pack = Options(RefitCommand::kPack);
  pack.manifest.clear();
  pack.patterns = {folder_};
  pack.out = folder_ / "one.csv";
  EXPECT_EQ(Run(pack), 2);
  EXPECT_EQ(fs::file_size(folder_ / "one.csv"), fs::file_size("datasets/runs_1.csv"));
}

TEST_F(RefitCommandsTest, DoesNotRefitAStoreInUse) {
  const auto lock = StoreLock::Take(folder_ / "a.sqlite");
  ASSERT_TRUE(lock);
  EXPECT_EQ(Run(Options(RefitCommand::kRefit)), 75);
  EXPECT_THAT(stderr_text_, HasSubstr("another process writes to this file"));
}

/// Refits twice; the second time after a signal, which only the child process gets.
int RefitAfter(int signal, const RefitPendulumsOptions& options) {
  if (!RunRefitCommand(options)) return -1;
  std::raise(signal);
  RefitPendulumsOptions forced = options;
  forced.refit.force = true;
  return RunRefitCommand(forced).value_or(-1);
}

TEST_F(RefitCommandsTest, ReportsASignalByExitCodeAndRemainingRuns) {
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 75}}) {
    EXPECT_EXIT(std::exit(RefitAfter(signal, Options(RefitCommand::kRefit))), testing::ExitedWithCode(code),
                "2 are left; run the same command to continue");
  }
}

}  // namespace
}  // namespace pendulum::refit_commands_test
