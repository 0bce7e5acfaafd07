// SPDX-License-Identifier: Apache-2.0
#include "service/guide_files.h"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/batch/small_batch.h"

namespace pendulum::guide_files_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// A guide with a page, a style sheet, a picture and a file without an ending, and secret files outside its folder.
class ReadGuideFileTest : public testing::Test {
 protected:
  ReadGuideFileTest() {
    folder_.Write("html/index.html", "<p>Guide</p>");
    folder_.Write("html/style.css", "p {}");
    folder_.Write("html/pictures/report.png", "\x89PNG");
    folder_.Write("html/notes", "no ending");
    folder_.Write("html-private/secret.html", "secret");
    folder_.Write("secret.html", "secret");
  }

  std::string Guide() const { return (folder_ / "html").string(); }

  /// The type and the bytes of a file, or the sentence of the error.
  std::string Answer(const std::string& path) const {
    const auto file = ReadGuideFile(Guide(), path);
    if (file) return std::string(file->type) + ": " + file->bytes;
    EXPECT_EQ(file.error().code, StatusCode::kNotFound);
    return file.error().message();
  }

  const small_batch::Folder folder_{"guide_files"};
};

TEST_F(ReadGuideFileTest, GivesFilesWithTheTypeOfTheirEnding) {
  EXPECT_EQ(Answer("index.html"), "text/html; charset=utf-8: <p>Guide</p>");
  EXPECT_EQ(Answer("style.css"), "text/css; charset=utf-8: p {}");
  EXPECT_EQ(Answer("pictures/report.png"), "image/png: \x89PNG");
  EXPECT_EQ(Answer("notes"), "application/octet-stream: no ending");
}

TEST_F(ReadGuideFileTest, NamesAFileThatDoesNotExist) {
  EXPECT_EQ(Answer("none.html"), "the user guide has no file 'none.html'; /docs/index.html lists its pages");
  for (const char* path : {"", ".", "pictures", "index.html/", "index.html/x"}) {
    EXPECT_THAT(Answer(path), StartsWith("the user guide has no file")) << path;
  }
}

TEST_F(ReadGuideFileTest, DoesNotLeaveItsFolder) {
  std::filesystem::create_symlink(folder_ / "secret.html", folder_ / "html/link.html");
  std::filesystem::create_directory_symlink(folder_.path(), folder_ / "html/up");
  for (const std::string& path :
       {std::string("../secret.html"), std::string("../html-private/secret.html"),
        std::string("pictures/../../secret.html"), std::string("link.html"), std::string("up/secret.html"),
        (folder_ / "secret.html").string(), std::string("/etc/passwd")}) {
    EXPECT_THAT(Answer(path), StartsWith("the user guide has no file")) << path;
  }
}

TEST_F(ReadGuideFileTest, FollowsALinkThatStaysInside) {
  std::filesystem::create_symlink("index.html", folder_ / "html/home.html");
  EXPECT_EQ(Answer("home.html"), "text/html; charset=utf-8: <p>Guide</p>");
}

TEST_F(ReadGuideFileTest, ExplainsHowToInstallAMissingGuide) {
  for (const std::string& folder : {std::string(), (folder_ / "none").string()}) {
    const auto file = ReadGuideFile(folder, "index.html");
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().code, StatusCode::kNotFound);
    EXPECT_THAT(file.error().message(), StartsWith("the user guide is not installed"));
    EXPECT_THAT(file.error().message(), HasSubstr("--docs"));
  }
}

}  // namespace
}  // namespace pendulum::guide_files_test
