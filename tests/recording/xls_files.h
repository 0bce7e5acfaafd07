// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

/// Workbooks of Excel 97 for tests ([MS-XLS], [MS-CFB]).
namespace pendulum {

template <typename T>
std::string LittleEndian(T number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

inline std::string U16(std::uint32_t number) { return LittleEndian(static_cast<std::uint16_t>(number)); }
inline std::string U32(std::uint32_t number) { return LittleEndian(number); }

inline std::string BiffRecordOf(std::uint16_t type, const std::string& data) {
  return U16(type) + U16(static_cast<std::uint32_t>(data.size())) + data;
}

/// A text of one byte per character with a length of two bytes.
inline std::string BiffText(const std::string& text) {
  return U16(static_cast<std::uint32_t>(text.size())) + std::string(1, '\0') + text;
}

/// The place of a cell and its style.
inline std::string At(int row, int column, int style = 0) { return U16(row) + U16(column) + U16(style); }

inline std::string NumberRecord(int row, int column, double number, int style = 0) {
  return BiffRecordOf(0x0203, At(row, column, style) + LittleEndian(number));
}
inline std::string RkRecord(int row, int column, std::uint32_t rk, int style = 0) {
  return BiffRecordOf(0x027E, At(row, column, style) + U32(rk));
}
inline std::string LabelRecord(int row, int column, const std::string& text) {
  return BiffRecordOf(0x0204, At(row, column) + BiffText(text));
}
inline std::string FormulaRecord(int row, int column, const std::string& result, int style = 0) {
  return BiffRecordOf(0x0006, At(row, column, style) + result + std::string(8, '\0'));
}
inline std::string EndRecord() { return BiffRecordOf(0x000A, ""); }
inline std::string BeginRecord(std::uint16_t kind, std::uint16_t version = 0x0600) {
  return BiffRecordOf(0x0809, U16(version) + U16(kind) + std::string(12, '\0'));
}

/// A compound file with these streams, each in sectors of its own. Excel's shortest stream there has 4096 bytes.
inline std::string CompoundFileOf(const std::vector<std::pair<std::string, std::string>>& streams,
                                  std::size_t smallest = 4096) {
  constexpr std::size_t kSector = 512;
  constexpr std::uint32_t kEnd = 0xFFFFFFFE, kFree = 0xFFFFFFFF, kTable = 0xFFFFFFFD;
  const auto entry = [](const std::string& name, char type, std::uint32_t first, std::size_t size) {
    std::string bytes(128, '\0');
    for (std::size_t i = 0; i < name.size(); ++i) bytes[2 * i] = name[i];
    bytes[64] = static_cast<char>(2 * name.size() + 2);
    bytes[66] = type;
    bytes.replace(116, 4, U32(first));
    bytes.replace(120, 4, U32(static_cast<std::uint32_t>(size)));
    return bytes;
  };
  std::string directory = entry("Root Entry", 5, kEnd, 0), data;
  std::vector<std::uint32_t> next;
  for (const auto& [name, stream] : streams) {
    const auto first = static_cast<std::uint32_t>(next.size());
    const std::size_t size = std::max(stream.size(), smallest);
    const std::size_t sectors = (size + kSector - 1) / kSector;
    for (std::size_t i = 1; i < sectors; ++i) next.push_back(static_cast<std::uint32_t>(next.size() + 1));
    next.push_back(kEnd);
    data += stream + std::string(sectors * kSector - stream.size(), '\0');
    directory += entry(name, 2, first, size);
  }
  directory.resize((directory.size() + kSector - 1) / kSector * kSector);
  const auto directory_at = static_cast<std::uint32_t>(next.size());
  for (std::size_t i = 1; i < directory.size() / kSector; ++i)
    next.push_back(static_cast<std::uint32_t>(next.size() + 1));
  next.push_back(kEnd);
  const std::size_t per_sector = kSector / 4;
  const std::size_t tables = next.size() / (per_sector - 1) + 1;
  const auto table_at = static_cast<std::uint32_t>(next.size());
  next.resize(next.size() + tables, kTable);
  next.resize(tables * per_sector, kFree);
  std::string header(kSector, '\0');
  header.replace(0, 8, "\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1");
  header.replace(26, 6, U16(3) + U16(0xFFFE) + U16(9));
  header.replace(44, 8, U32(static_cast<std::uint32_t>(tables)) + U32(directory_at));
  header.replace(56, 20, U32(static_cast<std::uint32_t>(smallest)) + U32(kEnd) + U32(0) + U32(kEnd) + U32(0));
  for (std::size_t i = 0; i < 109; ++i) {
    header.replace(76 + 4 * i, 4, U32(i < tables ? table_at + static_cast<std::uint32_t>(i) : kFree));
  }
  std::string table;
  for (const std::uint32_t each : next) table += U32(each);
  return header + data + directory + table;
}

/// A sheet: its name, and the records of its cells.
struct XlsSheetOf {
  std::string name, records;
  std::uint8_t type = 0;  // 0: cells, 2: a chart.
};

/// The stream of a workbook; `globals` are records before those of the sheets.
inline std::string XlsStream(const std::vector<XlsSheetOf>& sheets, const std::string& globals = "") {
  std::string begin = BeginRecord(5) + globals;
  std::size_t offset = begin.size() + EndRecord().size();
  for (const XlsSheetOf& sheet : sheets) offset += BiffRecordOf(0, std::string(8 + sheet.name.size(), 0)).size();
  std::string content;
  for (const XlsSheetOf& sheet : sheets) {
    begin += BiffRecordOf(0x0085, U32(static_cast<std::uint32_t>(offset + content.size())) + std::string(1, '\0') +
                                      static_cast<char>(sheet.type) + static_cast<char>(sheet.name.size()) + '\0' +
                                      sheet.name);
    content += BeginRecord(0x10) + sheet.records + EndRecord();
  }
  return begin + EndRecord() + content;
}

inline std::string XlsOf(const std::vector<XlsSheetOf>& sheets, const std::string& globals = "") {
  return CompoundFileOf({{"\x05SummaryInformation", ""}, {"Workbook", XlsStream(sheets, globals)}});
}

}  // namespace pendulum
