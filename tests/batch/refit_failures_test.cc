// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/batch/refit.h"
#include "pendulum/identify/identify.h"
#include "pendulum/report/json.h"
#include "tests/batch/refit_folder.h"
#include "tests/batch/small_batch.h"
#include "tests/batch/store_rows.h"

namespace pendulum::refit_failures_test {
namespace {

using refit_folder::RefitTest;
using refit_folder::ResultAlone;
using small_batch::OptionsWith;
using small_batch::RecordingText;
using small_batch::RefitInto;
using small_batch::WriteBatch;
using store_rows::AllRows;
using store_rows::Rows;
using store_rows::Value;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

namespace fs = std::filesystem;

// ---- Runs that cannot be fitted ------------------------------------------------------------------------------------

TEST_F(RefitTest, AFailedRunAffectsOnlyItsOwnRows) {
  WriteBatch(folder_, 1);
  fs::create_directory(folder_ / "folder.csv");
  folder_.Write("bad.csv", "time_s,angle_rad\n0,nonsense\n");
  folder_.Write("empty.csv", "");
  folder_.Write("still.csv", [] {
    std::string text = "time_s,angle_rad\n";
    for (int i = 0; i < 200; ++i) text += std::to_string(0.01 * i) + ",0.1\n";
    return text;
  }());
  folder_.Write("rig.json", R"({"gravity_torque": -1})");
  folder_.Write("calibration.json", "{");
  folder_.Write("runs.csv",
                "path,id,rig,calibration\n0.csv,good,,\nnowhere.csv,missing,,\nfolder.csv,folder,,\nbad.csv,bad,,\n"
                "empty.csv,empty,,\nstill.csv,still,,\n0.csv,rig,rig.json,\n0.csv,no_rig,nowhere.json,\n"
                "0.csv,calibration,,calibration.json\n");
  const RefitCounts counts = RefitAll(OptionsWith({"viscous", "coulomb"}));
  EXPECT_EQ(counts.runs, 9);
  EXPECT_EQ(counts.refitted, 9);
  EXPECT_EQ(counts.unfitted, 8);
  EXPECT_EQ(ValueOf("SELECT exit_code FROM runs WHERE id = 'good'"), "0");
  EXPECT_EQ(FailureOf("missing"), "3 nowhere.csv: there is no such file; check the path");
  EXPECT_THAT(FailureOf("folder"), AllOf(StartsWith("4 folder.csv: "), HasSubstr("directory")));
  EXPECT_THAT(FailureOf("bad"), StartsWith("4 bad.csv:2:"));
  EXPECT_THAT(FailureOf("empty"), StartsWith("5 empty.csv:1:"));
  EXPECT_THAT(FailureOf("still"), StartsWith("5 still.csv: "));
  EXPECT_THAT(FailureOf("rig"), AllOf(StartsWith("4 rig.json: "), HasSubstr("gravity_torque")));
  EXPECT_EQ(FailureOf("no_rig"), "3 nowhere.json: there is no such file; check the path");
  EXPECT_THAT(FailureOf("calibration"), StartsWith("4 calibration.json:1:"));
  for (const char* model : {"viscous", "coulomb"}) {
    EXPECT_EQ(ValueOf(std::string("SELECT count(*) FROM fits JOIN runs USING(run) WHERE status = 'failed' AND "
                                  "fits.reason = runs.reason AND model = '") +
                      model + "'"),
              "8");
  }
  EXPECT_EQ(ValueOf("SELECT count(*) FROM runs WHERE result IS NULL"), "8");
  EXPECT_EQ(ValueOf("SELECT count(*) FROM quantities JOIN runs USING(run) WHERE id <> 'good'"), "0");
}

TEST_F(RefitTest, NamesAWrongCommonRig) {
  WriteBatch(folder_, 1);
  RefitOptions options = coulomb_;
  options.rig = "{";
  RefitAll(options);
  EXPECT_THAT(FailureOf("a"), StartsWith("4 --rig:"));
}

TEST_F(RefitTest, FitsAFileThatAppearsLater) {
  WriteBatch(folder_, 2);
  fs::rename(folder_ / "1.csv", folder_ / "later.csv");
  EXPECT_EQ(RefitAll(coulomb_).unfitted, 1);
  const RefitCounts still = RefitAll(coulomb_);
  EXPECT_EQ(still.current, 2);
  EXPECT_EQ(still.unfitted, 1);
  fs::rename(folder_ / "later.csv", folder_ / "1.csv");
  EXPECT_THAT(Refitted(coulomb_), ElementsAre("b"));
  EXPECT_EQ(ValueOf("SELECT status FROM fits JOIN runs USING(run) WHERE id = 'b'"), "converged");
  EXPECT_EQ(ValueOf("SELECT reason FROM runs WHERE id = 'b'"), "NULL");
}

TEST_F(RefitTest, DetectsAMissingFile) {
  WriteBatch(folder_, 2);
  RefitAll(coulomb_);
  fs::remove(folder_ / "0.csv");
  RefitOptions replace = coulomb_;
  replace.replace_by_failures = true;
  EXPECT_THAT(Refitted(replace), ElementsAre("a"));
  EXPECT_EQ(FailureOf("a"), "3 0.csv: there is no such file; check the path");
  EXPECT_EQ(ValueOf("SELECT count(*) FROM quantities JOIN runs USING(run) WHERE id = 'a'"), "0");
}

// A run without a rig and a run with an unreadable rig must have different provenance.
TEST_F(RefitTest, DetectsAMissingNamedRig) {
  WriteBatch(folder_, 1);
  RefitAll(coulomb_);
  folder_.Write("runs.csv", "path,id,rig\n0.csv,a,nowhere.json\n");
  RefitOptions replace = coulomb_;
  replace.replace_by_failures = true;
  EXPECT_THAT(Refitted(replace), ElementsAre("a"));
  EXPECT_EQ(FailureOf("a"), "3 nowhere.json: there is no such file; check the path");
  folder_.Write("runs.csv", "path,id,rig\n0.csv,a,\n");
  EXPECT_THAT(Refitted(coulomb_), ElementsAre("a"));
  EXPECT_EQ(ValueOf("SELECT exit_code FROM runs"), "0");
}

TEST_F(RefitTest, UpdatesTheReasonOfAFailedRun) {
  folder_.Write("runs.csv", "path,id\nnowhere.csv,a\n");
  RefitAll(coulomb_);
  fs::create_directory(folder_ / "nowhere.csv");
  RefitAll(coulomb_);
  EXPECT_THAT(FailureOf("a"), HasSubstr("directory"));
}

// ---- Options in the manifest ---------------------------------------------------------------------------------------

TEST_F(RefitTest, UsesModelsAndWindowOfTheManifest) {
  WriteBatch(folder_, 1);
  folder_.Write("runs.csv", "path,id,models,from_s,to_s\n0.csv,a,,,\n0.csv,b,\"viscous,drag\",,\n0.csv,c,,1.5,5.5\n");
  RefitOptions options = coulomb_;
  options.run.swing.to = 7;
  RefitAll(options);
  const auto models = [&](const std::string& id) {
    return Rows(store_, "SELECT model FROM fits JOIN runs USING(run) WHERE id = '" + id + "' ORDER BY model");
  };
  EXPECT_THAT(models("a"), ElementsAre("coulomb"));
  EXPECT_THAT(models("b"), ElementsAre("drag", "viscous"));
  IdentifyOptions of_b = options.run;
  of_b.models = {"viscous", "drag"};
  of_b.fit.model = "viscous";
  EXPECT_EQ(ValueOf("SELECT result FROM runs WHERE id = 'b'"),
            ResultAlone(of_b, folder_ / "0.csv", std::nullopt, "0.csv"));
  IdentifyOptions of_c = options.run;
  of_c.swing.from = 1.5;
  of_c.swing.to = 5.5;
  EXPECT_EQ(ValueOf("SELECT result FROM runs WHERE id = 'c'"),
            ResultAlone(of_c, folder_ / "0.csv", std::nullopt, "0.csv"));
}

// ---- Stops, counts and errors --------------------------------------------------------------------------------------

TEST_F(RefitTest, ResumesAfterAStop) {
  WriteBatch(folder_, 6);
  folder_.Write("runs.csv", folder_.Read("runs.csv") + "nowhere.csv,z\n");
  RefitInto(folder_ / "whole.sqlite", folder_ / "runs.csv", coulomb_);
  std::atomic<bool> stop = false;
  RefitOptions stopped = coulomb_;
  stopped.stop = &stop;
  stopped.progress = [&](const RefitCounts& counts) { stop = counts.done() >= 4; };
  const RefitCounts first = RefitAll(stopped);
  EXPECT_TRUE(first.stopped);
  EXPECT_EQ(first.refitted, 4);
  EXPECT_EQ(ValueOf("SELECT count(*) FROM runs WHERE exit_code IS NULL"), "3");
  EXPECT_EQ(ValueOf("SELECT value FROM meta WHERE key = 'complete'"), "0");
  const RefitCounts second = RefitAll(coulomb_);
  EXPECT_FALSE(second.stopped);
  EXPECT_EQ(second.current, 4);
  EXPECT_EQ(second.refitted, 3);
  EXPECT_EQ(ValueOf("SELECT value FROM meta WHERE key = 'complete'"), "1");
  EXPECT_EQ(AllRows(store_), AllRows(folder_ / "whole.sqlite"));
}

TEST_F(RefitTest, StoresWhatIsDoneWhenStopped) {
  WriteBatch(folder_, 12);
  RefitInto(folder_ / "whole.sqlite", folder_ / "runs.csv", coulomb_);
  std::atomic<bool> stop = false;
  RefitOptions stopped = coulomb_;
  stopped.threads = 3;
  stopped.stop = &stop;
  stopped.progress = [&](const RefitCounts&) { stop = true; };
  const RefitCounts first = RefitAll(stopped);
  EXPECT_GE(first.refitted, 1);
  EXPECT_LE(first.refitted, 3);
  EXPECT_EQ(ValueOf("SELECT count(exit_code) FROM runs"), std::to_string(first.refitted));
  RefitAll(coulomb_);
  EXPECT_EQ(AllRows(store_), AllRows(folder_ / "whole.sqlite"));
}

TEST_F(RefitTest, DoesNothingOnceStopped) {
  WriteBatch(folder_, 2);
  const std::atomic<bool> stop = true;
  RefitOptions options = coulomb_;
  options.stop = &stop;
  const RefitCounts counts = RefitAll(options);
  EXPECT_TRUE(counts.stopped);
  EXPECT_EQ(counts.done(), 0);
  EXPECT_EQ(counts.runs, 2);
}

TEST_F(RefitTest, ReportsTheCountsAfterEachRun) {
  WriteBatch(folder_, 3);
  RefitAll(coulomb_);
  folder_.Write("runs.csv", folder_.Read("runs.csv") + "nowhere.csv,z\n");
  folder_.Write("1.csv", RecordingText(99));
  std::vector<std::string> seen;
  RefitOptions options = coulomb_;
  options.progress = [&](const RefitCounts& counts) {
    seen.push_back(std::to_string(counts.runs) + " " + std::to_string(counts.current) + " " +
                   std::to_string(counts.refitted) + " " + std::to_string(counts.unfitted));
  };
  RefitAll(options);
  EXPECT_THAT(seen, ElementsAre("4 1 0 0", "4 1 1 0", "4 2 1 0", "4 2 2 1"));
}

/// The source of a manifest whose files take `delay` to read.
Source Slow(const Source& source, std::chrono::milliseconds delay) {
  Source slow = source;
  slow.read = [source, delay](const std::string& path) {
    std::this_thread::sleep_for(delay);
    return source.read(path);
  };
  return slow;
}

TEST_F(RefitTest, ReturnsTheErrorOfTheCommitCallback) {
  WriteBatch(folder_, 4);
  const auto source = OpenSource(folder_ / "runs.csv");
  auto store = Store::Open(store_, Store::Mode::kWrite);
  ASSERT_TRUE(source && store);
  RefitOptions options = coulomb_;
  int commits = 0;
  options.committed = [&]() -> Result<void> {
    ++commits;
    return Error(StatusCode::kCannotWrite, "cannot write out: no space");
  };
  const auto counts = Refit(Slow(*source, std::chrono::milliseconds(1100)), *store, options);
  ASSERT_FALSE(counts);
  EXPECT_EQ(counts.error().code, StatusCode::kCannotWrite);
  EXPECT_EQ(counts.error().message(), "cannot write out: no space");
  EXPECT_EQ(commits, 1);
  EXPECT_EQ(ValueOf("SELECT count(exit_code) FROM runs"), "1");  // commits are at least a second apart
}

TEST_F(RefitTest, ReturnsTheErrorOfTheStore) {
  WriteBatch(folder_, 4);
  const auto source = OpenSource(folder_ / "runs.csv");
  auto store = Store::Open(store_, Store::Mode::kWrite);
  ASSERT_TRUE(source && store);
  Source breaking = *source;
  int read = 0;
  breaking.read = [&](const std::string& path) {
    if (++read == 2) store->database().exec("DROP TABLE quantities");
    return source->read(path);
  };
  const auto counts = Refit(breaking, *store, coulomb_);
  ASSERT_FALSE(counts);
  EXPECT_EQ(counts.error().code, StatusCode::kInternal);
  EXPECT_THAT(counts.error().message(), AllOf(StartsWith(store_.string()), HasSubstr("quantities")));
  EXPECT_EQ(read, 2);
}

TEST_F(RefitTest, ReturnsTheErrorOfTheManifest) {
  folder_.Write("runs.csv", "path,id\n0.csv,a\n1.csv,a\n");
  const auto source = OpenSource(folder_ / "runs.csv");
  auto store = Store::Open(store_, Store::Mode::kWrite);
  ASSERT_TRUE(source && store);
  const auto twice = Refit(*source, *store, coulomb_);
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(twice.error().message(), HasSubstr("runs.csv:3: the id \"a\" is also at"));
  folder_.Write("runs.csv", "path,id\n");
  const auto none = Refit(*source, *store, coulomb_);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(none.error().message(), HasSubstr("it names no recording"));
}

}  // namespace
}  // namespace pendulum::refit_failures_test
