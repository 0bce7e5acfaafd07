// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/http.h"

#include <algorithm>

namespace pendulum {

std::optional<std::string_view> HttpRequest::Field(std::string_view name) const {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  const auto found = std::ranges::find_if(
      fields, [&](const HttpField& field) { return std::ranges::equal(field.name, name, {}, lower, lower); });
  if (found == fields.end()) return std::nullopt;
  return found->value;
}

}  // namespace pendulum
