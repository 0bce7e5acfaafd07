// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/tools/temporary_folder.h"
#include "tools/output.h"

namespace pendulum::part_file_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

TEST(PartFile, IsNextToTheRecording) {
  const TemporaryFolder folder;
  EXPECT_EQ(PartFile(folder.Path("run.csv")).path(), folder.Path("run.csv") + ".part");
  folder.Create("run.csv", "an older one");
  EXPECT_EQ(PartFile(folder.Path("run.csv")).path(), folder.Path("run.csv") + ".part");
}

TEST(PartFile, CanBeReadWhileItGrows) {
  const TemporaryFolder folder;
  PartFile part(folder.Path("run.csv"));
  ASSERT_TRUE(part.Open());
  EXPECT_EQ(folder.Text("run.csv.part"), "");
  ASSERT_TRUE(part.Append("time_s,adc_counts\n"));
  EXPECT_EQ(folder.Text("run.csv.part"), "time_s,adc_counts\n");
  ASSERT_TRUE(part.Append("0,500\n"));
  ASSERT_TRUE(part.Synchronise());
  EXPECT_EQ(folder.Text("run.csv.part"), "time_s,adc_counts\n0,500\n");
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("run.csv.part"));
}

TEST(PartFile, RemainsUnlessRemoved) {
  const TemporaryFolder folder;
  {
    PartFile part(folder.Path("run.csv"));
    ASSERT_TRUE(part.Open());
    ASSERT_TRUE(part.Append("0,500\n"));
  }
  EXPECT_EQ(folder.Text("run.csv.part"), "0,500\n");
  PartFile(folder.Path("run.csv")).Remove();
  EXPECT_THAT(folder.Names(), IsEmpty());
}

TEST(PartFile, CanBeRemovedWhileOpen) {
  const TemporaryFolder folder;
  folder.Create("run.csv", "whole");
  PartFile part(folder.Path("run.csv"));
  ASSERT_TRUE(part.Open());
  part.Remove();
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("run.csv"));
  EXPECT_TRUE(part.Append("nowhere"));
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("run.csv"));
}

TEST(PartFile, DetectsTheFileOfAnEarlierRecording) {
  const TemporaryFolder folder;
  PartFile part(folder.Path("run.csv"));
  EXPECT_FALSE(part.Exists());
  folder.Create("run.csv", "");
  EXPECT_FALSE(part.Exists());
  folder.Create("run.csv.part", "old, and longer than what comes now");
  EXPECT_TRUE(part.Exists());
  ASSERT_TRUE(part.Open());
  ASSERT_TRUE(part.Append("new"));
  EXPECT_EQ(folder.Text("run.csv.part"), "new");
}

// A stream has no file next to it.
TEST(PartFile, IsNotUsedForAStream) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo(folder.Path("pipe").c_str(), 0600), 0);
  for (const std::string& path : {std::string("-"), std::string("/dev/null"), folder.Path("pipe"), folder.Path("")}) {
    PartFile part(path);
    EXPECT_EQ(part.path(), "") << path;
    EXPECT_FALSE(part.Exists());
    EXPECT_TRUE(part.Open());
    EXPECT_TRUE(part.Append("text"));
    EXPECT_TRUE(part.Synchronise());
    part.Remove();
  }
  EXPECT_FALSE(std::filesystem::exists("-.part"));
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("pipe"));
}

TEST(PartFile, ReportsAFailureToOpen) {
  const TemporaryFolder folder;
  PartFile part(folder.Path("nowhere/run.csv"));
  const auto opened = part.Open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, StatusCode::kCannotWrite);
  EXPECT_THAT(opened.error().message(), AllOf(HasSubstr("nowhere/run.csv.part"), HasSubstr("No such file")));
}

TEST(PartFile, ReportsAFullDisk) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/full", folder.Path("run.csv.part"));
  PartFile part(folder.Path("run.csv"));
  ASSERT_TRUE(part.Open());
  const auto appended = part.Append("0,500\n");
  ASSERT_FALSE(appended);
  EXPECT_EQ(appended.error().code, StatusCode::kCannotWrite);
  EXPECT_THAT(appended.error().message(), AllOf(HasSubstr("run.csv.part"), HasSubstr("No space left")));
}

}  // namespace
}  // namespace pendulum::part_file_test
