// SPDX-License-Identifier: Apache-2.0
#include "tools/output.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pendulum/base/try.h"

namespace pendulum {
namespace {

namespace fs = std::filesystem;

/// True for a pipe, a terminal or another device, which is written directly.
bool IsStream(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

fs::path FolderOf(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : "."; }

/// Identifies files by name; each folder is examined only once.
class Identities {
 public:
  /// Equal for all names of one file, existing or not; empty if it cannot be determined.
  std::string Of(const std::string& path) {
    if (IsStandardOutput(path)) return "-";
    struct stat file {};
    if (::stat(path.c_str(), &file) == 0) return std::to_string(file.st_dev) + ":" + std::to_string(file.st_ino);
    const fs::path target = FollowLinks(path);
    const std::string& folder = Canonical(FolderOf(target));
    return folder.empty() ? "" : (fs::path(folder) / target.filename()).string();
  }

  std::vector<std::string> Of(std::span<const NamedFile> files) {
    std::vector<std::string> identities;
    identities.reserve(files.size());
    for (const NamedFile& file : files) identities.push_back(Of(file.path));
    return identities;
  }

 private:
  const std::string& Canonical(const fs::path& folder) {
    const auto [known, is_new] = canonical_.try_emplace(folder.string());
    if (!is_new) return known->second;
    std::error_code error;
    const fs::path absolute = fs::absolute(folder, error);
    if (!error) known->second = fs::weakly_canonical(absolute, error).string();
    if (error) known->second.clear();
    return known->second;
  }

  std::map<std::string, std::string> canonical_;
};

bool IsRedirectionOfStdout(const std::string& path) {
  struct stat file {};
  struct stat out {};
  return ::stat(path.c_str(), &file) == 0 && ::fstat(STDOUT_FILENO, &out) == 0 && S_ISREG(file.st_mode) &&
         file.st_dev == out.st_dev && file.st_ino == out.st_ino;
}

/// `proven`: folders in which a file was already opened.
Result<void> CheckWritable(const std::string& path, std::set<fs::path>& proven) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return CannotWrite(path, "it is a directory");
  if (!fs::exists(status) && error && error != std::errc::no_such_file_or_directory) {
    return CannotWrite(path, error.message());
  }
  if (fs::exists(status) && ::access(path.c_str(), W_OK) != 0) return CannotWrite(path, SystemErrorText(errno));
  if (IsStream(path)) return {};
  const fs::path folder = FolderOf(FollowLinks(path));
  if (proven.contains(folder)) return {};
  RETURN_IF_ERROR(StagedFile(path).Open());
  proven.insert(folder);
  return {};
}

/// For each output the flag of the first later output that is the same file; empty if there is none.
std::vector<std::string> FlagsOfTheSame(std::span<const NamedFile> outputs, std::span<const std::string> identities) {
  std::vector<std::string> flags(outputs.size());
  std::unordered_map<std::string_view, std::size_t> later;
  for (std::size_t i = outputs.size(); i-- > 0;) {
    const auto [same, is_new] = later.try_emplace(identities[i], i);
    if (!is_new) flags[i] = outputs[std::exchange(same->second, i)].flag;
  }
  return flags;
}

/// Writes pieces to a stream as they arrive.
Result<void> WriteStream(const std::string& path, const std::function<Result<void>(const PieceSink&)>& run) {
  const bool standard = IsStandardOutput(path);
  const std::string name = standard ? "standard output" : path;
  const int descriptor = standard ? STDOUT_FILENO : ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) return CannotWrite(name, SystemErrorText(errno));
  Result<void> written = run([&](std::string_view text) -> Result<void> {
    if (WriteAll(descriptor, text)) return {};
    return CannotWrite(name, SystemErrorText(errno));
  });
  if (!standard && ::close(descriptor) != 0 && written) written = CannotWrite(name, SystemErrorText(errno));
  return written;
}

Result<void> WriteStream(const Output& output) {
  return WriteStream(output.path, [&](const PieceSink& take) { return take(output.text); });
}

bool IsStreamed(const std::string& path) { return IsStandardOutput(path) || IsStream(path); }

}  // namespace

bool IsStandardOutput(const std::string& path) { return path == "-" || path == "/dev/stdout" || path == "/dev/fd/1"; }

std::string NumberedPath(const std::string& path, int index, int count) {
  if (count == 1 || IsStandardOutput(path)) return path;
  constexpr std::size_t kDigits = 3;
  const std::size_t digits = std::max(kDigits, std::to_string(count).size());
  std::string number = std::to_string(index + 1);
  number.insert(0, digits - number.size(), '0');
  std::filesystem::path numbered(path);
  numbered.replace_filename(numbered.stem().string() + "_" + number + numbered.extension().string());
  return numbered.string();
}

Result<void> CheckOutputs(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs) {
  Identities identities;
  const std::vector<std::string> written = identities.Of(outputs);
  const std::vector<std::string> read = identities.Of(inputs);
  const std::vector<std::string> same = FlagsOfTheSame(outputs, written);
  std::set<fs::path> proven;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const std::string& path = outputs[i].path;
    const auto refuse = [&](const std::string& why) {
      return Error(StatusCode::kInvalidArgument,
                   std::string(outputs[i].flag).append(" ").append(path).append(" ").append(why));
    };
    std::error_code error;
    const bool device = fs::is_character_file(path, error);
    const bool comparable = !device && !written[i].empty();
    if (comparable && !same[i].empty()) return refuse("is the output of " + same[i] + " too");
    for (std::size_t k = 0; comparable && k < inputs.size(); ++k) {
      if (read[k] == written[i]) return refuse("would overwrite the input of " + inputs[k].flag);
    }
    if (IsStandardOutput(path)) continue;
    if (IsRedirectionOfStdout(path)) return refuse("is the file to which standard output goes; give - instead");
    RETURN_IF_ERROR(CheckWritable(path, proven));
  }
  return {};
}

Result<void> WriteOutputs(std::span<const Output> outputs, Durability durability) {
  std::vector<StagedFile> files;
  for (const Output& output : outputs) {
    if (IsStreamed(output.path)) continue;
    files.emplace_back(output.path, durability);
    RETURN_IF_ERROR(files.back().Open());
    RETURN_IF_ERROR(files.back().Write(output.text));
    RETURN_IF_ERROR(files.back().Finish());
  }
  for (StagedFile& file : files) {
    RETURN_IF_ERROR(file.Commit());
  }
  for (const Output& output : outputs) {
    if (!IsStreamed(output.path)) continue;
    RETURN_IF_ERROR(WriteStream(output));
  }
  return {};
}

namespace {

/// Collects all pieces before writing, because output to a stream cannot be undone if a later piece is an error.
Result<void> WriteStreamOfPieces(const std::string& path, int count,
                                 const std::function<Result<std::string>(int)>& piece) {
  Output output{path, ""};
  for (int i = 0; i < count; ++i) {
    ASSIGN_OR_RETURN(const std::string text, piece(i));
    output.text += text;
  }
  return WriteStream(output);
}

}  // namespace

Result<void> WriteStreamed(const std::string& path, const std::function<Result<void>(const PieceSink&)>& run) {
  if (IsStreamed(path)) return WriteStream(path, run);
  StagedFile file(path);
  RETURN_IF_ERROR(file.Open());
  RETURN_IF_ERROR(run([&](std::string_view text) { return file.Write(text); }));
  RETURN_IF_ERROR(file.Finish());
  return file.Commit();
}

Result<void> WritePieces(const std::string& path, int count, const std::function<Result<std::string>(int)>& piece) {
  if (IsStreamed(path)) return WriteStreamOfPieces(path, count, piece);
  return WriteStreamed(path, [&](const PieceSink& take) -> Result<void> {
    for (int i = 0; i < count; ++i) {
      ASSIGN_OR_RETURN(const std::string text, piece(i));
      RETURN_IF_ERROR(take(text));
    }
    return {};
  });
}

Result<void> SynchroniseFileSystem(const std::string& path) {
  const fs::path folder = FolderOf(FollowLinks(path));
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) {
    ::sync();  // A folder that can be written but not read: all file systems are synchronised.
    return {};
  }
  const bool synchronised = ::syncfs(descriptor) == 0;
  const int error = errno;
  ::close(descriptor);
  if (!synchronised) return CannotWrite(path, SystemErrorText(error));
  return {};
}

namespace {

constexpr int kReadAndWrite = 0666;  // before the umask is applied

bool IsFileOrAbsent(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  return status.type() == std::filesystem::file_type::not_found || std::filesystem::is_regular_file(status);
}

}  // namespace

PartFile::PartFile(const std::string& path)
    : path_(!path.empty() && !IsStandardOutput(path) && IsFileOrAbsent(path) ? path + ".part" : "") {}

PartFile::~PartFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool PartFile::Exists() const {
  std::error_code error;
  return !path_.empty() && std::filesystem::exists(path_, error);
}

Result<void> PartFile::Open() {
  if (path_.empty()) return {};
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kReadAndWrite);
  if (descriptor_ < 0) return CannotWrite(path_, SystemErrorText(errno));
  return {};
}

Result<void> PartFile::Append(std::string_view text) {
  if (descriptor_ < 0 || WriteAll(descriptor_, text)) return {};
  return CannotWrite(path_, SystemErrorText(errno));
}

Result<void> PartFile::Synchronise() {
  if (descriptor_ < 0 || ::fdatasync(descriptor_) == 0) return {};
  return CannotWrite(path_, SystemErrorText(errno));
}

void PartFile::Remove() {
  std::error_code error;
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!path_.empty()) std::filesystem::remove(path_, error);
}

namespace {

/// An environment variable; empty if it is not set.
std::string_view Environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string_view() : value;
}

}  // namespace

bool CanRedraw(int descriptor) {
  const std::string_view terminal = Environment("TERM");
  return ::isatty(descriptor) == 1 && !terminal.empty() && terminal != "dumb";
}

TerminalSize SizeOfTerminal(int descriptor) {
  winsize size{};
  if (::ioctl(descriptor, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) return {};
  return {size.ws_col, size.ws_row};
}

bool WantsColour(int descriptor) { return CanRedraw(descriptor) && Environment("NO_COLOR").empty(); }

TextStyle TextStyleFor(int descriptor) {
  constexpr std::size_t kLeast = 40, kMost = 100;  // longer lines are hard to read
  const std::size_t columns = std::clamp(SizeOfTerminal(descriptor).columns, kLeast, kMost);
  return {.colour = WantsColour(descriptor), .width = static_cast<int>(columns)};
}

}  // namespace pendulum
