// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/readers/data_list.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace pendulum::data_list_test {
namespace {

namespace fs = std::filesystem;

class ReadDataListTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "runs");
    std::ofstream(folder_ / "a.csv");
    std::ofstream(folder_ / "runs" / "b c.csv");
  }
  void TearDown() override { fs::remove_all(folder_); }

  Result<std::vector<ListedFile>> Read(const std::string& text) {
    std::ofstream(list_, std::ios::binary) << text;
    return ReadDataList(list_);
  }

  Status FaultOf(const std::string& text) {
    const auto files = Read(text);
    EXPECT_FALSE(files.has_value());
    return files ? Status{StatusCode::kInternal, ""} : files.error();
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("data_list_test_" + std::to_string(getpid()));
  const fs::path list_ = folder_ / "list.txt";
};

TEST_F(ReadDataListTest, ResolvesPathsAgainstTheListsFolder) {
  const auto files = Read("# runs\r\n\n  a.csv \r\nruns/b c.csv\n" + (folder_ / "runs" / ".." / "list.txt").string());
  ASSERT_TRUE(files.has_value()) << files.error().message();
  ASSERT_EQ(files->size(), 3);
  EXPECT_EQ((*files)[0].path, folder_ / "a.csv");
  EXPECT_EQ((*files)[0].place, list_.string() + ":3");
  EXPECT_EQ((*files)[1].path, folder_ / "runs" / "b c.csv");
  EXPECT_EQ((*files)[2].path, folder_ / "runs" / ".." / "list.txt");
}

TEST_F(ReadDataListTest, NamesTheLineOfAMissingFile) {
  const Status fault = FaultOf("a.csv\nnowhere.csv\n");
  EXPECT_EQ(fault.code, StatusCode::kNotFound);
  EXPECT_EQ(fault.message(), list_.string() + ":2: there is no file " + (folder_ / "nowhere.csv").string() +
                                 "; paths are relative to the folder of the list");
}

TEST_F(ReadDataListTest, RefusesDirectoriesAndRepeatedFiles) {
  EXPECT_EQ(FaultOf("runs\n").code, StatusCode::kDataLoss);
  EXPECT_EQ(FaultOf("runs\n").message(),
            list_.string() + ":1: " + (folder_ / "runs").string() + " is a directory; name a CSV file in it");
  EXPECT_EQ(FaultOf("a.csv\n\nruns/../a.csv\n").message(),
            list_.string() + ":3: " + (folder_ / "runs" / ".." / "a.csv").string() + " is also at " + list_.string() +
                ":1; keep one of them");
}

TEST_F(ReadDataListTest, RefusesAnEmptyList) {
  EXPECT_EQ(FaultOf("# none\n").code, StatusCode::kFailedPrecondition);
  EXPECT_EQ(FaultOf("# none\n").message(), list_.string() + ": the list names no file; give one path per line");
}

TEST_F(ReadDataListTest, RefusesAFileThatIsNotAList) {
  EXPECT_EQ(FaultOf(std::string("a\0b", 3)).code, StatusCode::kDataLoss);
  EXPECT_EQ(ReadDataList(folder_ / "none.txt").error().code, StatusCode::kNotFound);
  EXPECT_EQ(ReadDataList(folder_).error().message(),
            folder_.string() + ": this is a directory; name a list file in it");
}

}  // namespace
}  // namespace pendulum::data_list_test
