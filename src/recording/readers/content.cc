// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/content.h"

#include <algorithm>
#include <array>

#include "pendulum/base/file.h"
#include "recording/readers/mat/mat_version_4.h"

namespace pendulum {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kHdf5 = "\x89HDF\r\n\x1A\n"sv;
constexpr std::string_view kMat = "MATLAB "sv;

/// MATLAB's own files begin with a text of 116 bytes, "MATLAB 5.0 MAT-file, ...". In version 7.3, HDF5 data follow.
/// Files of version 4 begin with a variable.
bool IsMat(std::string_view begin) {
  constexpr std::size_t kHeader = 128, kUserBlock = 512;
  if (SizeOfVersion4(begin)) return true;
  if (!begin.starts_with(kMat) || begin.size() < kHeader) return false;
  const std::string_view text = begin.substr(0, kHeader - 12);
  if (text.find("MAT-file") == std::string_view::npos) return false;
  const std::string_view order = begin.substr(kHeader - 2, 2);
  return order == "IM" || order == "MI" || begin.substr(std::min(kUserBlock, begin.size())).starts_with(kHdf5);
}

/// A recognized format that cannot be read.
struct Foreign {
  std::string_view magic;
  std::string_view sentence;
};

constexpr std::array kForeign = {
    Foreign{kHdf5,
            "this is an HDF5 file without MATLAB's header; export the recording as CSV, or save it from MATLAB "
            "with save('run.mat', 't', 'angle_deg')"},
    Foreign{"\x1F\x8B"sv, "this is a gzip file; unpack it and name the file in it"},
    Foreign{"\xFD"
            "7zXZ"sv,
            "this is an xz file; unpack it and name the file in it"},
    Foreign{"BZh"sv, "this is a bzip2 file; unpack it and name the file in it"},
    Foreign{"7z\xBC\xAF\x27\x1C"sv, "this is a 7z file; unpack it and name the file in it"},
    Foreign{"Rar!"sv, "this is a RAR file; unpack it and name the file in it"},
    Foreign{"\xD0\xCF\x11\xE0"sv, "this is a workbook of an older Excel; save it as CSV and give the CSV file"},
    Foreign{"#ROSBAG"sv, "this is a ROS bag; export the topic as CSV (rostopic echo -p) and give the CSV file"},
    Foreign{"\x89MCAP"sv, "this is an MCAP log; export the topic as CSV and give the CSV file"},
    Foreign{"SQLite format 3"sv, "this is an SQLite file, not a recording; name a file of rows, a zip or a MAT-file"},
    Foreign{
        "<?xml"sv,
        "this is XML, such as the project of Logger Pro or Tracker; export its data as text and give the text file"},
    Foreign{"# Created by Octave"sv,
            "this is Octave's text format; save the variables with save -7 run.mat t angle_deg"},
    Foreign{"Octave-1-"sv, "this is Octave's binary format; save the variables with save -7 run.mat t angle_deg"},
    Foreign{"%PDF"sv, "this is a PDF; name the file of the recording"},
    Foreign{"PK\5\6"sv, "this zip file is empty; name one that holds a recording"},
    Foreign{"PK\7\x8"sv, "this is a part of a split zip file; put the parts together"},
};

const Foreign* FindForeign(std::string_view begin) {
  const auto* const found =
      std::ranges::find_if(kForeign, [&](const Foreign& each) { return begin.starts_with(each.magic); });
  return found == kForeign.end() ? nullptr : found;
}

}  // namespace

Content ContentOf(std::string_view begin) {
  if (begin.starts_with("PK\3\4"sv)) return Content::kZip;
  if (IsMat(begin)) return Content::kMat;
  return FindForeign(begin) != nullptr ? Content::kForeign : Content::kText;
}

tl::unexpected<Status> ForeignContent(std::string_view begin, const std::string& name) {
  const Foreign* foreign = FindForeign(begin);
  return Fault(name, std::string(foreign == nullptr ? "the format of this file is not supported" : foreign->sentence));
}

}  // namespace pendulum
