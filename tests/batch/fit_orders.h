// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "pendulum/batch/fit_store.h"
#include "tests/batch/small_batch.h"

/// Requests to a service made by hand, and a store for them.
namespace pendulum::fit_orders {

inline constexpr const char* kCreated = "2026-11-23T21:40:05Z";

/// An order for a run ID.csv whose only line is its id.
inline FitOrder OrderOf(const std::string& id, const std::string& created = kCreated) {
  return {id, created, R"({"model":"viscous"})", {{id + ".csv", id + "\n"}, {}, {}}};
}

inline std::vector<FitOrder> OrdersOf(const std::vector<std::string>& ids) {
  std::vector<FitOrder> orders;
  for (const std::string& id : ids) orders.push_back(OrderOf(id));
  return orders;
}

/// A store in a separate folder, and another connection to its file.
class FitStoreFolder : public testing::Test {
 protected:
  FitStore& Store() {
    if (!store_) Open();
    return *store_;
  }

  void Open() {
    store_.reset();
    auto store = FitStore::Open(path_);
    ASSERT_TRUE(store) << store.error().message();
    store_ = *std::move(store);
  }

  void Close() { store_.reset(); }

  /// The number that another reader of the file gets.
  std::int64_t NumberOutside(const std::string& query) const {
    return SQLite::Database(path_, SQLite::OPEN_READONLY).execAndGet(query).getInt64();
  }

  const small_batch::Folder folder_{"fit_store"};
  const std::string path_ = folder_ / "fits.sqlite";

 private:
  std::unique_ptr<FitStore> store_;
};

/// Ids in the order of the runs.
inline std::vector<std::string> IdsOf(const std::vector<ListedFit>& fits) {
  std::vector<std::string> ids;
  for (const ListedFit& fit : fits) ids.push_back(fit.id);
  return ids;
}

}  // namespace pendulum::fit_orders
