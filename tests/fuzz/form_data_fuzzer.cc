// SPDX-License-Identifier: Apache-2.0
// Any bytes give a form whose parts are in order within it, or an error sentence.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "pendulum/service/form_data.h"
#include "pendulum/service/media_type.h"
#include "tests/fuzz/require.h"

namespace pendulum {
namespace {

void Check(std::string_view content_type, std::string_view body) {
  const auto parts = ParseFormData(content_type, body);
  if (!parts) {
    Require(parts.error().code == StatusCode::kInvalidArgument && parts.error().message().size() < 2000);
    return;
  }
  Require(ParseMediaType(content_type).has_value() && parts->size() <= kMaxFormParts);
  const char* behind = body.data();
  for (const FormPart& part : *parts) {
    Require(!part.name.empty() && part.name.size() + part.filename.size() <= kMaxPartHeadBytes);
    if (part.content.empty()) continue;
    Require(part.content.data() >= behind);
    behind = part.content.data() + part.content.size();
    Require(behind <= body.data() + body.size());
  }
}

}  // namespace
}  // namespace pendulum

/// The first line of the input is the content type; if it is empty, a form with a short boundary is assumed.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = pendulum::TextOf(data, size);
  const std::string_view line = text.substr(0, text.find('\n'));
  const std::string_view body = text.substr(line.size() < text.size() ? line.size() + 1 : text.size());
  pendulum::Check(line.empty() ? "multipart/form-data; boundary=X" : line, body);
  return 0;
}
