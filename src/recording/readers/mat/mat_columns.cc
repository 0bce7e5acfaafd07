// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_columns.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <set>
#include <span>
#include <utility>

#include <matio.h>
#include <sys/resource.h>

#include "recording/readers/columns/runs.h"
#include "recording/readers/mat/mat_hdf5.h"
#include "recording/readers/mat/mat_subsystem.h"
#include "recording/readers/mat/mat_timeseries.h"

namespace pendulum {
namespace {

struct CloseFile {
  void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};

/// The run of all variables that do not belong to a structure or a matrix with its own time.
constexpr const char* kTopLevel = "top level";

constexpr const char* kObject = "an object";

std::string* complaint = nullptr;  // Where matio's messages are stored. Its callback has no argument for this.

/// Stores the first serious message of matio. A file that ends too early causes only a warning, although the following
/// numbers are wrong, so warnings are serious. Warnings of unknown kinds of objects or text are ignored, because other
/// variables are not affected.
void RecordMatioMessage(int level, char* message) {
  constexpr int kSerious = MATIO_LOG_LEVEL_ERROR | MATIO_LOG_LEVEL_CRITICAL | MATIO_LOG_LEVEL_WARNING;
  const auto says = [&](std::string_view words) {
    return std::string_view(message).find(words) != std::string_view::npos;
  };
  if (complaint == nullptr || (level & kSerious) == 0) return;
  if (level == MATIO_LOG_LEVEL_WARNING && (says("not a supported class") || says("for character data"))) return;
  // matio sends one message for each level of HDF5's error stack, from the outermost call to the root cause. The first
  // message is kept, unless a later one says that another file cannot be opened.
  const bool is_other_file = says("minor: Unable to open file");
  if (is_other_file || complaint->empty()) *complaint = is_other_file ? kOtherFile : message;
}

/// After this call the process can open no more files.
void ForbidOpeningFiles() {
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_NOFILE, &none);
}

/// Simulink's `tout` is in seconds.
std::string MeaningOf(const std::string& name) { return name == "tout" ? "time_s" : name; }

std::size_t CountOf(const matvar_t& variable) {
  std::size_t count = variable.rank > 0 ? 1 : 0;
  for (const std::size_t size : std::span(variable.dims, static_cast<std::size_t>(std::max(variable.rank, 0)))) {
    if (__builtin_mul_overflow(count, size, &count)) return 0;
  }
  return count;
}

template <typename T>
std::vector<double> Doubles(const matvar_t& variable, std::size_t count) {
  const auto* const data = static_cast<const T*>(variable.data);
  std::vector<double> values(count);
  std::transform(data, data + count, values.begin(), [](T value) { return static_cast<double>(value); });
  return values;
}

/// All numbers of a real, full array in MATLAB's order; empty for anything else.
std::vector<double> NumbersOf(const matvar_t& variable) {
  const std::size_t count = CountOf(variable);
  if (variable.data == nullptr || variable.isComplex != 0 || variable.data_size <= 0) return {};
  if (count > variable.nbytes / static_cast<std::size_t>(variable.data_size)) return {};
  switch (variable.class_type) {
    case MAT_C_DOUBLE: return Doubles<double>(variable, count);
    case MAT_C_SINGLE: return Doubles<float>(variable, count);
    case MAT_C_INT8: return Doubles<std::int8_t>(variable, count);
    case MAT_C_UINT8: return Doubles<std::uint8_t>(variable, count);
    case MAT_C_INT16: return Doubles<std::int16_t>(variable, count);
    case MAT_C_UINT16: return Doubles<std::uint16_t>(variable, count);
    case MAT_C_INT32: return Doubles<std::int32_t>(variable, count);
    case MAT_C_UINT32: return Doubles<std::uint32_t>(variable, count);
    case MAT_C_INT64: return Doubles<std::int64_t>(variable, count);
    case MAT_C_UINT64: return Doubles<std::uint64_t>(variable, count);
    default: return {};
  }
}

std::string KindOf(const matvar_t& variable) {
  if (variable.isComplex != 0) return "complex";
  switch (variable.class_type) {
    case MAT_C_CELL: return "a cell array";
    case MAT_C_STRUCT: return "a structure without columns";
    case MAT_C_CHAR: return "text";
    case MAT_C_SPARSE: return "sparse";
    case MAT_C_OBJECT:
    case MAT_C_FUNCTION:
    case MAT_C_OPAQUE: return kObject;
    default: return "no vector";
  }
}

/// Puts the variables of a file into a table.
class Collector {
 public:
  /// Variables that are objects are skipped.
  Collector(MatTable& table, const std::vector<MatReference>& objects) : table_(table) {
    for (const MatReference& object : objects) {
      const bool is_within = object.place.find_first_of(".{") != std::string::npos;
      if (!is_within) objects_.insert(object.place.substr(0, object.place.find('(')));
    }
  }

  void Add(const matvar_t& variable) {
    // For objects matio gives no name, or the name of the system to which they belong.
    if (variable.name == nullptr || variable.class_type == MAT_C_OPAQUE) return;
    const std::string name = variable.name;
    if (name.empty() || objects_.contains(name)) return;
    const std::size_t before = table_.columns.size();
    if (variable.class_type == MAT_C_STRUCT) {
      AddStructure(variable, name, name);
    } else {
      AddArray(variable, name, name, kTopLevel);
    }
    const bool is_scalar = CountOf(variable) == 1 && variable.class_type >= MAT_C_DOUBLE;
    const bool is_plain = is_scalar && variable.class_type < MAT_C_FUNCTION;
    if (table_.columns.size() == before && !is_plain) {
      const std::string kind = KindOf(variable);
      table_.skipped.push_back({name, kind, kind == kObject});
    }
  }

 private:
  /// Adds a vector, or the columns of a matrix (its rows, if there are more columns). A first column that increases is
  /// the time.
  void AddArray(const matvar_t& variable, const std::string& written, const std::string& meaning,
                const std::string& run) {
    std::vector<double> numbers = NumbersOf(variable);
    const std::size_t rows = numbers.empty() ? 0 : LongestOf(variable);
    if (rows < 2) return;
    const std::size_t columns = numbers.size() / rows;
    if (columns == 1) {
      const std::string sense = MeaningOf(meaning);
      table_.columns.push_back({{written, sense, run}, std::move(numbers), IsTimeUnitKnown(sense)});
      return;
    }
    if (variable.rank != 2 || columns > kMaxMatColumns) return;
    const bool is_upright = variable.dims[0] == rows;
    const auto column = [&](std::size_t j) {
      std::vector<double> values(rows);
      for (std::size_t i = 0; i < rows; ++i) values[i] = numbers[is_upright ? j * rows + i : i * columns + j];
      return values;
    };
    const std::vector<double> first = column(0);
    const bool has_time = std::ranges::adjacent_find(first, std::greater_equal<>()) == first.end();
    for (std::size_t j = 0; j < columns; ++j) {
      const std::string number = std::to_string(j + 1);
      const std::string place = is_upright ? "(:," + number + ")" : "(" + number + ",:)";
      table_.columns.push_back({{written + place, j == 0 && has_time ? "time_s" : meaning, has_time ? written : run},
                                j == 0 ? first : column(j),
                                j > 0 || !has_time});
    }
  }

  /// Whether the unit of a time is certain. Simulink's times are in seconds: `tout`, and the times of a structure
  /// with signals (AddStructure).
  static bool IsTimeUnitKnown(const std::string& sense) {
    return !csv::IsTime(sense) || csv::FindUnit(sense) != nullptr;
  }

  static std::size_t LongestOf(const matvar_t& variable) {
    return *std::max_element(variable.dims, variable.dims + variable.rank);
  }

  /// Adds the fields of a structure and of nested structures. In Simulink's `signals` the quantity is in `values` and
  /// its name in `label`.
  void AddStructure(const matvar_t& structure, const std::string& written, const std::string& meaning) {
    constexpr std::size_t kMaxElements = 100, kDeepest = 6;
    const std::size_t elements = CountOf(structure);
    const std::size_t fields = Mat_VarGetNumberOfFields(const_cast<matvar_t*>(&structure));  // NOLINT: only reads
    if (elements == 0 || elements > kMaxElements || structure.data == nullptr || depth_ == kDeepest) return;
    ++depth_;
    const std::size_t first = table_.columns.size();
    bool has_signals = false;
    auto* const* const members = static_cast<matvar_t**>(structure.data);
    for (std::size_t i = 0; i < elements; ++i) {
      const std::string element = elements == 1 ? written : written + "(" + std::to_string(i + 1) + ")";
      const std::span<matvar_t* const> of_element(members + i * fields, fields);
      for (const matvar_t* field : of_element) {
        if (field == nullptr || field->name == nullptr) continue;
        has_signals |= std::string_view(field->name) == "signals";
        AddField(*field, element, LabelOf(of_element, meaning));
      }
    }
    --depth_;
    if (has_signals) MarkUnitKnown(first, written + ".time");
    GroupByTime(first, written);
  }

  void AddField(const matvar_t& field, const std::string& structure, const std::string& meaning) {
    const std::string name = field.name;
    const std::string written = structure + "." + name;
    if (field.class_type == MAT_C_STRUCT) {
      AddStructure(field, written, name == "signals" ? meaning : name);
    } else {
      AddArray(field, written, name == "values" ? meaning : name, kTopLevel);
    }
  }

  /// MATLAB writes letters in one or two bytes. A unit needs only ASCII letters.
  static std::string AsciiOf(const matvar_t& text) {
    const std::size_t count = CountOf(text);
    std::string ascii;
    if (text.data_size <= 0 || count > text.nbytes / static_cast<std::size_t>(text.data_size)) return ascii;
    const auto take = [&]<typename T>(const T* letters) {
      for (std::size_t i = 0; i < count; ++i) ascii += letters[i] < 0x80 ? static_cast<char>(letters[i]) : '?';
    };
    if (text.data_size == 1) take(static_cast<const std::uint8_t*>(text.data));
    if (text.data_size == 2) take(static_cast<const std::uint16_t*>(text.data));
    return ascii;
  }

  /// The text in the field `label` if it contains a unit, otherwise `otherwise`.
  static std::string LabelOf(std::span<matvar_t* const> fields, const std::string& otherwise) {
    for (const matvar_t* field : fields) {
      const bool is_label = field != nullptr && field->name != nullptr && std::string_view(field->name) == "label";
      if (!is_label || field->class_type != MAT_C_CHAR || field->data == nullptr) continue;
      std::string label = AsciiOf(*field);
      if (csv::FindUnit(label) != nullptr) return label;
    }
    return otherwise;
  }

  void MarkUnitKnown(std::size_t first, const std::string& written) {
    for (MatColumn& column : std::span(table_.columns).subspan(first)) {
      if (column.name.written != written) continue;
      column.is_unit_known = true;
      if (csv::FindUnit(column.name.meaning) == nullptr) column.name.meaning = "time_s";
    }
  }

  /// Columns of a structure with its own time form a run.
  void GroupByTime(std::size_t first, const std::string& run) {
    const std::span<MatColumn> own = std::span(table_.columns).subspan(first);
    const auto is_time = [](const MatColumn& column) {
      return column.name.run == kTopLevel && csv::IsTime(column.name.meaning);
    };
    if (std::ranges::none_of(own, is_time)) return;
    for (MatColumn& column : own) {
      if (column.name.run == kTopLevel) column.name.run = run;
    }
  }

  MatTable& table_;
  std::set<std::string> objects_;  // Names of variables.
  std::size_t depth_ = 0;
};

}  // namespace

MatTable ReadMatTable(const std::string& path, std::string_view bytes) {
  MatTable table;
  complaint = &table.complaint;
  Mat_LogInitFunc("matio", RecordMatioMessage);
  const std::unique_ptr<mat_t, CloseFile> file(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
  const mat_ft version = file == nullptr ? MAT_FT_UNDEFINED : Mat_GetVersion(file.get());
  std::function<MatSubsystem()> in_hdf5;
  if (version == MAT_FT_MAT73) in_hdf5 = OpenHdf5(path);  // Before opening files is disabled.
  ForbidOpeningFiles();
  if (file == nullptr && (table.complaint.empty() || table.complaint == kOtherFile)) {
    table.complaint = "no MAT-file, or cut off";
  }
  const MatSubsystem subsystem = in_hdf5 ? in_hdf5() : version == MAT_FT_MAT5 ? SubsystemOf(bytes) : MatSubsystem{};
  Collector collector(table, subsystem.references);
  for (std::size_t i = 0; file != nullptr && i < subsystem.variables; ++i) {
    const std::unique_ptr<matvar_t, FreeVariable> variable(Mat_VarReadNext(file.get()));
    if (variable == nullptr) break;
    collector.Add(*variable);
  }
  complaint = nullptr;
  AddTimeseries(subsystem, table);
  return table;
}

}  // namespace pendulum
