// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/read_recording.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "column.h"
#include "csv.h"
#include "head.h"
#include "host_stamp.h"
#include "layout.h"
#include "metadata.h"
#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/recording/clock.h"
#include "pendulum/recording/line_reader.h"
#include "to_angle.h"

namespace pendulum {
namespace {

using csv::FieldCutter, csv::Layout, csv::Line, csv::Trim, csv::Unquote;
using Check = Result<void>;

constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);

/// Reads one text, line by line.
class Reader {
 public:
  Reader(LineReader lines, const ReadOptions& options) : lines_(std::move(lines)), options_(options) {}

  Result<Recording> Read();

 private:
  Check ReadLine();
  Check BeginRows();
  Check ChooseColumns(const std::vector<csv::Name>& names);
  Check TakeRow();
  Check ReadRow();
  const csv::Column& LastColumn() const;
  Check ReadField(std::string_view field, const csv::Column& column, double& number);
  Check TakeHostTime(const std::optional<csv::HostStamp>& stamp, double& time);
  Check MakeRoom();
  void Append(double time, double value, double second);
  void WarnOfIncompleteRow(const Line& line);
  Check CheckEnd();
  void LeaveOutCutStamp();
  void LeaveOutCutValue();
  void WarnOfClock();
  Check SetTimes();
  Result<Recording> Finish();
  void Warn(const std::string& code, const std::string& sentence) {
    samples_.warnings.push_back({code, lines_.name() + ": " + sentence});
  }

  double rate_hz() const { return options_.sample_rate_hz > 0 ? options_.sample_rate_hz : metadata_.sample_rate_hz; }
  bool is_host_time() const { return has_host_ && !layout_.time && !(rate_hz() > 0); }

  LineReader lines_;
  const ReadOptions& options_;
  csv::Metadata metadata_;
  std::vector<csv::HeadLine> head_;
  char separator_ = '\0';  // What the line `sep=` says.
  bool has_host_ = false;  // Lines begin with the stamp of a serial monitor.
  bool has_layout_ = false;
  Layout layout_;
  std::size_t time_index_ = kNoColumn;
  std::size_t second_index_ = kNoColumn;
  Line line_;  // The row being read; before there are rows, the header.
  csv::Numbers numbers_;
  std::optional<Status> cut_;  // The fault of a row that may be cut off, should another row follow.
  Line cut_line_;
  std::string cut_text_;
  bool is_short_ = false;      // The row just read has too few fields.
  double midnights_ = 0;       // s, to add to the host's time of day.
  double last_host_time_ = 0;  // s, with midnights.
  Eigen::Index rows_ = 0;
  RawSamples samples_;  // Until Finish, time and value have room for more than rows_.
};

Result<Recording> Reader::Read() {
  samples_.name = lines_.name();
  if (Check read = csv::ForEachLine(lines_, line_, [this] { return ReadLine(); }); !read) {
    return tl::unexpected(std::move(read).error());
  }
  if (!has_layout_ && !head_.empty()) {
    if (Check begun = BeginRows(); !begun) return tl::unexpected(std::move(begun).error());
  }
  return Finish();
}

Check Reader::ReadLine() {
  constexpr std::size_t kHeadLines = 2;  // A header and a row, or two rows of which the first may be cut off.
  if (csv::IsEmptyRow(line_.text)) return {};
  const std::string_view text = Trim(line_.text);
  if (text.front() == '#') return csv::ReadMetadata(line_, Trim(text.substr(1)), metadata_);
  if (has_layout_) return TakeRow();
  if (const auto separator = csv::SeparatorLine(line_.text); separator && head_.empty()) {
    separator_ = *separator;
    return {};
  }
  head_.push_back({std::string(line_.text), line_.number});
  return head_.size() < kHeadLines ? Check() : BeginRows();
}

// ---- What the columns are ----------------------------------------------------------------------------------------

/// Looks at the first lines, then reads those of them that are rows.
Check Reader::BeginRows() {
  has_layout_ = true;
  has_host_ = csv::HasHostStamps(head_);
  line_ = {lines_.name(), head_.front().text, head_.front().number};
  const std::vector<csv::Name> names = csv::LookAtHead(head_, has_host_, separator_, layout_);
  if (Check chosen = ChooseColumns(names); !chosen) return chosen;
  for (std::size_t i = layout_.has_header ? 1 : 0; i < head_.size(); ++i) {
    line_ = {lines_.name(), head_[i].text, head_[i].number};
    if (Check taken = TakeRow(); !taken) return taken;
  }
  return {};
}

Check Reader::ChooseColumns(const std::vector<csv::Name>& names) {
  csv::ColumnChooser chooser(line_, names, options_, metadata_.sample_rate_hz > 0, has_host_);
  if (Check chosen = chooser.Choose(layout_); !chosen) return chosen;
  if (Check checked = CheckCalibration(line_, layout_.value, options_, metadata_, samples_.warnings); !checked) {
    return checked;
  }
  numbers_ = csv::Numbers(layout_.separator != ',');
  if (layout_.second) second_index_ = layout_.second->index;
  if (layout_.time) {
    time_index_ = layout_.time->index;
    samples_.time_unit = layout_.time->unit->name;
  }
  return {};
}

// ---- Rows --------------------------------------------------------------------------------------------------------

/// Reads a row; the first of a paste without header and the last of a file may be cut off.
Check Reader::TakeRow() {
  if (cut_) return tl::unexpected(*cut_);
  is_short_ = false;
  Check read = ReadRow();
  if (read) return read;
  const bool is_first = !layout_.has_header && rows_ == 0 && line_.number == head_.front().number && head_.size() > 1;
  if (is_first) {
    WarnOfIncompleteRow(line_);
    return {};
  }
  if (!is_short_ && lines_.is_terminated()) return read;
  cut_ = std::move(read).error();
  cut_text_ = line_.text;
  cut_line_ = {lines_.name(), cut_text_, line_.number};
  return {};
}

void Reader::WarnOfIncompleteRow(const Line& line) {
  samples_.warnings.push_back({"incomplete_row", std::string(line.file) + ":" + std::to_string(line.number) +
                                                     ": the row " + Quoted(line.text) +
                                                     " is cut off; it was left out"});
}

Check Reader::ReadRow() {
  double time = 0, value = 0, second = 0;
  std::size_t index = 0;
  std::string_view row = line_.text;
  if (has_host_) {
    const auto stamp = csv::FindHostStamp(row);
    if (stamp) row = stamp->rest;
    if (Check taken = TakeHostTime(stamp, time); !taken) return taken;
  }
  for (FieldCutter fields(row, layout_.separator); !fields.done(); ++index) {
    const bool is_time = index == time_index_;
    const bool is_second = index == second_index_;
    if (is_time || is_second || index == layout_.value.index) {
      double& number = is_time ? time : is_second ? second : value;
      if (fields.NextNumber(numbers_, number)) continue;
      const csv::Column& column = is_time ? *layout_.time : is_second ? *layout_.second : layout_.value;
      if (Check read = ReadField(fields.Next(), column, number); !read) return read;
    } else if (const std::string_view text = Trim(fields.Next()); index >= layout_.width && !text.empty()) {
      return line_.Fault(text.data(), "field " + std::to_string(index + 1) + " holds " + Quoted(text) +
                                          " beyond the header's " + std::to_string(layout_.width) +
                                          " columns; name every column, and write decimals with a point");
    }
  }
  const csv::Column& last = LastColumn();
  if (index <= last.index) {
    is_short_ = true;
    return line_.Fault(line_.text.data() + line_.text.size(),
                       "the row ends after " + std::to_string(index) + " of " + std::to_string(layout_.width) +
                           " fields, before column " + last.name + "; complete the row or delete it");
  }
  if (rows_ == samples_.time.size()) {
    if (Check made = MakeRoom(); !made) return made;
  }
  Append(time, value, second);
  return {};
}

const csv::Column& Reader::LastColumn() const {
  const csv::Column* last = &layout_.value;
  for (const std::optional<csv::Column>& other : {std::cref(layout_.time), std::cref(layout_.second)}) {
    if (other && other->index > last->index) last = &*other;
  }
  return *last;
}

/// A field that is quoted, or at fault.
Check Reader::ReadField(std::string_view field, const csv::Column& column, double& number) {
  const std::string_view text = Unquote(field);
  if (numbers_.Parse(text, number)) return {};
  return line_.Fault(Trim(field).data(), "column " + column.name + " " + numbers_.WhyNot(text));
}

/// The host's stamp in seconds since the midnight before the first row, where it is the time.
Check Reader::TakeHostTime(const std::optional<csv::HostStamp>& stamp, double& time) {
  constexpr double kDay = 86400;
  if (!is_host_time()) return {};
  if (!stamp || !stamp->second_of_day) {
    return line_.Fault(line_.text.data(),
                       "this line does not begin with the host's time, such as 14:03:22.123 ->, as "
                       "others do; complete the row or delete it");
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
    return line_.Fault(line_.text.data(), "the rows up to here fill the memory; split the file");
  }
  return {};
}

void Reader::Append(double time, double value, double second) {
  samples_.time[rows_] = time;
  samples_.value[rows_] = value;
  if (layout_.second) samples_.second[rows_] = second;
  samples_.lines.Add(line_.number);
  ++rows_;
}

// ---- The end -----------------------------------------------------------------------------------------------------

Check Reader::CheckEnd() {
  if (cut_ && rows_ < kMinimumSamples) return tl::unexpected(*cut_);
  if (cut_) WarnOfIncompleteRow(cut_line_);
  if (rows_ >= kMinimumSamples) return {};
  const std::string least = "at least " + std::to_string(kMinimumSamples);
  const std::string sentence =
      lines_.is_empty() ? "the file is empty; a header and " + least + " rows of data are needed"
      : !has_layout_    ? "the file holds only comments and blank lines; a header and " + least + " rows are needed"
                     : "rows of data found: " + std::to_string(rows_) + "; " + least + " are needed: record for longer";
  const Line last{lines_.name(), "", lines_.number()};
  return last.Fault(last.text.data(), sentence, StatusCode::kFailedPrecondition);
}

/// Of a paste without header the first stamp may have lost its leading digits and read as a number all the same.
void Reader::LeaveOutCutStamp() {
  constexpr double kFar = 10;  // Times the steps that follow, and a digit or more.
  constexpr Eigen::Index kSteps = 7;
  const Eigen::VectorXd& time = samples_.time;
  if (layout_.has_header || !layout_.time || rows_ <= kMinimumSamples) return;
  double usual = 0;
  for (Eigen::Index i = 2; i <= kSteps; ++i) usual = std::max(usual, time[i] - time[i - 1]);
  if (time[0] < 0 || kFar * time[0] > time[1] || !(time[1] - time[0] > kFar * usual)) return;
  WarnOfIncompleteRow({lines_.name(), head_.front().text, head_.front().number});
  LineNumbers lines;
  for (Eigen::Index i = 1; i < rows_; ++i) lines.Add(samples_.lines.LineOf(i));
  samples_.lines = std::move(lines);
  --rows_;
  for (Eigen::VectorXd* column : {&samples_.time, &samples_.value, &samples_.second}) {
    if (column->size() == 0) continue;
    std::copy(column->begin() + 1, column->begin() + 1 + rows_, column->begin());
  }
}

/// A last value without a line end may have lost digits and read as a number all the same: it leaps as no other does.
void Reader::LeaveOutCutValue() {
  constexpr double kLeap = 2;  // Times the largest step between other rows.
  const Eigen::Index last = rows_ - 1;
  if (lines_.is_terminated() || last < kMinimumSamples || samples_.lines.LineOf(last) != lines_.number()) return;
  const Eigen::VectorXd& value = samples_.value;
  const double leap = std::abs(value[last] - value[last - 1]);
  const double usual = (value.segment(1, last - 1) - value.head(last - 1)).cwiseAbs().maxCoeff();
  if (!(usual > 0) || leap <= kLeap * usual) return;
  WarnOfIncompleteRow({lines_.name(), lines_.line(), lines_.number()});
  --rows_;
}

void Reader::WarnOfClock() {
  if (is_host_time()) {
    Warn("host_time",
         "the times are those at which the host received each line; a column of the device's own times is "
         "better, name it with --time_column");
  }
  if (!layout_.time && rate_hz() > 0 && metadata_.lost_samples.find_first_of("123456789") != std::string::npos) {
    Warn("lost_samples", "the file says that " + metadata_.lost_samples +
                             " samples were lost, and times counted from the sample rate are late after each");
  }
  if (layout_.time && !layout_.is_time_unit_told) {
    Warn("time_unit_assumed", "column " + layout_.time->name +
                                  " does not tell its unit and was taken as seconds; give "
                                  "--time_column with :s, :ms or :us after the column");
  }
}

/// Seconds, with the clock repaired.
Check Reader::SetTimes() {
  if (!layout_.time && rate_hz() > 0) {
    for (Eigen::Index i = 0; i < rows_; ++i) samples_.time[i] = static_cast<double>(i) / rate_hz();
    return {};
  }
  if (layout_.time && !layout_.is_time_unit_told && csv::AllWhole(samples_.time)) {
    return line_.Fault(line_.text.data(),
                       "column " + layout_.time->name +
                           " holds whole numbers and does not tell its unit; give --time_column "
                           "with :s, :ms or :us after the column",
                       StatusCode::kInvalidArgument);
  }
  Result<RawSamples> repaired = RepairClock(std::move(samples_));
  if (!repaired) return tl::unexpected(std::move(repaired).error());
  samples_ = *std::move(repaired);
  const csv::Unit& unit = layout_.time ? *layout_.time->unit : *csv::UnitOfSuffix("s");
  if (unit.divisor != 1) {
    for (double& time : samples_.time) time = unit.ToSi(time);
  }
  return {};
}

Result<Recording> Reader::Finish() {
  if (Check checked = CheckEnd(); !checked) return tl::unexpected(std::move(checked).error());
  LeaveOutCutValue();
  LeaveOutCutStamp();
  WarnOfClock();
  samples_.time.conservativeResize(rows_);
  samples_.value.conservativeResize(rows_);
  if (layout_.second) samples_.second.conservativeResize(rows_);
  Recording recording;
  if (Check set = SetTimes(); !set) return tl::unexpected(std::move(set).error());
  recording.path = lines_.name();
  recording.time = std::move(samples_.time);
  recording.value = std::move(samples_.value);
  recording.warnings = std::move(samples_.warnings);
  recording.clock_scale = metadata_.clock_scale;
  recording.clock_scale_std_dev =
      std::hypot(metadata_.clock_scale_std_dev, metadata_.clock_scale * samples_.clock_std_dev);
  recording.rig_json = metadata_.rig_json;
  csv::SetValues(layout_.value, options_, metadata_, recording);
  if (layout_.second) {
    if (Check turned = csv::TurnIntoAngles(*layout_.second, samples_.second, recording); !turned) {
      return tl::unexpected(std::move(turned).error());
    }
  }
  Result<std::string> sha256 = lines_.Sha256();
  if (!sha256) return tl::unexpected(std::move(sha256).error());
  recording.sha256 = *std::move(sha256);
  return MakeRecording(std::move(recording));
}

}  // namespace

Result<Recording> ParseRecording(std::string_view text, const std::string& name, const ReadOptions& options) {
  return Reader(LineReader(text, name), options).Read();
}

Result<Recording> ReadRecording(const std::filesystem::path& path, const ReadOptions& options) {
  if (path == "-") return Reader(LineReader(InputFile::StandardInput()), options).Read();
  Result<InputFile> file = InputFile::Open(path, "CSV");
  if (!file) return tl::unexpected(std::move(file).error());
  return Reader(LineReader(*std::move(file)), options).Read();
}

}  // namespace pendulum
