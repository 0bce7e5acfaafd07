// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/refit.h"

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
#include <nlohmann/json.hpp>

#include "pendulum/batch/summary.h"
#include "pendulum/identify/identify.h"
#include "pendulum/report/json.h"
#include "tests/batch/refit_folder.h"
#include "tests/batch/small_batch.h"
#include "tests/batch/store_rows.h"

namespace pendulum::refit_test {
namespace {

using refit_folder::RefitTest;
using refit_folder::ResultAlone;
using small_batch::Folder;
using small_batch::OptionsWith;
using small_batch::RecordingText;
using small_batch::RefitInto;
using small_batch::WriteBatch;
using Json = nlohmann::ordered_json;
using store_rows::AllRows;
using store_rows::Rows;
using store_rows::Value;
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

namespace fs = std::filesystem;

constexpr const char* kCalibration =
    R"({"schema_version": 1, "input": "counts", "angle_unit": "deg", "coefficients": [-49.6077, 0.1985]})";

/// A recording in counts that this calibration converts to degrees.
std::string CountsText(std::uint64_t seed) {
  const auto recording = SimulateRecording(small_batch::Truth(seed));
  if (!recording) return recording.error().message();
  std::string text = "time_s,angle_counts\n";
  for (Eigen::Index i = 0; i < recording->size(); ++i) {
    const double degrees = recording->value[i] * 180 / 3.14159265358979;
    text += std::to_string(recording->time[i]) + "," + std::to_string(std::lround((degrees + 49.6077) / 0.1985)) + "\n";
  }
  return text;
}

// ---- Results equal to single fits ----------------------------------------------------------------------------------

TEST_F(RefitTest, MatchesSingleFitsBitForBit) {
  folder_.Write("rigs/one.json", small_batch::kRigText);
  folder_.Write("data/1.csv", RecordingText(1));
  folder_.Write("data/2.csv", RecordingText(2));
  folder_.Write("runs.csv", "path,id,rig\ndata/1.csv,a,rigs/one.json\ndata/2.csv,b,\n");
  RefitOptions options = OptionsWith({"viscous", "coulomb"});
  options.threads = 2;
  RefitAll(options);
  const auto rig = ReadRig(folder_ / "rigs/one.json");
  ASSERT_TRUE(rig);
  EXPECT_EQ(ValueOf("SELECT result FROM runs WHERE id = 'a'"),
            ResultAlone(options.run, folder_ / "data/1.csv", *rig, "data/1.csv"));
  EXPECT_EQ(ValueOf("SELECT result FROM runs WHERE id = 'b'"),
            ResultAlone(options.run, folder_ / "data/2.csv", std::nullopt, "data/2.csv"));
  EXPECT_THAT(Rows(store_, "SELECT id, exit_code, reason FROM runs ORDER BY id"), ElementsAre("a|0|NULL", "b|0|NULL"));
}

TEST_F(RefitTest, ReproducesTheDatasetsWithACommonRig) {
  for (const char* name : {"runs_1.csv", "coulomb.csv"}) fs::copy(std::string("datasets/") + name, folder_ / name);
  folder_.Write("counts.csv", CountsText(3));
  folder_.Write("calibration.json", kCalibration);
  folder_.Write("runs.csv", "path,calibration\nruns_1.csv,\ncoulomb.csv,\ncounts.csv,calibration.json\n");
  RefitOptions options = coulomb_;
  options.rig = R"({"gravity_torque": 1.8033})";
  RefitAll(options);
  const auto rig = ParseRig(*options.rig, "--rig");
  const auto calibration = ParseCalibration(kCalibration, "calibration.json");
  ASSERT_TRUE(rig && calibration);
  for (const std::string name : {"runs_1.csv", "coulomb.csv", "counts.csv"}) {
    IdentifyOptions alone = options.run;
    if (name == "counts.csv") alone.read.calibration = *calibration;
    EXPECT_EQ(ValueOf("SELECT result FROM runs WHERE id = '" + name + "'"),
              ResultAlone(alone, folder_ / name, *rig, name));
  }
}

TEST_F(RefitTest, GivesClosedFormsWithoutAFit) {
  WriteBatch(folder_, 1);
  RefitOptions options = coulomb_;
  options.run.closed_form_only = true;
  const RefitCounts counts = RefitAll(options);
  EXPECT_EQ(counts.unfitted, 0);
  EXPECT_EQ(ValueOf("SELECT result FROM runs"), ResultAlone(options.run, folder_ / "0.csv", std::nullopt, "0.csv"));
  EXPECT_EQ(ValueOf("SELECT count(*) FROM fits"), "0");
}

TEST_F(RefitTest, RefitsOneRunAsInABatch) {
  WriteBatch(folder_, 1);
  RefitAll(coulomb_);
  ManifestEntry entry;
  entry.id = entry.path = "0.csv";
  const auto source = OpenSource(folder_ / "runs.csv");
  ASSERT_TRUE(source);
  const RunOutcome outcome = RefitRun(*source, entry, coulomb_);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.reason.text(), "");
  EXPECT_EQ(outcome.result.dump(), ValueOf("SELECT result FROM runs"));
  EXPECT_EQ(outcome.provenance.data_sha256, ValueOf("SELECT data_sha256 FROM runs"));
  entry.path = "nowhere.csv";
  EXPECT_EQ(RefitRun(*source, entry, coulomb_).exit_code, ExitCode(StatusCode::kNotFound));
}

TEST_F(RefitTest, DoesNotDependOnTheNumberOfThreads) {
  WriteBatch(folder_, 7);
  folder_.Write("runs.csv", folder_.Read("runs.csv") + "nowhere.csv,z\n");
  std::vector<std::string> rows;
  for (const int threads : {1, 2, 5}) {
    RefitOptions options = OptionsWith({"viscous", "coulomb"});
    options.threads = threads;
    const fs::path store = folder_ / ("store" + std::to_string(threads));
    RefitInto(store, folder_ / "runs.csv", options);
    if (threads == 1) rows = AllRows(store);
    EXPECT_THAT(rows, SizeIs(testing::Gt(8U + 16U)));
    EXPECT_EQ(AllRows(store), rows) << threads;
  }
}

// ---- Only what changed ---------------------------------------------------------------------------------------------

TEST_F(RefitTest, RefitsNothingTwice) {
  WriteBatch(folder_, 3);
  const RefitCounts first = RefitAll(coulomb_);
  EXPECT_EQ(first.runs, 3);
  EXPECT_EQ(first.refitted, 3);
  EXPECT_EQ(first.current, 0);
  const std::vector<std::string> rows = AllRows(store_);
  const RefitCounts second = RefitAll(coulomb_);
  EXPECT_EQ(second.runs, 3);
  EXPECT_EQ(second.refitted, 0);
  EXPECT_EQ(second.current, 3);
  EXPECT_FALSE(second.stopped);
  EXPECT_EQ(AllRows(store_), rows);
  EXPECT_THAT(Refitted(coulomb_), IsEmpty());
}

TEST_F(RefitTest, DetectsOneChangedByte) {
  WriteBatch(folder_, 3);
  RefitAll(coulomb_);
  std::string text = folder_.Read("1.csv");
  text.back() = ' ';  // a blank in place of the last line break; the values are the same
  folder_.Write("1.csv", text);
  EXPECT_THAT(Refitted(coulomb_), ElementsAre("b"));
  EXPECT_THAT(Refitted(coulomb_), IsEmpty());
}

TEST_F(RefitTest, DetectsAChangedRigOrCalibration) {
  folder_.Write("counts.csv", CountsText(2));
  folder_.Write("0.csv", RecordingText(1));
  folder_.Write("calibration.json", kCalibration);
  for (const char* name : {"one.json", "two.json"}) folder_.Write(name, small_batch::kRigText);
  folder_.Write("runs.csv",
                "path,id,rig,calibration\n0.csv,a,one.json,\n0.csv,b,two.json,\n0.csv,c,,\n"
                "counts.csv,d,,calibration.json\n");
  EXPECT_EQ(RefitAll(coulomb_).unfitted, 0);
  folder_.Write("two.json", R"({"gravity_torque": 1.9})");
  EXPECT_THAT(Refitted(coulomb_), ElementsAre("b"));
  folder_.Write("calibration.json", std::string(kCalibration) + "\n");
  EXPECT_THAT(Refitted(coulomb_), ElementsAre("d"));
  RefitOptions with_rig = coulomb_;  // for entries that name no rig
  with_rig.rig = small_batch::kRigText;
  EXPECT_THAT(Refitted(with_rig), ElementsAre("c", "d"));
  EXPECT_THAT(Refitted(with_rig), IsEmpty());
  EXPECT_THAT(Refitted(coulomb_), ElementsAre("c", "d"));
}

TEST_F(RefitTest, DetectsOtherOptions) {
  WriteBatch(folder_, 2);
  RefitAll(coulomb_);
  const std::vector<std::function<void(IdentifyOptions&)>> changes = {
      [](IdentifyOptions& run) {
        run.models = {"viscous", "coulomb"};
      },
      [](IdentifyOptions& run) { run.swing.from = 0.5; },
      [](IdentifyOptions& run) { run.swing.to = 6; },
      [](IdentifyOptions& run) { run.fit.fixed["coulomb"] = 0.002; },
      [](IdentifyOptions& run) {
        run.fit.bounds["coulomb"] = {0, 1};
      },
      [](IdentifyOptions& run) { run.fit.initial["coulomb"] = 0.002; },
      [](IdentifyOptions& run) {
        run.fit.priors["coulomb"] = {0.002, 0.001};
      },
      [](IdentifyOptions& run) { run.fit.noise = NoiseFamily::kGaussian; },
      [](IdentifyOptions& run) { run.fit.seed = 2; },
      [](IdentifyOptions& run) { run.read.resolution = 0.001; },
      [](IdentifyOptions& run) { run.closed_form_only = true; }};
  for (std::size_t k = 0; k < changes.size(); ++k) {
    RefitOptions options = coulomb_;
    changes[k](options.run);
    EXPECT_THAT(Refitted(options), ElementsAre("a", "b")) << k;
    EXPECT_THAT(Refitted(options), IsEmpty()) << k;
  }
  EXPECT_THAT(Refitted(coulomb_), ElementsAre("a", "b"));
}

TEST_F(RefitTest, IgnoresThreadsInTheProvenance) {
  WriteBatch(folder_, 2);
  RefitAll(coulomb_);
  RefitOptions options = coulomb_;
  options.threads = 2;
  options.run.fit.threads = 7;
  EXPECT_THAT(Refitted(options), IsEmpty());
}

TEST_F(RefitTest, DetectsAChangedWindowOrModels) {
  WriteBatch(folder_, 3);
  folder_.Write("runs.csv", "path,id,from_s,models\n0.csv,a,,\n1.csv,b,,\n2.csv,c,,\n");
  RefitAll(coulomb_);
  folder_.Write("runs.csv", "path,id,from_s,models\n0.csv,a,1,\n1.csv,b,,\n2.csv,c,,viscous\n");
  EXPECT_THAT(Refitted(coulomb_), ElementsAre("a", "c"));
  EXPECT_THAT(Rows(store_, "SELECT model FROM fits JOIN runs USING(run) WHERE id = 'c' AND fits.stale IS NULL"),
              ElementsAre("viscous"));
  folder_.Write("runs.csv", "path,id,from_s,models\n0.csv,a,1,coulomb\n1.csv,b,,\n2.csv,c,,viscous\n");
  EXPECT_THAT(Refitted(coulomb_), IsEmpty());  // equivalent options
}

TEST_F(RefitTest, RefitsRowsOfAnotherVersion) {
  WriteBatch(folder_, 2);
  RefitAll(coulomb_);
  SQLite::Database(store_.string(), SQLite::OPEN_READWRITE).exec("UPDATE runs SET version = '0.0.1' WHERE id = 'b'");
  EXPECT_THAT(Refitted(coulomb_), ElementsAre("b"));
}

TEST_F(RefitTest, RefitsEverythingIfForced) {
  WriteBatch(folder_, 2);
  RefitAll(coulomb_);
  const std::vector<std::string> rows = AllRows(store_);
  RefitOptions forced = coulomb_;
  forced.force = true;
  EXPECT_THAT(Refitted(forced), ElementsAre("a", "b"));
  EXPECT_EQ(AllRows(store_), rows);
}

TEST_F(RefitTest, RetriesFailuresOnRequest) {
  WriteBatch(folder_, 2);
  folder_.Write("bad.csv", "time_s,angle_rad\n0,nonsense\n");
  folder_.Write("runs.csv", folder_.Read("runs.csv") + "bad.csv,bad\nnowhere.csv,none\n");
  RefitAll(coulomb_);
  EXPECT_THAT(Refitted(coulomb_), IsEmpty());
  RefitOptions again = coulomb_;
  again.retry_failed = true;
  EXPECT_THAT(Refitted(again), ElementsAre("bad", "none"));
}

// ---- Results that stay ---------------------------------------------------------------------------------------------

TEST_F(RefitTest, KeepsTheResultOfARecordingThatIsGone) {
  WriteBatch(folder_, 2);
  RefitAll(coulomb_);
  const std::string fits = "SELECT model, status FROM fits", quantities = "SELECT * FROM quantities";
  const std::vector<std::string> before = Rows(store_, quantities);
  fs::rename(folder_ / "0.csv", folder_ / "elsewhere");
  EXPECT_EQ(RefitAll(coulomb_).stale, 1);
  EXPECT_THAT(Rows(store_, "SELECT id, exit_code, stale FROM runs ORDER BY id"),
              ElementsAre(StartsWith("a|0|0.csv: there is no such file"), "b|0|NULL"));
  EXPECT_EQ(Rows(store_, quantities), before);
  for (const bool force : {false, true}) {
    RefitOptions again = coulomb_;
    again.force = force;
    const RefitCounts counts = RefitAll(again);
    EXPECT_EQ(counts.stale, 1);
    EXPECT_EQ(counts.stale_before, force ? 0 : 1);
    EXPECT_EQ(counts.unfitted, 0);
    EXPECT_EQ(counts.current, force ? 0 : 2);
    EXPECT_EQ(Rows(store_, quantities), before);
  }
  fs::rename(folder_ / "elsewhere", folder_ / "0.csv");
  const RefitCounts counts = RefitAll(coulomb_);
  EXPECT_EQ(counts.stale, 0);
  EXPECT_EQ(counts.current, 1);
  EXPECT_EQ(counts.refitted, 1);  // a new fit was asked for
  EXPECT_THAT(Rows(store_, "SELECT id, exit_code, stale FROM runs ORDER BY id"), ElementsAre("a|0|NULL", "b|0|NULL"));
}

TEST_F(RefitTest, KeepsTheResultOfARecordingOrRigThatIsDamaged) {
  folder_.Write("rig.json", small_batch::kRigText);
  folder_.Write("a.csv", RecordingText(1));
  folder_.Write("b.csv", RecordingText(2));
  folder_.Write("runs.csv", "path,id,rig\na.csv,a,rig.json\nb.csv,b,\n");
  RefitAll(coulomb_);
  const std::vector<std::string> before = Rows(store_, "SELECT id, result FROM runs");
  folder_.Write("rig.json", "{");
  folder_.Write("b.csv", "time_s,angle_rad\n0,nonsense\n");
  EXPECT_EQ(RefitAll(coulomb_).stale, 2);
  EXPECT_EQ(Rows(store_, "SELECT id, result FROM runs"), before);
  EXPECT_THAT(Refitted(coulomb_), IsEmpty());
  folder_.Write("b.csv", RecordingText(3));
  EXPECT_THAT(Refitted(coulomb_), ElementsAre("b"));
  EXPECT_THAT(Rows(store_, "SELECT id FROM runs WHERE stale IS NOT NULL"), ElementsAre("a"));
}

TEST_F(RefitTest, LeavesResultsOfAnotherRigOrEntryOutUntilTheyAreReplaced) {
  const std::atomic<bool> stop = true;
  RefitOptions stopped = coulomb_;
  stopped.stop = &stop;
  folder_.Write("rig.json", small_batch::kRigText);
  for (const char* name : {"a.csv", "b.csv", "c.csv"}) folder_.Write(name, RecordingText(1));
  const std::string manifest = "path,id,rig,to_s,models\nb.csv,b,,,\n";
  folder_.Write("runs.csv", manifest + "a.csv,a,rig.json,,\nc.csv,c,,,\n");
  RefitAll(coulomb_);
  folder_.Write("rig.json", std::string(small_batch::kRigText) + "\n");
  folder_.Write("runs.csv", manifest + "a.csv,a,rig.json,,\nc.csv,c,,5,\n");
  RefitAll(stopped);
  EXPECT_THAT(Rows(store_, "SELECT id FROM runs WHERE stale IS NOT NULL ORDER BY id"), ElementsAre("a", "c"));
  folder_.Write("rig.json", small_batch::kRigText);
  folder_.Write("runs.csv", manifest + "a.csv,a,rig.json,,\nc.csv,c,,,\n");
  EXPECT_THAT(Refitted(coulomb_), IsEmpty());  // as they were fitted
  EXPECT_THAT(Rows(store_, "SELECT id FROM runs WHERE stale IS NOT NULL"), IsEmpty());
}

TEST_F(RefitTest, ContinuesAStoppedRefitOfAllRuns) {
  WriteBatch(folder_, 2);
  RefitAll(coulomb_);
  const std::atomic<bool> stop = true;
  RefitOptions forced = coulomb_;
  forced.force = true;
  forced.stop = &stop;
  RefitAll(forced);
  EXPECT_EQ(ValueOf("SELECT count(stale) FROM runs"), "2");
  const auto headline = [&] {
    auto store = Store::Open(store_, Store::Mode::kRead).value();
    return Summarize(store, {})->headline.text;
  };
  EXPECT_THAT(headline(), EndsWith("2 with a former result only; the last refit is not complete"));
  EXPECT_THAT(Refitted(coulomb_), ElementsAre("a", "b"));
  EXPECT_EQ(ValueOf("SELECT count(stale) FROM runs"), "0");
  EXPECT_EQ(headline(), "2 of 2 recordings fitted");
}

TEST_F(RefitTest, KeepsAConvergedFitInPlaceOfOneThatDoesNotConverge) {
  WriteBatch(folder_, 2);
  RefitAll(coulomb_);
  const std::vector<std::string> before = Rows(store_, "SELECT id, result FROM runs WHERE id = 'a'");
  std::string steps = "time_s,angle_rad\n";  // of a sensor that only switches
  for (int i = 0; i < 600; ++i) steps += std::to_string(0.01 * i) + (i / 60 % 2 == 0 ? ",0.2\n" : ",-0.2\n");
  folder_.Write("0.csv", steps);
  EXPECT_EQ(RefitAll(coulomb_).stale, 1);
  EXPECT_EQ(Rows(store_, "SELECT id, result FROM runs WHERE id = 'a'"), before);
  RefitOptions replacing = coulomb_;
  replacing.replace_by_failures = true;
  EXPECT_EQ(RefitAll(replacing).stale, 0);
  EXPECT_NE(Rows(store_, "SELECT id, result FROM runs WHERE id = 'a'"), before);
}

TEST_F(RefitTest, KeepsTheResultOfARecordingThatBecameShorter) {
  WriteBatch(folder_, 2);
  RefitAll(coulomb_);
  const std::string result = ValueOf("SELECT result FROM runs WHERE id = 'a'");
  const std::string text = folder_.Read("0.csv");
  folder_.Write("0.csv", text.substr(0, text.rfind('\n', text.size() * 9 / 10) + 1));
  EXPECT_EQ(RefitAll(coulomb_).stale, 1);
  EXPECT_EQ(ValueOf("SELECT result FROM runs WHERE id = 'a'"), result);
  EXPECT_THAT(ValueOf("SELECT stale FROM runs WHERE id = 'a'"),
              AllOf(StartsWith("0.csv: the recording has become shorter: "), HasSubstr(" samples, fewer than the ")));
  folder_.Write("0.csv", RecordingText(7));  // another one of the same length
  EXPECT_EQ(RefitAll(coulomb_).stale, 0);
  EXPECT_NE(ValueOf("SELECT result FROM runs WHERE id = 'a'"), result);
}

TEST_F(RefitTest, ReplacesTheResultOfAnotherRecordingUnlessTheFormerOneIsGoneAndLonger) {
  WriteBatch(folder_, 1);
  RefitAll(coulomb_);
  folder_.Write("other.csv", RecordingText(7));
  folder_.Write("runs.csv", "path,id\nother.csv,a\n");
  EXPECT_EQ(RefitAll(coulomb_).stale, 0);
  EXPECT_EQ(ValueOf("SELECT json_extract(result, '$.recordings[0].path') FROM runs"), "other.csv");
  const std::string text = folder_.Read("other.csv");  // a copy that has not ended
  folder_.Write("shorter.csv", text.substr(0, text.rfind('\n', text.size() * 9 / 10) + 1));
  folder_.Write("runs.csv", "path,id\nshorter.csv,a\n");
  fs::rename(folder_ / "other.csv", folder_ / "elsewhere");
  EXPECT_EQ(RefitAll(coulomb_).stale, 1);
  EXPECT_EQ(ValueOf("SELECT json_extract(result, '$.recordings[0].path') FROM runs"), "other.csv");
  EXPECT_THAT(ValueOf("SELECT stale FROM runs"), HasSubstr(" samples, fewer than the "));
  fs::rename(folder_ / "elsewhere", folder_ / "other.csv");  // another recording: both are there
  RefitOptions again = coulomb_;
  again.force = true;
  EXPECT_EQ(RefitAll(again).stale, 0);
  EXPECT_EQ(ValueOf("SELECT json_extract(result, '$.recordings[0].path') FROM runs"), "shorter.csv");
}

TEST_F(RefitTest, ReplacesADamagedResult) {
  WriteBatch(folder_, 1);
  RefitAll(coulomb_);
  SQLite::Database(store_.string(), SQLite::OPEN_READWRITE).exec("UPDATE runs SET result = '{broken'");
  folder_.Write("0.csv", RecordingText(7));
  EXPECT_EQ(RefitAll(coulomb_).stale, 0);
  EXPECT_EQ(ValueOf("SELECT json_valid(result) FROM runs"), "1");
}

TEST_F(RefitTest, ReplacesResultsByFailuresOnRequest) {
  WriteBatch(folder_, 2);
  RefitAll(coulomb_);
  const std::string text = folder_.Read("0.csv");
  folder_.Write("0.csv", text.substr(0, text.rfind('\n', text.size() * 9 / 10) + 1));
  fs::remove(folder_ / "1.csv");
  EXPECT_EQ(RefitAll(coulomb_).stale, 2);
  RefitOptions replace = coulomb_;
  replace.replace_by_failures = true;
  const RefitCounts counts = RefitAll(replace);
  EXPECT_EQ(counts.stale, 0);
  EXPECT_EQ(counts.unfitted, 1);
  EXPECT_THAT(Rows(store_, "SELECT id, exit_code, stale, result IS NULL FROM runs ORDER BY id"),
              ElementsAre("a|0|NULL|0", "b|3|NULL|1"));
}

TEST_F(RefitTest, KeepsFitsOfModelsNoLongerRequested) {
  WriteBatch(folder_, 1);
  RefitAll(OptionsWith({"viscous", "coulomb", "drag"}));
  const std::string quantities = "SELECT * FROM quantities WHERE model <> 'viscous'";
  const std::vector<std::string> before = Rows(store_, quantities);
  Json fit = Json::parse(ValueOf("SELECT json_extract(result, '$.fits[1]') FROM runs"));
  const std::string own = ValueOf("SELECT json_extract(result, '$.recordings[0].fits[1]') FROM runs");
  fit["recordings"] = Json::array({Json::parse(own)});
  RefitAll(OptionsWith({"viscous"}));
  EXPECT_THAT(Rows(store_, "SELECT model, stale FROM fits ORDER BY model"),
              ElementsAre("coulomb|the last refit did not ask for this model",
                          "drag|the last refit did not ask for this model", "viscous|NULL"));
  EXPECT_EQ(Rows(store_, quantities), before);
  EXPECT_EQ(Json::parse(ValueOf("SELECT json FROM fits WHERE model = 'coulomb'")), fit);
  EXPECT_EQ(ValueOf("SELECT json_array_length(result, '$.fits') FROM runs"), "1");
  EXPECT_EQ(ValueOf("SELECT law FROM results"), "viscous");
  fs::rename(folder_ / "0.csv", folder_ / "elsewhere");
  RefitAll(OptionsWith({"drag"}));  // fails, so all results stay
  EXPECT_EQ(Rows(store_, quantities), before);
  fs::rename(folder_ / "elsewhere", folder_ / "0.csv");
  RefitAll(OptionsWith({"viscous", "coulomb"}));
  EXPECT_THAT(Rows(store_, "SELECT model, stale IS NULL, json IS NULL FROM fits ORDER BY model"),
              ElementsAre("coulomb|1|1", "drag|0|0", "viscous|1|1"));
  EXPECT_EQ(Rows(store_, quantities), before);
}

TEST_F(RefitTest, DropsFailuresOfModelsNoLongerRequested) {
  folder_.Write("runs.csv", "path\nnowhere.csv\n");
  RefitAll(OptionsWith({"viscous", "coulomb"}));
  RefitAll(OptionsWith({"viscous"}));
  EXPECT_THAT(Rows(store_, "SELECT model FROM fits"), ElementsAre("viscous"));
}

TEST_F(RefitTest, LeavesResultsOfOtherOptionsOutUntilTheyAreReplaced) {
  WriteBatch(folder_, 2);
  folder_.Write("runs.csv", "path,id,models\n0.csv,a,\n1.csv,b,viscous\n");
  RefitAll(coulomb_);
  const std::string stale = "SELECT id, stale FROM runs ORDER BY id";
  const std::atomic<bool> stop = true;
  for (const bool has_rig : {false, true}) {
    RefitOptions stopped = has_rig ? coulomb_ : OptionsWith({"drag"});
    if (has_rig) stopped.rig = small_batch::kRigText;
    stopped.stop = &stop;
    RefitAll(stopped);
    EXPECT_THAT(Rows(store_, stale),
                ElementsAre("a|the options, rig or calibration changed, and this run has not been fitted again yet",
                            "b|the options, rig or calibration changed, and this run has not been fitted again yet"));
    EXPECT_EQ(RefitAll(coulomb_).current, 2);  // with the former options
    EXPECT_THAT(Rows(store_, stale), ElementsAre("a|NULL", "b|NULL"));
  }
  EXPECT_THAT(Refitted(OptionsWith({"drag"})), ElementsAre("a"));  // b has its own model
  EXPECT_THAT(Rows(store_, stale), ElementsAre("a|NULL", "b|NULL"));
}

TEST_F(RefitTest, RecognizesARenamedRecording) {
  WriteBatch(folder_, 2);
  folder_.Write("runs.csv", "path\n0.csv\n1.csv\n");
  RefitAll(OptionsWith({"viscous", "coulomb"}));
  const std::string estimates = "SELECT run, model, name, estimate FROM quantities ORDER BY run, model, name";
  const std::vector<std::string> before = Rows(store_, estimates);
  fs::rename(folder_ / "0.csv", folder_ / "new.csv");
  folder_.Write("runs.csv", "path\nnew.csv\n1.csv\n");
  EXPECT_EQ(RefitAll(OptionsWith({"viscous", "coulomb"})).renamed, 1);
  EXPECT_THAT(
      Rows(store_, "SELECT id, path, position, json_extract(result, '$.recordings[0].path') FROM runs ORDER BY id"),
      ElementsAre("1.csv|1.csv|1|1.csv", "new.csv|new.csv|0|new.csv"));
  EXPECT_EQ(Rows(store_, estimates), before);
  folder_.Write("runs.csv", "path\nnew.csv\n1.csv\ncopy.csv\n");
  fs::copy(folder_ / "1.csv", folder_ / "copy.csv");
  EXPECT_EQ(RefitAll(OptionsWith({"viscous", "coulomb"})).renamed, 0);  // 1.csv is still there
}

TEST_F(RefitTest, TakesOverOnlyTheSameRun) {
  WriteBatch(folder_, 1);
  folder_.Write("runs.csv", "path,id,from_s,to_s\n0.csv,early,0,10\n");
  RefitAll(coulomb_);
  folder_.Write("runs.csv", "path,id,from_s,to_s\n0.csv,late,10,20\n");
  EXPECT_EQ(RefitAll(coulomb_).renamed, 0);
  EXPECT_THAT(Rows(store_, "SELECT id, cast(from_s AS INTEGER) FROM runs ORDER BY id"),
              ElementsAre("early|0", "late|10"));
  folder_.Write("runs.csv", "path,id,from_s,to_s\n0.csv,first,0,10\n");  // only the id is another
  EXPECT_EQ(RefitAll(coulomb_).renamed, 1);
  EXPECT_THAT(Rows(store_, "SELECT id, cast(from_s AS INTEGER) FROM runs ORDER BY id"),
              ElementsAre("first|0", "late|10"));
}

TEST_F(RefitTest, DoesNotTakeACopyForARenamedRecording) {
  WriteBatch(folder_, 1);
  RefitAll(coulomb_);
  fs::copy(folder_ / "0.csv", folder_ / "copy.csv");
  folder_.Write("runs.csv", "path\ncopy.csv\n");
  EXPECT_EQ(RefitAll(coulomb_).renamed, 0);
  EXPECT_THAT(Rows(store_, "SELECT id FROM runs ORDER BY id"), ElementsAre("a", "copy.csv"));
}

TEST_F(RefitTest, RecognizesARenamedRecordingAfterAFailedAttempt) {
  WriteBatch(folder_, 1);
  RefitAll(coulomb_);
  folder_.Write("runs.csv", "path\nnew.csv\n");
  EXPECT_EQ(RefitAll(coulomb_).unfitted, 1);  // not renamed yet
  fs::rename(folder_ / "0.csv", folder_ / "new.csv");
  EXPECT_EQ(RefitAll(coulomb_).renamed, 1);
  EXPECT_THAT(Rows(store_, "SELECT id FROM runs"), ElementsAre("new.csv"));
}

TEST_F(RefitTest, DoesNotTakeAnotherRecordingInTheSameFileForARenamedRun) {
  WriteBatch(folder_, 1);
  RefitAll(coulomb_);
  folder_.Write("runs.csv", "path,id\n0.csv,tuesday\n");
  folder_.Write("0.csv", RecordingText(7));
  EXPECT_EQ(RefitAll(coulomb_).renamed, 0);
  EXPECT_THAT(Rows(store_, "SELECT id, exit_code, stale FROM runs ORDER BY id"),
              ElementsAre("a|0|NULL", "tuesday|0|NULL"));
}

TEST_F(RefitTest, MarksResultsOfARigThatChangedMeanwhile) {
  folder_.Write("rig.json", small_batch::kRigText);
  folder_.Write("a.csv", RecordingText(1));
  folder_.Write("b.csv", RecordingText(2));
  folder_.Write("runs.csv", "path,id,rig\na.csv,a,rig.json\nb.csv,b,rig.json\n");
  RefitOptions options = coulomb_;
  options.threads = 1;
  options.progress = [&](const RefitCounts& counts) {
    if (counts.done() == 1) folder_.Write("rig.json", std::string(small_batch::kRigText) + "\n");
  };
  EXPECT_EQ(RefitAll(options).changed, 1);
  EXPECT_THAT(Rows(store_, "SELECT id FROM runs WHERE stale IS NOT NULL"), ElementsAre("a"));
  EXPECT_THAT(Refitted(coulomb_), ElementsAre("a"));
}

TEST_F(RefitTest, MarksNothingIfGroupByIsWrong) {
  WriteBatch(folder_, 1);
  RefitAll(coulomb_);
  RefitOptions options = OptionsWith({"drag"});
  options.group_by = "bensh";
  const Source source = OpenSource(folder_ / "runs.csv").value();
  Store store = Store::Open(store_, Store::Mode::kWrite).value();
  EXPECT_FALSE(Refit(source, store, options));
  EXPECT_EQ(store.Count()->stale, 0);
  EXPECT_TRUE(store.Meta()->complete);
}

// ---- Limits and stops ----------------------------------------------------------------------------------------------

/// Options whose fit calls `begun` and waits in each of the first steps of a bootstrap, two seconds in all.
RefitOptions SlowOptions(const RefitOptions& options, const std::function<void()>& begun) {
  RefitOptions slow = options;
  slow.threads = 1;
  slow.run.fit.interval = IntervalMethod::kBootstrap;
  slow.run.fit.progress = [begun](const ProgressStep& step) {
    constexpr int kWaits = 100;
    if (!step.what.starts_with("bootstrap") || step.done > kWaits) return;
    begun();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  };
  return slow;
}

TEST_F(RefitTest, GivesUpARunThatTakesTooLong) {
  WriteBatch(folder_, 2);
  RefitOptions options = SlowOptions(coulomb_, [] {});
  options.fit_time = std::chrono::milliseconds(200);
  folder_.Write("bad.csv", "time_s,angle_rad\n0,nonsense\n");
  folder_.Write("runs.csv", folder_.Read("runs.csv") + "bad.csv,bad\n");
  EXPECT_EQ(RefitAll(options).unfitted, 3);
  EXPECT_THAT(ValueOf("SELECT reason FROM runs WHERE id = 'bad'"), HasSubstr("nonsense"));
  EXPECT_THAT(ValueOf("SELECT reason FROM runs WHERE id = 'a'"),
              AllOf(StartsWith("0.csv: the fit took longer than 0.2 s; "), HasSubstr("--fit_seconds")));
  EXPECT_EQ(ValueOf("SELECT exit_code FROM runs WHERE id = 'a'"), std::to_string(ExitCode(StatusCode::kTryAgain)));
  RefitOptions again = coulomb_;
  again.run.fit.interval = IntervalMethod::kBootstrap;
  again.fit_time = options.fit_time;
  EXPECT_THAT(Refitted(again), IsEmpty());
  again.retry_failed = true;
  EXPECT_THAT(Refitted(again), ElementsAre("a", "b", "bad"));
}

TEST_F(RefitTest, TriesARunThatTookTooLongAgainWithMoreTime) {
  WriteBatch(folder_, 2);
  RefitOptions options = SlowOptions(coulomb_, [] {});
  options.fit_time = std::chrono::milliseconds(200);
  EXPECT_EQ(RefitAll(options).unfitted, 2);
  EXPECT_THAT(Refitted(options), IsEmpty());
  options.fit_time = std::chrono::milliseconds(201);
  EXPECT_THAT(Refitted(options), ElementsAre("a", "b"));
  options.run.fit.progress = nullptr;
  options.fit_time = std::chrono::minutes(10);
  EXPECT_EQ(RefitAll(options).unfitted, 0);
}

TEST_F(RefitTest, KeepsTheResultOfARunThatTakesTooLongUntilItHasMoreTime) {
  WriteBatch(folder_, 1);
  RefitAll(coulomb_);
  RefitOptions options = SlowOptions(coulomb_, [] {});
  options.fit_time = std::chrono::milliseconds(200);
  RefitCounts counts = RefitAll(options);
  EXPECT_EQ(counts.stale, 1);
  EXPECT_EQ(counts.refitted, 1);
  EXPECT_THAT(ValueOf("SELECT stale FROM runs"), StartsWith("0.csv: the fit took longer than 0.2 s; "));
  EXPECT_EQ(RefitAll(options).current, 1);
  options.run.fit.progress = nullptr;
  options.fit_time = std::chrono::minutes(10);
  counts = RefitAll(options);
  EXPECT_EQ(counts.stale, 0);
  EXPECT_EQ(counts.refitted, 1);
}

TEST_F(RefitTest, LeavesTheRunInProgressForTheNextRefitWhenStopped) {
  WriteBatch(folder_, 2);
  std::atomic<bool> stop = false;
  RefitOptions options = SlowOptions(coulomb_, [&] { stop = true; });
  options.stop = &stop;
  const RefitCounts counts = RefitAll(options);
  EXPECT_TRUE(counts.stopped);
  EXPECT_EQ(counts.refitted, 0);
  EXPECT_EQ(ValueOf("SELECT count(*) FROM fits"), "0");
  EXPECT_THAT(Refitted(coulomb_), ElementsAre("a", "b"));
}

}  // namespace
}  // namespace pendulum::refit_test
