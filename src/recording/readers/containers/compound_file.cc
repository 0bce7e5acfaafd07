// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/compound_file.h"

#include <algorithm>

#include "recording/readers/containers/bytes.h"

namespace pendulum {
namespace {

constexpr std::size_t kCompoundHeader = 512, kSmallSector = 64, kEntryBytes = 128, kMaxNameBytes = 64;
constexpr std::size_t kWord = sizeof(std::uint32_t);
constexpr std::uint32_t kLastSector = 0xFFFFFFFA;  // Larger numbers are marks.

/// The words of a sector of a table.
void AppendWords(std::string_view sector, std::vector<std::uint32_t>& words) {
  for (std::size_t at = 0; at + kWord <= sector.size(); at += kWord) {
    words.push_back(NumberAt<std::uint32_t>(sector, at));
  }
}

/// A name in UTF-16, of which only ASCII matters here.
std::string NameOf(std::string_view entry) {
  const std::size_t size = std::min<std::size_t>(NumberAt<std::uint16_t>(entry, kMaxNameBytes), kMaxNameBytes);
  std::string name;
  for (std::size_t at = 0; at + 2 < size; at += 2) {
    name += entry[at + 1] == 0 ? entry[at] : '?';
  }
  return name;
}

}  // namespace

CompoundFile::CompoundFile(std::string_view bytes) : bytes_(bytes) {
  constexpr std::size_t kSizeAt = 30, kSmallBelowAt = 56, kSmallTableAt = 60;
  constexpr std::uint16_t kLargeSector = 12;
  if (bytes_.size() < kCompoundHeader) return;
  if (NumberAt<std::uint16_t>(bytes_, kSizeAt) == kLargeSector) sector_size_ = 4096;
  small_below_ = NumberAt<std::uint32_t>(bytes_, kSmallBelowAt);
  ReadTable();
  ReadEntries();
  const auto root = std::ranges::find(entries_, true, &Entry::is_root);
  if (root == entries_.end()) return;
  small_ = Chain(root->first_sector, root->size).value_or("");
  const std::size_t small_table = NumberAt<std::uint32_t>(bytes_, kSmallTableAt + 4) * sector_size_;
  if (const auto table = Chain(NumberAt<std::uint32_t>(bytes_, kSmallTableAt), small_table)) {
    AppendWords(*table, next_small_);
  }
}

/// The table of sectors. The header lists the first 109 sectors of it, and a chain of sectors lists the others.
void CompoundFile::ReadTable() {
  constexpr std::size_t kListAt = 76, kListed = 109, kNextListAt = 68;
  std::vector<std::uint32_t> list;
  AppendWords(bytes_.substr(kListAt, kListed * kWord), list);
  auto next = NumberAt<std::uint32_t>(bytes_, kNextListAt);
  for (std::size_t left = bytes_.size() / sector_size_; left > 0 && next < kLastSector; --left) {
    std::vector<std::uint32_t> words;
    AppendWords(Sector(next), words);
    if (words.empty()) break;
    next = words.back();
    list.insert(list.end(), words.begin(), words.end() - 1);
  }
  const std::size_t most = bytes_.size() / sector_size_ + sector_size_;
  for (const std::uint32_t sector : list) {
    if (sector < kLastSector && next_.size() < most) AppendWords(Sector(sector), next_);
  }
}

void CompoundFile::ReadEntries() {
  constexpr std::size_t kDirectoryAt = 48, kTypeAt = 66, kFirstAt = 116, kSizeAt = 120;
  constexpr char kRoot = 5;
  auto sector = NumberAt<std::uint32_t>(bytes_, kDirectoryAt);
  for (std::size_t left = next_.size(); left > 0 && sector < next_.size(); --left) {
    const std::string_view entries = Sector(sector);
    for (std::size_t at = 0; at + kEntryBytes <= entries.size(); at += kEntryBytes) {
      const std::string_view entry = entries.substr(at, kEntryBytes);
      if (entry[kTypeAt] == 0) continue;
      entries_.push_back({NameOf(entry), NumberAt<std::uint32_t>(entry, kFirstAt),
                          NumberAt<std::uint32_t>(entry, kSizeAt), entry[kTypeAt] == kRoot});
    }
    sector = next_[sector];
  }
}

const CompoundFile::Entry* CompoundFile::Find(std::string_view name) const {
  const auto found = std::ranges::find(entries_, name, &Entry::name);
  return found == entries_.end() ? nullptr : &*found;
}

/// The header occupies the place of a sector before the first one.
std::string_view CompoundFile::Sector(std::uint32_t sector) const {
  const std::size_t at = (static_cast<std::size_t>(sector) + 1) * sector_size_;
  return at >= bytes_.size() ? std::string_view() : bytes_.substr(at, sector_size_);
}

std::optional<std::string> CompoundFile::Chain(std::uint32_t sector, std::size_t size) const {
  if (size > bytes_.size()) return std::nullopt;
  std::string stream;
  while (stream.size() < size) {
    const std::string_view part = Sector(sector);
    if (part.empty()) return std::nullopt;
    stream += part;
    if (stream.size() < size && sector >= next_.size()) return std::nullopt;
    if (stream.size() < size) sector = next_[sector];
  }
  stream.resize(size);
  return stream;
}

std::optional<std::string> CompoundFile::SmallChain(std::uint32_t sector, std::size_t size) const {
  if (size > small_.size()) return std::nullopt;
  std::string stream;
  while (stream.size() < size) {
    const std::size_t at = static_cast<std::size_t>(sector) * kSmallSector;
    if (at >= small_.size() || sector >= next_small_.size()) return std::nullopt;
    stream += small_.substr(at, kSmallSector);
    sector = next_small_[sector];
  }
  stream.resize(size);
  return stream;
}

std::optional<std::string> CompoundFile::Read(std::string_view name) const {
  const Entry* const entry = Find(name);
  if (entry == nullptr) return std::nullopt;
  if (entry->size < small_below_) return SmallChain(entry->first_sector, entry->size);
  return Chain(entry->first_sector, entry->size);
}

}  // namespace pendulum
