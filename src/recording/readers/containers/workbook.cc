// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/workbook.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <utility>

#include "pendulum/base/format.h"

namespace pendulum {
namespace {

void PutLength(std::size_t length, std::string& bytes) {
  const std::uint64_t number = length;
  std::array<char, sizeof number> raw{};
  std::memcpy(raw.data(), &number, sizeof number);
  bytes.append(raw.data(), raw.size());
}

void PutString(const std::string& text, std::string& bytes) {
  PutLength(text.size(), bytes);
  bytes += text;
}

/// Removes a text from the front of `bytes`. The text is empty after the end.
std::string TakeString(std::string_view& bytes) {
  std::uint64_t length = 0;
  if (bytes.size() < sizeof length) return "";
  std::memcpy(&length, bytes.data(), sizeof length);
  bytes.remove_prefix(sizeof length);
  std::string text(bytes.substr(0, length));
  bytes.remove_prefix(text.size());
  return text;
}

}  // namespace

bool FinishSheet(CsvText& csv, std::size_t& max_bytes, Sheet& sheet, Workbook& workbook) {
  sheet.text = csv.Finish();
  max_bytes -= std::min(max_bytes, sheet.text.size());
  workbook.is_too_large |= csv.is_full();
  if (csv.is_disordered() && !workbook.is_too_large) {
    workbook.complaint = "the cells of sheet " + Quoted(sheet.name) + " are not in order; save the workbook again";
  }
  return !workbook.is_too_large && workbook.complaint.empty();
}

void ComplainIfEmpty(Workbook& workbook) {
  if (!workbook.sheets.empty()) return;
  workbook.complaint = "this workbook has no sheet with cells, only charts or macros; name one with the numbers";
}

std::string Pack(const Workbook& workbook) {
  std::string bytes;
  PutString(workbook.complaint, bytes);
  PutString(workbook.place, bytes);
  bytes += workbook.is_too_large ? 'L' : ' ';
  for (const Sheet& sheet : workbook.sheets) {
    PutString(sheet.name, bytes);
    PutString(sheet.text, bytes);
  }
  return bytes;
}

Workbook UnpackWorkbook(std::string_view bytes) {
  Workbook workbook;
  workbook.complaint = TakeString(bytes);
  workbook.place = TakeString(bytes);
  workbook.is_too_large = bytes.starts_with('L');
  bytes.remove_prefix(bytes.empty() ? 0 : 1);
  while (bytes.size() >= 2 * sizeof(std::uint64_t)) {
    Sheet sheet;
    sheet.name = TakeString(bytes);
    sheet.text = TakeString(bytes);
    workbook.sheets.push_back(std::move(sheet));
  }
  return workbook;
}

}  // namespace pendulum
