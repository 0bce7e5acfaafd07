// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pendulum {

/// What a file of a format that is not read is, and what to do: a sentence for a message. Empty if the first bytes are
/// of no such format.
std::string_view ForeignFormat(std::string_view begin);

/// The same for an XML text, by the name of its first element.
std::string_view ForeignXml(std::string_view root);

}  // namespace pendulum
