// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "pendulum/recording/readers/columns/read_options.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Reads a recording from the bytes of a zip file, such as phyphox exports. It uses the member that has a column for
/// the quantity and its time, or the one that --value_column "MEMBER/COLUMN" names; MEMBER may omit its folders.
/// Messages begin "name:member:line:". kDataLoss: the bytes are not a zip file, are damaged or encrypted, contain no
/// such member or several, or the member unpacks to more than options.most_unpacked_bytes.
Result<Recording> ReadZip(std::string_view bytes, const std::string& name, const ReadOptions& options);

}  // namespace pendulum
