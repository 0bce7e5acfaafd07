// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/file.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pendulum::file_test {
namespace {

using testing::HasSubstr;

class ReadFileTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directory(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("file_test_" + std::to_string(getpid()));
  const std::filesystem::path path_ = folder_ / "run.csv";
};

TEST_F(ReadFileTest, GivesEveryByte) {
  for (const std::size_t size : {0, 1, 65535, 65536, 65537, 300000}) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * 7 + i / 256);
    std::ofstream(path_, std::ios::binary) << bytes;
    EXPECT_EQ(ReadFile(path_, "CSV", 1'000'000), bytes) << size;
  }
}

TEST_F(ReadFileTest, ReadsAPipeToItsEnd) {
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  const std::string bytes(200000, 'x');
  std::thread writer([&] { std::ofstream(path_, std::ios::binary) << bytes; });
  EXPECT_EQ(ReadFile(path_, "CSV", 1'000'000), bytes);
  writer.join();
}

TEST_F(ReadFileTest, RefusesMoreThanTheAllowedBytes) {
  std::ofstream(path_) << "12345";
  EXPECT_TRUE(ReadFile(path_, "rig", 5));
  const auto refused = ReadFile(path_, "rig", 4);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(refused.error().message(), HasSubstr("run.csv: the file has more than 4 bytes, too many for a rig file"));
}

TEST_F(ReadFileTest, ReportsAnUnreadableFile) {
  // Linux opens this file, but reading at offset 0 fails, even for root.
  const auto refused = ReadFile("/proc/self/mem", "CSV", 1000);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, StatusCode::kDataLoss);
  EXPECT_EQ(refused.error().message(), "/proc/self/mem: the file cannot be read; check its permissions");
}

TEST_F(ReadFileTest, ReportsAMissingFile) {
  EXPECT_EQ(ReadFile("/nowhere/run.csv", "CSV", 9).error().message(),
            "/nowhere/run.csv: there is no such file; check the path");
  EXPECT_EQ(ReadFile("/nowhere/run.csv", "CSV", 9).error().code, StatusCode::kNotFound);
  EXPECT_THAT(ReadFile(folder_, "CSV", 9).error().message(), HasSubstr("this is a directory; name a CSV file in it"));
  EXPECT_EQ(ReadFile(folder_, "CSV", 9).error().code, StatusCode::kDataLoss);
}

}  // namespace
}  // namespace pendulum::file_test
