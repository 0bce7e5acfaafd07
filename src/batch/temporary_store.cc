// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/temporary_store.h"

#include <cstddef>
#include <string>
#include <system_error>

#include "pendulum/base/file.h"
#include "pendulum/base/staged_file.h"

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
  auto input = InputFile::Open(from, "store");
  if (!input) return tl::unexpected(input.error());
  StagedFile output(to.string());
  if (auto opened = output.Open(); !opened) return opened;
  std::string block(kBlock, '\0');
  for (std::size_t got = kBlock; got == kBlock;) {
    const auto read = input->Read(block);
    if (!read) return tl::unexpected(read.error());
    got = *read;
    if (auto written = output.Write({block.data(), got}); !written) return written;
  }
  if (auto finished = output.Finish(); !finished) return finished;
  return output.Commit();
}

void TemporaryStore::Remove() const {
  std::error_code unknown;
  fs::remove(path_, unknown);
  fs::remove(WithSuffix(path_, "-journal"), unknown);
}

}  // namespace pendulum
