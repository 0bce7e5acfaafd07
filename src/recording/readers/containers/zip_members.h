// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"

struct zip;  // libzip's zip_t

namespace pendulum {

/// The files in a zip file.
class ZipMembers {
 public:
  struct Member {
    std::string path;
    std::uint64_t index = 0;
    bool is_encrypted = false;
  };

  /// `bytes` must outlive this object. kDataLoss: not a zip file.
  static Result<ZipMembers> Open(std::string_view bytes, const std::string& name);

  /// The members that may be recordings: no folders, no hidden files, no metadata of phyphox ("meta/") or macOS.
  const std::vector<Member>& members() const { return members_; }

  /// True if there is a file with this path, of any kind.
  bool Has(std::string_view path) const { return Find(path) != nullptr; }

  /// True if a path of any file begins like this.
  bool HasFolder(std::string_view begin) const;

  /// The file with this path, of any kind. nullptr: there is none.
  const Member* Find(std::string_view path) const;

  /// The first bytes of a member, at most `max_bytes`. kDataLoss: encrypted, damaged, or packed in a way that libzip
  /// cannot unpack.
  Result<std::string> Unpack(const Member& member, std::size_t max_bytes) const;

  /// Unpacks a member in blocks until `take` returns false. Errors as Unpack.
  Result<void> UnpackBlocks(const Member& member, const std::function<bool(std::string_view)>& take) const;

  /// "NAME:MEMBER", the beginning of messages.
  std::string NameOf(const Member& member) const;

 private:
  struct Discard {
    void operator()(zip* archive) const;
  };

  void FindMembers();

  std::string name_;
  std::unique_ptr<zip, Discard> archive_;
  std::vector<Member> members_;
  std::vector<Member> all_;
};

}  // namespace pendulum
