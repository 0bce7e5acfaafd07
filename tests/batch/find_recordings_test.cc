// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/find_recordings.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <vector>

#include <glob.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "pendulum/recording/readers/file_names.h"

namespace pendulum::find_recordings_test {
namespace {

namespace fs = std::filesystem;

using testing::Contains;
using testing::ElementsAre;
using testing::ElementsAreArray;

/// A folder with subfolders; expected names are relative to it.
class FindRecordingsTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  void Make(std::initializer_list<const char*> names) const {
    for (const fs::path name : names) {
      fs::create_directories(folder_ / name.parent_path());
      std::ofstream(folder_ / name) << "x";
    }
  }

  /// The paths that a pattern finds in the folder, relative to it.
  std::vector<std::string> Find(const std::string& pattern) const {
    auto found = FindRecordings((folder_ / pattern).string());
    EXPECT_TRUE(found) << found.error().message();
    if (!found) return {};
    for (std::string& path : found->paths) {
      EXPECT_TRUE(path.starts_with(folder_.string() + "/")) << path;
      path.erase(0, folder_.string().size() + 1);
    }
    return found->paths;
  }

  void Write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }

  Status FaultOf(const std::string& pattern) const {
    const auto found = FindRecordings((folder_ / pattern).string());
    EXPECT_FALSE(found);
    return found ? Status{StatusCode::kInternal, ""} : found.error();
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("find_recordings_test_" + std::to_string(getpid()));
};

TEST_F(FindRecordingsTest, LeavesOutManifestsAndExportsInAFolder) {
  Write("run.csv", "time_s,angle_deg\n0,1\n");
  Write("runs.csv", "id;path;rig\r\n1;run.csv;\r\n");
  Write("paths.txt", "path\nrun.csv\n");
  Write("results.csv", "id,path,rig,calibration,model\n");
  const auto found = FindRecordings(folder_.string());
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_THAT(found->paths, ElementsAre((folder_ / "run.csv").string()));
  EXPECT_EQ(found->lists.size(), 3U);
  EXPECT_TRUE(found->left_out.empty());
  EXPECT_EQ(Find("*.csv").size(), 3U);  // a pattern says what is wanted
}

TEST_F(FindRecordingsTest, FindsCsvFilesInSubfoldersInOrder) {
  Make({"b.csv", "a/2.csv", "a/10.csv", "a/deep/er/x.csv", "B.csv", "c.json", "d.CSV", "e.csv.bak", "csv"});
  EXPECT_THAT(Find(""), ElementsAre("B.csv", "a/10.csv", "a/2.csv", "a/deep/er/x.csv", "b.csv", "d.CSV"));
}

TEST_F(FindRecordingsTest, IncludesPackedRecordingsAndMatFiles) {
  Make({"b.mat", "a/phone.zip", "a/R.MAT", "c.ZIP", "c.json", "zip", "x.mat.bak"});
  EXPECT_THAT(Find(""), ElementsAre("a/R.MAT", "a/phone.zip", "b.mat", "c.ZIP"));
}

TEST_F(FindRecordingsTest, IncludesWorkbooksButNotTheirLocks) {
  Make({"a.xlsx", "b.XLS", "c.ods", "d.npz", "~$a.xlsx", ".~lock.c.ods#", "e.json", "f.xlsm.bak"});
  EXPECT_THAT(Find(""), ElementsAre("a.xlsx", "b.XLS", "c.ods", "d.npz"));
}

// The endings are those of the page will_it_read_my_file; each format has a test of its reader.
TEST_F(FindRecordingsTest, FindsWhatFitPendulumReadsAndListsTheRest) {
  Make({"a.txt", "b.tsv", "c.DAT", "d.log", "e.lvm", "f.mot", "g.npy", "h.phyphox", "i.fods", "rig.json", "x/y.png",
        "none", "~$a.xlsx"});
  EXPECT_THAT(Find(""),
              ElementsAre("a.txt", "b.tsv", "c.DAT", "d.log", "e.lvm", "f.mot", "g.npy", "h.phyphox", "i.fods"));
  EXPECT_THAT(FindRecordings(folder_.string()).value().left_out,
              ElementsAre(folder_ / "none", folder_ / "rig.json", folder_ / "x/y.png"));
  EXPECT_THAT(FindRecordings((folder_ / "*.json").string()).value().left_out, ElementsAre());
}

TEST_F(FindRecordingsTest, IgnoresATrailingSlash) {
  Make({"a.csv", "b/c.csv"});
  EXPECT_EQ(FindRecordings(folder_.string()).value().paths, FindRecordings(folder_.string() + "/").value().paths);
}

TEST_F(FindRecordingsTest, ReturnsPathsWithTheFolderAsGiven) {
  EXPECT_THAT(FindRecordings("datasets/runs_?.csv").value().paths,
              ElementsAre("datasets/runs_1.csv", "datasets/runs_2.csv", "datasets/runs_3.csv", "datasets/runs_4.csv"));
  EXPECT_THAT(FindRecordings("datasets").value().paths, Contains("datasets/coulomb.csv"));
}

// glob(3) has the same patterns except **.
TEST_F(FindRecordingsTest, AgreesWithGlobOnPatterns) {
  Make({"a1.csv", "a2.csv", "b1.csv", "a[1].csv", "a-.csv", ".hidden.csv", "x/a1.csv", "y/a1.csv", "y/.a1.csv",
        ".z/a1.csv", "x/y/a1.csv", "a1.txt", "ä1.csv", "a.csv"});
  for (const std::string pattern : {"*", "*.csv", "a?.csv", "[ab]1.csv", "a[!1].csv", "[a-]*", "a\\[1].csv", ".*.csv",
                                    "*/a1.csv", "?/*", "*/*/*", ".z/*.csv", "*/.a*", "a1.[ct]*"}) {
    std::vector<std::string> expected;
    glob_t paths{};
    ASSERT_EQ(::glob((folder_ / pattern).c_str(), 0, nullptr, &paths), 0) << pattern;
    for (std::size_t i = 0; i < paths.gl_pathc; ++i) {
      const std::string path = paths.gl_pathv[i];
      if (fs::is_regular_file(path)) expected.push_back(path.substr(folder_.string().size() + 1));
    }
    ::globfree(&paths);
    std::ranges::sort(expected);  // glob sorts by the locale
    EXPECT_THAT(Find(pattern), ElementsAreArray(expected)) << pattern;
  }
}

TEST_F(FindRecordingsTest, MatchesAnyNumberOfFoldersWithTwoAsterisks) {
  Make({"p1.csv", "a/p1.csv", "a/p2.csv", "a/b/p1.csv", "a/b/c/p1.csv", "d/p1.csv", "a/b/q.txt"});
  EXPECT_THAT(Find("**/p1.csv"), ElementsAre("a/b/c/p1.csv", "a/b/p1.csv", "a/p1.csv", "d/p1.csv", "p1.csv"));
  EXPECT_THAT(Find("a/**/p?.csv"), ElementsAre("a/b/c/p1.csv", "a/b/p1.csv", "a/p1.csv", "a/p2.csv"));
  EXPECT_THAT(Find("**/b/*.csv"), ElementsAre("a/b/p1.csv"));
  EXPECT_THAT(Find("**/b/**/p1.csv"), ElementsAre("a/b/c/p1.csv", "a/b/p1.csv"));
  EXPECT_THAT(Find("**/**/p2.csv"), ElementsAre("a/p2.csv"));  // only once
  EXPECT_THAT(Find("a/b/**"), ElementsAre("a/b/c/p1.csv", "a/b/p1.csv", "a/b/q.txt"));
}

TEST_F(FindRecordingsTest, DistinguishesUpperAndLowerCaseInPatterns) {
  Make({"A.CSV", "c.csv"});
  EXPECT_THAT(Find("*.csv"), ElementsAre("c.csv"));
}

TEST_F(FindRecordingsTest, SkipsHiddenFilesAndFolders) {
  Make({"a.csv", ".b.csv", ".c/d.csv", "e/.f.csv", "e/.g/h.csv"});
  EXPECT_EQ(FindRecordings(folder_.string()).value().paths.size(), 1);
  EXPECT_THAT(Find("**/*"), ElementsAre("a.csv"));
  EXPECT_THAT(Find(".c"), ElementsAre(".c/d.csv"));  // a named hidden folder
  EXPECT_THAT(Find("**/.g/*.csv"), ElementsAre("e/.g/h.csv"));
}

TEST_F(FindRecordingsTest, AcceptsNamesOfAnyBytes) {
  Make({"a b.csv", " .csv", "new\nline.csv", "quote\".csv", "\xFF.csv", "π/振.csv"});
  EXPECT_THAT(FindRecordings(folder_.string()).value().paths.size(), 6);
  EXPECT_THAT(Find("new*line.csv"), ElementsAre("new\nline.csv"));
  EXPECT_THAT(Find("* *"), ElementsAre(" .csv", "a b.csv"));
}

TEST_F(FindRecordingsTest, AcceptsAFileWhosePathLooksLikeAPattern) {
  Make({"run[1].csv", "run1.csv"});
  EXPECT_THAT(Find("run[1].csv"), ElementsAre("run[1].csv"));
  fs::remove(folder_ / "run[1].csv");
  EXPECT_THAT(Find("run[1].csv"), ElementsAre("run1.csv"));
}

TEST_F(FindRecordingsTest, AcceptsAFileWithAnyName) {
  Make({"serial.txt"});
  EXPECT_THAT(Find("serial.txt"), ElementsAre("serial.txt"));
}

TEST_F(FindRecordingsTest, FollowsLinksToFilesButNotToFolders) {
  Make({"a/x.csv", "elsewhere/y.csv"});
  fs::create_symlink("../elsewhere/y.csv", folder_ / "a" / "file.csv");
  fs::create_directory_symlink("../elsewhere", folder_ / "a" / "folder");
  fs::create_directory_symlink("..", folder_ / "a" / "loop");
  EXPECT_THAT(Find("a"), ElementsAre("a/file.csv", "a/x.csv"));
  EXPECT_THAT(Find("a/**/*.csv"), ElementsAre("a/file.csv", "a/x.csv"));
  EXPECT_EQ(FaultOf("a/*/y.csv").code, StatusCode::kNotFound);
}

TEST_F(FindRecordingsTest, FollowsANamedLinkToAFolder) {
  Make({"elsewhere/y.csv", "elsewhere/deep/z.csv"});
  fs::create_directory_symlink("elsewhere", folder_ / "link");
  EXPECT_THAT(Find("link"), ElementsAre("link/deep/z.csv", "link/y.csv"));
  EXPECT_THAT(Find("link/*.csv"), ElementsAre("link/y.csv"));
}

TEST_F(FindRecordingsTest, ReportsPathsAndPatternsThatAreNotFound) {
  Make({"a/b.json"});
  const std::string folder = folder_.string();
  EXPECT_EQ(FaultOf("none.csv").code, StatusCode::kNotFound);
  EXPECT_EQ(FaultOf("none.csv").message(), folder + "/none.csv: there is no such file or folder; check the path");
  EXPECT_EQ(FaultOf("a").code, StatusCode::kNotFound);
  EXPECT_EQ(FaultOf("a").message(),
            folder + "/a: there is no " + RecordingNames() + " file in this folder or below it; check the path");
  EXPECT_EQ(FaultOf("*/*.csv").code, StatusCode::kNotFound);
  EXPECT_EQ(FaultOf("*/*.csv").message(), folder + "/*/*.csv: no file matches this pattern; check the path");
  EXPECT_EQ(FaultOf("none/**/x").message(), folder + "/none/**/x: no file matches this pattern; check the path");
}

TEST_F(FindRecordingsTest, RefusesAnUnreadableFolder) {
  Make({"a/x.csv", "locked/y.csv", "z.csv"});
  fs::permissions(folder_, fs::perms::all);
  fs::permissions(folder_ / "locked", fs::perms::none);
  const uid_t self = ::geteuid();
  constexpr uid_t kNobody = 65534;  // root can read every folder
  if (self == 0) {
    ASSERT_EQ(::seteuid(kNobody), 0);
  }
  for (const char* pattern : {"locked", "", "*/*.csv", "**/*.csv"}) {
    EXPECT_EQ(FaultOf(pattern).code, StatusCode::kDataLoss) << pattern;
    EXPECT_EQ(
        FaultOf(pattern).message(),
        (folder_ / "locked").string() + ": this folder cannot be read; check its permissions, or name another folder");
  }
  EXPECT_THAT(Find("a/*.csv"), ElementsAre("a/x.csv"));
  if (self == 0) {
    ASSERT_EQ(::seteuid(self), 0);
  }
  fs::permissions(folder_ / "locked", fs::perms::owner_all);
}

}  // namespace
}  // namespace pendulum::find_recordings_test
