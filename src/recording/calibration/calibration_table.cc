// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/calibration/calibration_table.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/recording/readers/columns/line_reader.h"
#include "recording/readers/columns/column.h"
#include "recording/readers/columns/column_choice.h"
#include "recording/readers/columns/csv.h"
#include "recording/readers/text/head.h"

namespace pendulum {
namespace {

using csv::FieldCutter, csv::Kind, csv::Line, csv::Trim, csv::Unquote;
using Check = Result<void>;
using Eigen::Index;

/// Reads one text, line by line.
class TableReader {
 public:
  explicit TableReader(LineReader lines) : lines_(std::move(lines)) {}

  Result<CalibrationTable> Read();

 private:
  Check ReadLine();
  Check ReadHeader();
  Check CheckUnits(const std::vector<csv::Name>& names) const;
  Check FindColumn(const std::vector<csv::Name>& names, Kind kind, csv::Column& column) const;
  Check ReadRow();
  Check ReadField(std::string_view field, const csv::Column& column, double& number);
  Check CheckEnd() const;

  LineReader lines_;
  Line line_;
  char separator_ = '\0';  // From the line `sep=`, or from the header.
  std::size_t width_ = 0;  // Number of columns; 0 before the header.
  csv::Column reading_, angle_;
  csv::Numbers numbers_;
  std::vector<double> readings_, angles_;
  std::vector<std::size_t> row_lines_;
};

Result<CalibrationTable> TableReader::Read() {
  RETURN_IF_ERROR(csv::ForEachLine(lines_, line_, [this] { return ReadLine(); }));
  RETURN_IF_ERROR(CheckEnd());
  CalibrationTable table;
  table.path = lines_.name();
  table.input = reading_.unit->name;
  table.angle_unit = angle_.unit->name;
  table.reading = Eigen::Map<const Eigen::VectorXd>(readings_.data(), static_cast<Index>(readings_.size()));
  table.angle = Eigen::Map<const Eigen::VectorXd>(angles_.data(), static_cast<Index>(angles_.size()));
  table.line = std::move(row_lines_);
  return MakeCalibrationTable(std::move(table));
}

Check TableReader::ReadLine() {
  if (csv::IsEmptyRow(line_.text) || Trim(line_.text).front() == '#') return {};
  if (width_ > 0) return ReadRow();
  if (const auto separator = csv::SeparatorLine(line_.text)) {
    separator_ = *separator;
    return {};
  }
  return ReadHeader();
}

Check TableReader::ReadHeader() {
  if (separator_ == '\0') separator_ = csv::Separator(line_.text);
  const std::vector<csv::Name> names = csv::SplitHeader(line_.text, separator_);
  if (std::ranges::none_of(names, [](const csv::Name& name) { return csv::IsName(name.text); })) {
    return line_.Fault(line_.text.data(),
                       "the first row has numbers instead of column names; put a header above it that gives the units, "
                       "such as counts,angle_deg");
  }
  RETURN_IF_ERROR(CheckUnits(names));
  RETURN_IF_ERROR(FindColumn(names, Kind::kRaw, reading_));
  RETURN_IF_ERROR(FindColumn(names, Kind::kAngle, angle_));
  numbers_ = csv::Numbers(separator_ != ',');
  width_ = names.size();
  return {};
}

/// The unit at the end of a name, even if a recording would not use it as a unit: delay_s.
const csv::Unit* UnitOf(const csv::Name& name) { return csv::MeaningOf(name.text).unit; }

/// Checks that every column has at most one unit, and that the table has the two required ones.
Check TableReader::CheckUnits(const std::vector<csv::Name>& names) const {
  for (const csv::Name& name : names) {
    const csv::Unit* unit = UnitOf(name);
    const csv::Unit* second = csv::MeaningOf(name.text).second;
    if (unit == nullptr) continue;
    const std::string column = "column " + Quoted(name.text);
    if (unit->kind != Kind::kRaw && unit->kind != Kind::kAngle) {
      return line_.Fault(
          name.at,
          column + " is in " + std::string(unit->name) +
              ", but a calibration table has readings in counts or volts and angles in deg or rad; delete this column");
    }
    if (second != nullptr && second != unit) {
      return line_.Fault(name.at, column + " names two units, " + std::string(second->name) + " and " +
                                      std::string(unit->name) + "; keep the unit of its values");
    }
  }
  return {};
}

Check TableReader::FindColumn(const std::vector<csv::Name>& names, Kind kind, csv::Column& column) const {
  const bool is_reading = kind == Kind::kRaw;
  const std::string role = is_reading ? "the reading" : "the angle";
  const csv::Name* found = nullptr;
  for (const csv::Name& name : names) {
    const csv::Unit* unit = UnitOf(name);
    if (unit == nullptr || unit->kind != kind) continue;
    if (found != nullptr) {
      return line_.Fault(name.at, "columns " + Quoted(found->text) + " and " + Quoted(name.text) + " could both be " +
                                      role + "; delete one of them");
    }
    found = &name;
    column = {static_cast<std::size_t>(&name - names.data()), Quoted(name.text), unit};
  }
  if (found != nullptr) return {};
  return line_.Fault(line_.text.data(), "no column's name shows that it is " + role + "; end the name in its unit, " +
                                            (is_reading ? "_counts or _volts" : "_deg or _rad"));
}

Check TableReader::ReadRow() {
  if (static_cast<Index>(readings_.size()) == kMaxCalibrationPoints) {
    return line_.Fault(line_.text.data(), "there are more than " + std::to_string(kMaxCalibrationPoints) +
                                              " rows; a calibration table has one row for each angle");
  }
  double reading = 0, angle = 0;
  std::size_t index = 0;
  for (FieldCutter fields(line_.text, separator_); !fields.done(); ++index) {
    const std::string_view field = fields.Next();
    if (index == reading_.index || index == angle_.index) {
      const bool is_reading = index == reading_.index;
      Check read = ReadField(field, is_reading ? reading_ : angle_, is_reading ? reading : angle);
      if (!read) return read;
    } else if (index >= width_ && !Trim(field).empty()) {
      return line_.Fault(Trim(field).data(), "field " + std::to_string(index + 1) + " holds " + Quoted(Trim(field)) +
                                                 " beyond the header's " + std::to_string(width_) +
                                                 " columns; name every column, and write decimals with a point");
    }
  }
  if (index <= std::max(reading_.index, angle_.index)) {
    return line_.Fault(line_.text.data() + line_.text.size(), "the row ends after " + std::to_string(index) + " of " +
                                                                  std::to_string(width_) +
                                                                  " fields; complete the row or delete it");
  }
  readings_.push_back(reading);
  angles_.push_back(angle);
  row_lines_.push_back(line_.number);
  return {};
}

Check TableReader::ReadField(std::string_view field, const csv::Column& column, double& number) {
  const std::string_view text = Unquote(field);
  if (numbers_.Parse(text, number)) return {};
  return line_.Fault(Trim(field).data(), "column " + column.name + " " + numbers_.NumberFault(text));
}

Check TableReader::CheckEnd() const {
  if (!readings_.empty()) return {};
  const Line last{lines_.name(), "", lines_.number()};
  const std::string lack = lines_.is_empty() ? "the file is empty"
                           : width_ == 0     ? "the file names no column"
                                             : "the header is followed by no row";
  return last.Fault(last.text.data(),
                    lack + "; a calibration table has a header such as counts,angle_deg and a row for each angle");
}

// ---- Requirements of a table -------------------------------------------------------------------------------------

/// "261 counts (line 5)"
std::string ReadingAt(const CalibrationTable& table, Index point) {
  return NumberText(table.reading[point]) + " " + table.input + " (line " + std::to_string(table.line[point]) + ")";
}

tl::unexpected<Status> FaultAt(const CalibrationTable& table, Index point, const std::string& sentence) {
  return Fault(table.Place(point), sentence);
}

/// The two points, first the one that is later in the file.
std::pair<Index, Index> LaterPointFirst(Index one, Index other) { return {std::max(one, other), std::min(one, other)}; }

Check CheckReadingsDiffer(const CalibrationTable& table, const std::vector<Index>& order) {
  for (std::size_t i = 1; i < order.size(); ++i) {
    const auto [later, earlier] = LaterPointFirst(order[i - 1], order[i]);
    if (table.reading[later] != table.reading[earlier]) continue;
    const bool same = table.angle[later] == table.angle[earlier];
    return FaultAt(table, later,
                   "the reading " + ReadingAt(table, earlier) + " is repeated with " +
                       (same ? "the same angle; give their mean, or delete one of the rows"
                             : "another angle; give their mean, or correct or delete one of the rows"));
  }
  return {};
}

/// The majority of steps determines whether angles rise or fall with the readings; any other step is a mistake.
Check CheckAnglesRiseOrFall(const CalibrationTable& table, const std::vector<Index>& order) {
  const auto step = [&](std::size_t i) { return table.angle[order[i]] - table.angle[order[i - 1]]; };
  int balance = 0;
  bool all_equal = true;
  for (std::size_t i = 1; i < order.size(); ++i) {
    balance += (step(i) > 0 ? 1 : 0) - (step(i) < 0 ? 1 : 0);
    all_equal = all_equal && step(i) == 0;
  }
  if (all_equal) return FaultAt(table, table.size() - 1, "all angles up to here are the same; set different angles");
  const bool rises = balance >= 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (rises ? step(i) >= 0 : step(i) <= 0) continue;
    const auto [later, earlier] = LaterPointFirst(order[i - 1], order[i]);
    return FaultAt(table, later,
                   "the angle is " + NumberText(table.angle[later]) + " " + table.angle_unit + " at " +
                       ReadingAt(table, later) + " and " + NumberText(table.angle[earlier]) + " at " +
                       ReadingAt(table, earlier) + ", but elsewhere it " + (rises ? "rises" : "falls") +
                       " as the reading rises; correct or delete one of these rows");
  }
  return {};
}

}  // namespace

std::vector<Index> CalibrationTable::ByReading() const {
  std::vector<Index> order(size());
  std::iota(order.begin(), order.end(), Index{0});
  std::ranges::stable_sort(order, {}, [this](Index point) { return reading[point]; });
  return order;
}

Result<CalibrationTable> MakeCalibrationTable(CalibrationTable table) {
  if (table.size() < 2) {
    return Fault(table.size() == 0 ? table.path : table.Place(0),
                 "points found: " + std::to_string(table.size()) + "; a calibration needs at least 2 of them");
  }
  if (!table.reading.allFinite() || !table.angle.allFinite()) {
    return Fault(table.path, "readings and angles must be finite");
  }
  const std::vector<Index> order = table.ByReading();
  for (const auto check : {CheckReadingsDiffer, CheckAnglesRiseOrFall}) {
    RETURN_IF_ERROR(check(table, order));
  }
  return table;
}

Result<CalibrationTable> ParseCalibrationTable(std::string_view text, const std::string& name) {
  return TableReader(LineReader(text, name)).Read();
}

Result<CalibrationTable> ReadCalibrationTable(const std::filesystem::path& path) {
  ASSIGN_OR_RETURN(InputFile file, path == "-" ? InputFile::StandardInput() : InputFile::Open(path, "CSV"));
  return TableReader(LineReader(std::move(file))).Read();
}

}  // namespace pendulum
