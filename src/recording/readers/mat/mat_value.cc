// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_value.h"

#include <algorithm>

namespace pendulum {
namespace {

constexpr double kIsReference = 0xDD000000U;

/// "(2)" or "{2}" for the second of several.
std::string PlaceOf(std::size_t i, std::size_t count, std::string_view brackets) {
  if (count == 1 && brackets == "()") return "";
  return brackets[0] + std::to_string(i + 1) + brackets[1];
}

}  // namespace

bool MatValue::IsEmpty() const {
  if (kind == Kind::kObject || kind == Kind::kOther) return false;
  return CountIn(sizes) == std::size_t{0};
}

const MatValue* MatValue::Field(std::string_view name) const {
  const auto found = std::ranges::find(names, name);
  if (kind != Kind::kStructure || found == names.end() || parts.size() != names.size()) return nullptr;
  return &parts[static_cast<std::size_t>(found - names.begin())];
}

char AsciiLetter(double letter) {
  constexpr double kAscii = 128;
  return letter > 0 && letter < kAscii ? static_cast<char>(letter) : '?';
}

std::optional<std::size_t> CountIn(const std::vector<std::size_t>& sizes) {
  constexpr std::size_t kMaxElements = std::size_t{1} << 40;
  if (std::ranges::find(sizes, std::size_t{0}) != sizes.end()) return 0;
  std::size_t count = 1;
  for (const std::size_t size : sizes) {
    if (size > kMaxElements / count) return std::nullopt;
    count *= size;
  }
  return count;
}

std::optional<MatObjects> ObjectsOf(const MatValue& value) {
  const std::vector<double>& numbers = value.numbers;
  const bool may_be = value.kind == MatValue::Kind::kNumbers || value.kind == MatValue::Kind::kObject;
  if (!may_be || numbers.size() < 3 || numbers[0] != kIsReference) return std::nullopt;
  const bool is_whole = std::ranges::all_of(numbers, [](double number) {
    return number >= 0 && number < 4294967296.0 && number == static_cast<double>(static_cast<std::uint32_t>(number));
  });
  const auto rank = is_whole ? static_cast<std::size_t>(numbers[1]) : 0;
  if (rank == 0 || rank > numbers.size() - 3) return std::nullopt;
  const auto first = numbers.begin() + 2;
  const auto last = first + static_cast<std::ptrdiff_t>(rank);
  if (CountIn({first, last}) != numbers.size() - 3 - rank) return std::nullopt;
  return MatObjects{{last, numbers.end() - 1}, static_cast<std::size_t>(numbers.back())};
}

void AddReferences(const MatValue& value, const std::string& name, std::vector<MatReference>& references) {
  constexpr std::size_t kMaxReferences = 100'000;
  if (references.size() >= kMaxReferences) return;
  const std::size_t parts = value.parts.size(), fields = value.names.size();
  if (value.kind == MatValue::Kind::kObject) {
    const std::optional<MatObjects> found = ObjectsOf(value);
    const std::size_t count = found ? found->objects.size() : 0;
    if (!found) references.push_back({name, value.text});
    for (std::size_t i = 0; i < std::min(count, kMaxReferences); ++i) {
      references.push_back({name + PlaceOf(i, count, "()"), value.text, found->objects[i]});
    }
  }
  if (value.kind == MatValue::Kind::kCells) {
    for (std::size_t i = 0; i < parts; ++i) AddReferences(value.parts[i], name + PlaceOf(i, parts, "{}"), references);
  }
  if (value.kind != MatValue::Kind::kStructure || fields == 0) return;
  for (std::size_t i = 0; i < parts; ++i) {
    const std::string element = name + PlaceOf(i / fields, parts / fields, "()");
    AddReferences(value.parts[i], element + "." + value.names[i % fields], references);
  }
}

}  // namespace pendulum
