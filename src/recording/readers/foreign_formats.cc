// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/foreign_formats.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "pendulum/base/utf8.h"

namespace pendulum {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kPicture = "this is a picture, not a recording; give the file with the numbers";
constexpr std::string_view kVideo =
    "this is a video; track the pendulum in it, for example with Tracker, and give the exported table";
constexpr std::string_view kSound =
    "this is a sound file, not a table; convert it to CSV, for example with sox run.wav run.dat, and give that file";
constexpr std::string_view kPacked = "this is a packed file; unpack it and give the file in it";
constexpr std::string_view kProgram = "this is a program, not a recording; give the file with the numbers";
constexpr std::string_view kTable =
    "this is a table of Apache Arrow or Parquet; save it as CSV: pandas.read_parquet('run.parquet').to_csv('run.csv') "
    "or pandas.read_feather";
constexpr std::string_view kHtml =
    "this is a web page (HTML), even if its name ends in .xls; open it in a spreadsheet program and save it as .xlsx "
    "or CSV";
constexpr std::string_view kRData =
    "this is a file of R; save the table as CSV: write.csv(run, 'run.csv', row.names = FALSE)";

/// A format with a mark at a fixed place.
struct ForeignMark {
  std::string_view mark;
  std::string_view sentence;
  std::size_t at = 0;
};

constexpr std::array kForeign = {
    ForeignMark{"\x89HDF\r\n\x1A\n"sv,
                "this is an HDF5 file without MATLAB's header; export the recording as CSV, or save it from MATLAB "
                "with save('run.mat', 't', 'angle_deg')"},
    ForeignMark{"\x1F\x8B"sv, "this is a gzip file; unpack it and name the file in it"},
    ForeignMark{"\xFD"
                "7zXZ"sv,
                "this is an xz file; unpack it and name the file in it"},
    ForeignMark{"BZh"sv, "this is a bzip2 file; unpack it and name the file in it"},
    ForeignMark{"7z\xBC\xAF\x27\x1C"sv, "this is a 7z file; unpack it and name the file in it"},
    ForeignMark{"Rar!"sv, "this is a RAR file; unpack it and name the file in it"},
    ForeignMark{"\x28\xB5\x2F\xFD"sv, kPacked},
    ForeignMark{"\x1F\x9D"sv, kPacked},
    ForeignMark{"ustar"sv, "this is a tar file; unpack it and name the file in it", 257},
    ForeignMark{"PK\5\6"sv, "this zip file is empty; name one that holds a recording"},
    ForeignMark{"PK\7\x8"sv, "this is a part of a split zip file; put the parts together"},
    ForeignMark{"#ROSBAG"sv, "this is a ROS bag; export the topic as CSV (rostopic echo -p) and give the CSV file"},
    ForeignMark{"\x89MCAP"sv, "this is an MCAP log; export the topic as CSV and give the CSV file"},
    ForeignMark{"SQLite format 3"sv,
                "this is an SQLite file, such as a bag of ROS 2; export the topic or the table as CSV and give the CSV "
                "file"},
    ForeignMark{"TDSm"sv,
                "this is a TDMS file of LabVIEW; open it in Excel or DIAdem and save the channels as CSV, or use "
                "nptdms in Python"},
    ForeignMark{"MDF     "sv, "this is a measurement file (MDF); export its channels as CSV or as a MAT-file"},
    ForeignMark{"PAR1"sv, kTable},
    ForeignMark{"ARROW1"sv, kTable},
    ForeignMark{"FEA1"sv, kTable},
    ForeignMark{"RDX2"sv, kRData},
    ForeignMark{"RDX3"sv, kRData},
    ForeignMark{"CDF\1"sv, "this is a netCDF file; export its variables as CSV"},
    ForeignMark{"CDF\2"sv, "this is a netCDF file; export its variables as CSV"},
    ForeignMark{"CPYA"sv, "this is a project of Origin; export the worksheet as CSV or ASCII"},
    ForeignMark{"CPYUA"sv, "this is a project of Origin; export the worksheet as CSV or ASCII"},
    ForeignMark{"# Created by Octave"sv,
                "this is Octave's text format; save the variables with save -7 run.mat t angle_deg"},
    ForeignMark{"Octave-1-"sv, "this is Octave's binary format; save the variables with save -7 run.mat t angle_deg"},
    ForeignMark{"\xFF\xD8\xFF"sv, kPicture},
    ForeignMark{"\x89PNG"sv, kPicture},
    ForeignMark{"GIF8"sv, kPicture},
    ForeignMark{"II*\0"sv, kPicture},
    ForeignMark{"MM\0*"sv, kPicture},
    ForeignMark{"ftypheic"sv, kPicture, 4},
    ForeignMark{"ftypheix"sv, kPicture, 4},
    ForeignMark{"ftypmif1"sv, kPicture, 4},
    ForeignMark{"ftypavif"sv, kPicture, 4},
    ForeignMark{"ftypM4A"sv, kSound, 4},
    ForeignMark{"ftyp"sv, kVideo, 4},
    ForeignMark{"moov"sv, kVideo, 4},
    ForeignMark{"mdat"sv, kVideo, 4},
    ForeignMark{"\x1A\x45\xDF\xA3"sv, kVideo},
    ForeignMark{"\x30\x26\xB2\x75\x8E\x66\xCF\x11"sv, kVideo},  // Windows Media
    ForeignMark{"OggS"sv, kSound},
    ForeignMark{"fLaC"sv, kSound},
    ForeignMark{"ID3\2"sv, kSound},
    ForeignMark{"ID3\3"sv, kSound},
    ForeignMark{"ID3\4"sv, kSound},
    ForeignMark{"%PDF"sv, "this is a PDF; name the file of the recording"},
    ForeignMark{"%!PS"sv, kPicture},
    ForeignMark{R"({\rtf)"sv, "this is a text document (RTF); save the table in it as CSV"},
    ForeignMark{"\x7F"
                "ELF"sv,
                kProgram},
    ForeignMark{"\x09\0\4\0"sv, "this is a workbook of Excel 2; open it in a newer Excel and save it as .xlsx"},
    ForeignMark{"\x09\2\6\0"sv, "this is a workbook of Excel 3; open it in a newer Excel and save it as .xlsx"},
    ForeignMark{"\x09\4\6\0"sv, "this is a workbook of Excel 4; open it in a newer Excel and save it as .xlsx"},
};

bool StartsWithIgnoringCase(std::string_view text, std::string_view lower) {
  const auto to_lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return text.size() >= lower.size() && std::ranges::equal(text.substr(0, lower.size()), lower, {}, to_lower);
}

bool IsHtml(std::string_view begin) {
  begin = WithoutByteOrderMark(begin);
  begin.remove_prefix(std::min(begin.find_first_not_of(" \t\r\n"), begin.size()));
  constexpr std::array kTags = {"<!doctype html"sv, "<html"sv, "<head"sv,  "<body"sv,  "<meta"sv,
                                "<table"sv,         "<div"sv,  "<style"sv, "<script"sv};
  return std::ranges::any_of(kTags, [&](std::string_view tag) { return StartsWithIgnoringCase(begin, tag); });
}

/// Sound and video of Microsoft: RIFF, a size, then the kind.
std::string_view RiffFormat(std::string_view begin) {
  constexpr std::size_t kKindAt = 8;
  if (!begin.starts_with("RIFF"sv) || begin.size() < kKindAt) return {};
  const std::string_view kind = begin.substr(kKindAt, 4);
  if (kind == "WAVE"sv) return kSound;
  if (kind == "WEBP"sv) return kPicture;
  return kind == "AVI "sv ? kVideo : std::string_view();
}

/// Formats whose marks could also begin a text.
std::string_view WeaklyMarkedFormat(std::string_view begin) {
  const bool has_nul = begin.find('\0') != std::string_view::npos;
  if (has_nul && begin.starts_with("MZ"sv)) return kProgram;
  if (has_nul && begin.starts_with("BM"sv)) return kPicture;
  const bool is_pickle = begin.size() > 2 && begin[0] == '\x80' && begin[1] >= 2 && begin[1] <= 5;
  if (is_pickle) {
    return "this is a pickle of Python, which is not read because it can run programs; save the table as CSV: "
           "frame.to_csv('run.csv', index=False), or arrays with np.savez('run.npz', t=t, angle_deg=angle)";
  }
  return {};
}

struct ForeignRoot {
  std::string_view root;
  std::string_view sentence;
};

constexpr std::array kForeignRoots = {
    ForeignRoot{"Document",
                "this is a project of Logger Pro (.cmbl); in Logger Pro choose File > Export As > CSV or Text, and "
                "give that file"},
    ForeignRoot{"object",
                "this is a project of Tracker (.trk); in Tracker choose File > Export > Data File, or copy the data "
                "table into a text file, and give that file"},
    ForeignRoot{"html", kHtml},
    ForeignRoot{"svg", kPicture},
    ForeignRoot{"geogebra", "this is a GeoGebra construction; export its table as CSV"},
    ForeignRoot{"LVData", "this is data of LabVIEW in XML; save the waveform as text (.lvm or .txt) or CSV"},
};

}  // namespace

std::string_view ForeignFormat(std::string_view begin) {
  const auto is_it = [&](const ForeignMark& each) {
    return begin.size() > each.at && begin.substr(each.at).starts_with(each.mark);
  };
  if (const auto* const found = std::ranges::find_if(kForeign, is_it); found != kForeign.end()) return found->sentence;
  if (IsHtml(begin)) return kHtml;
  if (const std::string_view riff = RiffFormat(begin); !riff.empty()) return riff;
  return WeaklyMarkedFormat(begin);
}

std::string_view ForeignXml(std::string_view root) {
  const auto* const found = std::ranges::find(kForeignRoots, root, &ForeignRoot::root);
  return found == kForeignRoots.end() ? std::string_view() : found->sentence;
}

}  // namespace pendulum
