// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/source.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pendulum/batch/store_lock.h"

namespace pendulum::source_test {
namespace {

namespace fs = std::filesystem;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::vector<ManifestEntry> EntriesOf(const Source& source) {
  std::vector<ManifestEntry> entries;
  const auto read = source.for_each([&](const ManifestEntry& entry) -> Result<void> {
    entries.push_back(entry);
    return {};
  });
  EXPECT_TRUE(read) << read.error().message();
  return entries;
}

std::vector<std::string> IdsOf(const Source& source) {
  std::vector<std::string> ids;
  for (const ManifestEntry& entry : EntriesOf(source)) ids.push_back(entry.id);
  return ids;
}

/// Every byte value, repeated so that the text fills more than a page of SQLite.
std::string BinaryBytes() {
  std::string bytes;
  for (int i = 0; i < 40 * 256; ++i) bytes += static_cast<char>(i % 256);
  return bytes;
}

class SourceTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_ / "runs"); }
  void TearDown() override { fs::remove_all(folder_); }

  void Write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }

  /// A manifest with all properties of entries, and all of its files except one.
  Source Manifest() const {
    Write("runs.csv",
          "path,id,rig,calibration,from_s,to_s,models,temperature\n"
          "runs/a.csv,first,rig.json,cal.json,0.1,2e1,all,\"21,5 °C\"\n"
          "runs/b.csv,,rig.json,,,,,\n"
          "runs/none.csv,third,,,,,,\n");
    Write("runs/a.csv", BinaryBytes());
    Write("runs/b.csv", "");
    Write("rig.json", "{}");
    Write("cal.json", "\"'; DROP TABLE files; --");
    return OpenSource(folder_ / "runs.csv").value();
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("source_test_" + std::to_string(getpid()));
  const fs::path pack_ = folder_ / "batch.pack";
};

// ---- Files ---------------------------------------------------------------------------------------------------------

TEST_F(SourceTest, ReadsFilesFromTheFolderOfTheManifest) {
  const Source source = Manifest();
  EXPECT_EQ(source.name, (folder_ / "runs.csv").string());
  EXPECT_THAT(IdsOf(source), ElementsAre("first", "runs/b.csv", "third"));
  EXPECT_EQ(source.read("runs/a.csv").value(), BinaryBytes());
  EXPECT_EQ(source.read("runs/b.csv").value(), "");
  EXPECT_EQ(source.read((folder_ / "rig.json").string()).value(), "{}");  // an absolute path
}

TEST_F(SourceTest, GivesPathsInErrorsAsTheManifestDoes) {
  const Source source = Manifest();
  EXPECT_EQ(source.read("runs/none.csv").error().code, StatusCode::kNotFound);
  EXPECT_EQ(source.read("runs/none.csv").error().message(), "runs/none.csv: there is no such file; check the path");
  EXPECT_EQ(source.read("runs").error().code, StatusCode::kDataLoss);
  EXPECT_EQ(source.read("runs").error().message(), "runs: this is a directory; name a file in it");
}

// Opening a pipe without a writer would block forever.
TEST_F(SourceTest, RefusesPipesAndDevicesWithoutOpeningThem) {
  const Source source = Manifest();
  ASSERT_EQ(::mkfifo((folder_ / "pipe.csv").c_str(), 0600), 0);
  for (const std::string path : {"pipe.csv", "/dev/zero"}) {
    const auto bytes = source.read(path);
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().code, StatusCode::kDataLoss);
    EXPECT_EQ(bytes.error().message(), path + ": this is a pipe or a device; a batch reads files");
  }
}

TEST_F(SourceTest, ReportsAMissingManifest) {
  const auto missing = OpenSource(folder_ / "none.csv");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, StatusCode::kNotFound);
  EXPECT_EQ(missing.error().message(), (folder_ / "none.csv").string() + ": there is no such file; check the path");
  const auto folder = OpenSource(folder_);
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.error().code, StatusCode::kDataLoss);
  EXPECT_EQ(folder.error().message(), folder_.string() + ": this is a directory; name a manifest file in it");
}

// ---- Folders and patterns ------------------------------------------------------------------------------------------

TEST_F(SourceTest, NamesTheRunsOfAFolderByTheirPaths) {
  const Source source = FindSource({"datasets/runs_[34].csv", "./datasets/runs_4.csv", "datasets/coulomb.csv"}).value();
  const auto entries = EntriesOf(source);
  ASSERT_EQ(entries.size(), 3);  // the fourth is a duplicate
  EXPECT_EQ(entries[0].path, "datasets/runs_3.csv");
  EXPECT_EQ(entries[1].path, "datasets/runs_4.csv");
  EXPECT_EQ(entries[2].path, "datasets/coulomb.csv");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    EXPECT_EQ(entries[i].id, entries[i].path);
    EXPECT_EQ(entries[i].position, i);
    EXPECT_EQ(entries[i].columns, "{}");
    EXPECT_EQ(entries[i].place, "");
  }
  EXPECT_EQ(source.read(entries[0].path).value().size(), fs::file_size("datasets/runs_3.csv"));
}

TEST_F(SourceTest, NamesAPatternWithoutMatches) {
  const auto source = FindSource({"datasets", "datasets/*.wav"});
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, StatusCode::kNotFound);
  EXPECT_EQ(source.error().message(), "datasets/*.wav: no file matches this pattern; check the path");
}

// ---- Packs ---------------------------------------------------------------------------------------------------------

TEST_F(SourceTest, GivesTheSameEntriesFromAPack) {
  const Source source = Manifest();
  ASSERT_TRUE(Pack(source, pack_));
  const Source packed = OpenSource(pack_).value();
  EXPECT_EQ(packed.name, pack_.string());
  const auto expected = EntriesOf(source), entries = EntriesOf(packed);
  ASSERT_EQ(entries.size(), 3);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    EXPECT_EQ(entries[i].position, expected[i].position);
    EXPECT_EQ(entries[i].id, expected[i].id);
    EXPECT_EQ(entries[i].path, expected[i].path);
    EXPECT_EQ(entries[i].rig, expected[i].rig);
    EXPECT_EQ(entries[i].calibration, expected[i].calibration);
    EXPECT_EQ(entries[i].from, expected[i].from);
    EXPECT_EQ(entries[i].to, expected[i].to);
    EXPECT_EQ(entries[i].models, expected[i].models);
    EXPECT_EQ(entries[i].columns, expected[i].columns);
  }
  EXPECT_EQ(entries[0].columns, R"({"temperature":"21,5 °C"})");
}

TEST_F(SourceTest, GivesTheSameBytesFromAPackWithoutTheFiles) {
  ASSERT_TRUE(Pack(Manifest(), pack_));
  fs::remove_all(folder_ / "runs");
  const Source packed = OpenSource(pack_).value();
  EXPECT_EQ(packed.read("runs/a.csv").value(), BinaryBytes());
  EXPECT_EQ(packed.read("runs/b.csv").value(), "");
  EXPECT_EQ(packed.read("rig.json").value(), "{}");
  EXPECT_EQ(packed.read("cal.json").value(), "\"'; DROP TABLE files; --");
}

TEST_F(SourceTest, ReportsTheErrorOfAFileFromAPack) {
  Write("runs.csv", "path\nruns/none.csv\nruns\npipe.csv\n");
  ASSERT_EQ(::mkfifo((folder_ / "pipe.csv").c_str(), 0600), 0);
  const Source source = OpenSource(folder_ / "runs.csv").value();
  ASSERT_TRUE(Pack(source, pack_));
  const Source packed = OpenSource(pack_).value();
  for (const std::string path : {"runs/none.csv", "runs", "pipe.csv"}) {
    EXPECT_EQ(packed.read(path).error().code, source.read(path).error().code) << path;
    EXPECT_EQ(packed.read(path).error().message(), source.read(path).error().message()) << path;
    EXPECT_EQ(packed.read(path).error().place, path);
  }
  EXPECT_EQ(packed.read("other.csv").error().code, StatusCode::kNotFound);
  EXPECT_EQ(packed.read("other.csv").error().message(), "other.csv: there is no such file in " + pack_.string());
}

TEST_F(SourceTest, CanPackFoundFilesAndAPack) {
  ASSERT_TRUE(Pack(FindSource({"datasets/runs_1.csv"}).value(), pack_));
  ASSERT_TRUE(Pack(OpenSource(pack_).value(), pack_));  // onto its own source
  const Source packed = OpenSource(pack_).value();
  EXPECT_THAT(IdsOf(packed), ElementsAre("datasets/runs_1.csv"));
  EXPECT_EQ(packed.read("datasets/runs_1.csv").value().size(), fs::file_size("datasets/runs_1.csv"));
}

TEST_F(SourceTest, ReplacesAPackAtomically) {
  ASSERT_TRUE(Pack(Manifest(), pack_));
  const Source old = OpenSource(pack_).value();
  Write("runs.csv", "path\nruns/c.csv\n");
  Write("runs/c.csv", "new");
  ASSERT_TRUE(Pack(OpenSource(folder_ / "runs.csv").value(), pack_));
  EXPECT_THAT(IdsOf(old), ElementsAre("first", "runs/b.csv", "third"));  // an open pack stays readable
  EXPECT_EQ(old.read("runs/a.csv").value(), BinaryBytes());
  const Source packed = OpenSource(pack_).value();
  EXPECT_THAT(IdsOf(packed), ElementsAre("runs/c.csv"));
  EXPECT_EQ(packed.read("runs/c.csv").value(), "new");
}

TEST_F(SourceTest, KeepsAPackIfTheSourceEndsInAnError) {
  ASSERT_TRUE(Pack(Manifest(), pack_));
  Write("runs.csv", "path\nruns/a.csv\n\"\n");
  const auto packed = Pack(OpenSource(folder_ / "runs.csv").value(), pack_);
  ASSERT_FALSE(packed);
  EXPECT_EQ(packed.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(packed.error().message(), StartsWith((folder_ / "runs.csv").string() + ":3: a field begins with"));
  EXPECT_THAT(IdsOf(OpenSource(pack_).value()), ElementsAre("first", "runs/b.csv", "third"));
  for (const auto& file : fs::directory_iterator(folder_)) {
    EXPECT_FALSE(file.path().filename().string().starts_with("batch.pack.")) << file.path();
  }
}

TEST_F(SourceTest, ReportsAnUnwritablePack) {
  const Source source = Manifest();
  for (const fs::path& path : {folder_ / "nowhere" / "batch.pack", folder_ / "runs"}) {
    const auto packed = Pack(source, path);
    ASSERT_FALSE(packed);
    EXPECT_EQ(packed.error().code, StatusCode::kCannotWrite);
    EXPECT_THAT(packed.error().message(), StartsWith("cannot write " + path.string() + ": "));
  }
}

TEST_F(SourceTest, OverwritesOnlyPacks) {
  const Source source = Manifest();
  const fs::path store = folder_ / "results.sqlite";
  SQLite::Database(store.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE).exec("CREATE TABLE runs(result)");
  for (const fs::path& other : {store, folder_ / "runs" / "a.csv"}) {
    const auto before = fs::file_size(other);
    const auto packed = Pack(source, other);
    ASSERT_FALSE(packed);
    EXPECT_EQ(packed.error().code, StatusCode::kInvalidArgument);
    EXPECT_THAT(packed.error().message(), StartsWith(other.string() + ": this file exists and is not a packed file"));
    EXPECT_EQ(fs::file_size(other), before);
  }
}

TEST_F(SourceTest, DoesNotPackIntoAPipe) {
  ASSERT_EQ(::mkfifo(pack_.c_str(), 0600), 0);
  const auto packed = Pack(Manifest(), pack_);
  ASSERT_FALSE(packed);
  EXPECT_EQ(packed.error().code, StatusCode::kCannotWrite);
  EXPECT_TRUE(fs::is_fifo(pack_));
}

TEST_F(SourceTest, AllowsOneProcessToPackAtATime) {
  const auto other = StoreLock::Take(pack_);
  EXPECT_EQ(Pack(Manifest(), pack_).error().code, StatusCode::kTryAgain);
  EXPECT_FALSE(fs::exists(pack_));
}

TEST_F(SourceTest, CountsFilesThatCouldNotBePacked) {
  const auto packed = Pack(Manifest(), pack_);
  ASSERT_TRUE(packed);
  EXPECT_EQ(packed->files, 5);
  EXPECT_EQ(packed->unreadable, 1);
  EXPECT_EQ(packed->first_reason, "runs/none.csv: there is no such file; check the path");
}

TEST_F(SourceTest, ReadsAManifestFromANamedPipe) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe) << "path\nruns/a.csv\n"; });
  EXPECT_THAT(IdsOf(OpenSource(pipe).value()), ElementsAre("runs/a.csv"));
  writer.join();
}

TEST_F(SourceTest, FollowsALinkToThePack) {
  fs::create_directory(folder_ / "disk");
  fs::create_symlink("disk/batch.pack", pack_);
  ASSERT_TRUE(Pack(Manifest(), pack_));
  EXPECT_TRUE(fs::is_symlink(pack_));
  EXPECT_EQ(IdsOf(OpenSource(folder_ / "disk" / "batch.pack").value()).size(), 3);
}

// ---- Other files ---------------------------------------------------------------------------------------------------

TEST_F(SourceTest, RefusesOtherSqliteFiles) {
  SQLite::Database(pack_.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE).exec("CREATE TABLE t(x)");
  const auto other = OpenSource(pack_);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, StatusCode::kDataLoss);
  EXPECT_EQ(other.error().message(),
            pack_.string() + ": this SQLite file was not made by refit_pendulums pack; name a packed file");
}

TEST_F(SourceTest, RefusesOtherSqliteFilesWithATableOfFiles) {
  SQLite::Database(pack_.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE).exec("CREATE TABLE files(name)");
  const auto other = OpenSource(pack_);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, StatusCode::kDataLoss);
  EXPECT_EQ(other.error().message(),
            pack_.string() + ": this SQLite file was not made by refit_pendulums pack; name a packed file");
}

TEST_F(SourceTest, RefusesAPackOfALaterFormat) {
  ASSERT_TRUE(Pack(Manifest(), pack_));
  SQLite::Database(pack_.string(), SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 3");
  const auto newer = OpenSource(pack_);
  ASSERT_FALSE(newer);
  EXPECT_EQ(newer.error().code, StatusCode::kDataLoss);
  EXPECT_EQ(newer.error().message(),
            pack_.string() + ": it was packed in format 3, but this program reads format 2; pack it again");
}

TEST_F(SourceTest, RefusesATruncatedPack) {
  ASSERT_TRUE(Pack(Manifest(), pack_));
  fs::resize_file(pack_, fs::file_size(pack_) / 2);
  const auto damaged = OpenSource(pack_);
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(damaged.error().message(), StartsWith(pack_.string() + ": the file is damaged ("));
}

TEST_F(SourceTest, ReportsDamagedPagesOfAPack) {
  ASSERT_TRUE(Pack(Manifest(), pack_));
  const auto size = static_cast<std::streamoff>(fs::file_size(pack_));
  constexpr std::streamoff kPage = 4096;  // SQLite's default
  std::fstream file(pack_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(kPage);
  file << std::string(static_cast<std::size_t>(size - kPage), '\xA5');
  file.close();
  const auto damaged = OpenSource(pack_);
  ASSERT_TRUE(damaged) << damaged.error().message();  // the first page is intact
  EXPECT_EQ(damaged->read("runs/a.csv").error().code, StatusCode::kDataLoss);
  EXPECT_THAT(damaged->read("runs/a.csv").error().message(), HasSubstr(": the file is damaged ("));
  const auto entries = damaged->for_each([](const ManifestEntry&) -> Result<void> { return {}; });
  ASSERT_FALSE(entries);
  EXPECT_EQ(entries.error().code, StatusCode::kDataLoss);
}

}  // namespace
}  // namespace pendulum::source_test
