// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pendulum/batch/source.h"
#include "pendulum/batch/store.h"
#include "tests/batch/small_batch.h"

namespace pendulum::made_store {

/// A manifest of `runs` runs with additional columns.
inline std::string ManifestOf(std::size_t runs, const std::string& columns,
                              const std::function<std::string(std::size_t)>& values) {
  std::string text = "path" + columns + "\n";
  for (std::size_t i = 0; i < runs; ++i) text += "run" + std::to_string(i) + ".csv" + values(i) + "\n";
  return text;
}

inline std::string PlainManifest(std::size_t runs) {
  return ManifestOf(runs, "", [](std::size_t) { return ""; });
}

/// A store with runs made by hand.
class MadeStoreTest : public testing::Test {
 protected:
  /// Begins a batch of that manifest. Stores the outcome make(position) of each run; if it is std::nullopt, the run
  /// stays pending, and the refit is not complete.
  Store StoreOf(const std::string& manifest, const std::function<std::optional<RunOutcome>(std::size_t)>& make) const {
    folder_.Write("runs.csv", manifest);
    const auto source = OpenSource(folder_ / "runs.csv");
    auto store = Store::Open(folder_ / "store.sqlite", Store::Mode::kWrite);
    const auto begun = store->Begin(*source, std::nullopt, "{}");
    EXPECT_TRUE(begun) << begun.error().message();
    const auto runs = store->Next(0, 100000);
    bool is_complete = true;
    for (std::size_t i = 0; i < runs->size(); ++i) {
      const auto outcome = make(i);
      is_complete = is_complete && outcome;
      EXPECT_TRUE(!outcome || store->Put((*runs)[i].entry.id, *outcome));
    }
    EXPECT_TRUE(is_complete ? store->Complete() : store->Commit());
    return *std::move(store);
  }

  small_batch::Folder folder_{"made_store"};
};

}  // namespace pendulum::made_store
