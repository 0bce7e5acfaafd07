// SPDX-License-Identifier: Apache-2.0
// Upgrades of the stores in tests/batch/golden, one of each schema (golden_stores.py).
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "batch/former_results.h"
#include "batch/store_schema.h"
#include "pendulum/batch/store.h"
#include "pendulum/batch/summary.h"
#include "tests/batch/small_batch.h"
#include "tests/batch/store_rows.h"

namespace pendulum::golden_stores_test {
namespace {

namespace fs = std::filesystem;

using store_rows::Rows;
using store_rows::Value;

constexpr int kVersions = static_cast<int>(kStoreMigrations.size());
constexpr int kFirstReleased = 5;  // the first store that a released program wrote; stores 1 to 4 were made from it
constexpr int kKilled = 9;

/// Exits as a killed process would, at the `left`-th event of SQLite in this process.
int left = 0;

int CountDown(void* /*unused*/) {
  if (--left == 0) ::_exit(kKilled);
  return 0;
}

int CountDownStatement(unsigned /*type*/, void* data, void* /*statement*/, void* /*text*/) { return CountDown(data); }

/// The events are the statements of each connection that is opened from now on. With a cache of one page, SQLite writes
/// into the file in the middle of a transaction.
int WatchStatements(sqlite3* database, char** /*error*/, const sqlite3_api_routines* /*unused*/) {
  ::sqlite3_exec(database, "PRAGMA cache_size = 1", nullptr, nullptr, nullptr);
  return ::sqlite3_trace_v2(database, SQLITE_TRACE_STMT, CountDownStatement, nullptr);
}

/// The events are every tenth step of SQLite's virtual machine.
int WatchSteps(sqlite3* database, char** /*error*/, const sqlite3_api_routines* /*unused*/) {
  constexpr int kSteps = 10;
  ::sqlite3_exec(database, "PRAGMA cache_size = 1", nullptr, nullptr, nullptr);
  ::sqlite3_progress_handler(database, kSteps, CountDown, nullptr);
  return SQLITE_OK;
}

/// Writing fails in this process from now on, as on a full disk.
void FillDisk() {
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit nothing{0, 0};
  ::setrlimit(RLIMIT_FSIZE, &nothing);
}

using Watch = int (*)(sqlite3*, char**, const sqlite3_api_routines*);

class GoldenStoresTest : public testing::Test {
 protected:
  static std::string GoldenSql(int version) {
    std::ostringstream text;
    text << std::ifstream("tests/batch/golden/store_" + std::to_string(version) + ".sql").rdbuf();
    return text.str();
  }

  /// The golden store of a version as a file.
  fs::path Make(int version, const std::string& name) const {
    const fs::path path = folder_ / name;
    fs::remove(path);
    SQLite::Database(path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE).exec(GoldenSql(version));
    return path;
  }

  /// A store of the last version before the present one with 1,000 runs.
  fs::path MakeLarge(const std::string& name) const {
    const fs::path path = Make(kVersions - 1, name);
    const auto copies = [](const std::string& table, const std::string& columns) {
      return "INSERT INTO " + table + "(run, " + columns + ") SELECT run + n, " + columns + " FROM " + table +
             ", numbers WHERE run = 1;";
    };
    const std::string runs =
        "position, path, rig, calibration, models, columns, exit_code, recommended, data_sha256, options_sha256, "
        "version, result";
    SQLite::Database(path.string(), SQLite::OPEN_READWRITE)
        .exec(
            "CREATE TEMP TABLE numbers AS WITH RECURSIVE f(n) AS (SELECT 10 UNION ALL SELECT n + 1 FROM f WHERE n < "
            "1006) SELECT n FROM f;"
            "INSERT INTO runs(run, id, " +
            runs + ") SELECT run + n, n, " + runs + " FROM runs, numbers WHERE run = 1;" +
            copies("fits", "model, status, reason, used_samples, rms_residual") +
            copies("quantities", "model, name, derived, estimate, std_error, unit, fixed, at_bound"));
    return path;
  }

  /// Opens the store in a process that is killed at the `event`-th event. Returns whether it was killed before the end.
  static bool OpenKilled(const fs::path& path, Watch watch, int event) {
    const pid_t child = ::fork();
    if (child == 0) {
      left = event;
      ::sqlite3_auto_extension(reinterpret_cast<void (*)()>(watch));
      const auto store = Store::Open(path, Store::Mode::kRead);
      ::_exit(store ? EXIT_SUCCESS : EXIT_FAILURE);
    }
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_NE(WEXITSTATUS(status), EXIT_FAILURE);
    SQLite::Database(path.string(), SQLite::OPEN_READWRITE).execAndGet("SELECT count(*) FROM runs");  // rolls back
    return WEXITSTATUS(status) == kKilled;
  }

  /// All that the first version had of the runs of a refit.
  static std::vector<std::string> ContentOf(const fs::path& path) {
    std::vector<std::string> all;
    for (const char* query :
         {"SELECT run, id, position, path, rig, calibration, from_s, to_s, models, columns, exit_code, reason, "
          "recommended, data_sha256, rig_sha256, calibration_sha256, options_sha256, version FROM runs "
          "WHERE id <> 'c' ORDER BY run",
          "SELECT run, model, status, reason, used_samples, rms_residual, sigma, aicc, runs_p, evaluations FROM fits "
          "ORDER BY run, model",
          "SELECT run, model, name, derived, estimate, std_error, lower95, upper95, systematic_std_error, unit, fixed, "
          "at_bound FROM quantities ORDER BY run, model, name",
          "SELECT key, value FROM meta ORDER BY key", "SELECT sha256, json FROM options"}) {
      for (std::string& row : Rows(path, query)) all.push_back(std::move(row));
    }
    return all;
  }

  static std::vector<std::string> ResultsOf(const fs::path& path) {
    return Rows(path, "SELECT result FROM runs WHERE result IS NOT NULL ORDER BY run");
  }

  /// Checks that a store of a former version has the present schema and the same content.
  void ExpectPresent(const fs::path& path, int former) const {
    EXPECT_EQ(Value(path, "PRAGMA user_version"), std::to_string(kVersions)) << former;
    EXPECT_EQ(Value(path, "PRAGMA integrity_check"), "ok") << former;
    const fs::path released = Make(std::max(former, kFirstReleased), "former.sqlite");
    EXPECT_EQ(ContentOf(path), ContentOf(released)) << former;
    std::vector<std::string> results = ResultsOf(released);
    for (std::string& result : results) result = ToCurrentResult(result);
    EXPECT_EQ(ResultsOf(path), results) << former;
    EXPECT_THAT(results, testing::Each(testing::HasSubstr(R"("schema_version":3)"))) << former;
    EXPECT_EQ(Value(path, "SELECT law || status FROM results WHERE id = 'a'"), "coulombconverged") << former;
    if (former >= 2) {
      EXPECT_EQ(Value(path, "SELECT flags || name FROM requests"), "{}") << former;
    }
  }

  small_batch::Folder folder_{"golden_stores_test"};
};

TEST_F(GoldenStoresTest, ThereIsOneOfEachSchema) {
  for (int version = 1; version <= kVersions; ++version) {
    EXPECT_EQ(Value(Make(version, "golden.sqlite"), "PRAGMA user_version"), std::to_string(version))
        << "add it with: python3 -B tests/batch/golden_stores.py build/release/bin";
  }
  const std::string schema =
      "SELECT sql FROM sqlite_schema WHERE sql IS NOT NULL AND name <> 'results' ORDER BY type, name";
  ASSERT_TRUE(Store::Open(folder_ / "new.sqlite", Store::Mode::kWrite));
  EXPECT_EQ(Rows(Make(kVersions, "golden.sqlite"), schema), Rows(folder_ / "new.sqlite", schema))
      << "a schema that people have must not change; add a migration";
}

TEST_F(GoldenStoresTest, AreUpgradedWithoutLoss) {
  for (int version = 1; version <= kVersions; ++version) {
    const fs::path path = Make(version, "golden.sqlite");
    auto store = Store::Open(path, Store::Mode::kWrite);
    ASSERT_TRUE(store) << store.error().message();
    const auto summary = Summarize(*store, {});
    ASSERT_TRUE(summary) << summary.error().message();
    EXPECT_EQ(summary->headline.fitted, 1);
    EXPECT_EQ(summary->headline.missing, 1);
    EXPECT_EQ(summary->headline.missing_runs.at(0).reason, "there is no such file; check the path");
    ExpectPresent(path, version);
  }
}

TEST_F(GoldenStoresTest, SeparateReasonsFromTheirPlaces) {
  const fs::path path = Make(7, "golden.sqlite");
  SQLite::Database(path.string(), SQLite::OPEN_READWRITE)
      .exec(
          "UPDATE runs SET stale = 'run.csv: the recording has become shorter' WHERE id = 'a';"
          "UPDATE runs SET reason = 'none.csv:3:5: \"x\" is not a number' WHERE id = 'b';"
          "UPDATE runs SET reason = 'rig.json: there is no such file' WHERE id = 'c'");
  ASSERT_TRUE(Store::Open(path, Store::Mode::kWrite));
  EXPECT_THAT(Rows(path, "SELECT id, place, sentence FROM runs ORDER BY run"),
              testing::ElementsAre("a|run.csv|the recording has become shorter", "b|none.csv:3:5|\"x\" is not a number",
                                   "c|NULL|NULL"));
}

TEST_F(GoldenStoresTest, AreReadFromAFullDisk) {
  for (int version = 1; version < kVersions; ++version) {
    const fs::path path = Make(version, "golden.sqlite");
    const std::vector<std::string> before = ContentOf(path);
    const pid_t child = ::fork();
    if (child == 0) {
      FillDisk();
      auto store = Store::Open(path, Store::Mode::kRead);
      const auto summary = store ? Summarize(*store, {}) : tl::unexpected(store.error());
      ::_exit(summary && summary->headline.fitted == 1 ? EXIT_SUCCESS : EXIT_FAILURE);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0) << version;
    EXPECT_EQ(Value(path, "PRAGMA user_version"), std::to_string(version));
    EXPECT_EQ(ContentOf(path), before) << version;
  }
}

TEST_F(GoldenStoresTest, AreRefusedAndUnchangedIfThereIsNoRoomForACopyEither) {
  const fs::path path = MakeLarge("golden.sqlite");
  const std::vector<std::string> before = ContentOf(path);
  const pid_t child = ::fork();
  if (child == 0) {
    FillDisk();
    const auto store = Store::Open(path, Store::Mode::kRead);
    const bool is_named = !store && store.error().message().starts_with("cannot write " + path.string() + ": ");
    ::_exit(is_named ? ExitCode(store.error().code) : EXIT_FAILURE);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), ExitCode(StatusCode::kCannotWrite));
  EXPECT_EQ(Value(path, "PRAGMA user_version"), std::to_string(kVersions - 1));
  EXPECT_EQ(ContentOf(path), before);
}

TEST_F(GoldenStoresTest, SurviveAnUpgradeThatIsKilledBeforeAnyOfItsStatements) {
  for (int version = 1; version < kVersions; ++version) {
    const fs::path path = Make(version, "golden.sqlite");
    const std::vector<std::string> before = ContentOf(path);
    int kills = 0;
    while (OpenKilled(path, WatchStatements, kills + 1)) {
      ++kills;
      if (Value(path, "PRAGMA user_version") == std::to_string(version)) {
        EXPECT_EQ(ContentOf(path), before) << version << ": killed at " << kills;
      }
    }
    EXPECT_GT(kills, 8) << version;
    ExpectPresent(path, version);
  }
}

TEST_F(GoldenStoresTest, SurviveAnUpgradeOfAThousandRunsThatIsKilledTwentyTimes) {
  constexpr int kKills = 20;
  const fs::path path = MakeLarge("golden.sqlite");
  const std::string content =
      "SELECT id, exit_code, json_extract(result, '$.fits[0].parameters.inertia.estimate'), model, name, estimate, "
      "std_error FROM runs LEFT JOIN quantities USING(run) ORDER BY run, name";
  const std::vector<std::string> before = Rows(path, content);
  EXPECT_EQ(Value(path, "SELECT count(*) FROM runs WHERE id <> 'c'"), "999");
  fs::copy(path, folder_ / "probe.sqlite", fs::copy_options::overwrite_existing);
  int steps = 1;
  while (OpenKilled(folder_ / "probe.sqlite", WatchSteps, steps)) steps *= 2;
  int kills = 0;
  for (int kill = 1; kill <= kKills; ++kill) {
    kills += OpenKilled(path, WatchSteps, 1 + steps / 2 * kill / kKills) ? 1 : 0;
    EXPECT_EQ(Rows(path, content), before) << "killed " << kills << " times";
  }
  EXPECT_EQ(kills, kKills);
  ASSERT_TRUE(Store::Open(path, Store::Mode::kWrite));
  EXPECT_EQ(Rows(path, content), before);
  EXPECT_EQ(Value(path, "PRAGMA user_version"), std::to_string(kVersions));
  EXPECT_EQ(Value(path, "PRAGMA integrity_check"), "ok");
}

}  // namespace
}  // namespace pendulum::golden_stores_test
