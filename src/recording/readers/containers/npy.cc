// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/npy.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "recording/readers/containers/bytes.h"
#include "recording/readers/containers/cell_time.h"
#include "recording/readers/containers/csv_text.h"
#include "recording/readers/containers/utf16.h"

namespace pendulum {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::string_view kEnd = ".npy";

/// The type of the numbers of a column.
struct NpyType {
  char kind = 'f';  // f, i, u, b, M (dates), m (durations), S and U (text).
  std::size_t size = 8;
  bool is_swapped = false;
  std::string unit;  // Of dates and durations.
};

struct NpyField {
  std::string name;
  NpyType type;
  std::size_t offset = 0;  // In a record.
};

struct NpyHeader {
  std::vector<NpyField> fields;  // One without a name if the array has no records.
  std::size_t record_bytes = 0;
  bool has_names = false, is_fortran_order = false;
  std::vector<std::size_t> shape;
  std::string unreadable;  // The type of a field that cannot be read.
};

// ---- The header, a dictionary of Python ----------------------------------------------------------------------------

class NpyHeaderParser {
 public:
  explicit NpyHeaderParser(std::string_view text) : text_(text) {}

  std::optional<NpyHeader> Parse() {
    NpyHeader header;
    if (!Take('{')) return std::nullopt;
    while (!Take('}')) {
      const std::optional<std::string> key = String();
      if (!key || !Take(':') || !Value(*key, header)) return std::nullopt;
      if (!header.unreadable.empty()) return header;
      Take(',');
    }
    if (header.fields.empty()) return std::nullopt;
    return header;
  }

 private:
  bool Value(const std::string& key, NpyHeader& header) {
    if (key == "descr") return Peek() == '[' ? Fields(header) : OneType(header);
    if (key == "fortran_order") {
      header.is_fortran_order = Word("True");
      return header.is_fortran_order || Word("False");
    }
    return key == "shape" && Shape(header.shape);
  }

  bool OneType(NpyHeader& header) {
    const std::optional<std::string> type = String();
    if (type) AddField("", *type, header);
    return type.has_value();
  }

  /// [('t', '<f8'), (('title', 'angle'), '<f8'), ('acceleration', '<f8', (3,))]
  bool Fields(NpyHeader& header) {
    if (!Take('[')) return false;
    header.has_names = true;
    while (!Take(']')) {
      if (!Take('(')) return false;
      const std::optional<std::string> name = FieldName();
      if (!name || !Take(',')) return false;
      if (Peek() == '[') {
        header.unreadable = "records in records";
        return true;
      }
      const std::optional<std::string> type = String();
      std::vector<std::size_t> shape;
      if (!type || (Take(',') && Peek() == '(' && !Shape(shape)) || !Take(')')) return false;
      std::size_t count = 1;
      for (const std::size_t size : shape) {
        if (size == 0 || size > kMaxParts / count) return false;
        count *= size;
      }
      for (std::size_t i = 0; i < count; ++i) {
        AddField(shape.empty() ? *name : *name + "." + std::to_string(i), *type, header);
      }
      Take(',');
    }
    return true;
  }

  std::optional<std::string> FieldName() {
    if (!Take('(')) return String();
    String();  // the title
    if (!Take(',')) return std::nullopt;
    std::optional<std::string> name = String();
    return Take(')') ? name : std::nullopt;
  }

  /// A type such as "<f8" or "<M8[ns]".
  static void AddField(const std::string& name, const std::string& text, NpyHeader& header) {
    constexpr std::size_t kMaxElement = std::size_t{1} << 20;
    NpyType type;
    std::size_t at = text.find_first_not_of("<>|=");
    type.is_swapped = text.starts_with('>');
    if (at == std::string::npos) at = 0;
    type.kind = text.empty() ? '?' : text[at];
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + std::min(at + 1, text.size()), end, type.size);
    if (type.kind == 'U') type.size *= 4;
    type.unit = std::string(stop, end);
    const bool is_sized = error == std::errc() && type.size > 0 && type.size <= kMaxElement;
    if (!is_sized || !IsReadable(type)) {
      if (header.unreadable.empty()) header.unreadable = text;
      if (!is_sized) type.size = 1;
    }
    if (type.kind != 'V') header.fields.push_back({name, type, header.record_bytes});
    header.record_bytes += type.size;
  }

  static bool IsReadable(const NpyType& type) {
    const auto is_size = [&](std::initializer_list<std::size_t> sizes) {
      return std::ranges::find(sizes, type.size) != sizes.end();
    };
    switch (type.kind) {
      case 'f': return is_size({2, 4, 8});
      case 'i':
      case 'u': return is_size({1, 2, 4, 8});
      case 'b': return is_size({1});
      case 'M':
      case 'm': return is_size({8});
      case 'S':
      case 'U':
      case 'V': return true;  // V is padding
      default: return false;
    }
  }

  bool Shape(std::vector<std::size_t>& shape) {
    if (!Take('(')) return false;
    while (!Take(')')) {
      SkipBlanks();
      std::size_t size = 0;
      const auto [stop, error] = std::from_chars(text_.data(), text_.data() + text_.size(), size);
      if (error != std::errc()) return false;
      text_.remove_prefix(stop - text_.data());
      Take('L');  // Python 2
      shape.push_back(size);
      Take(',');
    }
    return true;
  }

  std::optional<std::string> String() {
    SkipBlanks();
    if (text_.starts_with('u') || text_.starts_with('b')) text_.remove_prefix(1);
    if (text_.empty() || (text_.front() != '\'' && text_.front() != '"')) return std::nullopt;
    const std::size_t end = text_.find(text_.front(), 1);
    if (end == std::string_view::npos) return std::nullopt;
    std::string string(text_.substr(1, end - 1));
    text_.remove_prefix(end + 1);
    return string;
  }

  bool Word(std::string_view word) {
    SkipBlanks();
    if (!text_.starts_with(word)) return false;
    text_.remove_prefix(word.size());
    return true;
  }

  char Peek() {
    SkipBlanks();
    return text_.empty() ? '\0' : text_.front();
  }

  bool Take(char c) {
    if (Peek() != c) return false;
    text_.remove_prefix(1);
    return true;
  }

  void SkipBlanks() {
    while (!text_.empty() && (text_.front() == ' ' || text_.front() == '\n')) text_.remove_prefix(1);
  }

  static constexpr std::size_t kMaxParts = 1000;

  std::string_view text_;
};

// ---- Numbers -----------------------------------------------------------------------------------------------------

/// The number of bits of IEEE 754 half precision.
double NumberOfHalf(std::uint16_t half) {
  constexpr int kFractionBits = 10, kExponentMask = 31, kBias = 15;
  const int exponent = half >> kFractionBits & kExponentMask;
  const int fraction = half & ((1 << kFractionBits) - 1);
  double number = exponent == 0 ? std::ldexp(fraction, 1 - kBias - kFractionBits)
                                : std::ldexp(fraction + (1 << kFractionBits), exponent - kBias - kFractionBits);
  if (exponent == kExponentMask) number = fraction == 0 ? INFINITY : NAN;
  return half >> 15 != 0 ? -number : number;
}

template <typename Float, typename Bits>
double NumberOfBits(Bits bits) {
  Float number = 0;
  static_assert(sizeof number == sizeof bits);
  std::memcpy(&number, &bits, sizeof number);
  return number;
}

/// How many of a unit of dates are in a second, or seconds in the unit.
struct DateUnit {
  std::string_view name;
  std::int64_t seconds = 1;
  std::int64_t per_second = 1;
};

constexpr std::array kDateUnits = {
    DateUnit{"[D]", 86400, 1}, DateUnit{"[h]", 3600, 1},     DateUnit{"[m]", 60, 1},          DateUnit{"[s]", 1, 1},
    DateUnit{"[ms]", 1, 1000}, DateUnit{"[us]", 1, 1000000}, DateUnit{"[ns]", 1, 1000000000},
};

/// "2024-03-01T16:04:31.273" for a count of units since 1970.
std::string TextOfDate(std::int64_t count, const DateUnit& unit) {
  constexpr std::int64_t kMaxSeconds = 253402300800;  // The year 10000.
  std::int64_t whole = count / unit.per_second;
  std::int64_t part = count % unit.per_second;
  if (part < 0) part += unit.per_second, --whole;
  if (std::abs(whole) > kMaxSeconds / unit.seconds) return "";
  return DateText(whole * unit.seconds, part, std::to_string(unit.per_second).size() - 1);
}

/// An element's bytes as a number without a sign.
std::uint64_t BitsOf(std::string_view element, const NpyType& type) {
  std::array<char, sizeof(std::uint64_t)> ordered{};
  std::copy(element.begin(), element.end(), ordered.begin());
  if (type.is_swapped) std::reverse(ordered.begin(), ordered.begin() + static_cast<std::ptrdiff_t>(element.size()));
  return NumberAt<std::uint64_t>({ordered.data(), ordered.size()}, 0);
}

double FloatOf(std::uint64_t bits, std::size_t size) {
  if (size == sizeof(std::uint16_t)) return NumberOfHalf(static_cast<std::uint16_t>(bits));
  if (size == sizeof(float)) return NumberOfBits<float>(static_cast<std::uint32_t>(bits));
  return NumberOfBits<double>(bits);
}

std::int64_t SignedOf(std::uint64_t bits, std::size_t size) {
  const int unused = 64 - 8 * static_cast<int>(size);
  return static_cast<std::int64_t>(bits << unused) >> unused;
}

/// The unit of a date or a duration; nullptr if there is none, or if the element is NaT (not a time).
const DateUnit* UnitOf(std::int64_t count, const NpyType& type) {
  const auto* const unit = std::ranges::find(kDateUnits, type.unit, &DateUnit::name);
  const bool is_time = unit != kDateUnits.end() && count != std::numeric_limits<std::int64_t>::min();
  return is_time ? unit : nullptr;
}

std::string LettersOf(std::string_view element, const NpyType& type) {
  if (type.kind == 'S') return std::string(element.substr(0, element.find('\0')));
  std::string units;  // Each letter has four bytes; those outside of UTF-16's two do not matter here.
  for (std::size_t at = 0; at + 4 <= element.size(); at += 4) {
    const std::string_view pair = element.substr(type.is_swapped ? at + 2 : at, 2);
    if (pair == std::string_view("\0\0", 2)) break;
    units += pair;
  }
  return Utf8OfUtf16(units, type.is_swapped ? ByteOrder::kBig : ByteOrder::kLittle);
}

/// An element with a fraction, or a duration in seconds; std::nullopt for elements of other types.
std::optional<double> NumberOf(std::string_view element, const NpyType& type) {
  if (type.kind != 'f' && type.kind != 'm') return std::nullopt;
  const std::uint64_t bits = BitsOf(element, type);
  if (type.kind == 'f') return FloatOf(bits, type.size);
  const auto count = static_cast<std::int64_t>(bits);
  const DateUnit* const unit = UnitOf(count, type);
  if (unit == nullptr) return NAN;
  return static_cast<double>(count) * static_cast<double>(unit->seconds) / static_cast<double>(unit->per_second);
}

/// An element of another type: a whole number, a date, or text.
std::string TextOf(std::string_view element, const NpyType& type) {
  if (type.kind == 'S' || type.kind == 'U') return LettersOf(element, type);
  const std::uint64_t bits = BitsOf(element, type);
  switch (type.kind) {
    case 'u': return std::to_string(bits);
    case 'i': return std::to_string(SignedOf(bits, type.size));
    case 'b': return bits == 0 ? "0" : "1";
    default: break;
  }
  const auto count = static_cast<std::int64_t>(bits);
  const DateUnit* const unit = UnitOf(count, type);
  return unit == nullptr ? "" : TextOfDate(count, *unit);
}

/// Writes one element into a cell. What is no number stays empty.
void WriteElement(std::string_view element, const NpyType& type, std::size_t row, std::size_t column, CsvText& csv) {
  if (const auto number = NumberOf(element, type)) return csv.AddNumber(row, column, *number);
  csv.AddText(row, column, TextOf(element, type));
}

// ---- Arrays ------------------------------------------------------------------------------------------------------

/// An array: its header and the bytes of its elements.
struct NpyArray {
  NpyHeader header;
  std::string_view data;
  std::size_t rows = 0, columns = 1;
  bool is_transposed = false;  // The rows of the table are the columns of the array.
  std::string complaint;

  std::string_view Element(std::size_t row, std::size_t column, const NpyField& field) const {
    if (is_transposed) std::swap(row, column);
    const std::size_t array_columns = is_transposed ? rows : columns, array_rows = is_transposed ? columns : rows;
    const std::size_t index = header.is_fortran_order ? column * array_rows + row : row * array_columns + column;
    return data.substr(index * header.record_bytes + field.offset, field.type.size);
  }
};

void SetShape(NpyArray& array) {
  const std::vector<std::size_t>& shape = array.header.shape;
  array.rows = shape.empty() ? 1 : shape[0];
  if (shape.size() == 2) array.columns = shape[1];
  if (shape.size() < 2 || array.columns <= array.rows) return;
  array.is_transposed = true;
  std::swap(array.rows, array.columns);
}

NpyArray OpenNpy(std::string_view bytes) {
  constexpr std::size_t kVersionAt = 6, kSizeAt = 8;
  NpyArray array;
  const bool is_long = bytes.size() > kVersionAt && bytes[kVersionAt] > 1;
  const std::size_t begin = kSizeAt + (is_long ? sizeof(std::uint32_t) : sizeof(std::uint16_t));
  const std::size_t size = is_long ? NumberAt<std::uint32_t>(bytes, kSizeAt) : NumberAt<std::uint16_t>(bytes, kSizeAt);
  constexpr std::string_view kDamaged = "this array of NumPy is damaged or cut off; save or copy it again";
  if (!bytes.starts_with(kMagic) || bytes.size() < begin || size > bytes.size() - begin) {
    array.complaint = kDamaged;
    return array;
  }
  std::optional<NpyHeader> header = NpyHeaderParser(bytes.substr(begin, size)).Parse();
  if (!header) {
    array.complaint = kDamaged;
    return array;
  }
  array.header = *std::move(header);
  array.data = bytes.substr(begin + size);
  if (!array.header.unreadable.empty()) {
    const bool is_object = array.header.unreadable.find('O') != std::string::npos;
    array.complaint = is_object ? "this array of NumPy contains Python objects (pickle), which are not read"
                                : "this array of NumPy has elements of type " + Quoted(array.header.unreadable) +
                                      ", which are not read";
    array.complaint += "; save numbers: np.save('run.npy', np.column_stack([t, angle]).astype(float))";
    return array;
  }
  if (array.header.shape.size() > 2) {
    array.complaint = "this array of NumPy has " + std::to_string(array.header.shape.size()) +
                      " dimensions; save the times and the angles as two columns: np.column_stack([t, angle])";
    return array;
  }
  std::size_t left = array.data.size() / std::max<std::size_t>(array.header.record_bytes, 1);
  for (const std::size_t length : array.header.shape) left = length == 0 ? left : left / length;
  if (left == 0) array.complaint = kDamaged;
  SetShape(array);
  return array;
}

/// Writes an array, below a header if it has names.
void WriteArray(const NpyArray& array, CsvText& csv) {
  const std::size_t width = array.header.fields.size();
  for (std::size_t i = 0; array.header.has_names && i < width; ++i) csv.AddText(0, i, array.header.fields[i].name);
  const std::size_t first = array.header.has_names ? 1 : 0;
  for (std::size_t row = 0; row < array.rows && !csv.is_full(); ++row) {
    for (std::size_t column = 0; column < array.columns; ++column) {
      for (std::size_t i = 0; i < width; ++i) {
        const NpyField& field = array.header.fields[i];
        WriteElement(array.Element(row, column, field), field.type, first + row, column * width + i, csv);
      }
    }
  }
}

bool IsVector(const NpyArray& array) { return array.columns == 1 && !array.header.has_names; }

struct NpyVector {
  std::string name;
  std::string bytes;
  NpyArray array;
};

/// All vectors as columns with their names, after the lines of metadata.
void WriteVectors(const std::vector<NpyVector>& vectors, const std::vector<std::string>& comments, CsvText& csv) {
  std::size_t row = 0, rows = 0;
  for (const std::string& comment : comments) csv.AddText(row++, 0, comment);
  for (std::size_t i = 0; i < vectors.size(); ++i) csv.AddText(row, i, vectors[i].name);
  for (const NpyVector& vector : vectors) rows = std::max(rows, vector.array.rows);
  for (std::size_t r = 0; r < rows && !csv.is_full(); ++r) {
    ++row;
    for (std::size_t i = 0; i < vectors.size(); ++i) {
      const NpyArray& array = vectors[i].array;
      const NpyField& field = array.header.fields.front();
      if (r < array.rows) WriteElement(array.Element(r, 0, field), field.type, row, i, csv);
    }
  }
}

/// A number or a text without dimensions as "# key: value", or the parts of a record.
std::string CommentOf(const std::string& name, const NpyArray& array) {
  std::string comment = "# " + name + ":";
  for (const NpyField& field : array.header.fields) {
    const std::string_view element = array.Element(0, 0, field);
    const auto number = NumberOf(element, field.type);
    comment += " " + (number ? NumberText(*number) : TextOf(element, field.type));
  }
  return comment;
}

}  // namespace

Workbook ReadNpy(std::string_view bytes, std::size_t max_bytes) {
  Workbook workbook;
  const NpyArray array = OpenNpy(bytes);
  workbook.complaint = array.complaint;
  if (!array.complaint.empty()) return workbook;
  CsvText csv(max_bytes);
  WriteArray(array, csv);
  Sheet sheet;
  if (FinishSheet(csv, max_bytes, sheet, workbook)) workbook.sheets.push_back(std::move(sheet));
  return workbook;
}

bool IsNpz(const ZipMembers& zip) {
  const auto is_array = [](const ZipMembers::Member& member) { return member.path.ends_with(kEnd); };
  return !zip.members().empty() && std::ranges::all_of(zip.members(), is_array);
}

Workbook ReadNpz(const ZipMembers& zip, std::size_t max_bytes) {
  Workbook workbook;
  std::vector<NpyVector> vectors;
  vectors.reserve(zip.members().size());  // Arrays refer to the bytes beside them.
  std::vector<std::string> comments;
  std::string complaint;
  std::size_t left = max_bytes;
  for (const ZipMembers::Member& member : zip.members()) {
    Result<std::string> bytes = zip.Unpack(member, left + 1);
    if (!bytes) {
      complaint = "array " + Quoted(member.path) + " cannot be unpacked; save it again";
      continue;
    }
    workbook.is_too_large = bytes->size() > left;
    if (workbook.is_too_large) return workbook;
    left -= bytes->size();
    NpyVector& vector =
        vectors.emplace_back(NpyVector{member.path.substr(0, member.path.size() - kEnd.size()), *std::move(bytes), {}});
    vector.array = OpenNpy(vector.bytes);
    if (!vector.array.complaint.empty()) {
      complaint = vector.array.complaint;
      vectors.pop_back();
    } else if (vector.array.header.shape.empty()) {
      comments.push_back(CommentOf(vector.name, vector.array));
      vectors.pop_back();
    } else if (!IsVector(vector.array)) {
      CsvText csv(max_bytes);
      WriteArray(vector.array, csv);
      Sheet sheet{vector.name, ""};
      if (!FinishSheet(csv, max_bytes, sheet, workbook)) return workbook;
      workbook.sheets.push_back(std::move(sheet));
      vectors.pop_back();
    }
  }
  if (!vectors.empty()) {
    CsvText csv(max_bytes);
    WriteVectors(vectors, comments, csv);
    Sheet sheet;
    if (!FinishSheet(csv, max_bytes, sheet, workbook)) return workbook;
    workbook.sheets.insert(workbook.sheets.begin(), std::move(sheet));
  }
  if (workbook.sheets.empty()) workbook.complaint = complaint;
  return workbook;
}

}  // namespace pendulum
