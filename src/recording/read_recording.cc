// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/read_recording.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <openssl/evp.h>

#include "column.h"
#include "csv.h"
#include "metadata.h"
#include "pendulum/base/file.h"
#include "pendulum/base/format.h"

namespace pendulum {
namespace {

using csv::FieldCutter, csv::Kind, csv::MetadataKey, csv::ParseNumber, csv::Trim, csv::Unit, csv::Unquote;
using Check = Result<void>;

struct Column {
  std::size_t index;
  std::string_view name;
  const char* at;  // Where its name stands in the header.
  const Unit* unit;
};

/// Reads one text, line by line.
class Reader {
 public:
  Reader(std::string_view text, std::string name) : text_(text), rest_(text), name_(std::move(name)) {}

  Result<Recording> Read();

 private:
  tl::unexpected<Status> NotText();
  bool NextLine();
  Check ReadLine();
  Check ReadComment(std::string_view comment);
  Check ReadHeader();
  Check AddColumn(std::string_view field);
  Check CheckColumns() const;
  Check ReadRow();
  Check ReadField(std::string_view field, const Column& column, double& number) const;
  Check Append(double time, double value, const char* at);
  Result<Recording> Finish();

  std::string ColumnNames() const;
  tl::unexpected<Status> Fault(const char* at, const std::string& sentence,
                               StatusCode code = StatusCode::kDataLoss) const;

  std::string_view text_;
  std::string_view rest_;  // What follows line_.
  std::string name_;
  std::string_view line_;
  std::size_t line_number_ = 0;
  char separator_ = ',';
  std::size_t width_ = 0;  // Columns of the header; 0 before it is read.
  std::string_view header_;
  std::optional<Column> time_;
  std::optional<Column> value_;
  std::array<bool, csv::kMetadataKeys.size()> seen_{};
  double file_resolution_ = 0;
  std::optional<csv::Range> file_range_;
  Eigen::Index rows_ = 0;
  double last_time_ = 0;  // In the file's unit.
  std::size_t last_row_line_ = 0;
  Recording recording_;  // Until Finish, time and value have room for more than rows_.
};

/// An error at the byte `at` of the current line.
tl::unexpected<Status> Reader::Fault(const char* at, const std::string& sentence, StatusCode code) const {
  return Error(code, name_ + ":" + std::to_string(std::max<std::size_t>(line_number_, 1)) + ":" +
                         std::to_string(at - line_.data() + 1) + ": " + sentence);
}

Result<Recording> Reader::Read() {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  if (rest_.find('\0') != std::string_view::npos) return NotText();
  while (NextLine()) {
    if (Check read = ReadLine(); !read) return tl::unexpected(std::move(read).error());
  }
  return Finish();
}

/// NUL bytes are what a logger leaves that lost its power, or an encoding of two bytes a character.
tl::unexpected<Status> Reader::NotText() {
  while (NextLine() && line_.find('\0') == std::string_view::npos) continue;
  return Fault(line_.data() + line_.find('\0'),
               "a NUL byte stands here, so this is not CSV text; delete what is damaged, or save UTF-16 as UTF-8");
}

bool Reader::NextLine() {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line_ = rest_.substr(0, end);
  rest_.remove_prefix(std::min(line_.size() + 1, rest_.size()));
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  ++line_number_;
  return true;
}

Check Reader::ReadLine() {
  const std::string_view text = Trim(line_);
  if (text.empty()) return {};
  if (text.front() == '#') return ReadComment(Trim(text.substr(1)));
  // What a spreadsheet leaves of an empty row.
  if (text.find_first_not_of(" \t,;") == std::string_view::npos) return {};
  return width_ == 0 ? ReadHeader() : ReadRow();
}

Check Reader::ReadComment(std::string_view comment) {
  const std::size_t colon = std::min(comment.find(':'), comment.size());
  const auto* const entry = std::ranges::find(csv::kMetadataKeys, Trim(comment.substr(0, colon)), &MetadataKey::key);
  if (entry == csv::kMetadataKeys.end() || colon == comment.size()) return {};
  const std::string_view value = Trim(comment.substr(colon + 1));
  const std::string key(entry->key);
  if (!entry->is_well_formed(value)) {
    return Fault(value.data(), "the metadata " + key + " is " + Quoted(value) + "; it must be " +
                                   std::string(entry->rule) + ": correct or delete this line");
  }
  bool& seen = seen_.at(entry - csv::kMetadataKeys.begin());
  if (seen) return Fault(comment.data(), "the metadata " + key + " is given twice; keep one of them");
  seen = true;
  if (key == "resolution") ParseNumber(value, file_resolution_);
  if (key == "range") csv::ParseRange(value, file_range_.emplace());
  if (entry->changes_numbers) {
    recording_.warnings.push_back({"metadata_not_applied", name_ + ":" + std::to_string(line_number_) +
                                                               ": the metadata " + key + " is not applied"});
  }
  return {};
}

Check Reader::ReadHeader() {
  header_ = line_;
  separator_ = csv::Separator(line_);
  bool has_name = false;
  for (FieldCutter fields(line_, separator_); !fields.done();) {
    const std::string_view field = fields.Next();
    double number = 0;
    has_name = has_name || (!Unquote(field).empty() && !ParseNumber(Unquote(field), number));
    if (Check added = AddColumn(field); !added) return added;
  }
  if (!has_name) {
    return Fault(line_.data(),
                 "the first row holds numbers where the names of the columns should stand; put a header "
                 "above it, such as time_s,angle_deg");
  }
  return CheckColumns();
}

Check Reader::AddColumn(std::string_view field) {
  const std::string_view name = Unquote(field);
  const Column column = {width_++, name, Trim(field).data(), csv::FindUnit(name)};
  if (column.unit == nullptr) return {};
  const bool is_time = column.unit->kind == Kind::kTime;
  std::optional<Column>& role = is_time ? time_ : value_;
  if (role) {
    return Fault(column.at, "columns " + Quoted(role->name) + " and " + Quoted(name) + " could both be the " +
                                (is_time ? "time" : "quantity") + "; delete or rename one of them");
  }
  role = column;
  return {};
}

Check Reader::CheckColumns() const {
  if (!time_) {
    return Fault(line_.data(), "none of the columns " + ColumnNames() +
                                   " is a time; name the column of times time_s, time_ms or time_us");
  }
  if (!value_) {
    return Fault(line_.data(), "none of the columns " + ColumnNames() +
                                   " is an angle or a rate; end its name in its unit: _rad, _deg, _rad_s or _deg_s");
  }
  if (value_->unit->kind == Kind::kNeedsCalibration) {
    return Fault(value_->at, "column " + Quoted(value_->name) + " is in " + std::string(value_->unit->name) +
                                 " and needs a calibration to become an angle; convert it to degrees or "
                                 "radians and end its name in _deg or _rad");
  }
  return {};
}

/// The header's names as a message may show them.
std::string Reader::ColumnNames() const {
  constexpr std::size_t kShown = 8;
  std::string names;
  FieldCutter fields(header_, separator_);
  for (std::size_t i = 0; i < std::min(width_, kShown); ++i) {
    names += (i == 0 ? "" : ", ") + Quoted(Unquote(fields.Next()));
  }
  return names + (width_ > kShown ? ", ..." : "");
}

Check Reader::ReadRow() {
  double time = 0, value = 0;
  const char* time_at = line_.data();
  std::size_t index = 0;
  for (FieldCutter fields(line_, separator_); !fields.done(); ++index) {
    const bool is_time = index == time_->index;
    if (is_time) time_at = fields.at();
    if (is_time || index == value_->index) {
      double& number = is_time ? time : value;
      if (fields.NextNumber(number)) continue;
      if (Check read = ReadField(fields.Next(), is_time ? *time_ : *value_, number); !read) return read;
    } else if (const std::string_view text = Trim(fields.Next()); index >= width_ && !text.empty()) {
      return Fault(text.data(), "field " + std::to_string(index + 1) + " holds " + Quoted(text) +
                                    " beyond the header's " + std::to_string(width_) +
                                    " columns; name every column, and write decimals with a point");
    }
  }
  const Column& last = time_->index > value_->index ? *time_ : *value_;
  if (index <= last.index) {
    return Fault(line_.data() + line_.size(), "the row ends after " + std::to_string(index) + " of " +
                                                  std::to_string(width_) + " fields, before " + Quoted(last.name) +
                                                  "; complete the row or delete it");
  }
  return Append(time, value, time_at);
}

/// A field that is quoted, or at fault.
Check Reader::ReadField(std::string_view field, const Column& column, double& number) const {
  const std::string_view text = Unquote(field);
  if (ParseNumber(text, number)) return {};
  return Fault(Trim(field).data(), "column " + Quoted(column.name) + " " + csv::WhyNotANumber(text));
}

Check Reader::Append(double time, double value, const char* time_at) {
  const double seconds = time_->unit->ToSi(time);
  if (rows_ > 0 && seconds <= recording_.time[rows_ - 1]) {
    const std::string unit = " " + std::string(time_->unit->name);
    return Fault(time_at, "time " + NumberText(time) + unit + " does not follow " + NumberText(last_time_) + unit +
                              " of line " + std::to_string(last_row_line_) +
                              "; times must increase: delete or correct the row");
  }
  if (rows_ == recording_.time.size()) {
    constexpr std::size_t kUsualRowBytes = 16;
    const auto room = std::max(2 * rows_, static_cast<Eigen::Index>(text_.size() / kUsualRowBytes + kMinimumSamples));
    recording_.time.conservativeResize(room);
    recording_.value.conservativeResize(room);
  }
  recording_.time[rows_] = seconds;
  recording_.value[rows_] = value_->unit->ToSi(value);
  ++rows_;
  last_time_ = time;
  last_row_line_ = line_number_;
  return {};
}

Result<Recording> Reader::Finish() {
  if (rows_ < kMinimumSamples) {
    const std::string least = "at least " + std::to_string(kMinimumSamples);
    const std::string sentence =
        text_.empty() ? "the file is empty; a header and " + least + " rows of data are needed"
        : width_ == 0
            ? "the file holds only comments and blank lines; a header and " + least + " rows are needed"
            : "rows of data found: " + std::to_string(rows_) + "; " + least + " are needed: record for longer";
    return Fault(line_.data(), sentence, StatusCode::kFailedPrecondition);
  }
  recording_.path = name_;
  recording_.quantity = value_->unit->kind == Kind::kRate ? Quantity::kRate : Quantity::kAngle;
  recording_.unit = value_->unit->name;
  recording_.time.conservativeResize(rows_);
  recording_.value.conservativeResize(rows_);
  recording_.resolution = value_->unit->ToSi(file_resolution_);
  if (file_range_) {
    recording_.range = SensorRange{value_->unit->ToSi(file_range_->low), value_->unit->ToSi(file_range_->high)};
  }
  return MakeRecording(std::move(recording_));
}

Result<std::string> Sha256(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    return Error(StatusCode::kInternal, "OpenSSL cannot compute a SHA-256");
  }
  std::string text;
  for (unsigned int i = 0; i < size; ++i) text += {HexDigit(digest.at(i) >> 4), HexDigit(digest.at(i) & 15)};
  return text;
}

}  // namespace

Result<Recording> ParseRecording(std::string_view text, const std::string& name, const ReadOptions& /*options*/) {
  Result<Recording> recording = Reader(text, name).Read();
  if (!recording) return recording;
  Result<std::string> sha256 = Sha256(text);
  if (!sha256) return tl::unexpected(std::move(sha256).error());
  recording->sha256 = std::move(*sha256);
  return recording;
}

Result<Recording> ReadRecording(const std::filesystem::path& path, const ReadOptions& options) {
  constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 32;
  const Result<std::string> bytes = ReadFile(path, "CSV", kMostBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return ParseRecording(*bytes, path.string(), options);
}

}  // namespace pendulum
