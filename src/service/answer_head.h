// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <ctime>
#include <optional>
#include <string>

#include "pendulum/service/http.h"

namespace pendulum::wire {

/// Framing of the body of an answer.
struct Framing {
  std::optional<std::size_t> length;  ///< Content-Length; std::nullopt: in chunks, or until the connection ends.
  bool is_chunked = false;
  bool keeps_alive = false;
};

/// Whether an answer of this status may have a body (RFC 9110, section 6.4.1).
bool MayHaveBody(int status);

/// "Mon, 23 Nov 2026 21:40:05 GMT" (RFC 9110, section 5.6.7) in any locale.
std::string HttpDate(std::time_t time);

/// Status line and fields with the empty line after them. Control characters in a value become blanks. Fields whose
/// name is not a token, and those that the server sets, are left out.
std::string AnswerHead(const HttpResponse& response, const Framing& framing, std::time_t now);

}  // namespace pendulum::wire
