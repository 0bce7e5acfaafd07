// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/recording/readers/columns/read_options.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// A file with several members, each of which may contain a recording: a zip file or a workbook.
struct Folder {
  std::string name;    // Of the file, for messages.
  std::string kind;    // "zip file", "workbook"
  std::string member;  // "file", "sheet"
  std::vector<std::string> paths;
  std::function<std::string(std::size_t index)> name_of;  // "NAME:MEMBER", the beginning of messages.
  /// The first bytes of a member, at most max_bytes.
  std::function<Result<std::string>(std::size_t index, std::size_t max_bytes)> read;
};

/// Reads the recording in a member. The bytes are all of the member.
using MemberReader =
    std::function<Result<Recording>(const std::string& bytes, const std::string& name, const ReadOptions& options)>;

/// Reads the only member with a time and a column that could be the quantity, or the one that --value_column
/// "MEMBER/COLUMN" names; MEMBER may omit its folders. Of several, one called "Raw Data", which phyphox writes, is
/// preferred, or the only file of a phone's gyro. If no header tells, the only member that can be read. kDataLoss: no
/// such member or several.
Result<Recording> ReadOnlyMember(const Folder& folder, const ReadOptions& options, const MemberReader& read);

}  // namespace pendulum
