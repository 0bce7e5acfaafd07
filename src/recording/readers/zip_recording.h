// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "pendulum/recording/readers/columns/read_options.h"
#include "pendulum/recording/recording.h"
#include "recording/readers/bytes_recording.h"

namespace pendulum {

/// Reads a recording from the bytes of a zip file: a workbook (.xlsx, .ods), arrays of NumPy (.npz), or a zip file with
/// a recording, such as phyphox exports (see ReadOnlyMember). Messages begin "name:member:line:". kDataLoss: the bytes
/// are not a zip file, are damaged or encrypted, contain no recording or several, or the member unpacks to more than
/// options.most_unpacked_bytes.
Result<Recording> ReadZip(std::string_view bytes, const std::string& name, const ReadOptions& options, Nesting nesting);

}  // namespace pendulum
