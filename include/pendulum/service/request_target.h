// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// The decoded target of a request: valid UTF-8 without control characters.
struct RequestTarget {
  std::string path;                                        ///< "/v1/fits/7"; no slash at the end, except "/".
  std::vector<std::pair<std::string, std::string>> query;  ///< Names and values in their order; names are unique.
};

/// Parses the target of a request line in origin form, "/v1/fits?name=run%201", or absolute form, "http://host/v1/fits"
/// (RFC 9112, section 3.2), whose authority is ignored. Escapes follow RFC 3986. In the query + means a blank, as in
/// HTML forms, and a name without = has an empty value.
/// kInvalidArgument: an invalid escape, invalid UTF-8, control characters; in the path an empty segment, "." or "..", a
/// backslash or an escaped slash; a query parameter without a name, or a repeated one.
Result<RequestTarget> ParseTarget(std::string_view target);

/// The authority of a target in absolute form, "host:8080"; empty for other forms.
std::string_view AuthorityOf(std::string_view target);

}  // namespace pendulum
