// SPDX-License-Identifier: Apache-2.0
// Any bytes give a target without parts that a path or a terminal would interpret, or an error sentence.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "pendulum/service/request_target.h"
#include "tests/fuzz/require.h"

namespace pendulum {
namespace {

bool IsPlain(std::string_view text) {
  return std::ranges::none_of(text, [](char c) { return (c >= 0 && c < ' ') || c == '\x7F'; });
}

void Check(std::string_view text) {
  Require(AuthorityOf(text).size() <= text.size());
  const auto target = ParseTarget(text);
  if (!target) {
    Require(target.error().code == StatusCode::kInvalidArgument && target.error().message().size() < 2000);
    return;
  }
  const std::string& path = target->path;
  Require(path.starts_with('/') && (path == "/" || !path.ends_with('/')) && path.size() <= text.size() + 1);
  Require(IsPlain(path) && path.find('\\') == std::string::npos && path.find("//") == std::string::npos);
  for (const char* relative : {"/./", "/../"}) Require((path + "/").find(relative) == std::string::npos);
  std::set<std::string> names;
  for (const auto& [name, value] : target->query) {
    Require(!name.empty() && IsPlain(name) && IsPlain(value) && names.insert(name).second);
  }
}

}  // namespace
}  // namespace pendulum

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pendulum::Check(pendulum::TextOf(data, size));
  return 0;
}
