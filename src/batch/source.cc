// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/source.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "batch/entry_row.h"
#include "batch/sqlite.h"
#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/staged_file.h"
#include "pendulum/base/try.h"
#include "pendulum/batch/find_recordings.h"
#include "pendulum/batch/store_lock.h"
#include "pendulum/batch/temporary_store.h"
#include "pendulum/model/motion_model.h"

namespace pendulum {
namespace {

namespace fs = std::filesystem;

/// The bytes of a regular file in a folder, by its path in the entry.
Result<std::string> ReadFileInFolder(const fs::path& folder, const std::string& path) {
  const fs::path file = folder / path;
  std::error_code unknown;
  const fs::file_type type = fs::status(file, unknown).type();
  if (type == fs::file_type::not_found) {
    return ErrorAt(StatusCode::kNotFound, path, "there is no such file; check the path");
  }
  if (type == fs::file_type::directory) return Fault(path, "this is a directory; name a file in it");
  if (type != fs::file_type::regular && type != fs::file_type::none) {
    return Fault(path, "this is a pipe or a device; a batch reads files");
  }
  auto bytes = ReadFile(file, "CSV", kMaxRecordingBytes);
  if (!bytes) bytes.error().place = path;
  return bytes;
}

/// Whether a file begins with "SQLite format 3", as SQLite files do.
bool IsSqlite(const fs::path& path) {
  constexpr std::string_view kMagic{"SQLite format 3\0", 16};
  std::array<char, kMagic.size()> begin{};
  std::ifstream(path, std::ios::binary).read(begin.data(), begin.size());
  return std::string_view(begin.data(), begin.size()) == kMagic;
}

constexpr int kPackId = 0x50656e70;  // "Penp"
constexpr int kPackVersion = 2;

constexpr const char* kPackSchema = R"(
CREATE TABLE entries(  -- one row a run, as ManifestEntry
  position INTEGER PRIMARY KEY, id TEXT NOT NULL, path TEXT NOT NULL, rig TEXT NOT NULL, calibration TEXT NOT NULL,
  from_s REAL, to_s REAL, models TEXT NOT NULL, columns TEXT NOT NULL);
CREATE TABLE files(  -- recordings, rigs and calibrations, byte for byte; or the exit code and the sentence of why there is none
  path TEXT PRIMARY KEY, code INTEGER, sentence TEXT, bytes BLOB);
)";

/// A packed file that is open for reading. SQLite serializes threads; the mutex protects the statement of Read.
class PackedFile {
 public:
  explicit PackedFile(const fs::path& path)
      : name_(path.string()), database_(sqlite::FileName(name_), SQLite::OPEN_READONLY), read_(database_, kRead) {}

  static constexpr const char* kRead = "SELECT code, sentence, bytes FROM files WHERE path = ?";

  Result<void> Check() {
    const int id = database_.execAndGet("PRAGMA application_id").getInt();
    if (id != kPackId) return Fault(name_, "this SQLite file was not made by refit_pendulums pack; name a packed file");
    const int version = database_.execAndGet("PRAGMA user_version").getInt();
    if (version == kPackVersion) return {};
    return Fault(name_, "it was packed in format " + std::to_string(version) + ", but this program reads format " +
                            std::to_string(kPackVersion) + "; pack it again");
  }

  Result<void> ForEach(const EntrySink& take) {
    SQLite::Statement rows(database_,
                           "SELECT position, id, path, rig, calibration, from_s, to_s, models, columns FROM entries "
                           "ORDER BY position");
    for (std::int64_t position = 0; rows.executeStep(); ++position) {
      ManifestEntry entry = EntryOf(rows);
      entry.position = position;
      RETURN_IF_ERROR(CheckEntry(entry));
      RETURN_IF_ERROR(take(entry));
    }
    return {};
  }

  Result<std::string> Read(const std::string& path) {
    const std::scoped_lock lock(mutex_);
    sqlite::Bind(read_, path);
    if (!read_.executeStep()) return ErrorAt(StatusCode::kNotFound, path, "there is no such file in " + name_);
    if (!read_.getColumn(0).isNull()) {
      const bool missing = read_.getColumn(0).getInt() == ExitCode(StatusCode::kNotFound);
      return ErrorAt(missing ? StatusCode::kNotFound : StatusCode::kDataLoss, path, sqlite::Text(read_, 1));
    }
    return sqlite::Text(read_, 2);
  }

 private:
  /// Checks an entry, because another program may have written the pack.
  Result<void> CheckEntry(const ManifestEntry& entry) const {
    const auto models = FindMotionModels(entry.models);
    if (!entry.models.empty() && !models) return Fault(name_ + ": " + entry.id, models.error().message());
    const auto columns = nlohmann::ordered_json::parse(entry.columns, nullptr, false);
    const bool texts =
        columns.is_object() && std::ranges::all_of(columns, [](const auto& value) { return value.is_string(); });
    if (texts && !entry.id.empty() && !entry.path.empty()) return {};
    return Fault(name_, "the entry " + Quoted(entry.id) + " is not an entry of a manifest; pack it again");
  }

  std::string name_;
  SQLite::Database database_;
  SQLite::Statement read_;
  std::mutex mutex_;
};

Result<Source> OpenPack(const fs::path& path) {
  const std::string name = path.string();
  RETURN_IF_ERROR(sqlite::CheckReadable(name));
  return sqlite::Guard(name, [&]() -> Result<Source> {
    SQLite::Database probe(sqlite::FileName(name), SQLite::OPEN_READONLY);
    if (probe.execAndGet("PRAGMA application_id").getInt() != kPackId || !probe.tableExists("files")) {
      return Fault(name, "this SQLite file was not made by refit_pendulums pack; name a packed file");
    }
    const auto pack = std::make_shared<PackedFile>(path);
    RETURN_IF_ERROR(pack->Check());
    return Source{
        name, [pack, name](const EntrySink& take) { return sqlite::Guard(name, [&] { return pack->ForEach(take); }); },
        [pack, name](const std::string& file) { return sqlite::Guard(name, [&] { return pack->Read(file); }); }};
  });
}

/// Pack may replace only packed files, never a recording, a result store or a device.
Result<void> CheckReplaceable(const fs::path& path) {
  std::error_code unknown;
  const fs::file_type type = fs::status(path, unknown).type();
  if (type == fs::file_type::not_found) return {};
  if (type != fs::file_type::regular) {
    return CannotWrite(path.string(), "it is not a regular file; name a regular file");
  }
  if (IsSqlite(path) && OpenPack(path)) return {};
  return ErrorAt(StatusCode::kInvalidArgument, path.string(),
                 "this file exists and is not a packed file, and pack would replace it; name another file");
}

/// A packed file that is being written.
class Packer {
 public:
  Packer(const std::string& path, const Source& source)
      : source_(source),
        database_(sqlite::FileName(path), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE),
        begun_(Begin(database_)),
        add_entry_(database_, "INSERT INTO entries VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?)"),
        add_file_(database_, "INSERT INTO files VALUES(?, ?, ?, ?)"),
        has_file_(database_, "SELECT 1 FROM files WHERE path = ?") {}

  Result<void> Add(const ManifestEntry& entry) {
    sqlite::Bind(add_entry_, entry.position, entry.id, entry.path, entry.rig, entry.calibration, entry.from, entry.to,
                 entry.models, entry.columns)
        .exec();
    for (const std::string& path : {entry.path, entry.rig, entry.calibration}) AddFile(path);
    return {};
  }

  void Commit() { begun_->commit(); }

  const PackCounts& counts() const { return counts_; }

 private:
  static std::unique_ptr<SQLite::Transaction> Begin(SQLite::Database& database) {
    database.exec("PRAGMA application_id = " + std::to_string(kPackId));
    database.exec("PRAGMA user_version = " + std::to_string(kPackVersion));
    auto transaction = std::make_unique<SQLite::Transaction>(database);
    database.exec(kPackSchema);
    return transaction;
  }

  void AddFile(const std::string& path) {
    if (path.empty() || sqlite::Bind(has_file_, path).executeStep()) return;
    const auto bytes = source_.read(path);
    ++counts_.files;
    if (!bytes && counts_.unreadable++ == 0) counts_.first_reason = bytes.error().message();
    sqlite::Bind(add_file_, path);
    if (bytes) {
      add_file_.bind(4, bytes->data(), static_cast<int>(bytes->size()));
    } else {
      add_file_.bind(2, ExitCode(bytes.error().code));
      add_file_.bind(3, bytes.error().sentence);
    }
    add_file_.exec();
  }

  const Source& source_;
  SQLite::Database database_;
  std::unique_ptr<SQLite::Transaction> begun_;
  SQLite::Statement add_entry_;
  SQLite::Statement add_file_;
  SQLite::Statement has_file_;
  PackCounts counts_;
};

}  // namespace

Result<Source> OpenSource(const fs::path& path) {
  std::error_code unknown;
  if (fs::is_regular_file(path, unknown) && IsSqlite(path)) return OpenPack(path);
  if (path != "-" && !fs::is_fifo(path, unknown)) {  // opening a pipe to test it would disturb its writer
    RETURN_IF_ERROR(InputFile::Open(path, "manifest"));
  }
  const fs::path folder = path == "-" ? fs::path() : path.parent_path();
  return Source{path.string(),
                [path](const EntrySink& take) { return ReadManifest(path, take); },
                [folder](const std::string& file) { return ReadFileInFolder(folder, file); },
                {},
                {},
                folder.string()};
}

Result<Source> FindSource(const std::vector<std::string>& patterns) {
  std::vector<std::string> paths;
  std::set<std::string> known;
  std::map<std::string, std::int64_t> left_out;
  std::vector<std::string> lists;
  for (const std::string& pattern : patterns) {
    ASSIGN_OR_RETURN(const auto found, FindRecordings(pattern));
    for (const std::string& path : found.left_out) ++left_out["*" + fs::path(path).extension().string()];
    lists.insert(lists.end(), found.lists.begin(), found.lists.end());
    for (const std::string& path : found.paths) {
      if (known.insert(fs::path(path).lexically_normal().string()).second) paths.push_back(path);
    }
  }
  const auto for_each = [paths = std::move(paths)](const EntrySink& take) -> Result<void> {
    ManifestEntry entry;
    for (const std::string& path : paths) {
      entry.path = path;
      entry.id = fs::path(path).lexically_normal().string();
      RETURN_IF_ERROR(take(entry));
      ++entry.position;
    }
    return {};
  };
  return Source{
      patterns.front(),    for_each,         [](const std::string& file) { return ReadFileInFolder({}, file); },
      std::move(left_out), std::move(lists), ""};
}

Result<PackCounts> Pack(const Source& source, const fs::path& path) {
  RETURN_IF_ERROR(CheckFolderOf(path));
  RETURN_IF_ERROR(CheckReplaceable(path));
  ASSIGN_OR_RETURN(const auto lock, StoreLock::Take(path));
  const TemporaryStore unfinished(WithSuffix(path, ".unfinished"));
  auto packed = sqlite::Guard(path.string(), [&]() -> Result<PackCounts> {
    Packer packer(unfinished.path().string(), source);
    RETURN_IF_ERROR(source.for_each([&](const ManifestEntry& entry) { return packer.Add(entry); }));
    packer.Commit();
    return packer.counts();
  });
  if (!packed) return packed;
  std::error_code error;
  fs::rename(unfinished.path(), FollowLinks(path), error);
  if (error) return CannotWrite(path.string(), SystemErrorText(error.value()));
  return packed;
}

}  // namespace pendulum
