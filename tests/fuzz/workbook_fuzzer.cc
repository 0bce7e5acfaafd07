// SPDX-License-Identifier: Apache-2.0
// The readers of workbooks and other tables alone, without the child processes in which most of them run. The last byte
// of the input chooses the reader.
#include <cstddef>
#include <cstdint>

#include "recording/readers/containers/compound_file.h"
#include "recording/readers/containers/excel_xml.h"
#include "recording/readers/containers/json_table.h"
#include "recording/readers/containers/npy.h"
#include "recording/readers/containers/ods.h"
#include "recording/readers/containers/phyphox_state.h"
#include "recording/readers/containers/xls.h"
#include "recording/readers/containers/xlsx.h"
#include "tests/fuzz/recording.h"

namespace pendulum {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 16;

void CheckWorkbook(const Workbook& workbook) {
  std::size_t size = 0;
  for (const Sheet& sheet : workbook.sheets) size += sheet.text.size();
  Require(size <= kMaxBytes + kMaxSheetRows);
  Require(workbook.complaint.size() < 1000);
  const std::string packed = Pack(workbook);
  Require(Pack(UnpackWorkbook(packed)) == packed);
}

void CheckZip(std::string_view bytes) {
  const Result<ZipMembers> zip = ZipMembers::Open(bytes, "a.zip");
  if (!zip) return;
  CheckWorkbook(ReadXlsx(*zip, kMaxBytes));
  CheckWorkbook(ReadOds(*zip, kMaxBytes));
  CheckWorkbook(ReadNpz(*zip, kMaxBytes));
}

}  // namespace
}  // namespace pendulum

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using pendulum::CheckWorkbook, pendulum::kMaxBytes;
  if (size == 0) return 0;
  const std::string_view bytes = pendulum::TextOf(data, size - 1);
  switch (data[size - 1] % 7) {
    case 0: CheckWorkbook(pendulum::ReadXls(bytes, kMaxBytes)); break;
    case 1: CheckWorkbook(pendulum::ReadFlatOds(bytes, kMaxBytes)); break;
    case 2: CheckWorkbook(pendulum::ReadExcelXml(bytes, kMaxBytes)); break;
    case 3: CheckWorkbook(pendulum::ReadPhyphoxState(bytes, kMaxBytes)); break;
    case 4: CheckWorkbook(pendulum::ReadNpy(bytes, kMaxBytes)); break;
    case 5: CheckWorkbook(pendulum::ReadJsonTables(bytes, kMaxBytes)); break;
    default: pendulum::CheckZip(bytes); break;
  }
  return 0;
}
