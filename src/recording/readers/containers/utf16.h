// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pendulum {

enum class ByteOrder { kLittle, kBig };

/// UTF-8 of a text in UTF-16. An invalid or incomplete character becomes U+FFFD.
std::string Utf8OfUtf16(std::string_view bytes, ByteOrder order);

/// UTF-8 of a text in ISO 8859-1.
std::string Utf8OfLatin1(std::string_view bytes);

}  // namespace pendulum
