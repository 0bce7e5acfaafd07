// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/text/row_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/recording/clock.h"
#include "pendulum/recording/encoder_edges.h"
#include "recording/readers/columns/column.h"
#include "recording/readers/columns/column_choice.h"
#include "recording/readers/columns/csv.h"
#include "recording/readers/columns/metadata.h"
#include "recording/readers/columns/to_angle.h"
#include "recording/readers/columns/to_recording.h"
#include "recording/readers/columns/unit_guess.h"
#include "recording/readers/text/cell.h"
#include "recording/readers/text/head.h"
#include "recording/readers/text/host_stamp.h"
#include "recording/readers/text/phone_log.h"
#include "recording/readers/text/ros_rows.h"
#include "recording/readers/text/truncated_row.h"

namespace pendulum {
namespace {

using csv::FieldCutter, csv::Layout, csv::Line, csv::Trim;
using Check = Result<void>;

/// The bytes in which the structure of a text is looked for, and those whose numbers may decide on the columns.
constexpr std::size_t kHeadBytes = std::size_t{1} << 16, kNumbersBytes = std::size_t{1} << 24;

std::string SeparatorWords(char separator) {
  switch (separator) {
    case ';': return "semicolons";
    case '\t': return "tabs";
    case ' ': return "blanks";
    default: return separator == ',' ? "commas" : std::string("\"") + separator + "\"";
  }
}

/// The bytes for the numbers without a last line that is cut off at their end.
std::string WholeLines(const std::string& bytes) {
  return bytes.size() < kNumbersBytes ? bytes : bytes.substr(0, bytes.rfind('\n') + 1);  // npos + 1 is 0
}

struct TextOfLine {
  std::string text;
  std::size_t number = 0;
};

/// Lines that are no rows.
struct LinesLeftOut {
  std::size_t count = 0, cut_off = 0;  // All, and the rows among them that are cut off.
  TextOfLine first;
};

/// Those after the last row.
struct LinesSetAside {
  LinesLeftOut lines;
  bool begins_with_text = false;  // The first is not a row that is cut off.
  std::optional<Status> error;    // Why they must not be left out if a row follows.
};

/// The rows of one of several tables.
struct Table {
  Eigen::Index rows = 0;
  Eigen::VectorXd time, value, second;
  LineNumbers lines;
  std::size_t inner_gap_rows = 0, unpaired_rows = 0;
};

/// Where one of several tables begins, and how many rows it has.
struct TableBegin {
  std::size_t line = 0;
  Eigen::Index rows = 0;
};

/// Whether a program may write this text in place of a reading.
bool SaysNoReading(std::string_view text) {
  constexpr std::array<std::string_view, 14> kWords = {"of range", "error",     "fail",       "failed",   "failure",
                                                       "timeout",  "timed out", "invalid",    "overflow", "lost",
                                                       "missing",  "saturated", "saturation", "no data"};
  std::string words = " " + csv::PlainName(text) + " ";
  std::ranges::replace_if(
      words, [](char c) { return c == '_' || c == ':' || c == ',' || c == '.' || c == '!'; }, ' ');
  return std::ranges::any_of(
      kWords, [&](std::string_view word) { return words.find(" " + std::string(word) + " ") != std::string::npos; });
}

/// Reads one text, line by line.
class Reader {
 public:
  Reader(LineReader lines, const ReadOptions& options, bool are_lists)
      : lines_(std::move(lines)), options_(options), are_lists_(are_lists) {}

  Result<Recording> Read();
  Result<std::vector<csv::TableColumn>> ReadNames();

 private:
  /// What a field of a row is. Fields beyond kAxis are further axes of a gyro.
  enum Slot : int { kNotRead = -1, kTime, kValue, kSecond, kAxis };

  Check ParseHead();
  Check HeadTooLong(std::size_t last_line_end) const;
  Check ReadLine();
  Check ReadComments();
  Check ChooseColumns();
  Check ReadOrSetAsideRow();
  std::optional<Status> FaultOfText() const;
  Check SetAside(std::optional<Status> error);
  bool HasOtherFields() const;
  Check LeaveOutBetweenRows();
  Check CheckLeftOut();
  bool BeginsSecondTable(double time) const;
  void BeginTable();
  void KeepLonger();
  void TakeLongest();
  Check ReadRow();
  Check ReadRosRow();
  Check SelectJoint();
  Check ReadHostTime(const std::optional<csv::HostStamp>& stamp, double& time);
  Check ReadField(FieldCutter& fields, int slot, double& number);
  Check MakeRoom();
  const csv::Column& ColumnOf(int slot) const;
  std::size_t LastIndex() const;
  Check Append(double time, double value, double second = 0);
  void Warn(std::size_t line, Warning warning);
  void WarnOfIncompleteRow(const Line& line);
  void WarnOfNote(std::string_view text);
  Check CheckEnd();
  void WarnOfTheEnd();
  void RemoveTruncatedStamp();
  void RemoveTruncatedValue();
  void WarnOfEmptyCells();
  Check CheckUnpairedRows();
  void WarnOfOtherRate(Recording& recording) const;
  Result<Recording> Finish();
  double rate_hz() const { return options_.sample_rate_hz > 0 ? options_.sample_rate_hz : metadata_.sample_rate_hz; }
  bool has_times() const { return layout_.time || is_host_time(); }
  bool is_host_time() const { return head_.has_host && !layout_.time && !(rate_hz() > 0); }

  LineReader lines_;
  const ReadOptions& options_;
  bool are_lists_;  // The columns are lists of a file of JSON or NumPy.
  csv::Metadata metadata_;
  std::string first_bytes_;  // head_ refers to them.
  csv::Head head_;
  bool has_layout_ = false;
  Layout layout_;
  std::vector<int> slots_;  // Of each field of a row.
  Line line_;               // The current row; before the first row, the header.
  csv::Cells cells_;
  csv::DayClock day_clock_;
  std::optional<csv::RosRows> ros_;
  std::size_t gap_rows_ = 0, inner_gap_rows_ = 0;  // Rows with a gap after the last complete row, and before it.
  std::size_t unpaired_rows_ = 0;     // Those after it that have a time or a reading, and no other column has anything.
  LinesSetAside below_;               // After the last row.
  LinesLeftOut between_;              // Between rows.
  std::vector<TextOfLine> comments_;  // After the last row. They may belong to a second table.
  std::size_t header_again_ = 0;      // The line in which the header stands again, after the last row.
  bool is_over_ = false;              // Nothing of what follows is read.
  bool has_begun_again_ = false;      // The current row is the first of another table.
  std::optional<Table> longest_;      // Of several tables, the longest before the current one.
  std::vector<TableBegin> tables_;    // Where each began; empty if there is only one.
  bool has_note_ = false;             // A row has text beyond the columns.
  Eigen::Index rows_ = 0;
  RawSamples samples_;  // Before Finish, time and value may be longer than rows_.
};

Result<Recording> Reader::Read() {
  samples_.name = lines_.name();
  RETURN_IF_ERROR(ParseHead());
  const auto read_line = [this]() -> Check {
    Check read = ReadLine();
    // A fault in another table than the longest does not matter.
    if (!read && longest_ && longest_->rows > rows_) is_over_ = true;
    return is_over_ ? Check() : read;
  };
  RETURN_IF_ERROR(csv::ForEachLine(lines_, line_, read_line));
  return Finish();
}

Result<std::vector<csv::TableColumn>> Reader::ReadNames() {
  RETURN_IF_ERROR(ParseHead());
  return std::move(head_.columns);
}

/// Reads a line: metadata, a row, or a part of the head, which is known already.
Check Reader::ReadLine() {
  if (csv::IsEmptyRow(line_.text)) return {};
  if (is_over_) return {};
  const std::string_view text = Trim(line_.text);
  if (text.front() == '#') {
    if (rows_ == 0) return csv::ReadMetadata(line_, Trim(text.substr(1)), metadata_);
    comments_.push_back({std::string(line_.text), line_.number});
    return {};
  }
  if (head_.first_row.number == 0 || line_.number < head_.first_row.number) return {};
  if (!has_layout_) {
    const Line row = line_;
    RETURN_IF_ERROR(ChooseColumns());
    line_ = row;
  }
  return ReadOrSetAsideRow();
}

// ---- Columns -----------------------------------------------------------------------------------------------------

/// The error for a text whose first kHeadBytes hold no row of data.
Check Reader::HeadTooLong(std::size_t last_line_end) const {
  const bool has_line = last_line_end != std::string::npos;
  const Line first{lines_.name(), "", has_line ? Line::kNoNumber : 1};
  const std::string size = std::to_string(kHeadBytes / 1024) + " kB";
  return first.Fault(first.text.data(),
                     has_line ? "no row of data begins in the first " + size + ": shorten the text above the table"
                              : "the first line is longer than " + size + " and begins with " + Quoted(first_bytes_) +
                                    ": shorten it to the names of the columns, or name a CSV file");
}

/// Finds the names of the columns and the first row.
Check Reader::ParseHead() {
  ASSIGN_OR_RETURN(std::string bytes, lines_.Peek(kHeadBytes));
  first_bytes_ = std::move(bytes);
  std::string_view begin = first_bytes_;
  const std::size_t last_line_end = begin.rfind('\n');
  if (begin.size() == kHeadBytes && last_line_end != std::string_view::npos) begin = begin.substr(0, last_line_end + 1);
  head_ = csv::ParseHead(begin, layout_);
  if (first_bytes_.size() == kHeadBytes && head_.first_row.number == 0) return HeadTooLong(last_line_end);
  csv::NamePhoneSensor(lines_.name(), head_.columns);
  line_ = {lines_.name(), head_.names.text, head_.names.number};
  if (head_.columns.empty() || head_.first_row.number == 0) return {};
  const auto table = csv::FindRos(head_.columns, head_.first_row.text, layout_.separator, options_);
  if (table) ros_.emplace(*table, head_.columns, layout_);
  return {};
}

Check Reader::ChooseColumns() {
  has_layout_ = true;
  const std::size_t next_line = lines_.number();
  const Line header{lines_.name(), head_.names.text, head_.names.number};
  const std::string row(next_line > 0 ? lines_.line() : std::string_view());
  line_ = header;
  const ReadOptions options = ros_ ? ros_->SplitOffJoint(options_) : options_;
  ASSIGN_OR_RETURN(const auto names, csv::NamesOf(header, head_.columns, options));
  const bool has_times = std::ranges::any_of(names, [](const csv::Name& name) { return csv::IsTime(name.text); });
  const bool needs_rate = !has_times && metadata_.sample_rate_hz == 0 && !(options_.sample_rate_hz > 0);
  if (needs_rate) metadata_.sample_rate_hz = head_.sample_rate_hz;
  const auto& calibration = csv::ChosenCalibration(options_, metadata_);
  const csv::TableView table{
      .line = header,
      .names = names,
      .has_rate = metadata_.sample_rate_hz > 0,
      .is_rate_weak = needs_rate,
      .has_host = head_.has_host,
      .raw_input = calibration ? calibration->input : "",
      .value_unit = head_.value_unit,
      .numbers = [&]() -> Result<csv::TableNumbers> {
        ASSIGN_OR_RETURN(const std::string rest, lines_.Peek(kNumbersBytes));
        return csv::ReadNumbers(row + "\n" + WholeLines(rest), next_line, head_, layout_);
      },
      .first_rows = [this] { return csv::FirstRows(first_bytes_, TablePreview::kRows, head_, layout_); }};
  if (options.preview != nullptr && options.preview->format.empty()) {
    options.preview->format = "text with columns separated by " + SeparatorWords(layout_.separator);
  }
  RETURN_IF_ERROR(csv::ChooseColumns(table, options, layout_, samples_.warnings));
  if (needs_rate && layout_.time) metadata_.sample_rate_hz = 0;
  if (needs_rate && !layout_.time && head_.rate_line.number > 0) {
    const std::string rate = NumberText(head_.sample_rate_hz) + " Hz";
    Warn(head_.rate_line.number, {.code = "sample_rate_from_text",
                                  .finding = "the rows have no times, so the rate of " + rate + " was taken from " +
                                             Quoted(Trim(head_.rate_line.text)),
                                  .advice = "--sample_rate_hz says otherwise",
                                  .flags = {"sample_rate_hz"},
                                  .assumed = rate + ", from a line above the rows (--sample_rate_hz)"});
  }
  RETURN_IF_ERROR(ros_ ? ros_->CheckSecond(header) : Check());
  RETURN_IF_ERROR(CheckCalibration(header, layout_.value, options_, metadata_, samples_.warnings));
  cells_ = {csv::Numbers(layout_.separator != ',')};
  if (layout_.time) samples_.time_unit = layout_.time->unit->name;
  slots_.assign(layout_.width, kNotRead);
  const auto set_slot = [&](std::size_t index, int slot) { slots_.at(index) = slot; };
  if (layout_.time) set_slot(layout_.time->index, kTime);
  set_slot(layout_.value.index, kValue);
  if (layout_.second) set_slot(layout_.second->index, kSecond);
  for (std::size_t i = 0; i < layout_.axes.size(); ++i) set_slot(layout_.axes[i].index, kAxis + static_cast<int>(i));
  return {};
}

// ---- Rows --------------------------------------------------------------------------------------------------------

/// Reads the comments after the last row, when it is known that they belong to this table.
Check Reader::ReadComments() {
  for (const TextOfLine& comment : std::exchange(comments_, {})) {
    const Line line{lines_.name(), comment.text, comment.number};
    RETURN_IF_ERROR(csv::ReadMetadata(line, Trim(Trim(line.text).substr(1)), metadata_));
  }
  return {};
}

/// Reads a row. The first row of a paste without a header and the last row of a file may be cut off, text may stand
/// between rows, and text or a second table may follow. Such a line is set aside.
Check Reader::ReadOrSetAsideRow() {
  const bool is_after_fault = below_.error && !below_.begins_with_text;
  if (is_after_fault && !csv::IsHeaderAgain(line_.text, head_, layout_)) return tl::unexpected(*below_.error);
  if (!ros_ && csv::IsTextAmongRows(line_.text, head_, layout_.separator)) return SetAside(FaultOfText());
  Check read = ros_ ? ReadRosRow() : ReadRow();
  if (read) return LeaveOutBetweenRows();
  const bool is_first = !layout_.has_header && rows_ == 0 && line_.number == head_.first_row.number;
  if (!is_first) return SetAside(std::move(read).error());
  WarnOfIncompleteRow(line_);
  return {};
}

/// Why the text of this line must not be left out between rows; std::nullopt if it may be. Rows without times are
/// counted, so the text must be one that surely stands for no row: a remark of several words.
std::optional<Status> Reader::FaultOfText() const {
  const std::string_view row = Trim(csv::DevicePart(line_.text, head_.has_host));
  const std::vector<csv::Name> names = csv::SplitHeader(row, layout_.separator);
  const bool has_width = names.size() == layout_.width;
  const auto fault = [&](const std::string& sentence) {
    return line_.Fault(row.data(), "the text " + Quoted(row) + " stands between rows" + sentence).value();
  };
  const auto says_something = [](const csv::Name& name) {
    const csv::NameMeaning meaning = csv::MeaningOf(name.text);
    return meaning.kind || meaning.has_other_unit;
  };
  const bool is_header = has_width && layout_.width > 1 && std::ranges::all_of(names, says_something);
  if (is_header && std::ranges::any_of(names, csv::IsTime, &csv::Name::text)) {
    return fault(" and may be the header of another table; save each table in a file of its own, or delete the line");
  }
  const bool is_remark =
      row.find(' ') != std::string_view::npos && (layout_.width == 1 || !has_width) && !SaysNoReading(row);
  if (has_times() || is_remark) return std::nullopt;
  return fault(
      " that have no times, and if it stands for a row, all later times are wrong; write a number in its place, or "
      "delete the line if it stands for none");
}

/// Sets aside a line that is no row. error: why it must not be left out if a row follows. A row that is cut off may be,
/// if its time is missing then. Returns the error of a line that is neither cut off nor text.
Check Reader::SetAside(std::optional<Status> error) {
  if (csv::IsHeaderAgain(line_.text, head_, layout_)) {
    header_again_ = line_.number;
    return {};
  }
  const bool is_text = csv::IsText(csv::RemarkPart(line_.text, head_));
  if (is_text && header_again_ > 0) return {};  // units below the names
  const bool is_short = !is_text && !ros_ && HasOtherFields();
  const bool is_first = below_.lines.count == 0, is_faulty = !is_text && !is_short && lines_.is_terminated();
  if (is_first && is_faulty) return tl::unexpected(*std::move(error));
  if (is_short && has_times()) error.reset();
  const bool is_cut_off = !is_text || !lines_.is_terminated();
  if (is_first) {
    below_.lines.first = {std::string(line_.text), line_.number};
    below_.begins_with_text = !is_cut_off;
  }
  ++below_.lines.count;
  below_.lines.cut_off += is_cut_off ? 1 : 0;
  if (!below_.error) below_.error = std::move(error);
  return {};
}

/// Whether the line ends before the last column that is read, or, after many rows, goes on after the last column: two
/// rows may have lost what was between them.
bool Reader::HasOtherFields() const {
  constexpr Eigen::Index kMany = 20;
  std::size_t count = 0;
  for (FieldCutter fields(csv::DevicePart(line_.text, head_.has_host), layout_.separator); !fields.done(); ++count) {
    fields.Next();
  }
  return count <= LastIndex() || (count > layout_.width && rows_ >= kMany);
}

/// After a row or at the end: leaves out the lines that were set aside.
Check Reader::LeaveOutBetweenRows() {
  constexpr std::size_t kMostNeighbours = 10;  // more are another table, or rows that are not understood
  if (below_.lines.count == 0) return {};
  auto [lines, begins_with_text, error] = std::exchange(below_, {});
  const Line first{lines_.name(), lines.first.text, lines.first.number};
  if (std::exchange(has_begun_again_, false)) {
    if (!begins_with_text) WarnOfIncompleteRow(first);
    return {};
  }
  if (error) return tl::unexpected(*std::move(error));
  if (lines.count > kMostNeighbours) {
    return first.Fault(first.text.data(), "this line and " + std::to_string(lines.count - 1) +
                                              " below it are no rows; delete them, or save each table in a file of "
                                              "its own");
  }
  if (between_.count == 0) between_.first = lines.first;
  between_.count += lines.count;
  between_.cut_off += lines.cut_off;
  return {};
}

/// Whether the row after a repeated header begins a second table: its time does not continue the times before.
bool Reader::BeginsSecondTable(double time) const {
  return header_again_ > 0 && rows_ > 0 && !(layout_.time && time > samples_.time[rows_ - 1]);
}

void Reader::Warn(std::size_t line, Warning warning) {
  warning.about.file = lines_.name();
  warning.about.line = line;
  samples_.warnings.push_back(std::move(warning));
}

void Reader::WarnOfIncompleteRow(const Line& line) {
  Warn(line.number, {.code = "incomplete_row",
                     .finding = "the row " + Quoted(line.text) + " is incomplete",
                     .explanation = "it was left out"});
}

/// `text`: what the current row holds beyond the columns.
void Reader::WarnOfNote(std::string_view text) {
  if (!std::exchange(has_note_, true)) {
    Warn(line_.number, {.code = "notes_left_out",
                        .finding = "this row has text after its last column, " + Quoted(text),
                        .explanation = "such text was left out in all rows",
                        .advice = "if it is a reading, name its column in the header"});
  }
}

/// Reads the number of a field that is not a plain number: quoted, empty, a time of day, or faulty.
Check Reader::ReadField(FieldCutter& fields, int slot, double& number) {
  const std::string_view field = fields.Next();
  if (slot != kTime || !layout_.is_clock) return cells_.Read(line_, field, ColumnOf(slot), number);
  const std::string_view text = csv::Unquote(field);
  const std::optional<double> second_of_day = csv::SecondOfDay(text);
  if (second_of_day) number = day_clock_.Continue(*second_of_day);
  if (second_of_day || text.empty()) {
    cells_.is_gap |= text.empty();
    return {};
  }
  return line_.Fault(Trim(field).data(), "column " + layout_.time->name + " holds " + Quoted(text) +
                                             ", which is not a time of day such as 16:04:31.273; correct the field or "
                                             "delete the row");
}

Check Reader::ReadRow() {
  constexpr std::size_t kMostSlots = 8;
  std::array<double, kMostSlots> numbers{};
  std::size_t index = 0;
  bool has_number = false, has_others = false;
  std::string_view row = line_.text;
  if (head_.has_host) {
    const auto stamp = csv::FindHostStamp(row);
    if (stamp) row = stamp->rest;
    RETURN_IF_ERROR(ReadHostTime(stamp, numbers[kTime]));
  }
  for (FieldCutter fields(row, layout_.separator); !fields.done(); ++index) {
    const int slot = index < slots_.size() ? slots_[index] : kNotRead;
    if (slot != kNotRead) {
      const bool is_clock = slot == kTime && layout_.is_clock;
      if (!is_clock && fields.NextNumber(cells_.numbers, numbers.at(slot))) {
        has_number = true;
        continue;
      }
      const bool had_gap = std::exchange(cells_.is_gap, false);
      RETURN_IF_ERROR(ReadField(fields, slot, numbers.at(slot)));
      has_number |= !cells_.is_gap;
      cells_.is_gap |= had_gap;
    } else if (const std::string_view text = Trim(fields.Next()); index < layout_.width) {
      has_others |= !text.empty();
    } else if (!text.empty()) {
      if (layout_.separator != ' ' && csv::IsText(text)) {
        WarnOfNote(csv::Unquote(text));
        continue;
      }
      return line_.Fault(text.data(), "field " + std::to_string(index + 1) + " holds " + Quoted(text) +
                                          " beyond the header's " + std::to_string(layout_.width) +
                                          " columns; name every column, and write decimals with a point");
    }
  }
  const std::size_t last = LastIndex();
  if (cells_.TakeGap() || (head_.may_be_short && index <= last)) {
    const bool is_first = !layout_.has_header && line_.number == head_.first_row.number;
    const bool is_cut_off = is_first || (!head_.may_be_short && !lines_.is_terminated());
    if (is_cut_off) WarnOfIncompleteRow(line_);
    gap_rows_ += is_cut_off ? 0 : 1;
    const bool is_pair = layout_.time && !layout_.second && layout_.axes.empty();
    unpaired_rows_ += is_pair && has_number && !has_others && !is_cut_off ? 1 : 0;
    return {};
  }
  if (index <= last) {
    return line_.Fault(line_.text.data() + line_.text.size(),
                       "the row ends after " + std::to_string(index) + " of " + std::to_string(layout_.width) +
                           " fields, before column " + ColumnOf(slots_[last]).name + "; complete the row or delete it");
  }
  double value = numbers[kValue];
  if (!layout_.axes.empty()) {
    value *= layout_.direction[0];
    for (std::size_t i = 0; i < layout_.axes.size(); ++i) {
      value += layout_.direction[static_cast<Eigen::Index>(i) + 1] * numbers.at(kAxis + i);
    }
  }
  return Append(numbers[kTime], value, numbers[kSecond]);
}

const csv::Column& Reader::ColumnOf(int slot) const {
  switch (slot) {
    case kTime: return *layout_.time;
    case kValue: return layout_.value;
    case kSecond: return *layout_.second;
    default: return layout_.axes.at(slot - kAxis);
  }
}

/// The index of the last column that is read.
std::size_t Reader::LastIndex() const {
  const auto last = std::find_if(slots_.rbegin(), slots_.rend(), [](int slot) { return slot != kNotRead; });
  return static_cast<std::size_t>(slots_.rend() - last) - 1;
}

/// If the host's stamp is the time, sets `time` to the seconds since the midnight before the first row.
Check Reader::ReadHostTime(const std::optional<csv::HostStamp>& stamp, double& time) {
  if (!is_host_time()) return {};
  if (!stamp || !stamp->second_of_day) {
    return line_.Fault(line_.text.data(),
                       "this line does not begin with the host's time, such as 14:03:22.123 ->, although others do; "
                       "complete the row or delete it");
  }
  time = day_clock_.Continue(*stamp->second_of_day);
  return {};
}

Check Reader::MakeRoom() {
  constexpr Eigen::Index kFirstRoom = 4096;
  const Eigen::Index room = std::max(2 * rows_, kFirstRoom);
  try {
    samples_.time.conservativeResize(room);
    samples_.value.conservativeResize(room);
    if (layout_.second) samples_.second.conservativeResize(room);
  } catch (const std::exception&) {
    return line_.Fault(line_.text.data(), "the rows up to here use all memory; split the file");
  }
  return {};
}

/// Sets aside the table that ends here, unless a longer one is set aside, and begins another one.
void Reader::BeginTable() {
  if (tables_.empty()) tables_.push_back({head_.first_row.number, 0});
  tables_.back().rows = rows_;
  tables_.push_back({line_.number, 0});
  KeepLonger();
  has_begun_again_ = true;
  comments_.clear();
}

/// Of the current table and the one set aside, sets aside the longer. Then no row is in the current one.
void Reader::KeepLonger() {
  if (!longest_ || rows_ > longest_->rows) {
    longest_ = Table{rows_,
                     std::move(samples_.time),
                     std::move(samples_.value),
                     std::move(samples_.second),
                     std::move(samples_.lines),
                     inner_gap_rows_,
                     unpaired_rows_};
  }
  samples_.time = samples_.value = samples_.second = {};
  samples_.lines = {};
  rows_ = 0;
  gap_rows_ = inner_gap_rows_ = unpaired_rows_ = 0;
}

/// Of several tables, takes the longest.
void Reader::TakeLongest() {
  if (tables_.empty()) return;
  tables_.back().rows = rows_;
  KeepLonger();
  rows_ = longest_->rows;
  samples_.time = std::move(longest_->time);
  samples_.value = std::move(longest_->value);
  samples_.second = std::move(longest_->second);
  samples_.lines = std::move(longest_->lines);
  inner_gap_rows_ = longest_->inner_gap_rows;
  unpaired_rows_ = longest_->unpaired_rows;
}

Check Reader::Append(double time, double value, double second) {
  if (BeginsSecondTable(time)) {
    BeginTable();
  }
  header_again_ = 0;
  if (!comments_.empty()) {
    RETURN_IF_ERROR(ReadComments());
  }
  if (rows_ == samples_.time.size()) {
    RETURN_IF_ERROR(MakeRoom());
  }
  samples_.time[rows_] = time;
  samples_.value[rows_] = value;
  if (layout_.second) samples_.second[rows_] = second;
  samples_.lines.Add(line_.number);
  ++rows_;
  inner_gap_rows_ += rows_ > 1 ? gap_rows_ : 0;
  gap_rows_ = 0;
  unpaired_rows_ = 0;
  return {};
}

// ---- Rows of ROS -------------------------------------------------------------------------------------------------

Check Reader::ReadRosRow() {
  ASSIGN_OR_RETURN(const auto sample, ros_->Read(line_, cells_));
  if (sample) return Append(sample->time, sample->value, sample->second);
  gap_rows_ += cells_.TakeGap() ? 1 : 0;
  return {};
}

/// If each row belongs to one joint, selects the rows of one joint.
Check Reader::SelectJoint() {
  if (!ros_ || !ros_->has_joints()) return {};
  ASSIGN_OR_RETURN(auto chosen, ros_->ChooseJoint({lines_.name(), head_.names.text, head_.names.number}));
  if (chosen == nullptr) return {};
  csv::JointRows& rows = *chosen;
  rows_ = static_cast<Eigen::Index>(rows.time.size());
  samples_.time = Eigen::VectorXd::Map(rows.time.data(), rows_);
  samples_.value = Eigen::VectorXd::Map(rows.value.data(), rows_);
  samples_.lines = std::move(rows.lines);
  layout_.value.name = ros_->NameOf(rows);
  return {};
}

// ---- The end -----------------------------------------------------------------------------------------------------

Check Reader::CheckEnd() {
  if (tables_.empty()) {
    RETURN_IF_ERROR(ReadComments());
  }
  if (below_.error && !below_.begins_with_text && rows_ < kMinimumSamples) return tl::unexpected(*below_.error);
  if (below_.lines.count > 1 && !below_.begins_with_text) {
    RETURN_IF_ERROR(LeaveOutBetweenRows());
  }
  RETURN_IF_ERROR(CheckLeftOut());
  WarnOfTheEnd();
  if (rows_ >= kMinimumSamples) return {};
  const std::string least = "at least " + std::to_string(kMinimumSamples);
  const std::string second = tables_.empty()
                                 ? std::string()
                                 : " in the longest of " + std::to_string(tables_.size()) + " tables with this header";
  const std::string sentence =
      lines_.is_empty() ? "the file is empty; a header and " + least + " rows of data are needed"
      : head_.names.number == 0
          ? "the file holds only comments and blank lines; a header and " + least + " rows are needed"
          : "rows of data found: " + std::to_string(rows_) + second + "; " + least + " are needed: record for longer";
  const Line last{lines_.name(), "", lines_.number()};
  return last.Fault(last.text.data(), sentence, StatusCode::kFailedPrecondition);
}

/// Says which lines between rows were left out; refuses many.
Check Reader::CheckLeftOut() {
  constexpr std::size_t kMost = 3, kRowsPerLine = 10;  // so many lines, or one for so many rows
  const auto& [count, cut_off, first] = between_;
  if (count == 0) return {};
  std::string sentence = count == 1 ? "1 line that is no row" : std::to_string(count) + " lines that are no rows";
  sentence += (count == 1 ? ", " : ", the first is ") + Quoted(Trim(first.text));
  if (count > std::max(kMost, static_cast<std::size_t>(rows_) / kRowsPerLine)) {
    const Line line{lines_.name(), first.text, first.number};
    return line.Fault(line.text.data(), "between " + std::to_string(rows_) + " rows stand " + sentence +
                                            ": too many to leave out; delete them, or have the device send rows alone");
  }
  sentence += count == 1 ? ", was left out" : ", were left out";
  std::string explanation = cut_off > 0 ? "rows that are cut off: " + std::to_string(cut_off) : "";
  if (!has_times()) {
    explanation += std::string(explanation.empty() ? "" : "; ") +
                   "the rows have no times, so a line that stood for a row makes later times wrong";
  }
  Warn(first.number, {.code = "stray_lines", .finding = sentence, .explanation = explanation});
  samples_.left_out += cut_off;
  return {};
}

/// Warns of what stands below the last row.
void Reader::WarnOfTheEnd() {
  if (!tables_.empty()) {
    const auto longest = std::ranges::max_element(tables_, {}, &TableBegin::rows);
    std::string others;
    for (const TableBegin& table : tables_) {
      if (&table == &*longest) continue;
      others += (others.empty() ? "" : ", ") + std::to_string(table.rows) + " from line " + std::to_string(table.line);
    }
    const std::string rows = std::to_string(longest->rows) + " rows";
    Warn(longest->line,
         {.code = "second_table",
          .finding = "the header stands again, and the times begin again",
          .explanation = "of these tables the longest was read, " + rows + " from this line on, and not: " + others,
          .advice = "save each table in a file of its own to fit the others",
          .assumed = "the longest table, of " + rows + " (split the file for the others)"});
  }
  if (below_.lines.count == 0) return;
  const TextOfLine& line = below_.lines.first;
  if (!below_.begins_with_text) return WarnOfIncompleteRow({lines_.name(), line.text, line.number});
  Warn(line.number, {.code = "text_below_table",
                     .finding = "the table ends here, at the text " + Quoted(line.text),
                     .explanation = "this line and all below it were not read"});
}

/// In a paste without a header, the first stamp may have lost its leading digits and still parse as a number.
void Reader::RemoveTruncatedStamp() {
  if (layout_.has_header || !layout_.time || rows_ <= kMinimumSamples || !csv::IsTruncatedStamp(samples_.time)) return;
  WarnOfIncompleteRow({lines_.name(), head_.first_row.text, head_.first_row.number});
  LineNumbers lines;
  for (Eigen::Index i = 1; i < rows_; ++i) lines.Add(samples_.lines.LineOf(i));
  samples_.lines = std::move(lines);
  --rows_;
  for (Eigen::VectorXd* column : {&samples_.time, &samples_.value, &samples_.second}) {
    if (column->size() == 0) continue;
    std::copy(column->begin() + 1, column->begin() + 1 + rows_, column->begin());
  }
}

/// A last value without a line end may have lost digits and still parse as a number.
void Reader::RemoveTruncatedValue() {
  const Eigen::Index last = rows_ - 1;
  if (lines_.is_terminated() || last < kMinimumSamples || samples_.lines.LineOf(last) != lines_.number()) return;
  const bool is_cut =
      csv::IsTruncatedValue(samples_.value, last) || (layout_.second && csv::IsTruncatedValue(samples_.second, last));
  if (!is_cut) return;
  WarnOfIncompleteRow({lines_.name(), lines_.line(), lines_.number()});
  --rows_;
}

/// Does not count empty cells before the first complete row and after the last: there, only other columns have values.
void Reader::WarnOfEmptyCells() {
  if (inner_gap_rows_ == 0) return;
  samples_.left_out += inner_gap_rows_;
  samples_.warnings.push_back(csv::EmptyCells(lines_.name(), inner_gap_rows_, layout_.value.name));
}

Result<Recording> Reader::Finish() {
  RETURN_IF_ERROR(SelectJoint());
  TakeLongest();
  RETURN_IF_ERROR(CheckEnd());
  RemoveTruncatedValue();
  RemoveTruncatedStamp();
  WarnOfEmptyCells();
  RETURN_IF_ERROR(CheckUnpairedRows());
  samples_.time.conservativeResize(rows_);
  samples_.value.conservativeResize(rows_);
  if (layout_.second) samples_.second.conservativeResize(rows_);
  ASSIGN_OR_RETURN(std::string sha256, lines_.Sha256());
  Result<Recording> recording = csv::ToRecording(
      {std::move(samples_), layout_, std::move(metadata_), is_host_time(), std::move(sha256)}, options_);
  if (recording) WarnOfOtherRate(*recording);
  return recording;
}

/// Lists of different lengths: nothing says which of their numbers belong together. In a text, an empty cell stands in
/// its row, and the logger may have stopped before its clock.
Check Reader::CheckUnpairedRows() {
  constexpr std::size_t kMostCutOff = 1;
  if (unpaired_rows_ <= kMostCutOff) return {};
  const std::string file(lines_.name()), last = std::to_string(unpaired_rows_);
  const std::string lost = "the last " + last +
                           " rows have only one of time and reading: if some were lost before "
                           "them, the times after that are wrong";
  if (are_lists_) {
    return Fault(file, lost +
                           "; look for the missing ones at their "
                           "source, or shorten the longer list if the others are complete");
  }
  samples_.warnings.push_back(
      {.code = "unequal_columns", .finding = lost, .explanation = "these rows were left out", .about = {.file = file}});
  return {};
}

/// The times of rows count more than what the text above them says.
void Reader::WarnOfOtherRate(Recording& recording) const {
  constexpr double kDiffers = 0.02;  // no rounding of a rate or an interval is as coarse
  if (!layout_.time || !(head_.sample_rate_hz > 0) || IsEventDriven(recording)) return;
  const double step = csv::MedianStep(recording.time), stated = 1 / head_.sample_rate_hz;
  // The interval may be in ms or us.
  const auto is_stated = [&](double unit) { return std::abs(step / (stated * unit) - 1) <= kDiffers; };
  if (is_stated(1) || is_stated(1e-3) || is_stated(1e-6)) return;
  const auto text = [](double seconds) { return NumberText(seconds, 4) + " s"; };
  recording.warnings.push_back({.code = "rate_disagrees",
                                .finding = "the times in column " + layout_.time->name + " are " + text(step) +
                                           " apart, but the lines above say " + text(stated) + "; the times are used",
                                .advice = "to use the lines above, give --time_column none --sample_rate_hz " +
                                          NumberText(head_.sample_rate_hz, 6),
                                .flags = {"time_column", "sample_rate_hz"},
                                .about = {.file = recording.path}});
}

}  // namespace

Result<Recording> ReadRows(LineReader lines, const ReadOptions& options) {
  return Reader(std::move(lines), options, false).Read();
}

Result<Recording> ReadLists(LineReader lines, const ReadOptions& options) {
  return Reader(std::move(lines), options, true).Read();
}

Result<std::vector<csv::TableColumn>> ReadColumnNames(LineReader lines) {
  return Reader(std::move(lines), {}, false).ReadNames();
}

}  // namespace pendulum
