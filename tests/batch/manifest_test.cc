// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/manifest.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace pendulum::manifest_test {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Optional;
using testing::StartsWith;

class ReadManifestTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  Result<std::vector<ManifestEntry>> Read(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    std::vector<ManifestEntry> entries;
    const auto read = ReadManifest(path_, [&](const ManifestEntry& entry) -> Result<void> {
      entries.push_back(entry);
      return {};
    });
    if (!read) return tl::unexpected(read.error());
    return entries;
  }

  /// The entries of a valid manifest.
  std::vector<ManifestEntry> Entries(const std::string& text) const {
    auto entries = Read(text);
    EXPECT_TRUE(entries) << text.substr(0, 1000) << entries.error().message();
    return entries ? *entries : std::vector<ManifestEntry>();
  }

  /// The value of a field that is in column x next to a path.
  std::string FieldOf(const std::string& field) const {
    const auto entries = Entries("path,x\r\na.csv," + field + "\r\n");
    return entries.size() == 1 ? Json::parse(entries[0].columns)["x"].get<std::string>() : "no single entry";
  }

  /// The error message for a refused text, without the manifest's path.
  std::string FaultOf(const std::string& text) const {
    const auto entries = Read(text);
    if (entries) return "not refused";
    EXPECT_EQ(entries.error().code, StatusCode::kDataLoss);
    EXPECT_THAT(entries.error().message(), StartsWith(path_.string() + ":"));
    return entries.error().message().substr(path_.string().size());
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("manifest_test_" + std::to_string(getpid()));
  const fs::path path_ = folder_ / "runs.csv";
};

std::vector<std::string> PathsOf(const std::vector<ManifestEntry>& entries) {
  std::vector<std::string> paths;
  for (const ManifestEntry& entry : entries) paths.push_back(entry.path);
  return paths;
}

/// Lines with at least `bytes` bytes in total.
std::string Lines(std::size_t bytes) {
  std::string text;
  while (text.size() < bytes) text += std::string(1000, 'x') + "\n";
  return text;
}

// ---- Valid manifests -----------------------------------------------------------------------------------------------

TEST_F(ReadManifestTest, IdentifiesColumnsByName) {
  const auto entries = Entries(
      "to_s,id,models,path,calibration,rig,from_s\n"
      "1e1,first,\"viscous,coulomb\",runs/a.csv,cal.json,rig.json,-0.5\n"
      ",,,b.csv,,,\n");
  ASSERT_EQ(entries.size(), 2);
  EXPECT_EQ(entries[0].position, 0);
  EXPECT_EQ(entries[0].id, "first");
  EXPECT_EQ(entries[0].path, "runs/a.csv");
  EXPECT_EQ(entries[0].rig, "rig.json");
  EXPECT_EQ(entries[0].calibration, "cal.json");
  EXPECT_THAT(entries[0].from, Optional(-0.5));
  EXPECT_THAT(entries[0].to, Optional(10.0));
  EXPECT_EQ(entries[0].models, "viscous,coulomb");
  EXPECT_EQ(entries[0].columns, "{}");
  EXPECT_EQ(entries[1].position, 1);
  EXPECT_EQ(entries[1].id, "b.csv");  // the default id is the path
  EXPECT_EQ(entries[1].rig + entries[1].calibration + entries[1].models, "");
  EXPECT_FALSE(entries[1].from || entries[1].to);
}

TEST_F(ReadManifestTest, PassesOtherColumnsInOrder) {
  const auto entries = Entries("rig_no,path,Datum,\n007,a.csv,\"1. März, früh\",\n,b.csv,\xFF,x\n");
  ASSERT_EQ(entries.size(), 2);
  EXPECT_EQ(entries[0].columns, R"({"rig_no":"007","Datum":"1. März, früh","":""})");
  // Invalid UTF-8 becomes U+FFFD (Unicode 15, section 3.9), because JSON is UTF-8.
  EXPECT_EQ(entries[1].columns, "{\"rig_no\":\"\",\"Datum\":\"\xEF\xBF\xBD\",\"\":\"x\"}");
}

// RFC 4180, section 2, rules 5 to 7.
TEST_F(ReadManifestTest, ReadsQuotedFields) {
  EXPECT_EQ(FieldOf(R"("bbb")"), "bbb");
  EXPECT_EQ(FieldOf(R"("b""bb")"), "b\"bb");
  EXPECT_EQ(FieldOf(R"("b,bb")"), "b,bb");
  EXPECT_EQ(FieldOf("\"b\nbb\""), "b\nbb");
  EXPECT_EQ(FieldOf(R"("")"), "");
  EXPECT_EQ(FieldOf(R"("""")"), "\"");
  EXPECT_EQ(FieldOf("\"\n\n,\"\"\n\""), "\n\n,\"\n");
}

TEST_F(ReadManifestTest, KeepsBlanksOnlyInQuotes) {
  EXPECT_EQ(FieldOf(R"("  b ")"), "  b ");
  EXPECT_EQ(FieldOf("  b b "), "b b");
}

TEST_F(ReadManifestTest, ReadsPathsInAnyScript) {
  EXPECT_THAT(PathsOf(Entries("path\nVersuche/Öl π 振り子.csv\n\"a, b.csv\"\n")),
              ElementsAre("Versuche/Öl π 振り子.csv", "a, b.csv"));
}

TEST_F(ReadManifestTest, ReadsSemicolonsAndTabsToo) {
  for (const std::string separator : {",", ";", "\t"}) {
    const auto entries = Entries("\"a,;\tb\"" + separator + "path\n1" + separator + "\"x,;\ty\"\n");
    ASSERT_EQ(entries.size(), 1) << separator;
    EXPECT_EQ(entries[0].path, "x,;\ty") << separator;
    EXPECT_EQ(Json::parse(entries[0].columns)["a,;\tb"], "1") << separator;
  }
  EXPECT_EQ(Entries("path;x\na,b.csv;1,5\n")[0].path, "a,b.csv");
}

TEST_F(ReadManifestTest, ReadsManifestsWrittenBySpreadsheets) {
  const auto entries = Entries("\xEF\xBB\xBFpath,id\r\na.csv,1\r\nb.csv,2");  // no line end after the last row: rule 2
  ASSERT_EQ(entries.size(), 2);
  EXPECT_EQ(entries[0].id, "1");
  EXPECT_EQ(entries[1].id, "2");
  EXPECT_EQ(entries[1].place, path_.string() + ":3");
}

TEST_F(ReadManifestTest, SkipsBlankLines) {
  const auto entries = Entries("\n\r\npath,id\n\na.csv,1\n   \n\nb.csv,2\n\n");
  ASSERT_EQ(entries.size(), 2);
  EXPECT_EQ(entries[0].place, path_.string() + ":5");
  EXPECT_EQ(entries[1].place, path_.string() + ":8");
  EXPECT_EQ(entries[1].position, 1);
}

TEST_F(ReadManifestTest, DetectsTheSeparatorBelowBlankLines) {
  EXPECT_EQ(Entries("\n  \npath;id\na.csv;1\n")[0].id, "1");
}

TEST_F(ReadManifestTest, GivesTheFirstLineOfARow) {
  const auto entries = Entries("path,x\n\"a\n\nb.csv\",1\nc.csv,\"\n\n\"\n\nd.csv,2\n");
  ASSERT_EQ(entries.size(), 3);
  EXPECT_EQ(entries[0].path, "a\n\nb.csv");
  EXPECT_EQ(entries[0].place, path_.string() + ":2");
  EXPECT_EQ(entries[1].place, path_.string() + ":5");
  EXPECT_EQ(entries[2].place, path_.string() + ":9");
  EXPECT_THAT(FaultOf("path,x\n\"a\n\nb.csv\",1\nc.csv\n"), StartsWith(":5: the row has 1 fields"));
}

TEST_F(ReadManifestTest, HasNoEntryForAHeaderOnly) {
  EXPECT_THAT(Entries("path,id\n"), IsEmpty());
  EXPECT_THAT(Entries("path"), IsEmpty());
}

TEST_F(ReadManifestTest, ReadsARowOfManyLines) {
  const std::string field = Lines(std::size_t{1} << 19);
  EXPECT_TRUE(FieldOf("\"" + field + "\"") == field);
}

TEST_F(ReadManifestTest, SkipsAnyNumberOfBlankLines) {
  std::string blank = Lines(std::size_t{17} << 20);
  std::ranges::replace(blank, 'x', ' ');
  EXPECT_THAT(PathsOf(Entries("path\n" + blank + "a.csv\n")), ElementsAre("a.csv"));
}

TEST_F(ReadManifestTest, StopsIfTheSinkReturnsAnError) {
  std::ofstream(path_) << "path\na.csv\nb.csv\n\"never closed";
  int taken = 0;
  const auto read = ReadManifest(path_, [&](const ManifestEntry&) -> Result<void> {
    ++taken;
    return Error(StatusCode::kCannotWrite, "enough");
  });
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, StatusCode::kCannotWrite);
  EXPECT_EQ(read.error().message(), "enough");
  EXPECT_EQ(taken, 1);
}

// ---- Invalid manifests ---------------------------------------------------------------------------------------------

TEST_F(ReadManifestTest, RefusesAHeaderWithoutRecordings) {
  const std::string empty = ": the manifest is empty; its first line names the columns, such as path,id";
  EXPECT_EQ(FaultOf(""), empty);
  EXPECT_EQ(FaultOf("\xEF\xBB\xBF\r\n\n"), empty);
  EXPECT_EQ(
      FaultOf("\nid,Path\na,b\n"),
      ":2: a column has nearly the name of a column with a meaning; rename \"Path\" to path, or choose another name "
      "if it is a label");
  EXPECT_EQ(FaultOf("path,x,x\n"), ":1: the header has the column \"x\" twice; rename one of them");
  EXPECT_EQ(FaultOf("path,id,path\n"), ":1: the header has the column \"path\" twice; rename one of them");
}

TEST_F(ReadManifestTest, RefusesARowOfAnotherLength) {
  const std::string why = "; put a field that contains a separator in quotes";
  EXPECT_EQ(FaultOf("path,id\na.csv\n"), ":2: the row has 1 fields, the header 2" + why);
  EXPECT_EQ(FaultOf("path\na.csv\nb,c.csv\n"), ":3: the row has 2 fields, the header 1" + why);
}

TEST_F(ReadManifestTest, RefusesARowWithoutAPath) {
  EXPECT_EQ(FaultOf("id,path\n1,\n"), ":2: column path: it is empty; name a recording or delete the row");
  EXPECT_EQ(FaultOf("id\tpath\n\t\n"), ":2: column path: it is empty; name a recording or delete the row");
}

TEST_F(ReadManifestTest, RefusesInvalidWindows) {
  for (const std::string time : {"soon", "1 s", "1.5.2", "nan", "inf", "1e999", "0x10", "--1"}) {
    EXPECT_EQ(FaultOf("path,to_s\na.csv," + time + "\n"),
              ":2: column to_s: \"" + time + "\" is not a time in seconds on the file's clock");
  }
  EXPECT_EQ(FaultOf("path;from_s\na.csv;1,5\n"),
            ":2: column from_s: \"1,5\" is not a time in seconds on the file's clock");
  EXPECT_EQ(FaultOf("path,from_s,to_s\na.csv,2.5,1\n"), ":2: from_s 2.5 is not before to_s 1");
  EXPECT_EQ(FaultOf("path,from_s,to_s\na.csv,2,2\n"), ":2: from_s 2 is not before to_s 2");
}

TEST_F(ReadManifestTest, RefusesNearlyTheNameOfAColumn) {
  EXPECT_EQ(
      FaultOf("path,Rig\na.csv,rig.json\n"),
      ":1: a column has nearly the name of a column with a meaning; rename \"Rig\" to rig, or choose another name "
      "if it is a label");
  EXPECT_EQ(
      FaultOf("Path,rig_file,calib,from,to,model\na.csv,,,,,\n"),
      ":1: columns have nearly the name of a column with a meaning; rename \"Path\" to path, \"rig_file\" to rig, "
      "\"calib\" to calibration, \"from\" to from_s, \"to\" to to_s, \"model\" to models, or choose other "
      "names if they are labels");
  EXPECT_EQ(Entries("path,rig_id,file,models,model,operator,identity,tool\na.csv,1,2,viscous,4,5,6,7\n").size(), 1U);
}

TEST_F(ReadManifestTest, RefusesUnknownModels) {
  EXPECT_THAT(FaultOf("path,models\na.csv,all\nb.csv,magic\n"),
              StartsWith(":3: column models: there is no model 'magic'; the models are viscous, "));
  EXPECT_EQ(FaultOf("path,models\na.csv,\"viscous,viscous\"\n"),
            ":2: column models: 'viscous,viscous' names viscous twice");
  EXPECT_EQ(FaultOf("path,models\na.csv,\"coulomb,dry\"\n"),
            ":2: column models: 'coulomb,dry' names coulomb twice; dry is another name of it");
}

TEST_F(ReadManifestTest, RefusesUnpairedQuotes) {
  const std::string open =
      ": a field begins with a double quote that is never closed; close it, or double a quote that belongs to the text";
  EXPECT_EQ(FaultOf("path\na.csv\n\"b.csv\nc.csv\n"), ":3" + open);
  EXPECT_EQ(FaultOf("\"path\na.csv\n"), ":1" + open);
  const std::string inside =
      ": there is a double quote inside a field; put the whole field in quotes and double its own quotes";
  EXPECT_EQ(FaultOf("path\na.csv\n5\" rod.csv\n"), ":3" + inside);
  EXPECT_EQ(FaultOf("path\n\"a\"b.csv\n"), ":2" + inside);
}

TEST_F(ReadManifestTest, RefusesCarriageReturnsAsLineEnds) {
  const std::string why = ": there is a carriage return within the line; end lines with LF or CRLF";
  EXPECT_EQ(FaultOf("path,id\ra.csv,1\r"), ":1" + why);
  EXPECT_EQ(FaultOf("path,id\na.csv\rx\n"), ":2" + why);
  EXPECT_EQ(FieldOf("\"a\rb\""), "a\rb");
}

TEST_F(ReadManifestTest, RefusesBytesThatAreNotText) {
  EXPECT_THAT(FaultOf(std::string("path\na\0b.csv\n", 13)), StartsWith(":2:2: there is a NUL byte"));
  EXPECT_THAT(FaultOf("path\n" + std::string(std::size_t{2} << 20, 'a') + "\n"),
              HasSubstr(":2:1: this line is longer than 1 MiB and begins with \"aaa"));
}

// Without the limit an unclosed quote would read a whole large manifest into memory.
TEST_F(ReadManifestTest, RefusesARowThatNeverEnds) {
  const std::string lines = Lines(std::size_t{17} << 20);
  const std::string why = " the row that begins here is longer than ";
  EXPECT_THAT(FaultOf("path,x\na.csv,1\nb.csv,\"" + lines + "\"\n"), StartsWith(":3:" + why));
  EXPECT_THAT(FaultOf("path,x\na.csv,\"" + lines), AllOf(StartsWith(":2:" + why), EndsWith("not closed")));
}

TEST_F(ReadManifestTest, RefusesAPathThatIsNotAFile) {
  const EntrySink none = [](const ManifestEntry&) -> Result<void> { return {}; };
  const Status missing = ReadManifest(folder_ / "none.csv", none).error();
  EXPECT_EQ(missing.code, StatusCode::kNotFound);
  EXPECT_EQ(missing.message(), (folder_ / "none.csv").string() + ": there is no such file; check the path");
  const Status directory = ReadManifest(folder_, none).error();
  EXPECT_EQ(directory.code, StatusCode::kDataLoss);
  EXPECT_EQ(directory.message(), folder_.string() + ": this is a directory; name a manifest file in it");
}

}  // namespace
}  // namespace pendulum::manifest_test
