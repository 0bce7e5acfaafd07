// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pendulum {

/// A compound file of Microsoft (OLE 2, [MS-CFB]): streams with names, in chains of sectors. Older Office programs use
/// it for their documents, and later ones for encrypted documents.
class CompoundFile {
 public:
  /// `bytes` must outlive this object. A damaged file has fewer streams.
  explicit CompoundFile(std::string_view bytes);

  /// True if there is a stream or a folder with this name.
  bool Has(std::string_view name) const { return Find(name) != nullptr; }

  /// The bytes of a stream of the top folder; std::nullopt: there is none, or it is cut off.
  std::optional<std::string> Read(std::string_view name) const;

 private:
  struct Entry {
    std::string name;
    std::uint32_t first_sector = 0;
    std::size_t size = 0;
    bool is_root = false;
  };

  void ReadTable();
  void ReadEntries();
  const Entry* Find(std::string_view name) const;
  std::string_view Sector(std::uint32_t sector) const;
  std::optional<std::string> Chain(std::uint32_t sector, std::size_t size) const;
  std::optional<std::string> SmallChain(std::uint32_t sector, std::size_t size) const;

  std::string_view bytes_;
  std::size_t sector_size_ = 512;
  std::size_t small_below_ = 4096;         // Shorter streams are in small sectors.
  std::vector<std::uint32_t> next_;        // The sector after each one.
  std::vector<std::uint32_t> next_small_;  // The same for small sectors.
  std::vector<Entry> entries_;
  std::string small_;  // The stream of all small sectors.
};

}  // namespace pendulum
