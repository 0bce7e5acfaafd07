// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/idempotency_key.h"

#include <algorithm>
#include <string_view>

#include "pendulum/base/format.h"
#include "pendulum/service/media_type.h"

namespace pendulum {

Result<std::string> IdempotencyKey(const HttpRequest& request) {
  const auto wrong = [](const std::string& sentence) {
    return Error(StatusCode::kInvalidArgument, "the Idempotency-Key " + sentence);
  };
  const auto values = request.Fields("Idempotency-Key");
  if (values.empty()) return "";
  if (values.size() > 1) return wrong("is given more than once; keep one of them");
  const std::string_view key = WithoutBlanks(values.front());
  if (key.empty()) return wrong("is empty; give each request its own key, or none");
  if (key.size() > kLongestIdempotencyKey) {
    return wrong("has " + std::to_string(key.size()) + " bytes; it may have at most " +
                 std::to_string(kLongestIdempotencyKey));
  }
  if (std::ranges::all_of(key, [](char c) { return c > ' ' && c < '\x7F'; })) return std::string(key);
  return wrong(Quoted(key) + " has characters other than visible ASCII; write a random number or a UUID");
}

}  // namespace pendulum
