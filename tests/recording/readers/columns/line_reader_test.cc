// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/readers/columns/line_reader.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pendulum::line_reader_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

class LineReaderTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  LineReader OpenFile(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return LineReader(InputFile::Open(path_, "CSV").value());
  }

  const std::filesystem::path path_ =
      std::filesystem::path(testing::TempDir()) / ("line_reader_test_" + std::to_string(getpid()));
};

std::vector<std::string> LinesOf(LineReader reader) {
  std::vector<std::string> lines;
  while (true) {
    const Result<bool> next = reader.Next();
    EXPECT_TRUE(next.has_value()) << (next ? "" : next.error().message());
    if (!next || !*next) return lines;
    lines.emplace_back(reader.line());
    EXPECT_EQ(reader.number(), lines.size());
  }
}

std::string FaultOf(LineReader reader) {
  while (true) {
    const Result<bool> next = reader.Next();
    if (!next) return next.error().message();
    if (!*next) return "no fault";
  }
}

TEST_F(LineReaderTest, GivesLinesWithoutLineEnds) {
  EXPECT_THAT(LinesOf(LineReader("a\n\r\nb\r\n c", "x")), ElementsAre("a", "", "b", " c"));
  EXPECT_THAT(LinesOf(LineReader("\xEF\xBB\xBF"
                                 "a\n",
                                 "x")),
              ElementsAre("a"));
  EXPECT_THAT(LinesOf(LineReader("", "x")), IsEmpty());
}

TEST_F(LineReaderTest, ReportsWhetherTheLastLineIsTerminated) {
  LineReader reader("a\nb", "x");
  EXPECT_TRUE(reader.Next().value());
  EXPECT_TRUE(reader.is_terminated());
  EXPECT_TRUE(reader.Next().value());
  EXPECT_FALSE(reader.is_terminated());
  EXPECT_FALSE(reader.Next().value());
  EXPECT_FALSE(reader.is_empty());
}

/// Lines of various lengths around the end of a block, which is slightly longer than the longest line.
TEST_F(LineReaderTest, GivesTheSameLinesOfAFileInBlocks) {
  for (const std::size_t first : {LineReader::kLongestLine - 2, LineReader::kLongestLine}) {
    std::string text = std::string(first, 'a') + "\n";
    for (int i = 0; i < 200000; ++i) text += std::to_string(i * 37) + "\n";
    EXPECT_EQ(LinesOf(OpenFile(text)), LinesOf(LineReader(text, "x")));
  }
}

TEST_F(LineReaderTest, HashesEveryByte) {
  // FIPS 180-2, appendices B.1 and B.3: "abc" and a million letters a.
  LineReader abc("abc", "x");
  while (abc.Next().value()) continue;
  EXPECT_EQ(abc.Sha256(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  LineReader million = OpenFile(std::string(1000000, 'a'));
  while (million.Next().value()) continue;
  EXPECT_EQ(million.Sha256(), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_F(LineReaderTest, RefusesALineLongerThanAMebibyte) {
  const std::string longest(LineReader::kLongestLine, 'a');
  EXPECT_EQ(LinesOf(LineReader("b\n" + longest, "x")).size(), 2);
  EXPECT_EQ(LinesOf(OpenFile("b\n" + longest + "\n")).size(), 2);
  const std::string message = ":2:1: this line is longer than 1 MiB and begins with \"" + std::string(40, 'a') +
                              "...\", so this is not CSV text; name a CSV file";
  for (const char* const end : {"", "\n", "\nb\n"}) {
    EXPECT_EQ(FaultOf(LineReader("b\n" + longest + "a" + end, "x")), "x" + message);
    EXPECT_EQ(FaultOf(OpenFile("b\n" + longest + "a" + end)), path_.string() + message);
  }
}

TEST_F(LineReaderTest, RefusesANulByteAtItsPosition) {
  EXPECT_EQ(FaultOf(LineReader(std::string_view("a\nbc\0d", 6), "x")),
            "x:2:3: there is a NUL byte, so this is not CSV text; delete the damaged part, or save UTF-16 as UTF-8");
  std::string text;
  for (int i = 0; i < 300000; ++i) text += "12345\n";
  EXPECT_THAT(FaultOf(OpenFile(text + std::string("ab\0", 3))), StartsWith(path_.string() + ":300001:3: "));
}

TEST_F(LineReaderTest, ReadsASlowPipe) {
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  std::thread writer([&] {
    std::ofstream pipe(path_, std::ios::binary);
    for (const char* const part : {"a", "b\nc", "\n", "d"}) {
      pipe << part << std::flush;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  EXPECT_THAT(LinesOf(LineReader(InputFile::Open(path_, "CSV").value())), ElementsAre("ab", "c", "d"));
  writer.join();
}

}  // namespace
}  // namespace pendulum::line_reader_test
