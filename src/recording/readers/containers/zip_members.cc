// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/zip_members.h"

#include <algorithm>
#include <array>
#include <utility>

#include <zip.h>

#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/try.h"

namespace pendulum {
namespace {

bool MayBeRecording(std::string_view path) {
  const std::string_view file = path.substr(path.rfind('/') + 1);  // npos + 1 is 0
  return !file.empty() && file.front() != '.' && !path.starts_with("meta/") && !path.starts_with("__MACOSX/");
}

struct Close {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

}  // namespace

void ZipMembers::Discard::operator()(zip* archive) const { zip_discard(archive); }

Result<ZipMembers> ZipMembers::Open(std::string_view bytes, const std::string& name) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  ZipMembers opened;
  opened.name_ = name;
  if (source != nullptr) opened.archive_.reset(zip_open_from_source(source, ZIP_RDONLY, &error));
  if (opened.archive_ == nullptr && source != nullptr) zip_source_free(source);
  const std::string why = zip_error_strerror(&error);
  zip_error_fini(&error);
  if (opened.archive_ == nullptr) {
    return Fault(name, "this zip file cannot be opened (" + why + "): it is damaged or cut off; export it again");
  }
  opened.FindMembers();
  return opened;
}

void ZipMembers::FindMembers() {
  const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    zip_stat_t stat;
    if (zip_stat_index(archive_.get(), i, ZIP_FL_ENC_GUESS, &stat) != 0) continue;
    if ((stat.valid & ZIP_STAT_NAME) == 0 || stat.name == nullptr) continue;
    const bool is_encrypted = (stat.valid & ZIP_STAT_ENCRYPTION_METHOD) != 0 && stat.encryption_method != ZIP_EM_NONE;
    all_.push_back({stat.name, static_cast<std::uint64_t>(i), is_encrypted});
    if (MayBeRecording(stat.name)) members_.push_back(all_.back());
  }
}

const ZipMembers::Member* ZipMembers::Find(std::string_view path) const {
  const auto found = std::ranges::find(all_, path, &Member::path);
  return found == all_.end() ? nullptr : &*found;
}

bool ZipMembers::HasFolder(std::string_view begin) const {
  return std::ranges::any_of(all_, [&](const Member& member) { return member.path.starts_with(begin); });
}

std::string ZipMembers::NameOf(const Member& member) const {
  const std::string quoted = Quoted(member.path);
  return name_ + ":" + quoted.substr(1, quoted.size() - 2);
}

Result<std::string> ZipMembers::Unpack(const Member& member, std::size_t max_bytes) const {
  std::string text;
  const auto add = [&](std::string_view block) {
    text += block.substr(0, max_bytes - text.size());
    return text.size() < max_bytes;
  };
  RETURN_IF_ERROR(UnpackBlocks(member, add));
  return text;
}

Result<void> ZipMembers::UnpackBlocks(const Member& member, const std::function<bool(std::string_view)>& take) const {
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  if (member.is_encrypted) {
    return Fault(NameOf(member), "it is encrypted; unpack it with its password and name the file");
  }
  const auto damaged = [&](const std::string& why) {
    return Fault(NameOf(member), "it cannot be unpacked (" + why + "); export or pack it again");
  };
  const std::unique_ptr<zip_file_t, Close> file(zip_fopen_index(archive_.get(), member.index, 0));
  if (file == nullptr) return damaged(zip_error_strerror(zip_get_error(archive_.get())));
  std::string block(kBlock, '\0');
  while (true) {
    const zip_int64_t got = zip_fread(file.get(), block.data(), block.size());
    if (got < 0) return damaged(zip_error_strerror(zip_file_get_error(file.get())));
    if (got == 0 || !take({block.data(), static_cast<std::size_t>(got)})) return {};
  }
}

}  // namespace pendulum
