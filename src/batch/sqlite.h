// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cerrno>
#include <stdexcept>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sqlite3.h>
#include <unistd.h>

#include "pendulum/base/file.h"
#include "pendulum/base/status.h"

/// Helpers for SQLite in the stores. Guard converts exceptions of SQLite to errors.
namespace pendulum::sqlite {

inline tl::unexpected<Status> Damaged(const std::string& name, const std::string& words) {
  return Fault(name, "the file is damaged (" + words + "); restore it, or start with a new file");
}

/// Converts an exception of SQLite to an error about the file `name`.
inline tl::unexpected<Status> ErrorFromSqlite(const std::string& name, const SQLite::Exception& error) {
  const std::string words = error.what();
  switch (error.getErrorCode() & 0xff) {  // the primary code; a backup throws extended ones
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return ErrorAt(StatusCode::kTryAgain, name, "another process uses it; try again when that process is done");
    case SQLITE_NOTADB: return Fault(name, "this is not an SQLite file; name an SQLite file");
    case SQLITE_CORRUPT: return Damaged(name, words);
    case SQLITE_FULL:
    case SQLITE_IOERR:
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM: return Error(StatusCode::kCannotWrite, "cannot write " + name + ": " + words);
    default: return ErrorAt(StatusCode::kInternal, name, words);
  }
}

/// A path in a form that SQLite does not take for a URI or ":memory:".
inline std::string FileName(const std::string& path) { return path.starts_with('/') ? path : "./" + path; }

/// Gives a permission error its own message; SQLite reports only that the file cannot be opened.
inline Result<void> CheckReadable(const std::string& name) {
  if (::faccessat(AT_FDCWD, name.c_str(), R_OK, AT_EACCESS) == 0 || errno != EACCES) return {};
  return Fault(name, "the file cannot be read; check its permissions");
}

/// The result of `work`, or SQLite's error about the file `name`. Content that cannot be parsed means a damaged file.
template <typename Work>
auto Guard(const std::string& name, const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const SQLite::Exception& error) {
    return ErrorFromSqlite(name, error);
  } catch (const nlohmann::json::exception& error) {
    return Damaged(name, error.what());
  } catch (const std::logic_error& error) {  // from std::stoll
    return Damaged(name, error.what());
  }
}

/// Binds values to the first parameters of a statement, in order. Empty optionals and the remaining parameters become
/// NULL.
template <typename... Values>
SQLite::Statement& Bind(SQLite::Statement& statement, const Values&... values) {
  (void)statement.tryReset();  // an error of its last step was already reported
  statement.clearBindings();
  int place = 0;
  const auto bind = [&](const auto& value) {
    ++place;
    if constexpr (requires { value.has_value(); }) {
      value ? statement.bind(place, *value) : statement.bind(place);
    } else {
      statement.bind(place, value);
    }
  };
  (bind(values), ...);
  return statement;
}

/// The text of a column in the current row of a statement; empty for NULL.
inline std::string Text(const SQLite::Statement& statement, int column) {
  const SQLite::Column value = statement.getColumn(column);
  return value.isNull() ? "" : value.getString();
}

/// The first column of all rows of a query.
inline std::vector<std::string> Texts(SQLite::Database& database, const std::string& query) {
  SQLite::Statement rows(database, query);
  std::vector<std::string> texts;
  while (rows.executeStep()) texts.push_back(Text(rows, 0));
  return texts;
}

/// Names of the additional manifest columns in a store.
inline constexpr const char* kManifestColumns = "SELECT DISTINCT key FROM runs, json_each(runs.columns) ORDER BY key";

}  // namespace pendulum::sqlite
