// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/temporary_store.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace pendulum::temporary_store_test {
namespace {

namespace fs = std::filesystem;

class TemporaryStoreTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path Write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  static std::string Read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("temporary_store_test_" + std::to_string(getpid()));
};

TEST_F(TemporaryStoreTest, RemovesFileAndJournalWhenCreatedAndWhenDestroyed) {
  const fs::path path = Write("a.sqlite", "left by a killed process");
  const fs::path journal = Write("a.sqlite-journal", "its journal");
  {
    const TemporaryStore store(path);
    EXPECT_FALSE(fs::exists(path) || fs::exists(journal));
    Write("a.sqlite", "new");
    Write("a.sqlite-journal", "new");
  }
  EXPECT_FALSE(fs::exists(path) || fs::exists(journal));
}

TEST_F(TemporaryStoreTest, KeepsARenamedFile) {
  {
    const TemporaryStore store(folder_ / "a.sqlite");
    Write("a.sqlite", "whole");
    fs::rename(store.path(), folder_ / "b.sqlite");
  }
  EXPECT_EQ(Read(folder_ / "b.sqlite"), "whole");
}

// Sizes around the size of a block.
TEST_F(TemporaryStoreTest, PublishesACopyOfEveryByte) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1} << 20, (std::size_t{1} << 20) + 1}) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i % 251);
    const fs::path to = Write("to", "what was there");
    const auto published = Publish(Write("from", bytes), to);
    ASSERT_TRUE(published) << published.error().message();
    EXPECT_TRUE(Read(to) == bytes) << size;
  }
}

TEST_F(TemporaryStoreTest, KeepsTheOldFileIfThereIsNothingToPublish) {
  const fs::path to = Write("to", "what was there");
  EXPECT_EQ(Publish(folder_ / "none", to).error().code, StatusCode::kNotFound);
  EXPECT_EQ(Read(to), "what was there");
}

TEST_F(TemporaryStoreTest, NamesAMissingFolder) {
  EXPECT_TRUE(CheckFolderOf(folder_ / "a.sqlite"));
  EXPECT_TRUE(CheckFolderOf("a.sqlite"));
  const auto checked = CheckFolderOf(folder_ / "nowhere" / "a.sqlite");
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, StatusCode::kCannotWrite);
  EXPECT_EQ(checked.error().message(), "cannot write " + (folder_ / "nowhere" / "a.sqlite").string() +
                                           ": there is no folder " + (folder_ / "nowhere").string() +
                                           "; make it first");
}

}  // namespace
}  // namespace pendulum::temporary_store_test
