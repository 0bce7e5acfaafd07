// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/manifest.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/base/try.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/recording/readers/columns/line_reader.h"

namespace pendulum {
namespace {

/// The fields of a row, and the line where it begins.
struct Row {
  std::vector<std::string> fields;
  std::size_t line = 0;
};

/// Rows of CSV text (RFC 4180), also with another separator: the first of comma, semicolon and tab outside quotes in
/// the first line. Blanks around a field that is not in quotes do not belong to it.
class CsvRows {
 public:
  explicit CsvRows(InputFile file) : lines_(std::move(file)) {}

  const std::string& name() const { return lines_.name(); }

  /// Reads the next row that is not blank; false at the end.
  Result<bool> Next(Row& row) {
    row = {};
    std::size_t bytes = 0;
    while (true) {
      ASSIGN_OR_RETURN(const bool next, lines_.Next());
      if (!next && place_ == Place::kInQuotes) {
        return RowFault(row,
                        "a field begins with a double quote that is never closed; close it, or double a quote that "
                        "belongs to the text");
      }
      if (!next) return false;
      const bool is_first = place_ != Place::kInQuotes;
      const char* const blanks = separator_ == '\t' ? " " : " \t";
      if (is_first && lines_.line().find_first_not_of(blanks) == std::string::npos) continue;
      if (is_first) row.line = lines_.number();
      if (separator_ == 0) ChooseSeparator(lines_.line());
      bytes += lines_.line().size();
      if (bytes > kLongestRow) {
        return RowFault(row,
                        "the row that begins here is longer than 16 MiB; check for a double quote that is not closed");
      }
      RETURN_IF_ERROR(AddLine(lines_.line(), row));
      if (place_ != Place::kInQuotes) return true;
      field_ += '\n';
    }
  }

 private:
  /// Before a field, within one, within quotes, behind them.
  enum class Place { kBefore, kInField, kInQuotes, kBehindQuotes };

  void ChooseSeparator(std::string_view header) {
    bool quoted = false;
    separator_ = ',';
    for (const char c : header) {
      if (c == '"') quoted = !quoted;
      if (quoted || (c != ',' && c != ';' && c != '\t')) continue;
      separator_ = c;
      return;
    }
  }

  /// Adds the fields that end in the line; one in quotes may go on in the next.
  Result<void> AddLine(std::string_view line, Row& row) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      const char c = line[i];
      if (place_ == Place::kInQuotes) {
        if (c != '"') {
          field_ += c;
        } else if (i + 1 < line.size() && line[i + 1] == '"') {
          field_ += line[++i];
        } else {
          place_ = Place::kBehindQuotes;
        }
      } else if (c == separator_) {
        EndField(row);
      } else if (c == '\r') {
        return LineFault("there is a carriage return within the line; end lines with LF or CRLF");
      } else if (c == '"' && place_ == Place::kBefore) {
        place_ = Place::kInQuotes;
      } else if (c == '"' || (place_ == Place::kBehindQuotes && c != ' ' && c != '\t')) {
        return LineFault(
            "there is a double quote inside a field; put the whole field in quotes and double its own quotes");
      } else if (place_ == Place::kInField || (place_ == Place::kBefore && c != ' ' && c != '\t')) {
        place_ = Place::kInField;
        field_ += c;
      }
    }
    if (place_ != Place::kInQuotes) EndField(row);
    return {};
  }

  void EndField(Row& row) {
    if (place_ == Place::kInField) field_.erase(field_.find_last_not_of(" \t") + 1);
    row.fields.push_back(std::exchange(field_, {}));
    place_ = Place::kBefore;
  }

  Result<bool> RowFault(const Row& row, const std::string& why) const {
    return Fault(name() + ":" + std::to_string(row.line), why);
  }
  Result<void> LineFault(const std::string& why) const {
    return Fault(name() + ":" + std::to_string(lines_.number()), why);
  }

  static constexpr std::size_t kLongestRow = std::size_t{16} << 20;  // bytes

  LineReader lines_;
  char separator_ = 0;  // 0: not chosen yet
  std::string field_;
  Place place_ = Place::kBefore;
};

/// Columns with a meaning; other columns are kept as they are.
constexpr std::array<std::string_view, 7> kColumns = {"path", "id", "rig", "calibration", "from_s", "to_s", "models"};

/// Spellings that are meant as a column with a meaning, in small letters and digits alone: "rigfile" for "Rig_File".
/// Other names are labels: rig_id tells pendulums apart.
struct Misspellings {
  std::string_view column;
  std::vector<std::string_view> spellings;
};

const std::vector<Misspellings>& KnownMisspellings() {
  static const std::vector<Misspellings> known = {
      {"path", {"path", "paths", "filepath", "filepaths"}},
      {"id", {"id", "ids"}},
      {"rig", {"rig", "rigs", "rigfile", "rigfiles", "rigpath", "rigjson"}},
      {"calibration",
       {"calibration", "calibrations", "calibrationfile", "calibrationfiles", "calibrationpath", "calibrationjson",
        "calib", "calibs", "calibfile", "calibpath", "cal", "calfile", "calpath"}},
      {"from_s", {"from", "froms", "fromsec", "fromsecond", "fromseconds", "fromtime", "fromtimes"}},
      {"to_s", {"to", "tos", "tosec", "tosecond", "toseconds", "totime", "totimes"}},
      {"models", {"model", "models"}}};
  return known;
}

/// The column that a name is a misspelling of; empty if it is none.
std::string_view MisspelledColumn(std::string_view name) {
  std::string letters;
  for (const char c : name) {
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) letters += c;
    if (c >= 'A' && c <= 'Z') letters += static_cast<char>(c - 'A' + 'a');
  }
  for (const auto& [column, spellings] : KnownMisspellings()) {
    if (name != column && std::ranges::find(spellings, letters) != spellings.end()) return column;
  }
  return {};
}

/// Refuses names that would be labels without a meaning, though they are meant as columns with one. A name is a label
/// if the header has the right column, too.
Result<void> CheckSpelling(const std::string& where, const std::vector<std::string>& names) {
  std::vector<std::string> wrong;
  for (const std::string& name : names) {
    const std::string_view column = MisspelledColumn(name);
    if (column.empty() || std::ranges::find(names, column) != names.end()) continue;
    wrong.push_back(Quoted(name) + " to " + std::string(column));
  }
  if (wrong.empty()) return {};
  return Fault(where, std::string(wrong.size() == 1 ? "a column has" : "columns have") +
                          " nearly the name of a column with a meaning; rename " + NameList(wrong) +
                          (wrong.size() == 1 ? ", or choose another name if it is a label"
                                             : ", or choose other names if they are labels"));
}

/// The header, and the conversion of rows to entries.
class Header {
 public:
  static Result<Header> Make(const std::string& file, Row row) {
    Header header(file, std::move(row.fields));
    const std::string where = file + ":" + std::to_string(row.line);
    for (std::size_t i = 0; i < header.names_.size(); ++i) {
      const std::string& name = header.names_[i];
      if (std::ranges::count(header.names_, name) > 1) {
        return Fault(where, "the header has the column " + Quoted(name) + " twice; rename one of them");
      }
    }
    RETURN_IF_ERROR(CheckSpelling(where, header.names_));
    if (std::ranges::find(header.names_, "path") == header.names_.end()) {
      return Fault(where, "the header has no column path, only " + Quoted(NameList(header.names_)) +
                              "; the column path names the recordings");
    }
    return header;
  }

  Result<ManifestEntry> Entry(const Row& row, std::int64_t position) const {
    const std::string where = file_ + ":" + std::to_string(row.line);
    if (row.fields.size() != names_.size()) {
      return Fault(where, "the row has " + std::to_string(row.fields.size()) + " fields, the header " +
                              std::to_string(names_.size()) + "; put a field that contains a separator in quotes");
    }
    ManifestEntry entry;
    entry.position = position;
    entry.place = where;
    nlohmann::ordered_json columns = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const auto* const known = std::ranges::find(kColumns, names_[i]);
      if (known == kColumns.end()) {
        columns[names_[i]] = row.fields[i];
      } else if (const auto set = SetField(*known, row.fields[i], entry); !set) {
        return Fault(where + ": column " + names_[i], set.error().message());
      }
    }
    if (entry.id.empty()) entry.id = entry.path;
    entry.columns = JsonText(columns);
    if (entry.from && entry.to && *entry.from >= *entry.to) {
      return Fault(where, "from_s " + NumberText(*entry.from) + " is not before to_s " + NumberText(*entry.to));
    }
    return entry;
  }

 private:
  Header(std::string file, std::vector<std::string> names) : file_(std::move(file)), names_(std::move(names)) {}

  static Result<void> SetTime(const std::string& field, std::optional<double>& time) {
    if (field.empty()) return {};
    double number = 0;
    const char* end = field.data() + field.size();
    const auto [rest, error] = std::from_chars(field.data(), end, number);
    if (error != std::errc() || rest != end || !std::isfinite(number)) {
      return Error(StatusCode::kDataLoss, Quoted(field) + " is not a time in seconds on the file's clock");
    }
    time = number;
    return {};
  }

  static Result<void> SetField(std::string_view column, const std::string& field, ManifestEntry& entry) {
    if (column == "path" && field.empty()) {
      return Error(StatusCode::kDataLoss, "it is empty; name a recording or delete the row");
    }
    if (column == "path") entry.path = field;
    if (column == "id") entry.id = field;
    if (column == "rig") entry.rig = field;
    if (column == "calibration") entry.calibration = field;
    if (column == "models") {
      entry.models = field;
      if (const auto models = FindMotionModels(field); !field.empty() && !models) {
        return tl::unexpected(models.error());
      }
    }
    if (column == "from_s") return SetTime(field, entry.from);
    if (column == "to_s") return SetTime(field, entry.to);
    return {};
  }

  std::string file_;
  std::vector<std::string> names_;
};

}  // namespace

Result<void> ReadManifest(const std::filesystem::path& path, const EntrySink& take) {
  ASSIGN_OR_RETURN(InputFile file, path == "-" ? InputFile::StandardInput() : InputFile::Open(path, "manifest"));
  CsvRows rows(std::move(file));
  Row row;
  auto next = rows.Next(row);
  if (!next) return tl::unexpected(next.error());
  if (!*next) return Fault(rows.name(), "the manifest is empty; its first line names the columns, such as path,id");
  ASSIGN_OR_RETURN(const auto header, Header::Make(rows.name(), std::move(row)));
  for (std::int64_t position = 0;; ++position) {
    next = rows.Next(row);
    if (!next) return tl::unexpected(next.error());
    if (!*next) return {};
    ASSIGN_OR_RETURN(const auto entry, header.Entry(row, position));
    RETURN_IF_ERROR(take(entry));
  }
}

}  // namespace pendulum
