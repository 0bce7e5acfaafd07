// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/workbook_recording.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>
#include <vector>

#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/sha256.h"
#include "pendulum/base/try.h"
#include "pendulum/recording/readers/columns/line_reader.h"
#include "recording/readers/containers/compound_file.h"
#include "recording/readers/containers/excel_xml.h"
#include "recording/readers/containers/json_table.h"
#include "recording/readers/containers/ods.h"
#include "recording/readers/containers/phyphox_state.h"
#include "recording/readers/containers/xls.h"
#include "recording/readers/containers/xml_parser.h"
#include "recording/readers/folder.h"
#include "recording/readers/foreign_formats.h"
#include "recording/readers/process/child_process.h"
#include "recording/readers/text/row_reader.h"

namespace pendulum {
namespace {

std::string SaveLess(WorkbookWords words) {
  return "; save only the " + std::string(words.sheet) + " with the times and the angles, or export it as CSV";
}

/// A million rows take some seconds, and their file is compressed to a tenth. Several copies of the text exist until
/// the answer is complete.
ChildLimits LimitsForWorkbook(std::size_t bytes, std::size_t max_unpacked) {
  constexpr std::size_t kCopies = 4, kMinBytes = std::size_t{1} << 26;
  ChildLimits limits;
  limits.answer_bytes = max_unpacked + (std::size_t{1} << 20);
  limits.memory_bytes = std::min(limits.memory_bytes, kMinBytes + kCopies * std::max(max_unpacked, bytes));
  limits.processor_seconds = 10 + static_cast<int>(bytes >> 22);
  limits.time = std::chrono::seconds(5 + 5 * limits.processor_seconds);  // Other processes also use the processors.
  return limits;
}

tl::unexpected<Status> NoWorkbook(ChildFailure failure, const ChildLimits& limits, WorkbookWords words,
                                  const std::string& name) {
  const std::string what = "this " + std::string(words.kind);
  const std::string less = SaveLess(words);
  switch (failure) {
    case ChildFailure::kNotStarted: break;
    case ChildFailure::kCrashed: return Fault(name, what + " is damaged: its reader crashed; save it again");
    case ChildFailure::kOutOfTime:
      return Fault(name, what + " takes longer to read than " + std::to_string(limits.processor_seconds) +
                             " s of processor time: it is damaged or too large" + less);
    case ChildFailure::kOutOfMemory:
      return Fault(name, what + " needs more memory to read than the " + SizeText(limits.memory_bytes) +
                             " that are allowed: it is damaged or too large" + less);
    case ChildFailure::kAnswerTooLarge:
      return Fault(
          name, what + " unpacks to more than " + SizeText(limits.answer_bytes) + ", too many for a recording" + less);
  }
  return ErrorAt(StatusCode::kTryAgain, name, "the process that reads it could not be started; try again");
}

/// Phyphox writes the sheets "Metadata Device" and "Metadata Time".
void RemoveUnusedSheets(std::vector<Sheet>& sheets) {
  std::erase_if(sheets, [](const Sheet& sheet) { return sheet.text.find_first_not_of("\n;") == std::string::npos; });
  const auto is_metadata = [](const Sheet& sheet) { return sheet.name.starts_with("Metadata "); };
  if (!std::ranges::all_of(sheets, is_metadata)) std::erase_if(sheets, is_metadata);
}

Folder FolderOfSheets(const std::vector<Sheet>& sheets, WorkbookWords words, const std::string& name) {
  Folder folder{name, std::string(words.kind), std::string(words.sheet), {}, {}, {}};
  for (const Sheet& sheet : sheets) folder.paths.push_back(sheet.name);
  folder.name_of = [&sheets, name](std::size_t i) {
    const std::string quoted = Quoted(sheets[i].name);
    return name + ":" + (sheets[i].name.empty() ? "table" : quoted.substr(1, quoted.size() - 2));
  };
  folder.read = [&sheets](std::size_t i, std::size_t max_bytes) -> Result<std::string> {
    return sheets[i].text.substr(0, max_bytes);
  };
  return folder;
}

/// The name of the first element of an XML text.
std::string RootOf(std::string_view xml) {
  std::string root;
  XmlParser* running = nullptr;
  XmlHandlers handlers;
  handlers.start = [&](std::string_view element, const XmlAttributes&) {
    root = element;
    running->Stop();
  };
  XmlParser parser(std::move(handlers));
  running = &parser;
  parser.Add(xml);
  return root;
}

std::string UnknownXml(const std::string& root) {
  if (const std::string_view sentence = ForeignXml(root); !sentence.empty()) return std::string(sentence);
  return "this is XML" + (root.empty() ? "" : " (its first element is " + Quoted(root) + ")") +
         ", which is not read; export the data as CSV";
}

}  // namespace

Result<Recording> FromWorkbook(Workbook workbook, WorkbookWords words, std::string_view bytes, const std::string& name,
                               const ReadOptions& options) {
  if (!workbook.complaint.empty()) {
    return Fault(workbook.place.empty() ? name : name + ":" + workbook.place, workbook.complaint);
  }
  if (workbook.is_too_large) {
    const std::string rows = words.sheet == kSheets.sheet ? std::to_string(kMaxSheetRows) + " rows or " : "";
    return Fault(name, "this " + std::string(words.kind) + " has more than " + rows +
                           SizeText(options.most_unpacked_bytes) + ", too many for a recording" + SaveLess(words));
  }
  RemoveUnusedSheets(workbook.sheets);
  if (workbook.sheets.empty()) {
    return Fault(name, "this " + std::string(words.kind) + " has no cells with numbers; give another file");
  }
  if (options.preview != nullptr) options.preview->format = words.kind;
  const bool are_lists = words.sheet != kSheets.sheet;
  const auto read = [&](const std::string& text, const std::string& member, const ReadOptions& rest) {
    return are_lists ? ReadLists(LineReader(text, member), rest) : ReadRows(LineReader(text, member), rest);
  };
  Result<Recording> recording = ReadOnlyMember(FolderOfSheets(workbook.sheets, words, name), options, read);
  if (!recording) return recording;
  ASSIGN_OR_RETURN(std::string sha256, Sha256(bytes));
  recording->path = name;
  recording->sha256 = std::move(sha256);
  return recording;
}

Result<Recording> ReadWorkbook(const std::function<Workbook()>& read, WorkbookWords words, std::string_view bytes,
                               const std::string& name, const ReadOptions& options) {
  const ChildLimits limits = LimitsForWorkbook(bytes.size(), options.most_unpacked_bytes);
  const auto packed = RunInChildProcess([&] { return Pack(read()); }, limits);
  if (!packed) return NoWorkbook(packed.error(), limits, words, name);
  return FromWorkbook(UnpackWorkbook(*packed), words, bytes, name, options);
}

Result<Recording> ReadXml(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  const std::string root = RootOf(bytes);
  const std::size_t max_bytes = options.most_unpacked_bytes;
  std::function<Workbook()> read;
  if (root == "phyphox") read = [&] { return ReadPhyphoxState(bytes, max_bytes); };
  if (root == "Workbook") read = [&] { return ReadExcelXml(bytes, max_bytes); };
  if (root == "document") read = [&] { return ReadFlatOds(bytes, max_bytes); };
  if (!read) return Fault(name, UnknownXml(root));
  return ReadWorkbook(read, kSheets, bytes, name, options);
}

Result<Recording> ReadCompound(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  const CompoundFile file(bytes);
  if (file.Has("EncryptedPackage")) {
    return Fault(name, "this document is encrypted; open it in Excel and save it without a password");
  }
  if (file.Has("WordDocument")) {
    return Fault(name, "this is a text document (.doc); copy its table into a spreadsheet, and save that");
  }
  if (!file.Has("Workbook") && !file.Has("Book")) {
    return Fault(name,
                 "this is a document of an Office program, but not a workbook; save the table as .xlsx or CSV, or copy "
                 "the file again if it should be a workbook");
  }
  return ReadWorkbook([&] { return ReadXls(bytes, options.most_unpacked_bytes); }, kSheets, bytes, name, options);
}

Result<Recording> ReadJson(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  return ReadWorkbook([&] { return ReadJsonTables(bytes, options.most_unpacked_bytes); }, kJsonTables, bytes, name,
                      options);
}

}  // namespace pendulum
