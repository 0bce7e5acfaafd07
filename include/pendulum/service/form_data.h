// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

/// A field of a form.
struct FormPart {
  std::string name;
  std::string filename;      ///< As the client wrote it, never used as a path; empty if missing.
  std::string content_type;  ///< As written, "text/csv; charset=utf-8"; empty if missing.
  std::string_view content;  ///< View into the body.
};

inline constexpr std::size_t kMaxFormParts = 20'000;
inline constexpr std::size_t kMaxPartHeadBytes = 8192;

/// The fields of a form (RFC 7578) in their order, as views into `body`; O(size of the body). `content_type`: the value
/// of the request's Content-Type field, which names the boundary. Names may be escaped with backslashes, or with %22,
/// %0D and %0A as browsers do; filename* (RFC 8187) takes precedence over filename. Text before the first boundary and
/// after the last is ignored (RFC 2046, section 5.1.1).
/// kInvalidArgument: the content type is no form or has no boundary; no closing boundary, more than kMaxFormParts
/// parts; a part without a name or blank line, with a head above kMaxPartHeadBytes, or with an encoding other than
/// 7bit, 8bit and binary.
Result<std::vector<FormPart>> ParseFormData(std::string_view content_type, std::string_view body);

}  // namespace pendulum
