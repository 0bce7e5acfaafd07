// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
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

  /// `bytes` must outlive this object. kDataLoss: they are no zip file.
  static Result<ZipMembers> Open(std::string_view bytes, const std::string& name);

  /// Those that may be recordings: no folders, nothing that is hidden, no notes of phyphox ("meta/") or macOS.
  const std::vector<Member>& members() const { return members_; }

  /// True where there is a file of that path, whatever it is.
  bool Has(std::string_view path) const;

  /// The first bytes of a member, `most` at most. kDataLoss: encrypted, damaged, or packed as libzip cannot unpack.
  Result<std::string> Unpack(const Member& member, std::size_t most) const;

  /// "NAME:MEMBER", which messages begin with.
  std::string NameOf(const Member& member) const;

 private:
  struct Discard {
    void operator()(zip* archive) const;
  };

  void FindMembers();

  std::string name_;
  std::unique_ptr<zip, Discard> archive_;
  std::vector<Member> members_;
  std::vector<std::string> paths_;
};

}  // namespace pendulum
