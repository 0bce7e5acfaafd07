// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pendulum/batch/refit.h"
#include "pendulum/batch/source.h"
#include "pendulum/batch/store.h"

/// Batches without files, and outcomes for a store.
namespace pendulum::example_runs {

/// A source of entries without files; the first entry is on line 2.
inline Source SourceOf(std::vector<ManifestEntry> entries) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    entries[i].position = static_cast<std::int64_t>(i);
    entries[i].place = "runs.csv:" + std::to_string(i + 2);
  }
  const auto for_each = [entries](const EntrySink& take) -> Result<void> {
    for (const ManifestEntry& entry : entries) {
      if (auto taken = take(entry); !taken) return taken;
    }
    return {};
  };
  return {"runs.csv", for_each,
          [](const std::string& path) -> Result<std::string> { return Error(StatusCode::kNotFound, path); }};
}

/// Entries with these ids and the files ID.csv.
inline Source SourceOfIds(const std::vector<std::string>& ids) {
  std::vector<ManifestEntry> entries;
  for (const std::string& id : ids) {
    entries.emplace_back();
    entries.back().id = id;
    entries.back().path = id + ".csv";
  }
  return SourceOf(entries);
}

/// The outcome of a refit of datasets/runs_1.csv with two models.
inline const RunOutcome& RefittedOutcome() {
  static const RunOutcome outcome = [] {
    RefitOptions options;
    options.run.models = {"viscous", "coulomb"};
    options.run.fit.model = "viscous";
    ManifestEntry entry;
    entry.id = entry.path = "datasets/runs_1.csv";
    entry.rig = "datasets/textbook_rig.json";
    return RefitRun(FindSource({entry.path}).value(), entry, options);
  }();
  return outcome;
}

/// The outcome of a refit of a missing file with the same models.
inline RunOutcome UnfittedOutcome() {
  RunOutcome outcome;
  outcome.provenance = {"", "rig", "", "options", "0.1.0", "cpu"};
  outcome.exit_code = 3;
  outcome.reason = {"none.csv", "there is no such file; check the path"};
  outcome.models = {"viscous", "coulomb"};
  return outcome;
}

/// A new store for the entries of that source.
inline Store StoreOf(const std::string& path, const Source& source) {
  Store store = Store::Open(path, Store::Mode::kWrite).value();
  const auto begun = store.Begin(source, std::nullopt, "{}");
  EXPECT_TRUE(begun) << begun.error().message();
  return store;
}

}  // namespace pendulum::example_runs
