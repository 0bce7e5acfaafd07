// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/temporary_store.h"

#include <cstddef>
#include <string>
#include <system_error>

#include "pendulum/base/file.h"
#include "pendulum/base/staged_file.h"
#include "pendulum/base/try.h"

namespace pendulum {

namespace fs = std::filesystem;

fs::path WithSuffix(const fs::path& path, const std::string& suffix) { return path.string() + suffix; }

Result<void> CheckFolderOf(const fs::path& file) {
  std::error_code unknown;
  if (!file.has_parent_path() || fs::is_directory(file.parent_path(), unknown)) return {};
  return CannotWrite(file.string(), "there is no folder " + file.parent_path().string() + "; make it first");
}

Result<void> Publish(const fs::path& from, const fs::path& to) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  ASSIGN_OR_RETURN(auto input, InputFile::Open(from, "store"));
  StagedFile output(to.string());
  RETURN_IF_ERROR(output.Open());
  std::string block(kBlock, '\0');
  for (std::size_t got = kBlock; got == kBlock;) {
    ASSIGN_OR_RETURN(const auto read, input.Read(block));
    got = read;
    RETURN_IF_ERROR(output.Write({block.data(), got}));
  }
  RETURN_IF_ERROR(output.Finish());
  return output.Commit();
}

void TemporaryStore::Remove() const {
  std::error_code unknown;
  fs::remove(path_, unknown);
  fs::remove(WithSuffix(path_, "-journal"), unknown);
}

}  // namespace pendulum
