// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "pendulum/base/status.h"

namespace pendulum {

/// The format of a file according to its first bytes; the file name is ignored.
enum class Content {
  kText,
  kLabelled,  ///< Text in which each value has its label: t:0,pot:512.
  kReturns,   ///< Text whose lines end with a carriage return alone, as spreadsheets on a Macintosh write it.
  kUtf16,     ///< Text with two bytes per character.
  kZip,       ///< Also .xlsx, .ods and .npz.
  kMat,       ///< MATLAB.
  kNpy,       ///< NumPy.
  kJson,
  kXml,       ///< Workbooks of Excel 2003, .fods, states of phyphox, and others that are not read.
  kCompound,  ///< Microsoft's compound file: .xls, and others that are not read.
  kForeign,   ///< Not read.
};

inline constexpr std::size_t kContentBytes = 4096;  ///< Number of bytes needed for the detection.

/// Detects the format from a file's first kContentBytes, or from all its bytes if it is shorter.
Content ContentOf(std::string_view begin);

/// The error kDataLoss for a file of kForeign, with its format and what to do. `name` is shown as the path.
tl::unexpected<Status> ForeignContent(std::string_view begin, const std::string& name);

}  // namespace pendulum
