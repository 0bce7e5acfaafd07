// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pendulum/batch/refit.h"
#include "pendulum/identify/identify.h"
#include "pendulum/report/json.h"
#include "tests/batch/small_batch.h"
#include "tests/batch/store_rows.h"

namespace pendulum::refit_folder {

/// A folder with a batch.
class RefitTest : public testing::Test {
 protected:
  RefitCounts RefitAll(const RefitOptions& options) const {
    return small_batch::RefitInto(folder_ / "store.sqlite", folder_ / "runs.csv", options);
  }

  /// Ids of the runs that a refit with these options would fit again, in order.
  std::vector<std::string> Refitted(const RefitOptions& options) const {
    const std::string mark = "UPDATE runs SET cpu = 'before'";
    SQLite::Database((folder_ / "store.sqlite").string(), SQLite::OPEN_READWRITE).exec(mark);
    RefitAll(options);
    return store_rows::Rows(folder_ / "store.sqlite", "SELECT id FROM runs WHERE cpu <> 'before' ORDER BY position");
  }

  std::string ValueOf(const std::string& query) const { return store_rows::Value(folder_ / "store.sqlite", query); }

  /// "5 path: why" for a run.
  std::string FailureOf(const std::string& id) const {
    return ValueOf("SELECT exit_code || ' ' || reason FROM runs WHERE id = '" + id + "'");
  }

  small_batch::Folder folder_{"refit_test"};
  const std::filesystem::path store_ = folder_ / "store.sqlite";
  const RefitOptions coulomb_ = small_batch::OptionsWith({"coulomb"});
};

/// The library's result of one recording, fitted alone, with the path as in the manifest.
inline std::string ResultAlone(const IdentifyOptions& options, const std::filesystem::path& file,
                               const std::optional<Rig>& rig, const std::string& path) {
  auto one = PrepareFile(file.string(), options, rig);
  if (!one) return one.error().message();
  const auto runs = IdentifyEach(options, *std::move(one));
  if (runs.size() != 1 || !runs.front()) return "not one run";
  nlohmann::ordered_json json = ToJson(*runs.front());
  EXPECT_EQ(json["recordings"][0]["path"], file.string());
  json["recordings"][0]["path"] = path;
  return json.dump();
}

}  // namespace pendulum::refit_folder
