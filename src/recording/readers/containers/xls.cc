// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/xls.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "recording/readers/containers/bytes.h"
#include "recording/readers/containers/cell_time.h"
#include "recording/readers/containers/compound_file.h"
#include "recording/readers/containers/csv_text.h"
#include "recording/readers/containers/utf16.h"

namespace pendulum {
namespace {

/// Numbers of records. The same in BIFF5 and BIFF8, the versions of Excel 5 and 97.
enum BiffRecordType : std::uint16_t {
  kFormula = 0x0006,
  kEof = 0x000A,
  kDateMode = 0x0022,
  kFilePass = 0x002F,
  kContinue = 0x003C,
  kBoundSheet = 0x0085,
  kMulRk = 0x00BD,
  kRString = 0x00D6,
  kXf = 0x00E0,
  kSst = 0x00FC,
  kLabelSst = 0x00FD,
  kNumber = 0x0203,
  kLabel = 0x0204,
  kBoolErr = 0x0205,
  kString = 0x0207,
  kRk = 0x027E,
  kFormat = 0x041E,
  kBof = 0x0809,
};

constexpr std::uint16_t kBiff8 = 0x0600;

struct BiffRecord {
  std::uint16_t type = 0;
  std::string_view data;

  template <typename T>
  T At(std::size_t at) const {
    return NumberAt<T>(data, at);
  }
};

/// Reads the records of a stream one after another.
class BiffRecords {
 public:
  BiffRecords(std::string_view stream, std::size_t at) : rest_(stream.substr(std::min(at, stream.size()))) {}

  /// Takes the next record; false at the end, and for a record that is cut off.
  bool Next(BiffRecord& record) {
    constexpr std::size_t kHeader = 4;
    if (rest_.size() < kHeader) return false;
    const auto size = NumberAt<std::uint16_t>(rest_, 2);
    if (size > rest_.size() - kHeader) return false;
    record = {NumberAt<std::uint16_t>(rest_, 0), rest_.substr(kHeader, size)};
    rest_.remove_prefix(kHeader + size);
    return true;
  }

  std::uint16_t NextType() const { return NumberAt<std::uint16_t>(rest_, 0); }

 private:
  std::string_view rest_;
};

/// The characters of a string of BIFF8.
std::string TextOf(std::string_view characters, bool is_wide) {
  return is_wide ? Utf8OfUtf16(characters, ByteOrder::kLittle) : Utf8OfLatin1(characters);
}

/// The shared strings, which go on in the records after theirs.
class XlsStrings {
 public:
  explicit XlsStrings(std::vector<std::string_view> parts) : parts_(std::move(parts)) {}

  std::vector<std::string> Read() {
    constexpr std::size_t kCountAt = 4, kBegin = 8;
    const std::size_t count = NumberAt<std::uint32_t>(parts_.front(), kCountAt);
    Skip(kBegin);
    std::vector<std::string> strings;
    while (strings.size() < count && !IsAtEnd()) strings.push_back(ReadOne());
    return strings;
  }

 private:
  bool IsAtEnd() {
    while (part_ < parts_.size() && parts_[part_].empty()) ++part_;
    return part_ == parts_.size();
  }

  void Skip(std::size_t size) {
    while (size > 0 && !IsAtEnd()) {
      const std::size_t step = std::min(size, parts_[part_].size());
      parts_[part_].remove_prefix(step);
      size -= step;
    }
  }

  template <typename T>
  T Take() {
    if (IsAtEnd()) return 0;
    const T number = NumberAt<T>(parts_[part_], 0);
    Skip(sizeof(T));
    return number;
  }

  /// A string may continue in the next record, whose first byte gives the width again.
  std::string ReadOne() {
    constexpr unsigned kWide = 1, kExtended = 4, kRich = 8;
    constexpr std::size_t kRunBytes = 4;
    std::size_t left = Take<std::uint16_t>();
    const unsigned flags = Take<std::uint8_t>();
    bool is_wide = (flags & kWide) != 0;
    const std::size_t runs = (flags & kRich) != 0 ? Take<std::uint16_t>() : 0;
    const std::size_t extension = (flags & kExtended) != 0 ? Take<std::uint32_t>() : 0;
    std::string text;
    while (left > 0 && part_ < parts_.size()) {
      if (parts_[part_].empty()) {
        if (++part_ < parts_.size()) is_wide = (Take<std::uint8_t>() & kWide) != 0;
        continue;
      }
      const std::size_t width = is_wide ? 2 : 1;
      const std::size_t characters = std::min(left, (parts_[part_].size() + width - 1) / width);
      text += TextOf(parts_[part_].substr(0, characters * width), is_wide);
      parts_[part_].remove_prefix(std::min(characters * width, parts_[part_].size()));
      left -= characters;
    }
    Skip(kRunBytes * runs + extension);
    return text;
  }

  std::vector<std::string_view> parts_;
  std::size_t part_ = 0;
};

struct XlsSheet {
  std::string name;
  std::size_t offset = 0;
  bool has_cells = true;
};

/// What the sheets refer to.
struct XlsGlobals {
  bool is_biff8 = true, is_1904 = false, is_encrypted = false;
  std::vector<XlsSheet> sheets;
  std::vector<std::string> strings;
  std::vector<std::uint16_t> formats;     // Of each XF.
  std::map<std::uint16_t, bool> is_time;  // For formats that the file defines.

  bool IsTime(std::size_t xf) const {
    if (xf >= formats.size()) return false;
    const auto own = is_time.find(formats[xf]);
    return own == is_time.end() ? IsTimeFormat(static_cast<int>(formats[xf])) : own->second;
  }
};

/// A string with its length before it: of one byte or two, `at` in the record.
std::string StringAt(const BiffRecord& record, std::size_t at, std::size_t length_bytes, bool is_biff8) {
  const std::size_t length = length_bytes == 1 ? record.At<std::uint8_t>(at) : record.At<std::uint16_t>(at);
  at += length_bytes;
  const std::string_view rest = record.data.substr(std::min(at, record.data.size()));
  if (!is_biff8) return Utf8OfLatin1(rest.substr(0, length));
  if (rest.empty()) return "";
  const bool is_wide = (rest.front() & 1) != 0;
  return TextOf(rest.substr(1, is_wide ? 2 * length : length), is_wide);
}

XlsGlobals ReadGlobals(std::string_view stream) {
  constexpr std::size_t kSheetTypeAt = 5, kSheetNameAt = 6;
  XlsGlobals globals;
  BiffRecords records(stream, 0);
  BiffRecord record;
  while (records.Next(record) && record.type != kEof) {
    switch (record.type) {
      case kBof: globals.is_biff8 = record.At<std::uint16_t>(0) == kBiff8; break;
      case kFilePass: globals.is_encrypted = true; return globals;
      case kDateMode: globals.is_1904 = record.At<std::uint16_t>(0) == 1; break;
      case kBoundSheet:
        globals.sheets.push_back({StringAt(record, kSheetNameAt, 1, globals.is_biff8), record.At<std::uint32_t>(0),
                                  record.At<std::uint8_t>(kSheetTypeAt) == 0});
        break;
      case kFormat:
        globals.is_time[record.At<std::uint16_t>(0)] =
            IsTimeFormat(StringAt(record, 2, globals.is_biff8 ? 2 : 1, globals.is_biff8));
        break;
      case kXf: globals.formats.push_back(record.At<std::uint16_t>(2)); break;
      case kSst: {
        std::vector<std::string_view> parts = {record.data};
        while (records.NextType() == kContinue && records.Next(record)) parts.push_back(record.data);
        globals.strings = XlsStrings(std::move(parts)).Read();
        break;
      }
      default: break;
    }
  }
  return globals;
}

struct XlsCell {
  std::uint16_t row = 0, column = 0;
  std::optional<double> number;
  std::string text;
};

/// The compressed form of a number.
double NumberOfRk(std::uint32_t rk) {
  constexpr std::uint32_t kHundredths = 1, kInteger = 2;
  std::string high(sizeof(double), '\0');
  for (std::size_t i = 0; i < sizeof rk; ++i) high[sizeof rk + i] = static_cast<char>((rk & ~3U) >> (8 * i));
  const double number =
      (rk & kInteger) != 0 ? static_cast<double>(static_cast<std::int32_t>(rk) >> 2) : NumberAt<double>(high, 0);
  return (rk & kHundredths) != 0 ? number / 100 : number;
}

/// Reads the cells of one sheet.
class XlsSheetReader {
 public:
  explicit XlsSheetReader(const XlsGlobals& globals) : globals_(globals) {}

  /// False if the sheet is cut off.
  bool Read(std::string_view stream, std::size_t offset) {
    BiffRecords records(stream, offset);
    BiffRecord record;
    int depth = 0;  // A chart in the sheet has its own begin and end.
    while (records.Next(record)) {
      depth += record.type == kBof ? 1 : record.type == kEof ? -1 : 0;
      if (depth == 1) ReadRecord(record);
      if (depth <= 0) return record.type == kEof;
    }
    return false;
  }

  void WriteTo(CsvText& csv) {
    std::ranges::sort(cells_, std::less<>(), [](const XlsCell& cell) { return std::tuple(cell.row, cell.column); });
    for (const XlsCell& cell : cells_) {
      if (cell.number) {
        csv.AddNumber(cell.row, cell.column, *cell.number);
      } else {
        csv.AddText(cell.row, cell.column, cell.text);
      }
    }
  }

 private:
  static constexpr std::size_t kXfAt = 4, kValueAt = 6;

  XlsCell& Add(const BiffRecord& record) {
    return cells_.emplace_back(XlsCell{record.At<std::uint16_t>(0), record.At<std::uint16_t>(2), {}, {}});
  }

  void AddNumber(std::size_t row, std::size_t column, std::size_t xf, double number) {
    XlsCell& cell = cells_.emplace_back(
        XlsCell{static_cast<std::uint16_t>(row), static_cast<std::uint16_t>(column), std::nullopt, ""});
    if (globals_.IsTime(xf)) {
      cell.text = TimeText(number, globals_.is_1904);
    } else {
      cell.number = number;
    }
  }

  void AddNumber(const BiffRecord& record, double number) {
    AddNumber(record.At<std::uint16_t>(0), record.At<std::uint16_t>(2), record.At<std::uint16_t>(kXfAt), number);
  }

  void ReadRecord(const BiffRecord& record) {
    switch (record.type) {
      case kNumber: return AddNumber(record, record.At<double>(kValueAt));
      case kRk: return AddNumber(record, NumberOfRk(record.At<std::uint32_t>(kValueAt)));
      case kMulRk: return ReadMulRk(record);
      case kFormula: return ReadFormula(record);
      case kBoolErr:
        if (record.At<std::uint8_t>(kValueAt + 1) == 0) AddBool(record, record.At<std::uint8_t>(kValueAt));
        return;
      case kLabelSst:
        if (const auto i = record.At<std::uint32_t>(kValueAt); i < globals_.strings.size()) {
          Add(record).text = globals_.strings[i];
        }
        return;
      case kLabel:
      case kRString: Add(record).text = StringAt(record, kValueAt, 2, globals_.is_biff8); return;
      case kString:
        if (is_text_expected_) cells_.back().text = StringAt(record, 0, 2, globals_.is_biff8);
        is_text_expected_ = false;
        return;
      default: return;
    }
  }

  void AddBool(const BiffRecord& record, std::uint8_t value) { Add(record).text = value == 0 ? "FALSE" : "TRUE"; }

  void ReadMulRk(const BiffRecord& record) {
    constexpr std::size_t kStep = 6;
    std::size_t column = record.At<std::uint16_t>(2);
    for (std::size_t at = kXfAt; at + kStep <= record.data.size(); at += kStep) {
      AddNumber(record.At<std::uint16_t>(0), column++, record.At<std::uint16_t>(at),
                NumberOfRk(record.At<std::uint32_t>(at + 2)));
    }
  }

  /// The stored result of a formula. A text follows in a record of its own; an error stays empty.
  void ReadFormula(const BiffRecord& record) {
    constexpr std::uint16_t kNoNumber = 0xFFFF;
    constexpr std::uint8_t kText = 0, kBool = 1;
    if (record.At<std::uint16_t>(kValueAt + 6) != kNoNumber) return AddNumber(record, record.At<double>(kValueAt));
    const auto kind = record.At<std::uint8_t>(kValueAt);
    is_text_expected_ = kind == kText;
    if (kind == kText) Add(record);
    if (kind == kBool) AddBool(record, record.At<std::uint8_t>(kValueAt + 2));
  }

  const XlsGlobals& globals_;
  std::vector<XlsCell> cells_;
  bool is_text_expected_ = false;
};

Workbook Complain(std::string complaint) {
  Workbook workbook;
  workbook.complaint = std::move(complaint);
  return workbook;
}

}  // namespace

Workbook ReadXls(std::string_view bytes, std::size_t max_bytes) {
  const CompoundFile file(bytes);
  const auto stream = file.Read(file.Has("Workbook") ? "Workbook" : "Book");
  if (!stream) return Complain("this workbook is damaged or cut off; save or copy it again");
  const XlsGlobals globals = ReadGlobals(*stream);
  if (globals.is_encrypted) return Complain("this workbook is encrypted; save it without a password");
  Workbook workbook;
  for (const XlsSheet& listed : globals.sheets) {
    if (!listed.has_cells) continue;
    XlsSheetReader reader(globals);
    if (!reader.Read(*stream, listed.offset)) {
      return Complain("this workbook is cut off in sheet " + Quoted(listed.name) + "; save or copy it again");
    }
    CsvText csv(max_bytes, kMaxSheetRows);
    reader.WriteTo(csv);
    Sheet sheet{listed.name, ""};
    if (!FinishSheet(csv, max_bytes, sheet, workbook)) return workbook;
    workbook.sheets.push_back(std::move(sheet));
  }
  ComplainIfEmpty(workbook);
  return workbook;
}

}  // namespace pendulum
