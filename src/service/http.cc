// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/http.h"

#include <algorithm>

namespace pendulum {
namespace {

bool IsSameName(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::ranges::equal(a, b, {}, lower, lower);
}

}  // namespace

std::optional<std::string_view> HttpRequest::Field(std::string_view name) const {
  const auto found = std::ranges::find_if(fields, [&](const HttpField& field) { return IsSameName(field.name, name); });
  if (found == fields.end()) return std::nullopt;
  return found->value;
}

std::vector<std::string_view> HttpRequest::Fields(std::string_view name) const {
  std::vector<std::string_view> values;
  for (const HttpField& field : fields) {
    if (IsSameName(field.name, name)) values.emplace_back(field.value);
  }
  return values;
}

}  // namespace pendulum
