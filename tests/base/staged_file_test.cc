// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/staged_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace pendulum::staged_file_test {
namespace {

namespace fs = std::filesystem;

using testing::HasSubstr;

class StagedFileTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string TextOf(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::size_t FilesInFolder() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {}));
  }

  const fs::path folder_ = testing::TempDir() + "staged_file_test_" + std::to_string(getpid());
  const std::string path_ = folder_ / "result";
};

TEST_F(StagedFileTest, ShowsTheOldFileUntilItIsCommitted) {
  std::ofstream(path_) << "old";
  StagedFile file(path_);
  ASSERT_TRUE(file.Open());
  ASSERT_TRUE(file.Write("new, "));
  ASSERT_TRUE(file.Write("in pieces"));
  ASSERT_TRUE(file.Finish());
  EXPECT_EQ(TextOf(path_), "old");
  ASSERT_TRUE(file.Commit());
  EXPECT_EQ(TextOf(path_), "new, in pieces");
  EXPECT_EQ(FilesInFolder(), 1);
}

TEST_F(StagedFileTest, LeavesNothingUnlessCommitted) {
  {
    StagedFile file(path_);
    ASSERT_TRUE(file.Open());
    ASSERT_TRUE(file.Write("half"));
    EXPECT_EQ(FilesInFolder(), 1);
  }
  EXPECT_EQ(FilesInFolder(), 0);
}

TEST_F(StagedFileTest, KeepsModeAndLinkOfTheReplacedFile) {
  const fs::path target = folder_ / "target";
  std::ofstream(target) << "old";
  fs::permissions(target, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("target", path_);
  StagedFile file(path_);
  ASSERT_TRUE(file.Open() && file.Write("new") && file.Finish() && file.Commit());
  EXPECT_TRUE(fs::is_symlink(path_));
  EXPECT_EQ(TextOf(target), "new");
  EXPECT_EQ(fs::status(target).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(StagedFileTest, ReportsTheSystemsErrorIfUnwritable) {
  const Result<void> opened = StagedFile(folder_ / "nowhere" / "result").Open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, StatusCode::kCannotWrite);
  EXPECT_THAT(opened.error().message(), HasSubstr("nowhere/result: No such file or directory"));
}

}  // namespace
}  // namespace pendulum::staged_file_test
