// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// Names in lower case and values, of which no name comes twice.
using FieldParameters = std::vector<std::pair<std::string, std::string>>;

/// A media type: "text/csv; charset=utf-8".
struct MediaType {
  std::string type;            ///< "text/csv", in lower case.
  FieldParameters parameters;  ///< {{"charset", "utf-8"}}

  /// The value of a parameter, whose name is in lower case; none where it is not there.
  std::optional<std::string_view> Parameter(std::string_view name) const;
};

/// The value of a Content-Type field (RFC 9110, section 8.3.1). kInvalidArgument: it is none.
Result<MediaType> ParseMediaType(std::string_view text);

/// What a backslash in a quoted value does: escape whatever follows (RFC 9110, section 5.6.4), or a quote and a
/// backslash only, for browsers write any other as it is.
enum class Backslash { kEscapesAll, kEscapesQuotes };

/// The parameters behind a value: "; charset=utf-8; a=\"b c\"", blanks as RFC 9110, section 5.6.6, has them.
/// `what`: whose they are, for messages. kInvalidArgument: they are none, or one comes twice.
Result<FieldParameters> ParseFieldParameters(std::string_view text, std::string_view what, Backslash backslash);

/// Whether the text is a token (RFC 9110, section 5.6.2), as names of fields and types are.
bool IsToken(std::string_view text);

/// A to Z as a to z, everything else as it is.
std::string LowerCase(std::string_view text);

/// Whether two texts are the same but for the case of A to Z, as names of fields and codings are compared.
bool IsSameWord(std::string_view a, std::string_view b);

/// Without blanks and tabs at its ends.
std::string_view WithoutBlanks(std::string_view text);

}  // namespace pendulum
