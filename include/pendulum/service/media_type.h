// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// Names in lower case with their values; names are unique.
using FieldParameters = std::vector<std::pair<std::string, std::string>>;

/// A media type: "text/csv; charset=utf-8".
struct MediaType {
  std::string type;            ///< "text/csv", in lower case.
  FieldParameters parameters;  ///< {{"charset", "utf-8"}}

  /// The value of a parameter, whose name is in lower case; std::nullopt if there is none.
  std::optional<std::string_view> Parameter(std::string_view name) const;
};

/// Parses the value of a Content-Type field (RFC 9110, section 8.3.1). kInvalidArgument: it is not a media type.
Result<MediaType> ParseMediaType(std::string_view text);

/// Meaning of a backslash in a quoted value. It escapes any character (RFC 9110, section 5.6.4), or only a quote and a
/// backslash, because browsers write other backslashes unescaped.
enum class Backslash { kEscapesAll, kEscapesQuotes };

/// Parses the parameters after a value: "; charset=utf-8; a=\"b c\"", with blanks as in RFC 9110, section 5.6.6.
/// `what`: the value they belong to, for messages. kInvalidArgument: the syntax is wrong, or a name is repeated.
Result<FieldParameters> ParseFieldParameters(std::string_view text, std::string_view what, Backslash backslash);

/// Whether the text is a token (RFC 9110, section 5.6.2), the syntax of field names and types.
bool IsToken(std::string_view text);

/// Converts A to Z to a to z and keeps all other bytes.
std::string LowerCase(std::string_view text);

/// Whether two texts are equal except for the case of A to Z. Names of fields and codings are compared this way.
bool IsSameWord(std::string_view a, std::string_view b);

/// The text without blanks and tabs at its ends.
std::string_view WithoutBlanks(std::string_view text);

}  // namespace pendulum
