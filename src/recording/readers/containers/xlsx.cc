// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/xlsx.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "recording/readers/containers/cell_time.h"
#include "recording/readers/containers/csv_text.h"
#include "recording/readers/containers/xml_parser.h"

namespace pendulum {
namespace {

/// A file that another file of the workbook refers to.
struct XlsxRelation {
  std::string type;  // The end of the type's address: worksheet, sharedStrings, ...
  std::string path;  // In the zip file.
};

using XlsxRelations = std::map<std::string, XlsxRelation, std::less<>>;  // By identifier.

/// What the cells of all sheets refer to.
struct XlsxBook {
  bool is_1904 = false;
  std::vector<std::string> strings;
  std::vector<bool> is_time;  // For each format of cells.
};

/// Parses a file in the workbook. Returns false and sets the complaint if it is damaged.
bool ParseMember(const ZipMembers& zip, const std::string& path, XmlHandlers handlers, Workbook& workbook) {
  const ZipMembers::Member* const member = zip.Find(path);
  if (member == nullptr) {
    workbook.complaint = "this workbook is damaged: " + Quoted(path) + " is missing; save it again";
    return false;
  }
  XmlParser parser(std::move(handlers));
  const auto unpacked = zip.UnpackBlocks(*member, [&](std::string_view block) { return parser.Add(block); });
  if (unpacked) parser.Add("", true);
  if (unpacked && parser.fault().empty()) return true;
  workbook.complaint = "this workbook is damaged: " + Quoted(path) + " cannot be read (" +
                       (unpacked ? parser.fault() : "it cannot be unpacked") + "); save it again";
  return false;
}

/// The path of `target`, which is relative to a folder ("xl/") or begins with a slash.
std::string PathOf(std::string folder, std::string_view target) {
  if (target.starts_with('/')) return std::string(target.substr(1));
  while (target.starts_with("../") || target.starts_with("./")) {
    if (target.starts_with("../") && !folder.empty()) {
      folder.pop_back();
      folder.erase(folder.rfind('/') + 1);  // npos + 1 is 0
    }
    target.remove_prefix(target.find('/') + 1);
  }
  return folder + std::string(target);
}

/// The relations of a file: "xl/_rels/workbook.xml.rels" for "xl/workbook.xml".
XlsxRelations RelationsOf(const ZipMembers& zip, const std::string& path, Workbook& workbook) {
  const std::size_t name = path.rfind('/') + 1;  // npos + 1 is 0
  const std::string folder = path.substr(0, name);
  XlsxRelations relations;
  XmlHandlers handlers;
  handlers.start = [&](std::string_view element, const XmlAttributes& attributes) {
    if (element != "Relationship") return;
    const std::string_view type = attributes["Type"];
    relations[std::string(attributes["Id"])] = {std::string(type.substr(type.rfind('/') + 1)),
                                                PathOf(folder, attributes["Target"])};
  };
  ParseMember(zip, folder + "_rels/" + path.substr(name) + ".rels", std::move(handlers), workbook);
  return relations;
}

const XlsxRelation* FindType(const XlsxRelations& relations, std::string_view type) {
  const auto found = std::ranges::find_if(relations, [&](const auto& each) { return each.second.type == type; });
  return found == relations.end() ? nullptr : &found->second;
}

// ---- What cells refer to -----------------------------------------------------------------------------------------

/// Text of a cell or a shared string: the parts of rich text, without the pronunciation of East Asian text.
class XlsxText {
 public:
  void Start(std::string_view element) {
    if (element == "rPh") ++hidden_;
    is_text_ = element == "t" && hidden_ == 0;
  }
  void End(std::string_view element) {
    if (element == "rPh") --hidden_;
    if (element == "t") is_text_ = false;
  }
  void Add(std::string_view text) {
    if (is_text_) text_ += text;
  }
  std::string Take() { return std::exchange(text_, ""); }

 private:
  std::string text_;
  int hidden_ = 0;
  bool is_text_ = false;
};

void ReadStrings(const ZipMembers& zip, const std::string& path, XlsxBook& book, Workbook& workbook) {
  XlsxText text;
  XmlHandlers handlers;
  handlers.start = [&](std::string_view element, const XmlAttributes&) { text.Start(element); };
  handlers.text = [&](std::string_view piece) { text.Add(piece); };
  handlers.end = [&](std::string_view element) {
    text.End(element);
    if (element == "si") book.strings.push_back(text.Take());
  };
  ParseMember(zip, path, std::move(handlers), workbook);
}

void ReadStyles(const ZipMembers& zip, const std::string& path, XlsxBook& book, Workbook& workbook) {
  std::map<std::size_t, bool> formats;
  bool is_of_cells = false;
  XmlHandlers handlers;
  handlers.start = [&](std::string_view element, const XmlAttributes& attributes) {
    if (element == "numFmt") formats[attributes.Number("numFmtId", 0)] = IsTimeFormat(attributes["formatCode"]);
    if (element == "cellXfs") is_of_cells = true;
    if (element != "xf" || !is_of_cells) return;
    const std::size_t format = attributes.Number("numFmtId", 0);
    const auto own = formats.find(format);
    book.is_time.push_back(own == formats.end() ? IsTimeFormat(static_cast<int>(format)) : own->second);
  };
  handlers.end = [&](std::string_view element) {
    if (element == "cellXfs") is_of_cells = false;
  };
  ParseMember(zip, path, std::move(handlers), workbook);
}

// ---- Sheets ------------------------------------------------------------------------------------------------------

/// Row and column of a cell such as "BC12", counted from 0.
struct XlsxPlace {
  std::size_t row = 0, column = 0;
};

std::optional<XlsxPlace> PlaceOf(std::string_view reference) {
  constexpr std::size_t kMaxLetters = 3;
  std::size_t letters = 0, column = 0;
  while (letters < reference.size() && reference[letters] >= 'A' && reference[letters] <= 'Z') {
    column = 26 * column + (reference[letters] - 'A' + 1);
    if (++letters > kMaxLetters) return std::nullopt;
  }
  std::size_t row = 0;
  const char* const end = reference.data() + reference.size();
  const auto [stop, error] = std::from_chars(reference.data() + letters, end, row);
  if (letters == 0 || error != std::errc() || stop != end || row == 0) return std::nullopt;
  return XlsxPlace{row - 1, column - 1};
}

/// Reads the cells of one sheet.
class XlsxSheetReader {
 public:
  XlsxSheetReader(const XlsxBook& book, std::size_t max_bytes) : book_(book), csv_(max_bytes, kMaxSheetRows) {}

  void Start(std::string_view element, const XmlAttributes& attributes) {
    text_.Start(element);
    if (element == "row") {
      const std::size_t number = attributes.Number("r", 0);
      next_ = {number > 0 ? number - 1 : row_after_, 0};
      row_after_ = next_.row + 1;
    } else if (element == "c") {
      place_ = PlaceOf(attributes["r"]).value_or(next_);
      type_ = attributes["t"];
      style_ = attributes.Number("s", 0);
      value_.clear();
    }
    is_value_ = element == "v";
  }

  void Add(std::string_view text) {
    if (is_value_) value_ += text;
    text_.Add(text);
  }

  void End(std::string_view element) {
    text_.End(element);
    if (element == "v") is_value_ = false;
    if (element != "c") return;
    AddCell();
    next_ = {place_.row, place_.column + 1};
  }

  CsvText& csv() { return csv_; }

 private:
  void AddText(std::string_view text) { csv_.AddText(place_.row, place_.column, text); }

  /// A cell with an error, such as #N/A, stays empty.
  void AddCell() {
    const std::string own_text = text_.Take();
    if (type_ == "e") return;
    if (type_ == "inlineStr") return AddText(own_text);
    if (type_ == "str" || type_ == "d") return AddText(value_);
    if (type_ == "b") return AddText(value_ == "0" ? "FALSE" : "TRUE");
    double number = 0;
    const char* const end = value_.data() + value_.size();
    const auto [stop, error] = std::from_chars(value_.data(), end, number);
    if (value_.empty() || error != std::errc() || stop != end) return;
    if (type_ == "s") {
      if (number >= 0 && number < static_cast<double>(book_.strings.size())) {
        AddText(book_.strings[static_cast<std::size_t>(number)]);
      }
    } else if (style_ < book_.is_time.size() && book_.is_time[style_]) {
      AddText(TimeText(number, book_.is_1904));
    } else {
      csv_.AddNumber(place_.row, place_.column, number);
    }
  }

  const XlsxBook& book_;
  CsvText csv_;
  XlsxText text_;
  XlsxPlace next_, place_;
  std::size_t row_after_ = 0, style_ = 0;
  bool is_value_ = false;
  std::string type_, value_;
};

/// Reads a sheet; returns false if the workbook cannot be read further.
bool ReadSheet(const ZipMembers& zip, const std::string& path, const XlsxBook& book, std::size_t& max_bytes,
               Sheet& sheet, Workbook& workbook) {
  XlsxSheetReader reader(book, max_bytes);
  XmlHandlers handlers;
  handlers.start = [&](std::string_view element, const XmlAttributes& attributes) {
    reader.Start(element, attributes);
  };
  handlers.text = [&](std::string_view text) { reader.Add(text); };
  handlers.end = [&](std::string_view element) { reader.End(element); };
  return ParseMember(zip, path, std::move(handlers), workbook) && FinishSheet(reader.csv(), max_bytes, sheet, workbook);
}

/// A sheet as the workbook lists it.
struct XlsxSheet {
  std::string name, relation;
};

std::vector<XlsxSheet> ListSheets(const ZipMembers& zip, const std::string& path, XlsxBook& book, Workbook& workbook) {
  std::vector<XlsxSheet> sheets;
  XmlHandlers handlers;
  handlers.start = [&](std::string_view element, const XmlAttributes& attributes) {
    if (element == "workbookPr") book.is_1904 = attributes["date1904"] == "1" || attributes["date1904"] == "true";
    if (element == "sheet") sheets.push_back({std::string(attributes["name"]), std::string(attributes["id"])});
  };
  ParseMember(zip, path, std::move(handlers), workbook);
  return sheets;
}

/// The path of the file that lists the sheets.
std::string WorkbookPath(const ZipMembers& zip) {
  Workbook ignored;
  const XlsxRelations top = RelationsOf(zip, "", ignored);
  const XlsxRelation* const found = FindType(top, "officeDocument");
  return found == nullptr || !zip.Has(found->path) ? "xl/workbook.xml" : found->path;
}

}  // namespace

bool IsXlsx(const ZipMembers& zip) {
  if (zip.Has("xl/workbook.xml")) return true;
  if (!zip.Has("[Content_Types].xml") || zip.HasFolder("word/") || zip.HasFolder("ppt/")) return false;
  return zip.HasFolder("xl/worksheets/") && !zip.Has("xl/workbook.bin");
}

Workbook ReadXlsx(const ZipMembers& zip, std::size_t max_bytes) {
  Workbook workbook;
  XlsxBook book;
  const std::string path = WorkbookPath(zip);
  const std::vector<XlsxSheet> sheets = ListSheets(zip, path, book, workbook);
  if (!workbook.complaint.empty()) return workbook;
  const XlsxRelations relations = RelationsOf(zip, path, workbook);
  if (!workbook.complaint.empty()) return workbook;
  if (const XlsxRelation* strings = FindType(relations, "sharedStrings");
      strings != nullptr && zip.Has(strings->path)) {
    ReadStrings(zip, strings->path, book, workbook);
  }
  if (const XlsxRelation* styles = FindType(relations, "styles"); styles != nullptr && zip.Has(styles->path)) {
    ReadStyles(zip, styles->path, book, workbook);
  }
  if (!workbook.complaint.empty()) return workbook;
  for (const XlsxSheet& listed : sheets) {
    const auto relation = relations.find(listed.relation);
    if (relation == relations.end() || relation->second.type != "worksheet") continue;  // A chart or a macro.
    Sheet sheet{listed.name, ""};
    if (!ReadSheet(zip, relation->second.path, book, max_bytes, sheet, workbook)) return workbook;
    workbook.sheets.push_back(std::move(sheet));
  }
  ComplainIfEmpty(workbook);
  return workbook;
}

}  // namespace pendulum
