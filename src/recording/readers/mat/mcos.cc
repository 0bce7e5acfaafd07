// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mcos.h"

#include <algorithm>
#include <span>
#include <utility>

#include "recording/readers/mat/mat_elements.h"

namespace pendulum {
namespace {

constexpr std::size_t kMcosWord = sizeof(std::uint32_t);
constexpr std::size_t kMcosHeaderWords = 10;  // Version, number of names, eight offsets.
constexpr std::size_t kFirstCell = 2;         // After the table and an empty cell.

std::optional<std::vector<std::uint32_t>> WordsBetween(std::string_view bytes, std::size_t begin, std::size_t end,
                                                       bool is_swapped) {
  if (begin > end || end > bytes.size()) return std::nullopt;
  return WordsOf(bytes.substr(begin, end - begin), is_swapped);
}

}  // namespace

std::optional<Mcos> Mcos::Read(std::string_view bytes, std::size_t cells) {
  constexpr std::uint32_t kFirstVersion = 2, kLastVersion = 4, kSwapped = 0x10000;
  auto header = WordsBetween(bytes, 0, kMcosHeaderWords * kMcosWord, false);
  const bool is_swapped = header && header->front() >= kSwapped;
  if (is_swapped) header = WordsBetween(bytes, 0, kMcosHeaderWords * kMcosWord, true);
  if (!header || header->front() < kFirstVersion || header->front() > kLastVersion) return std::nullopt;
  const std::size_t after_properties = header->front() - kFirstVersion + 1;
  if (cells < kFirstCell + after_properties) return std::nullopt;
  const std::span<const std::uint32_t> offsets(header->begin() + 2, header->end());
  const auto region = [&](std::size_t i) { return WordsBetween(bytes, offsets[i], offsets[i + 1], is_swapped); };
  const auto classes = region(0), saved = region(1), objects = region(2), normal = region(3);
  if (offsets[0] < kMcosHeaderWords * kMcosWord || offsets[0] > bytes.size()) return std::nullopt;
  if (!classes || !saved || !objects || !normal) return std::nullopt;
  const std::string_view names = bytes.substr(kMcosHeaderWords * kMcosWord, offsets[0] - kMcosHeaderWords * kMcosWord);
  const std::size_t end_of_cells = cells - after_properties;
  Mcos mcos;
  const bool is_whole = mcos.ReadNames(names, (*header)[1]) && mcos.ReadClasses(*classes) &&
                        mcos.ReadProperties(*saved, end_of_cells, mcos.saved_) &&
                        mcos.ReadProperties(*normal, end_of_cells, mcos.normal_) && mcos.ReadObjects(*objects);
  return is_whole ? std::optional(std::move(mcos)) : std::nullopt;
}

bool Mcos::ReadNames(std::string_view bytes, std::size_t count) {
  if (count > bytes.size()) return false;
  names_.emplace_back();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t end = bytes.find('\0');
    if (end == std::string_view::npos || end == 0) return false;
    names_.emplace_back(bytes.substr(0, end));
    bytes.remove_prefix(end + 1);
  }
  return bytes.find_first_not_of('\0') == std::string_view::npos;
}

bool Mcos::ReadClasses(const Words& words) {
  constexpr std::size_t kBlock = 4;
  if (words.size() % kBlock != 0) return false;
  for (std::size_t at = 0; at < words.size(); at += kBlock) {
    const Class one{words[at], words[at + 1]};
    const bool is_none = one.package == 0 && one.name == 0;
    if (one.package >= names_.size() || one.name >= names_.size() || is_none != (at == 0)) return false;
    if (at > 0 && one.name == 0) return false;
    classes_.push_back(one);
  }
  return !classes_.empty();
}

bool Mcos::ReadObjects(const Words& words) {
  constexpr std::size_t kBlock = 6, kOne = 1;
  if (words.size() % kBlock != 0) return false;
  for (std::size_t at = 0; at < words.size(); at += kBlock) {
    const Object one{words[at], words[at + 3], words[at + 4]};
    if (one.class_id >= classes_.size() || (one.class_id == 0) != (at == 0)) return false;
    if (one.saved >= std::max(saved_.size(), kOne) || one.normal >= std::max(normal_.size(), kOne)) return false;
    if (one.saved != 0 && one.normal != 0) return false;
    objects_.push_back(one);
  }
  return !objects_.empty();
}

bool Mcos::ReadProperties(const Words& words, std::size_t end_of_cells, std::vector<Properties>& blocks) const {
  constexpr std::size_t kEntry = 3;
  if (words.size() % 2 != 0) return false;
  for (std::size_t at = 0; at < words.size();) {
    const std::size_t count = words[at++];
    if (count > (words.size() - at) / kEntry || (blocks.empty() && count > 0)) return false;
    Properties& block = blocks.emplace_back();
    for (std::size_t i = 0; i < count; ++i, at += kEntry) {
      const std::size_t name = words[at], kind = words[at + 1], value = words[at + 2];
      const bool is_cell = kind == static_cast<std::size_t>(McosProperty::Kind::kCell);
      const bool is_name = kind == static_cast<std::size_t>(McosProperty::Kind::kEnumeration);
      const bool is_number = kind == static_cast<std::size_t>(McosProperty::Kind::kNumber);
      if (name == 0 || name >= names_.size() || !(is_cell || is_name || is_number)) return false;
      if ((is_cell && value >= end_of_cells - kFirstCell) || (is_name && value >= names_.size())) return false;
      block.push_back({name, static_cast<McosProperty::Kind>(kind), is_cell ? value + kFirstCell : value});
    }
    at += at % 2;  // Blocks are aligned to eight bytes.
  }
  return true;
}

std::string Mcos::ClassName(std::size_t class_id) const {
  if (class_id >= classes_.size()) return "";
  const Class& one = classes_[class_id];
  return (one.package == 0 ? "" : names_[one.package] + ".") + names_[one.name];
}

std::size_t Mcos::ClassOf(std::size_t object) const { return object < objects_.size() ? objects_[object].class_id : 0; }

const McosProperty* Mcos::Find(std::size_t object, std::string_view name) const {
  if (object >= objects_.size()) return nullptr;
  const Object& one = objects_[object];
  const Properties* const properties = one.saved != 0    ? &saved_[one.saved]
                                       : one.normal != 0 ? &normal_[one.normal]
                                                         : nullptr;
  if (properties == nullptr) return nullptr;
  const auto found =
      std::ranges::find(*properties, name, [&](const McosProperty& p) { return std::string_view(names_[p.name]); });
  return found == properties->end() ? nullptr : &*found;
}

}  // namespace pendulum
