// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/http.h"

#include <algorithm>

#include "pendulum/service/media_type.h"

namespace pendulum {

std::optional<std::string_view> HttpRequest::Field(std::string_view name) const {
  const auto found = std::ranges::find_if(fields, [&](const HttpField& field) { return IsSameWord(field.name, name); });
  if (found == fields.end()) return std::nullopt;
  return found->value;
}

std::vector<std::string_view> HttpRequest::Fields(std::string_view name) const {
  std::vector<std::string_view> values;
  for (const HttpField& field : fields) {
    if (IsSameWord(field.name, name)) values.emplace_back(field.value);
  }
  return values;
}

}  // namespace pendulum
