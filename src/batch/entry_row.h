// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "batch/sqlite.h"
#include "pendulum/batch/manifest.h"

namespace pendulum {

/// The entry of a row that begins with the columns position, id, path, rig, calibration, from_s, to_s, models, columns.
inline ManifestEntry EntryOf(const SQLite::Statement& row) {
  const auto number = [&](int column) {
    return row.getColumn(column).isNull() ? std::nullopt : std::optional(row.getColumn(column).getDouble());
  };
  ManifestEntry entry;
  entry.position = row.getColumn(0).getInt64();
  entry.id = sqlite::Text(row, 1);
  entry.path = sqlite::Text(row, 2);
  entry.rig = sqlite::Text(row, 3);
  entry.calibration = sqlite::Text(row, 4);
  entry.from = number(5);
  entry.to = number(6);
  entry.models = sqlite::Text(row, 7);
  entry.columns = sqlite::Text(row, 8);
  return entry;
}

}  // namespace pendulum
