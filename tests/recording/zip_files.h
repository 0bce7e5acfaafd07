// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <zip.h>

/// Zip files for tests, made by libzip.
namespace pendulum {

/// The bytes of a zip file with these members (path and content), encrypted if there is a password.
inline std::string ZipOf(const std::vector<std::pair<std::string, std::string>>& members,
                         const char* password = nullptr) {
  constexpr std::time_t kModified = 1767225600;  // The same members always give the same bytes.
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* bytes = zip_source_buffer_create(nullptr, 0, 0, &error);
  zip_source_keep(bytes);
  zip_t* zip = zip_open_from_source(bytes, ZIP_TRUNCATE, &error);
  for (const auto& [path, content] : members) {
    const zip_int64_t index =
        zip_file_add(zip, path.c_str(), zip_source_buffer(zip, content.data(), content.size(), 0), 0);
    zip_file_set_mtime(zip, static_cast<zip_uint64_t>(index), kModified, 0);
    if (password != nullptr) zip_file_set_encryption(zip, index, ZIP_EM_AES_128, password);
  }
  EXPECT_EQ(zip_close(zip), 0);
  zip_source_open(bytes);
  zip_source_seek(bytes, 0, SEEK_END);
  std::string packed(zip_source_tell(bytes), '\0');
  zip_source_seek(bytes, 0, SEEK_SET);
  zip_source_read(bytes, packed.data(), packed.size());
  zip_source_close(bytes);
  zip_source_free(bytes);
  zip_error_fini(&error);
  return packed;
}

}  // namespace pendulum
