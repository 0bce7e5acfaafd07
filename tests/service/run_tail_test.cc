// SPDX-License-Identifier: Apache-2.0
#include "service/run_tail.h"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pendulum::run_tail_test {
namespace {

namespace fs = std::filesystem;

class RunTailTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  void Write(const std::string& text) const { std::ofstream(part_, std::ios::binary | std::ios::trunc) << text; }
  void Append(const std::string& text) const { std::ofstream(part_, std::ios::binary | std::ios::app) << text; }

  /// The lines of one look, after "new: " if they come from another file.
  std::string Look() {
    const RunTail::News news = tail_.Look();
    EXPECT_FALSE(news.has_more);
    return (news.is_another ? "new: " : "") + news.lines;
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("run_tail_test_" + std::to_string(getpid()));
  const fs::path run_ = folder_ / "run.csv", part_ = folder_ / "run.csv.part";
  RunTail tail_{run_};
};

TEST_F(RunTailTest, GivesEachCompleteLineOnce) {
  EXPECT_EQ(Look(), "");
  Write("");
  EXPECT_EQ(Look(), "");
  Append("a\nb");
  EXPECT_EQ(Look(), "a\n");
  EXPECT_EQ(Look(), "");
  Append("c");
  EXPECT_EQ(Look(), "");
  Append("\n\nd\n");
  EXPECT_EQ(Look(), "bc\n\nd\n");
}

TEST_F(RunTailTest, ReportsAnotherFile) {
  Write("first\n");
  EXPECT_EQ(Look(), "first\n");
  Write("2\n");  // shorter
  EXPECT_EQ(Look(), "new: 2\n");
  Write("third, longer\n");  // longer, but other bytes
  EXPECT_EQ(Look(), "new: third, longer\n");
  std::ofstream(folder_ / "other") << "third, longer\nand more\n";  // the same beginning, but another file
  fs::rename(folder_ / "other", part_);
  EXPECT_EQ(Look(), "new: third, longer\nand more\n");
  fs::rename(part_, run_);  // the same file under the other name
  EXPECT_EQ(Look(), "");
  fs::remove(run_);
  EXPECT_EQ(Look(), "new: ");
  EXPECT_EQ(Look(), "");
}

TEST_F(RunTailTest, ForgetsAnUnfinishedLineOfARemovedFile) {
  Write("a\nunfinished");
  EXPECT_EQ(Look(), "a\n");
  Write("b\n");
  EXPECT_EQ(Look(), "new: b\n");
}

TEST_F(RunTailTest, PrefersThePartFile) {
  std::ofstream(run_) << "whole\n";
  EXPECT_EQ(Look(), "whole\n");
  EXPECT_FALSE(tail_.is_growing());
  Write("part\n");
  EXPECT_EQ(Look(), "new: part\n");
  EXPECT_TRUE(tail_.is_growing());
  fs::remove(part_);
  EXPECT_EQ(Look(), "new: whole\n");
}

TEST_F(RunTailTest, OpensRegularFilesOnly) {
  fs::create_directory(part_);
  EXPECT_EQ(Look(), "");
  EXPECT_LT(OpenRegularFile(part_), 0);
  fs::remove(part_);
  ASSERT_EQ(::mkfifo(part_.c_str(), 0600), 0);  // opening it would block, because the other end is not open
  EXPECT_EQ(Look(), "");
  EXPECT_LT(OpenRegularFile(part_), 0);
  EXPECT_LT(OpenRegularFile(folder_ / "absent"), 0);
}

TEST_F(RunTailTest, SkipsALineThatIsTooLong) {
  Write("a\n");
  EXPECT_EQ(Look(), "a\n");
  for (int i = 0; i < 20; ++i) {
    Append(std::string(100'000, '7'));
    EXPECT_EQ(Look(), "");
  }
  Append("\nb\n");
  EXPECT_EQ(Look(), "b\n");
}

TEST_F(RunTailTest, ReadsALongFileInSeveralSteps) {
  std::string text;
  while (text.size() < (std::size_t{9} << 20)) text += "line " + std::to_string(text.size()) + "\n";
  Write(text);
  std::string read;
  int looks = 0;
  for (bool has_more = true; has_more; ++looks) {
    const RunTail::News news = tail_.Look();
    EXPECT_LE(news.lines.size(), std::size_t{5} << 20);
    EXPECT_FALSE(news.is_another);
    read += news.lines;
    has_more = news.has_more;
  }
  EXPECT_TRUE(read == text);
  EXPECT_GE(looks, 2);
}

}  // namespace
}  // namespace pendulum::run_tail_test
