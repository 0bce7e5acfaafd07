// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <ctime>
#include <optional>
#include <string>

#include "pendulum/service/http.h"

namespace pendulum::wire {

/// How the body of an answer ends.
struct Framing {
  std::optional<std::size_t> length;  ///< Bytes, for Content-Length; none: chunks, or what comes until the end.
  bool is_chunked = false;
  bool keeps_alive = false;
};

/// Whether an answer of this status may have a body (RFC 9110, section 6.4.1).
bool MayHaveBody(int status);

/// "Mon, 23 Nov 2026 21:40:05 GMT" (RFC 9110, section 5.6.7), whatever the locale.
std::string HttpDate(std::time_t time);

/// Status line and fields with the empty line after them. Control characters in a value become blanks, a field whose
/// name is no token and those that the server sets are left out.
std::string AnswerHead(const HttpResponse& response, const Framing& framing, std::time_t now);

}  // namespace pendulum::wire
