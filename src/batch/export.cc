// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/export.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "batch/run_kinds.h"
#include "batch/sqlite.h"
#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/base/try.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

/// Columns of this query: 0 id, 1 path, 2 rig, 3 calibration, 4 from_s, 5 to_s, 6 models, 7 columns, 8 exit_code, 9
/// reason, 10 result, 11 stale, 12 former fits.
const std::string kRuns = R"sql(
SELECT id, path, rig, calibration, from_s, to_s, models, columns, exit_code, reason, result, )sql" +
                          kWhyStale + R"sql(,
    (SELECT json_group_array(json(json)) FROM fits WHERE fits.run = runs.run AND fits.stale IS NOT NULL
      HAVING count(*) > 0)
  FROM runs WHERE exit_code IS NOT NULL ORDER BY position, id)sql";

/// The manifest's data of a run, without missing columns.
Json ManifestJson(const SQLite::Statement& row) {
  Json json = {{"path", sqlite::Text(row, 1)}};
  constexpr std::array<std::pair<int, const char*>, 3> kTexts = {{{2, "rig"}, {3, "calibration"}, {6, "models"}}};
  for (const auto& [column, name] : kTexts) {
    if (const std::string text = sqlite::Text(row, column); !text.empty()) json[name] = text;
  }
  if (!row.getColumn(4).isNull()) json["from_s"] = row.getColumn(4).getDouble();
  if (!row.getColumn(5).isNull()) json["to_s"] = row.getColumn(5).getDouble();
  json.update(Json::parse(sqlite::Text(row, 7)));
  return json;
}

std::string JsonLine(const SQLite::Statement& row) {
  std::string line = "{\"id\":" + JsonText(sqlite::Text(row, 0)) + ",\"manifest\":" + JsonText(ManifestJson(row));
  if (!row.getColumn(11).isNull()) line += ",\"stale\":" + JsonText(sqlite::Text(row, 11));
  if (!row.getColumn(12).isNull()) line += ",\"former_fits\":" + sqlite::Text(row, 12);
  line += ",\"result\":";
  if (!row.getColumn(10).isNull()) return line + sqlite::Text(row, 10) + "}\n";
  const Json error = {{"exit_code", row.getColumn(8).getInt()}, {"message", sqlite::Text(row, 9)}};
  return line + "null,\"error\":" + JsonText(error) + "}\n";
}

/// Columns of table fits; the CSV columns have the same names.
constexpr std::array<const char*, 18> kStatistics = {
    "status",       "reason",     "used_samples", "effective_samples", "residual_unit",
    "rms_residual", "sigma",      "noise_model",  "lag1_correlation",  "log_likelihood",
    "aic",          "aicc",       "bic",          "durbin_watson",     "ljung_box_p",
    "runs_p",       "iterations", "evaluations"};

/// Columns of table quantities. The CSV column of the estimate is named after the quantity alone.
constexpr std::array<const char*, 6> kMembers = {"estimate", "std_error", "lower95", "upper95", "systematic_std_error",
                                                 "unit"};

/// A value of a row as a field: text unchanged, numbers as the shortest text that reads back exactly.
std::string FieldOf(const SQLite::Column& value) {
  if (value.isNull()) return "";
  if (value.isFloat()) return NumberText(value.getDouble());
  return CsvField(value.getString());
}

/// Number of CSV columns before the manifest's other columns: id, path, rig, calibration.
constexpr int kOfTheRun = 4;

/// The CSV table of a store.
class CsvTable {
 public:
  explicit CsvTable(SQLite::Database& database) : database_(database), members_(database, MembersQuery()) {
    columns_ = sqlite::Texts(database, sqlite::kManifestColumns);
    quantities_ = sqlite::Texts(database, "SELECT name FROM quantities GROUP BY name ORDER BY min(derived), name");
  }

  std::string Header() const {
    std::vector<std::string> ours = {"id", "path", "rig", "calibration", "model", "recommended", "stale"};
    ours.insert(ours.end(), kStatistics.begin(), kStatistics.end());
    for (const std::string& name : quantities_) {
      for (const char* member : kMembers) ours.push_back(NameOf(name, member));
    }
    std::vector<std::string> names = ours;
    std::string theirs;
    for (std::string name : columns_) {
      while (std::ranges::find(names, name) != names.end()) name.insert(0, "manifest_");
      names.push_back(name);
      theirs += "," + CsvField(name);
    }
    std::string line = ours.front();
    for (std::size_t i = 1; i < ours.size(); ++i) {
      if (i == kOfTheRun) line += theirs;
      line += "," + CsvField(ours[i]);
    }
    return line + "\n";
  }

  /// Writes one row per fit.
  Result<void> Rows(const TextSink& take) {
    std::string query =
        "SELECT fits.run, id, path, rig, calibration, columns, fits.model, recommended = fits.model, coalesce(" +
        kWhyStale + ", fits.stale)";
    for (const char* name : kStatistics) query += std::string(", fits.") + name;
    SQLite::Statement fits(database_, query + " FROM runs JOIN fits USING(run) ORDER BY position, id, fits.model");
    while (fits.executeStep()) {
      RETURN_IF_ERROR(take(Row(fits)));
    }
    return {};
  }

 private:
  static std::string NameOf(const std::string& quantity, const std::string& member) {
    return member == kMembers.front() ? quantity : quantity + "_" + member;
  }

  static std::string MembersQuery() {
    std::string query = "SELECT name";
    for (const char* member : kMembers) query += std::string(", ") + member;
    return query + " FROM quantities WHERE run = ? AND model = ?";
  }

  std::string Row(const SQLite::Statement& fit) {
    std::string line = FieldOf(fit.getColumn(1));
    for (int i = 2; i <= kOfTheRun; ++i) line += "," + FieldOf(fit.getColumn(i));
    const Json columns = Json::parse(sqlite::Text(fit, kOfTheRun + 1));
    for (const std::string& name : columns_) {
      const auto found = columns.find(name);
      line += "," + (found == columns.end() ? "" : CsvField(found->get<std::string>()));
    }
    constexpr int kFirst = kOfTheRun + 2;
    for (int i = kFirst; i < fit.getColumnCount(); ++i) line += "," + FieldOf(fit.getColumn(i));
    return line + Quantities(fit.getColumn(0).getInt64(), sqlite::Text(fit, kFirst)) + "\n";
  }

  std::string Quantities(std::int64_t run, const std::string& model) {
    std::map<std::string, std::string> fields;
    sqlite::Bind(members_, run, model);
    while (members_.executeStep()) {
      std::string& list = fields[sqlite::Text(members_, 0)];
      for (int i = 1; i < members_.getColumnCount(); ++i) list += "," + FieldOf(members_.getColumn(i));
    }
    std::string line;
    for (const std::string& name : quantities_) {
      const auto found = fields.find(name);
      line += found == fields.end() ? std::string(kMembers.size(), ',') : found->second;
    }
    return line;
  }

  SQLite::Database& database_;
  SQLite::Statement members_;
  std::vector<std::string> columns_, quantities_;
};

}  // namespace

std::string CsvField(std::string_view text) {
  if (text.find_first_of("\",;\t\r\n") == std::string_view::npos && !text.starts_with(' ') && !text.ends_with(' ')) {
    return std::string(text);
  }
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + '"';
}

Result<void> ExportJsonLines(Store& store, const TextSink& take) {
  return sqlite::Guard(store.name(), [&]() -> Result<void> {
    SQLite::Statement runs(store.database(), kRuns);
    while (runs.executeStep()) {
      RETURN_IF_ERROR(take(JsonLine(runs)));
    }
    return {};
  });
}

Result<void> ExportCsv(Store& store, const TextSink& take) {
  return sqlite::Guard(store.name(), [&]() -> Result<void> {
    CsvTable table(store.database());
    RETURN_IF_ERROR(take(table.Header()));
    return table.Rows(take);
  });
}

}  // namespace pendulum
