// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// What a request asks for, decoded: valid UTF-8 without control characters.
struct RequestTarget {
  std::string path;                                        ///< "/v1/fits/7"; begins with a slash, ends in none but "/".
  std::vector<std::pair<std::string, std::string>> query;  ///< Names and values in their order; no name twice.
};

/// The target of a request line in origin form, "/v1/fits?name=run%201", or absolute form, "http://host/v1/fits"
/// (RFC 9112, section 3.2), whose authority is passed over. Escapes as RFC 3986 has them; in the query + is a blank, as
/// HTML forms write it, and a name without = has an empty value.
/// kInvalidArgument: an escape that is none, bytes that are no UTF-8, control characters; in the path an empty segment,
/// "." or "..", a backslash or an escaped slash; a query parameter without name, or given twice.
Result<RequestTarget> ParseTarget(std::string_view target);

/// The authority of a target in absolute form, "host:8080"; empty for any other.
std::string_view AuthorityOf(std::string_view target);

}  // namespace pendulum
