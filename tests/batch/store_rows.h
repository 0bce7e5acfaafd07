// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>

#include "pendulum/base/sha256.h"

/// The content of a store, read with SQLite alone.
namespace pendulum::store_rows {

/// A value as text; two texts are equal only if the values are equal bit for bit.
inline std::string ValueText(const SQLite::Column& value) {
  if (value.isNull()) return "NULL";
  if (!value.isFloat()) return value.getString();
  constexpr std::size_t kMaxCharacters = 64;
  std::array<char, kMaxCharacters> text{};
  std::snprintf(text.data(), text.size(), "%a", value.getDouble());
  return text.data();
}

/// The rows of a query, with values separated by bars.
inline std::vector<std::string> Rows(const std::filesystem::path& store, const std::string& query) {
  const SQLite::Database database(store.string(), SQLite::OPEN_READONLY);
  SQLite::Statement rows(database, query);
  std::vector<std::string> texts;
  while (rows.executeStep()) {
    texts.emplace_back();
    for (int i = 0; i < rows.getColumnCount(); ++i) {
      texts.back() += (i > 0 ? "|" : "") + ValueText(rows.getColumn(i));
    }
  }
  return texts;
}

/// The single value of a query.
inline std::string Value(const std::filesystem::path& store, const std::string& query) {
  const std::vector<std::string> rows = Rows(store, query);
  return rows.size() == 1 ? rows.front() : std::to_string(rows.size()) + " rows";
}

/// All rows about runs, ordered by id, with a hash of each result. Internal run numbers and fits of models that are no
/// longer asked for are left out.
inline std::vector<std::string> AllRows(const std::filesystem::path& store) {
  std::vector<std::string> all = Rows(store,
                                      "SELECT id, position, path, rig, calibration, from_s, to_s, models, columns, "
                                      "exit_code, reason, recommended, data_sha256, rig_sha256, calibration_sha256, "
                                      "options_sha256, version, cpu, result FROM runs ORDER BY id");
  for (std::string& row : all) {
    const std::size_t result = row.rfind("|{\"schema_version\"");
    if (result != std::string::npos) row.replace(result + 1, std::string::npos, *Sha256(row.substr(result + 1)));
  }
  for (const char* table : {"fits", "quantities"}) {
    for (const std::string& row : Rows(store, std::string("SELECT id, theirs.* FROM ") + table +
                                                  " AS theirs JOIN runs USING(run) JOIN fits AS fit USING(run, model) "
                                                  "WHERE fit.stale IS NULL ORDER BY id, 3, 4")) {
      // The second value is the run's number.
      const std::size_t begin = row.find('|');
      all.push_back(std::string(table) + "|" + row.substr(0, begin) + row.substr(row.find('|', begin + 1)));
    }
  }
  return all;
}

}  // namespace pendulum::store_rows
