// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_recording.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/sha256.h"
#include "pendulum/base/staged_file.h"
#include "pendulum/base/try.h"
#include "recording/readers/columns/runs.h"
#include "recording/readers/columns/to_angle.h"
#include "recording/readers/columns/to_recording.h"
#include "recording/readers/mat/mat_elements.h"
#include "recording/readers/mat/mat_version_4.h"
#include "recording/readers/process/child_process.h"

namespace pendulum {
namespace {

constexpr std::size_t kHeaderBytes = 128, kTagBytes = 8;

tl::unexpected<Status> TruncationError(const std::string& name, std::size_t at, std::size_t size, std::size_t left) {
  return Fault(name, "the file is cut off: the variable at byte " + std::to_string(at) + " has " +
                         std::to_string(size) + " bytes, but only " + std::to_string(left) +
                         " are left; save or copy it again");
}

tl::unexpected<Status> NoVariable(const std::string& name, std::size_t at) {
  return Fault(name,
               "the file is damaged: at byte " + std::to_string(at) + " no variable begins; save or copy it again");
}

Result<void> CheckSizesOfVersion4(std::string_view bytes, const std::string& name) {
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t left = bytes.size() - at;
    const std::optional<std::size_t> size = SizeOfVersion4(bytes.substr(at));
    if (!size) return NoVariable(name, at);
    if (*size > left) return TruncationError(name, at, *size, left);
    at += *size;
  }
  return {};
}

/// In version 5 each variable is preceded by its size. These sizes are checked here, because matio does not report that
/// the last variable is cut off.
Result<void> CheckSizes(std::string_view bytes, const std::string& name) {
  constexpr std::size_t kOrderAt = 126;
  if (bytes.size() > 4 * kHeaderBytes && bytes.substr(4 * kHeaderBytes).starts_with("\x89HDF")) return {};
  if (SizeOfVersion4(bytes)) return CheckSizesOfVersion4(bytes, name);
  const bool is_little = bytes.substr(kOrderAt, 2) == "IM";
  const bool is_swapped = is_little != (std::endian::native == std::endian::little);
  for (std::size_t at = kHeaderBytes; at < bytes.size();) {
    const std::size_t left = bytes.size() - at;
    const auto tag = left < kTagBytes ? std::nullopt : WordsOf(bytes.substr(at, kTagBytes), is_swapped);
    if (!tag) return TruncationError(name, at, 0, 0);
    const std::uint32_t type = tag->front();
    const std::size_t size = tag->back();
    if (size > left - kTagBytes) return TruncationError(name, at, size, left - kTagBytes);
    if (type != kMatrixElement && type != kPackedElement) return NoVariable(name, at);
    at += kTagBytes + size;
  }
  return {};
}

/// A temporary file for matio, which cannot read from memory. It must be a real file, because HDF5 follows the links of
/// /proc.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string_view bytes) {
    std::error_code unknown;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(unknown);
    path_ = ((unknown ? "/tmp" : folder) / "pendulum_XXXXXX").string();
    const int descriptor = ::mkostemp(path_.data(), O_CLOEXEC);
    exists_ = descriptor >= 0;
    if (!exists_ || !WriteAll(descriptor, bytes)) error_ = errno;
    if (exists_ && ::close(descriptor) != 0 && error_ == 0) error_ = errno;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile(TemporaryFile&&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  TemporaryFile& operator=(TemporaryFile&&) = delete;
  ~TemporaryFile() {
    if (exists_) ::unlink(path_.c_str());
  }

  int error() const { return error_; }  // The errno of a failure, or 0.
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  bool exists_ = false;
  int error_ = 0;
};

/// A second is enough for a hundred megabytes, but some damaged files would take forever, or as much memory as a
/// damaged length says. Several copies of the numbers exist until the answer is complete.
ChildLimits LimitsFor(std::size_t bytes, std::size_t max_unpacked) {
  constexpr std::size_t kCopies = 8, kMinBytes = std::size_t{1} << 26;
  constexpr std::size_t kMaxRatio = 1032;  // zlib packs no better
  ChildLimits limits;
  limits.answer_bytes = max_unpacked;
  const std::size_t unpacked = std::max(std::min(max_unpacked, kMaxRatio * bytes), bytes);
  limits.memory_bytes = std::min(limits.memory_bytes, kMinBytes + kCopies * unpacked);
  limits.processor_seconds = 2 + static_cast<int>(bytes >> 25);
  limits.time = std::chrono::seconds(5 + 5 * limits.processor_seconds);  // Other processes also use the processors.
  return limits;
}

/// Why matio returned no table, and what to do.
tl::unexpected<Status> NoTable(ChildFailure failure, const ChildLimits& limits, const std::string& name) {
  constexpr std::string_view kLess = "; save only the times and the angles, or export them as CSV";
  const std::string less(kLess);
  switch (failure) {
    case ChildFailure::kNotStarted: break;
    case ChildFailure::kCrashed:
      return Fault(name, "this MAT-file is damaged: its reader, matio, crashed; save it again");
    case ChildFailure::kOutOfTime:
      return Fault(name, "this MAT-file takes longer to read than " + std::to_string(limits.processor_seconds) +
                             " s of processor time: it is damaged or too large" + less);
    case ChildFailure::kOutOfMemory:
      return Fault(name, "this MAT-file needs more memory to read than the " + std::to_string(limits.memory_bytes) +
                             " bytes that are allowed: it is damaged or too large" + less);
    case ChildFailure::kAnswerTooLarge:
      return Fault(name, "this MAT-file unpacks to more than " + std::to_string(limits.answer_bytes) +
                             " bytes, too many for a recording" + less);
  }
  return ErrorAt(StatusCode::kTryAgain, name, "the process that reads it could not be started; try again");
}

Result<MatTable> ReadTable(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  RETURN_IF_ERROR(CheckSizes(bytes, name));
  const TemporaryFile file(bytes);
  if (file.error() != 0) {
    const std::string folder = std::filesystem::path(file.path()).parent_path().string();
    return ErrorAt(StatusCode::kTryAgain, name,
                   "cannot copy this MAT-file to " + Quoted(folder) + " (" +
                       std::generic_category().message(file.error()) +
                       "); free space there, or name another folder in TMPDIR");
  }
  const ChildLimits limits = LimitsFor(bytes.size(), options.most_unpacked_bytes);
  const auto packed = RunInChildProcess([&] { return Pack(ReadMatTable(file.path(), bytes)); }, limits);
  if (!packed) return NoTable(packed.error(), limits, name);
  MatTable table = UnpackMatTable(*packed);
  if (table.complaint.empty()) return table;
  if (table.complaint == kOtherFile) {
    return Fault(name, "this MAT-file refers to numbers in another file, which is not opened; save all in one file");
  }
  return Fault(name, "this MAT-file is damaged (" + Quoted(table.complaint) + "); save it again");
}

/// True for a variable that may contain the quantity in an unsupported form: a cell array, complex or sparse numbers,
/// or an object.
bool MayContainQuantity(const SkippedVariable& variable) {
  const std::array kinds = {"a cell array", "complex", "sparse"};
  return variable.is_object || std::ranges::find(kinds, variable.kind) != kinds.end();
}

/// The variable that explains why there is no column of angles; nullptr if the columns themselves give the error.
const SkippedVariable* FindUnusableVariable(const MatTable& table, const std::vector<csv::TableColumn>& columns,
                                            const ReadOptions& options) {
  const std::vector<SkippedVariable>& all = table.skipped;
  const auto first = [&](const auto& is_match) {
    const auto found = std::ranges::find_if(all, is_match);
    return found == all.end() ? nullptr : &*found;
  };
  if (!options.value_column.empty()) {
    return first([&](const SkippedVariable& each) { return each.name == options.value_column; });
  }
  if (!csv::CandidatesOf(columns, options.unit).empty()) return nullptr;
  const auto has_unit = [](const SkippedVariable& each) {
    return MayContainQuantity(each) && csv::FindUnit(each.name) != nullptr && !csv::IsTime(each.name);
  };
  if (const SkippedVariable* const named = first(has_unit); named != nullptr) return named;
  const bool is_other = std::ranges::any_of(columns, [](const auto& column) { return !csv::IsTime(column.meaning); });
  if (is_other && !options.unit.empty()) return nullptr;  // the only other column may be the quantity
  if (const SkippedVariable* const object = first(&SkippedVariable::is_object); object != nullptr) return object;
  return is_other || columns.empty() ? nullptr : first(MayContainQuantity);
}

/// Reports what the file contains instead of a column of angles.
Result<void> CheckVariables(const MatTable& table, const std::vector<csv::TableColumn>& columns,
                            const std::string& name, const ReadOptions& options) {
  const SkippedVariable* const skipped = FindUnusableVariable(table, columns, options);
  if (skipped != nullptr) {
    const std::string which = skipped->name.empty() ? "a variable" : "variable " + Quoted(skipped->name);
    return Fault(name,
                 which + " is " + skipped->kind +
                     (skipped->is_object
                          ? "; save its numbers in MATLAB, for a timeseries ts: t = ts.Time; angle_deg = ts.Data; "
                            "save('run.mat', 't', 'angle_deg')"
                          : "; a column must be a vector of real numbers, or part of a matrix or a structure"));
  }
  const bool has_more = std::ranges::any_of(columns, [](const auto& column) { return !csv::IsTime(column.meaning); });
  if (has_more || (!columns.empty() && !options.value_column.empty())) return {};
  std::string kinds;
  for (const SkippedVariable& variable :
       std::span(table.skipped).first(std::min<std::size_t>(table.skipped.size(), 8))) {
    kinds += (kinds.empty() ? " (" : ", ") + (variable.name.empty() ? "one" : Quoted(variable.name)) + " is " +
             variable.kind;
  }
  return Fault(name, std::string("no variable of this MAT-file ") + (columns.empty() ? "" : "but the time ") +
                         "is a vector or a matrix of real numbers" + (kinds.empty() ? kinds : kinds + ")") +
                         "; save the times as t and the angles as angle_deg");
}

/// The columns of the table that a layout reads.
struct ChosenColumns {
  std::vector<const std::vector<double>*> columns;  // Time, value, second coordinate or axes.
  std::vector<std::string> names;
};

ChosenColumns ColumnsOf(const MatTable& table, const csv::Layout& layout) {
  ChosenColumns chosen;
  const auto add = [&](const csv::Column& column) {
    chosen.columns.push_back(&table.columns[column.index].values);
    chosen.names.push_back(column.name);
  };
  add(layout.time ? *layout.time : layout.value);
  add(layout.value);
  if (layout.second) add(*layout.second);
  for (const csv::Column& axis : layout.axes) add(axis);
  return chosen;
}

/// The numbers of the chosen columns, without rows in which one of them is NaN.
Result<RawSamples> SamplesOf(const MatTable& table, const csv::Layout& layout, const std::string& name) {
  const ChosenColumns chosen = ColumnsOf(table, layout);
  const std::size_t size = chosen.columns[1]->size();
  for (std::size_t i = 0; i < chosen.columns.size(); ++i) {
    if (chosen.columns[i]->size() == size) continue;
    return Fault(name, "column " + chosen.names[i] + " has " + std::to_string(chosen.columns[i]->size()) +
                           " numbers and column " + layout.value.name + " " + std::to_string(size) +
                           (i == 0 ? "; choose the time of this quantity with --time_column"
                                   : "; choose one column with --value_column"));
  }
  RawSamples samples;
  samples.name = name;
  samples.time.resize(static_cast<Eigen::Index>(size));
  samples.value.resize(samples.time.size());
  samples.second.resize(layout.second ? samples.time.size() : 0);
  Eigen::Index rows = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const auto number = [&](std::size_t column) { return (*chosen.columns[column])[i]; };
    bool is_complete = true;
    for (std::size_t column = 0; column < chosen.columns.size(); ++column) is_complete &= std::isfinite(number(column));
    if (!is_complete) continue;
    samples.time[rows] = number(0);
    samples.value[rows] = number(1);
    if (layout.second) samples.second[rows] = number(2);
    if (!layout.axes.empty()) {
      samples.value[rows] *= layout.direction[0];
      for (std::size_t axis = 0; axis < layout.axes.size(); ++axis) {
        samples.value[rows] += layout.direction[static_cast<Eigen::Index>(axis) + 1] * number(2 + axis);
      }
    }
    samples.lines.Add(i + 1);
    ++rows;
  }
  samples.time.conservativeResize(rows);
  samples.value.conservativeResize(rows);
  if (layout.second) samples.second.conservativeResize(rows);
  const std::size_t left_out = size - static_cast<std::size_t>(rows);
  samples.left_out = left_out;
  if (left_out > 0) samples.warnings.push_back(csv::EmptyCells(name, left_out, layout.value.name));
  if (rows >= kMinimumSamples) return samples;
  return ErrorAt(StatusCode::kFailedPrecondition, name,
                 "column " + layout.value.name + " has " + std::to_string(rows) + " numbers; at least " +
                     std::to_string(kMinimumSamples) + " are needed: record for longer");
}

/// The numbers of the table, as far as they are needed to choose columns. Shorter columns end in NaN.
csv::TableNumbers NumbersOf(const MatTable& table) {
  csv::TableNumbers numbers;
  numbers.is_clock.resize(table.columns.size());
  std::size_t longest = 0;
  for (const MatColumn& column : table.columns) longest = std::max(longest, column.values.size());
  longest = std::min(longest, csv::kMostCells / std::max<std::size_t>(table.columns.size(), 1));
  for (const MatColumn& column : table.columns) {
    const auto rows = static_cast<Eigen::Index>(std::min(column.values.size(), longest));
    Eigen::VectorXd padded = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(longest), std::nan(""));
    padded.head(rows) = Eigen::VectorXd::Map(column.values.data(), rows);
    numbers.columns.push_back(std::move(padded));
  }
  return numbers;
}

std::vector<std::vector<std::string>> FirstRowsOf(const MatTable& table) {
  std::vector<std::vector<std::string>> rows(TablePreview::kRows);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const MatColumn& column : table.columns) {
      rows[i].push_back(i < column.values.size() ? NumberText(column.values[i]) : "");
    }
  }
  return rows;
}

}  // namespace

Result<Recording> ReadMat(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  const Result<MatTable> table = ReadTable(bytes, name, options);
  return table ? FromMatTable(*table, bytes, name, options) : tl::unexpected(table.error());
}

Result<Recording> FromMatTable(const MatTable& table, std::string_view bytes, const std::string& name,
                               const ReadOptions& options) {
  csv::Line line{name, "", csv::Line::kNoNumber};
  std::vector<csv::TableColumn> columns;
  for (const MatColumn& column : table.columns) {
    columns.push_back(column.name);
    if (!column.is_unit_known) columns.back().meaning = "time";
  }
  RETURN_IF_ERROR(CheckVariables(table, columns, name, options));
  ASSIGN_OR_RETURN(const auto names, csv::NamesOf(line, columns, options));
  csv::ReadColumns read;
  read.layout.width = columns.size();
  read.layout.has_header = true;
  const csv::TableView view{.line = line,
                            .names = names,
                            .has_rate = false,
                            .has_host = false,
                            .raw_input = options.calibration ? options.calibration->input : "",
                            .value_unit = "",
                            .numbers = [&table]() -> Result<csv::TableNumbers> { return NumbersOf(table); },
                            .first_rows = [&table] { return FirstRowsOf(table); }};
  if (options.preview != nullptr) options.preview->format = "MAT-file";
  std::vector<Warning> assumptions;
  RETURN_IF_ERROR(csv::ChooseColumns(view, options, read.layout, assumptions));
  Result<RawSamples> samples = SamplesOf(table, read.layout, name);
  Result<std::string> sha256 = Sha256(bytes);
  if (!samples || !sha256) return tl::unexpected(samples ? sha256.error() : samples.error());
  read.samples = *std::move(samples);
  read.samples.warnings.insert(read.samples.warnings.begin(), assumptions.begin(), assumptions.end());
  RETURN_IF_ERROR(csv::CheckCalibration(line, read.layout.value, options, {}, read.samples.warnings));
  read.sha256 = *std::move(sha256);
  if (read.layout.time) read.samples.time_unit = read.layout.time->unit->name;
  return csv::ToRecording(std::move(read), options);
}

}  // namespace pendulum
