// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_version_4.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include "recording/readers/mat/mat_elements.h"
#include "recording/readers/mat/mat_value.h"

namespace pendulum {
namespace {

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Whether this is a MATLAB variable name with a final zero.
bool IsName(std::string_view name) {
  if (name.size() < 2 || name.back() != '\0' || !IsLetter(name.front())) return false;
  name.remove_suffix(1);
  return std::ranges::all_of(name, [](char c) { return IsLetter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

std::optional<std::size_t> SizeInOrder(std::string_view bytes, bool is_little) {
  constexpr std::size_t kHeader = 20, kLongestName = 64;
  constexpr std::uint32_t kBigType = 1000, kPrecisions = 10, kKinds = 3;
  constexpr std::array<std::size_t, 6> kNumberBytes = {8, 4, 4, 2, 2, 1};  // Indexed by the tens of the type.
  const bool is_swapped = is_little != (std::endian::native == std::endian::little);
  const auto words = bytes.size() < kHeader ? std::nullopt : WordsOf(bytes.substr(0, kHeader), is_swapped);
  if (!words) return std::nullopt;
  const std::uint32_t rows = (*words)[1], columns = (*words)[2], is_complex = (*words)[3];
  const std::uint32_t type = (*words)[0] - (is_little ? 0 : kBigType);
  const std::size_t precision = type / kPrecisions, name = (*words)[4];
  if (precision >= kNumberBytes.size() || type % kPrecisions >= kKinds || is_complex > 1) return std::nullopt;
  if (name > std::min(kLongestName, bytes.size() - kHeader) || !IsName(bytes.substr(kHeader, name)))
    return std::nullopt;
  const auto numbers = CountIn({rows, columns, 1 + is_complex, kNumberBytes[precision]});
  return numbers ? std::optional(kHeader + name + *numbers) : std::nullopt;
}

}  // namespace

std::optional<std::size_t> SizeOfVersion4(std::string_view bytes) {
  const auto little = SizeInOrder(bytes, true);
  return little ? little : SizeInOrder(bytes, false);
}

}  // namespace pendulum
