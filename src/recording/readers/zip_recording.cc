// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/zip_recording.h"

#include <array>
#include <utility>

#include "pendulum/base/file.h"
#include "pendulum/base/sha256.h"
#include "pendulum/base/try.h"
#include "recording/readers/containers/npy.h"
#include "recording/readers/containers/ods.h"
#include "recording/readers/containers/xlsx.h"
#include "recording/readers/containers/zip_members.h"
#include "recording/readers/folder.h"
#include "recording/readers/workbook_recording.h"

namespace pendulum {
namespace {

/// A document that is a zip file and is not read.
struct ForeignZip {
  std::string_view path;  // The beginning of the path of a member.
  std::string_view sentence;
};

constexpr std::array kForeignZips = {
    ForeignZip{"xl/workbook.bin", "this is a binary workbook (.xlsb); save it as .xlsx or CSV"},
    ForeignZip{"word/", "this is a text document (.docx); copy its table into a spreadsheet, and save that"},
    ForeignZip{"ppt/", "this is a presentation (.pptx); give the file with the numbers"},
    ForeignZip{"Index/", "this is a document of Numbers, Pages or Keynote; export it as Excel or CSV"},
    ForeignZip{"geogebra.xml", "this is a GeoGebra construction; export its table as CSV"},
    ForeignZip{"AndroidManifest.xml", "this is an Android app; give the file with the numbers"},
};

/// What a document of OpenDocument that is no spreadsheet is, or an empty text.
std::string ForeignDocument(std::string_view type) {
  constexpr std::string_view kStart = "application/vnd.oasis.opendocument.";
  if (!type.starts_with(kStart)) return "";
  type.remove_prefix(kStart.size());
  const bool is_text = type.starts_with("text");
  return std::string("this is ") + (is_text ? "a text document (.odt)" : "a document of OpenDocument") +
         "; copy its table into a spreadsheet, and save that";
}

std::string ForeignZipSentence(const ZipMembers& zip, std::string_view type) {
  for (const ForeignZip& each : kForeignZips) {
    if (zip.HasFolder(each.path)) return std::string(each.sentence);
  }
  if (zip.Has("main.xml") && zip.HasFolder("data/")) {
    return "this is a project of PASCO Capstone (.cap); in Capstone choose File > Export Data, and give that file";
  }
  return ForeignDocument(type);
}

Folder FolderOfZip(const ZipMembers& zip, const std::string& name) {
  Folder folder{name, "zip file", "file", {}, {}, {}};
  for (const ZipMembers::Member& member : zip.members()) folder.paths.push_back(member.path);
  folder.name_of = [&zip](std::size_t i) { return zip.NameOf(zip.members()[i]); };
  folder.read = [&zip](std::size_t i, std::size_t max_bytes) { return zip.Unpack(zip.members()[i], max_bytes); };
  return folder;
}

/// The content of the file `mimetype` of OpenDocument.
std::string TypeOf(const ZipMembers& zip) {
  constexpr std::size_t kLongest = 100;
  const ZipMembers::Member* const member = zip.Find("mimetype");
  return member == nullptr ? "" : zip.Unpack(*member, kLongest).value_or("");
}

}  // namespace

Result<Recording> ReadZip(std::string_view bytes, const std::string& name, const ReadOptions& options,
                          Nesting nesting) {
  const Result<ZipMembers> zip = ZipMembers::Open(bytes, name);
  if (!zip) return tl::unexpected(zip.error());
  const std::size_t max_bytes = options.most_unpacked_bytes;
  if (IsXlsx(*zip)) return ReadWorkbook([&] { return ReadXlsx(*zip, max_bytes); }, kSheets, bytes, name, options);
  const std::string type = TypeOf(*zip);
  if (type.starts_with("application/vnd.oasis.opendocument.spreadsheet")) {
    return ReadWorkbook([&] { return ReadOds(*zip, max_bytes); }, kSheets, bytes, name, options);
  }
  if (IsNpz(*zip)) return FromWorkbook(ReadNpz(*zip, max_bytes), kArrays, bytes, name, options);
  if (const std::string sentence = ForeignZipSentence(*zip, type); !sentence.empty()) return Fault(name, sentence);
  if (nesting == Nesting::kMember) {
    return Fault(name, "this is a zip file in a zip file; unpack it and give the unpacked file");
  }
  if (options.preview != nullptr) options.preview->format = "zip file";
  const auto read = [](const std::string& member, const std::string& member_name, const ReadOptions& rest) {
    return ReadBytes(member, member_name, rest, Nesting::kMember);
  };
  Result<Recording> recording = ReadOnlyMember(FolderOfZip(*zip, name), options, read);
  if (!recording) return recording;
  ASSIGN_OR_RETURN(std::string sha256, Sha256(bytes));
  recording->path = name;
  recording->sha256 = std::move(sha256);
  return recording;
}

}  // namespace pendulum
