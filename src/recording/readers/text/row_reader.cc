// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/text/row_reader.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/recording/clock.h"
#include "recording/readers/columns/column.h"
#include "recording/readers/columns/column_choice.h"
#include "recording/readers/columns/csv.h"
#include "recording/readers/columns/metadata.h"
#include "recording/readers/columns/to_angle.h"
#include "recording/readers/columns/to_recording.h"
#include "recording/readers/text/cell.h"
#include "recording/readers/text/head.h"
#include "recording/readers/text/host_stamp.h"
#include "recording/readers/text/ros_rows.h"
#include "recording/readers/text/truncated_row.h"

namespace pendulum {
namespace {

using csv::FieldCutter, csv::Layout, csv::Line, csv::Trim;
using Check = Result<void>;

constexpr std::size_t kNoColumn = csv::kNoColumn;

/// Reads one text, line by line.
class Reader {
 public:
  Reader(LineReader lines, const ReadOptions& options) : lines_(std::move(lines)), options_(options) {}

  Result<Recording> Read();
  Result<std::vector<csv::TableColumn>> ReadNames();

 private:
  Check ReadLine();
  Check ParseHead();
  Check BeginRows();
  Check ChooseColumns();
  Check ReadOrSetAsideRow();
  Check ReadRow();
  Check ReadRosRow();
  Check SelectJoint();
  Check ReadHostTime(const std::optional<csv::HostStamp>& stamp, double& time);
  Check MakeRoom();
  const csv::Column& LastColumn() const;
  Check Append(double time, double value, double second = 0);
  void WarnOfIncompleteRow(const Line& line);
  Check CheckEnd();
  void RemoveTruncatedStamp();
  void RemoveTruncatedValue();
  void WarnOfEmptyCells();
  Result<Recording> Finish();
  double rate_hz() const { return options_.sample_rate_hz > 0 ? options_.sample_rate_hz : metadata_.sample_rate_hz; }
  bool is_host_time() const { return has_host_ && !layout_.time && !(rate_hz() > 0); }

  LineReader lines_;
  const ReadOptions& options_;
  csv::Metadata metadata_;
  std::vector<csv::HeadLine> lines_of_head_;
  csv::Head head_;
  bool is_head_only_ = false;
  char separator_ = '\0';  // From the line `sep=`.
  bool has_host_ = false;  // Lines begin with the stamp of a serial monitor.
  bool has_layout_ = false;
  Layout layout_;
  std::size_t time_index_ = kNoColumn, second_index_ = kNoColumn;
  Line line_;  // The current row; before the first row, the header.
  csv::Cells cells_;
  std::optional<csv::RosRows> ros_;
  std::size_t gap_rows_ = 0, inner_gap_rows_ = 0;  // Rows with a gap after the last complete row, and before it.
  std::optional<Status> is_truncated_;             // The error of a possibly cut-off row; used if another row follows.
  Line truncated_line_;
  std::string truncated_text_;
  bool is_short_ = false;      // The current row has too few fields.
  double midnights_ = 0;       // s, added to the host's time of day.
  double last_host_time_ = 0;  // s, with midnights.
  Eigen::Index rows_ = 0;
  RawSamples samples_;  // Before Finish, time and value may be longer than rows_.
};

Result<Recording> Reader::Read() {
  samples_.name = lines_.name();
  if (Check read = csv::ForEachLine(lines_, line_, [this] { return ReadLine(); }); !read) {
    return tl::unexpected(std::move(read).error());
  }
  if (!has_layout_ && !lines_of_head_.empty()) {
    if (Check begun = BeginRows(); !begun) return tl::unexpected(std::move(begun).error());
  }
  return Finish();
}

Result<std::vector<csv::TableColumn>> Reader::ReadNames() {
  is_head_only_ = true;
  line_.file = lines_.name();
  while (!has_layout_) {
    const Result<bool> next = lines_.Next();
    if (!next) return tl::unexpected(next.error());
    if (!*next) break;
    line_.text = lines_.line();
    line_.number = lines_.number();
    if (Check read = ReadLine(); !read) return tl::unexpected(std::move(read).error());
  }
  if (!has_layout_ && !lines_of_head_.empty()) {
    if (Check begun = BeginRows(); !begun) return tl::unexpected(std::move(begun).error());
  }
  return std::move(head_.columns);
}

Check Reader::ReadLine() {
  if (csv::IsEmptyRow(line_.text)) return {};
  const std::string_view text = Trim(line_.text);
  if (text.front() == '#') return csv::ReadMetadata(line_, Trim(text.substr(1)), metadata_);
  if (has_layout_) return ReadOrSetAsideRow();
  if (const auto separator = csv::SeparatorLine(line_.text); separator && lines_of_head_.empty()) {
    separator_ = *separator;
    return {};
  }
  lines_of_head_.push_back({std::string(line_.text), line_.number});
  return lines_of_head_.size() < csv::HeadLines(lines_of_head_.front()) ? Check() : BeginRows();
}

// ---- Columns -----------------------------------------------------------------------------------------------------

/// Finds the names of the columns and the line that contains them.
Check Reader::ParseHead() {
  const std::vector<csv::HeadLine>& lines = lines_of_head_;
  has_layout_ = true;
  has_host_ = csv::HasHostStamps(lines);
  head_ = csv::ParseHead(lines, has_host_, separator_, layout_);
  line_ = {lines_.name(), lines[head_.names_line].text, lines[head_.names_line].number};
  if (head_.columns.empty() || head_.first_row >= lines.size()) return {};
  const auto table = csv::FindRos(head_.columns, lines[head_.first_row].text, layout_.separator, options_);
  if (table) ros_.emplace(*table, head_.columns, layout_);
  return {};
}

/// Examines the first lines, then reads those that are rows.
Check Reader::BeginRows() {
  if (Check looked = ParseHead(); !looked || is_head_only_) return looked;
  if (Check chosen = ChooseColumns(); !chosen) return chosen;
  for (std::size_t i = head_.first_row; i < lines_of_head_.size(); ++i) {
    line_ = {lines_.name(), lines_of_head_[i].text, lines_of_head_[i].number};
    if (Check taken = ReadOrSetAsideRow(); !taken) return taken;
  }
  return {};
}

Check Reader::ChooseColumns() {
  const ReadOptions options = ros_ ? ros_->SplitOffJoint(options_) : options_;
  const auto names = csv::NamesOf(line_, head_.columns, options);
  if (!names) return tl::unexpected(names.error());
  csv::ColumnChooser chooser(line_, *names, options, metadata_.sample_rate_hz > 0, has_host_);
  if (Check chosen = chooser.Choose(layout_); !chosen) return chosen;
  if (Check checked = ros_ ? ros_->CheckSecond(line_) : Check(); !checked) return checked;
  if (Check checked = CheckCalibration(line_, layout_.value, options_, metadata_, samples_.warnings); !checked) {
    return checked;
  }
  cells_ = {csv::Numbers(layout_.separator != ','), head_.may_have_gaps || ros_};
  if (layout_.time) {
    time_index_ = layout_.time->index;
    samples_.time_unit = layout_.time->unit->name;
  }
  if (layout_.second) second_index_ = layout_.second->index;
  return {};
}

// ---- Rows --------------------------------------------------------------------------------------------------------

/// Reads a row. The first row of a paste without a header and the last row of a file may be cut off. The error of such
/// a row is set aside.
Check Reader::ReadOrSetAsideRow() {
  if (is_truncated_) return tl::unexpected(*is_truncated_);
  is_short_ = false;
  Check read = ros_ ? ReadRosRow() : ReadRow();
  if (read) return read;
  const std::vector<csv::HeadLine>& head = lines_of_head_;
  const bool is_first = !layout_.has_header && rows_ == 0 && line_.number == head.front().number && head.size() > 1;
  if (is_first) {
    WarnOfIncompleteRow(line_);
    return {};
  }
  if (!is_short_ && lines_.is_terminated()) return read;
  is_truncated_ = std::move(read).error();
  truncated_text_ = line_.text;
  truncated_line_ = {lines_.name(), truncated_text_, line_.number};
  return {};
}

void Reader::WarnOfIncompleteRow(const Line& line) {
  samples_.warnings.push_back({"incomplete_row", std::string(line.file) + ":" + std::to_string(line.number) +
                                                     ": the row " + Quoted(line.text) +
                                                     " is incomplete; it was left out"});
}

Check Reader::ReadRow() {
  double time = 0, value = 0, second = 0;
  std::size_t index = 0;
  std::string_view row = line_.text;
  if (has_host_) {
    const auto stamp = csv::FindHostStamp(row);
    if (stamp) row = stamp->rest;
    if (Check taken = ReadHostTime(stamp, time); !taken) return taken;
  }
  for (FieldCutter fields(row, layout_.separator); !fields.done(); ++index) {
    const bool is_time = index == time_index_;
    const bool is_second = index == second_index_;
    if (is_time || is_second || index == layout_.value.index) {
      double& number = is_time ? time : is_second ? second : value;
      if (fields.NextNumber(cells_.numbers, number)) continue;
      const csv::Column& column = is_time ? *layout_.time : is_second ? *layout_.second : layout_.value;
      if (Check read = cells_.Read(line_, fields.Next(), column, number); !read) return read;
    } else if (const std::string_view text = Trim(fields.Next()); index >= layout_.width && !text.empty()) {
      return line_.Fault(text.data(), "field " + std::to_string(index + 1) + " holds " + Quoted(text) +
                                          " beyond the header's " + std::to_string(layout_.width) +
                                          " columns; name every column, and write decimals with a point");
    }
  }
  const csv::Column& last = LastColumn();
  if (cells_.TakeGap() || (cells_.may_have_gaps && index <= last.index)) {
    ++gap_rows_;
    return {};
  }
  if (index <= last.index) {
    is_short_ = true;
    return line_.Fault(line_.text.data() + line_.text.size(),
                       "the row ends after " + std::to_string(index) + " of " + std::to_string(layout_.width) +
                           " fields, before column " + last.name + "; complete the row or delete it");
  }
  return Append(time, value, second);
}

const csv::Column& Reader::LastColumn() const {
  const csv::Column* last = &layout_.value;
  if (layout_.time && layout_.time->index > last->index) last = &*layout_.time;
  if (layout_.second && layout_.second->index > last->index) last = &*layout_.second;
  return *last;
}

/// If the host's stamp is the time, sets `time` to the seconds since the midnight before the first row.
Check Reader::ReadHostTime(const std::optional<csv::HostStamp>& stamp, double& time) {
  constexpr double kDay = 86400;
  if (!is_host_time()) return {};
  if (!stamp || !stamp->second_of_day) {
    return line_.Fault(line_.text.data(),
                       "this line does not begin with the host's time, such as 14:03:22.123 ->, although others do; "
                       "complete the row or delete it");
  }
  time = *stamp->second_of_day + midnights_;
  if (rows_ > 0 && time < last_host_time_ - kDay / 2) {
    midnights_ += kDay;
    time += kDay;
  }
  last_host_time_ = time;
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

Check Reader::Append(double time, double value, double second) {
  if (rows_ == samples_.time.size()) {
    if (Check made = MakeRoom(); !made) return made;
  }
  samples_.time[rows_] = time;
  samples_.value[rows_] = value;
  if (layout_.second) samples_.second[rows_] = second;
  samples_.lines.Add(line_.number);
  ++rows_;
  inner_gap_rows_ += rows_ > 1 ? gap_rows_ : 0;
  gap_rows_ = 0;
  return {};
}

// ---- Rows of ROS -------------------------------------------------------------------------------------------------

Check Reader::ReadRosRow() {
  const auto sample = ros_->Read(line_, cells_);
  if (!sample) return tl::unexpected(sample.error());
  if (*sample) return Append((*sample)->time, (*sample)->value, (*sample)->second);
  gap_rows_ += cells_.TakeGap() ? 1 : 0;
  return {};
}

/// If each row belongs to one joint, selects the rows of one joint.
Check Reader::SelectJoint() {
  if (!ros_ || !ros_->has_joints()) return {};
  const csv::HeadLine& header = lines_of_head_[head_.names_line];
  auto chosen = ros_->ChooseJoint({lines_.name(), header.text, header.number});
  if (!chosen) return tl::unexpected(std::move(chosen).error());
  if (*chosen == nullptr) return {};
  csv::JointRows& rows = **chosen;
  rows_ = static_cast<Eigen::Index>(rows.time.size());
  samples_.time = Eigen::VectorXd::Map(rows.time.data(), rows_);
  samples_.value = Eigen::VectorXd::Map(rows.value.data(), rows_);
  samples_.lines = std::move(rows.lines);
  layout_.value.name = ros_->NameOf(rows);
  return {};
}

// ---- The end -----------------------------------------------------------------------------------------------------

Check Reader::CheckEnd() {
  if (is_truncated_ && rows_ < kMinimumSamples) return tl::unexpected(*is_truncated_);
  if (is_truncated_) WarnOfIncompleteRow(truncated_line_);
  if (rows_ >= kMinimumSamples) return {};
  const std::string least = "at least " + std::to_string(kMinimumSamples);
  const std::string sentence =
      lines_.is_empty() ? "the file is empty; a header and " + least + " rows of data are needed"
      : !has_layout_    ? "the file holds only comments and blank lines; a header and " + least + " rows are needed"
                     : "rows of data found: " + std::to_string(rows_) + "; " + least + " are needed: record for longer";
  const Line last{lines_.name(), "", lines_.number()};
  return last.Fault(last.text.data(), sentence, StatusCode::kFailedPrecondition);
}

/// In a paste without a header, the first stamp may have lost its leading digits and still parse as a number.
void Reader::RemoveTruncatedStamp() {
  if (layout_.has_header || !layout_.time || rows_ <= kMinimumSamples || !csv::IsTruncatedStamp(samples_.time)) return;
  WarnOfIncompleteRow({lines_.name(), lines_of_head_.front().text, lines_of_head_.front().number});
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
  samples_.warnings.push_back(csv::EmptyCells(lines_.name(), inner_gap_rows_, layout_.value.name));
}

Result<Recording> Reader::Finish() {
  if (Check selected = SelectJoint(); !selected) return tl::unexpected(std::move(selected).error());
  if (Check checked = CheckEnd(); !checked) return tl::unexpected(std::move(checked).error());
  RemoveTruncatedValue();
  RemoveTruncatedStamp();
  WarnOfEmptyCells();
  samples_.time.conservativeResize(rows_);
  samples_.value.conservativeResize(rows_);
  if (layout_.second) samples_.second.conservativeResize(rows_);
  Result<std::string> sha256 = lines_.Sha256();
  if (!sha256) return tl::unexpected(std::move(sha256).error());
  return csv::ToRecording({std::move(samples_), layout_, std::move(metadata_), is_host_time(), *std::move(sha256)},
                          line_, options_);
}

}  // namespace

Result<Recording> ReadRows(LineReader lines, const ReadOptions& options) {
  return Reader(std::move(lines), options).Read();
}

Result<std::vector<csv::TableColumn>> ReadColumnNames(LineReader lines) {
  return Reader(std::move(lines), {}).ReadNames();
}

}  // namespace pendulum
