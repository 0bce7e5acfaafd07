// SPDX-License-Identifier: Apache-2.0
#include "tools/output.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pendulum {
namespace {

namespace fs = std::filesystem;

std::string SystemWords(int error) { return std::generic_category().message(error); }

tl::unexpected<Status> CannotWrite(const std::string& path, const std::string& why) {
  return Error(StatusCode::kCannotWrite, "cannot write " + path + ": " + why);
}

/// The file a path stands for once symbolic links in its last component are followed, whether or not it exists.
fs::path FollowLinks(fs::path path) {
  constexpr int kMostLinks = 40;  // as the kernel's own limit
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(path, error); ++i) {
    const fs::path target = fs::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / target;  // an absolute target replaces the whole
  }
  return path;
}

/// True for what is written to as it stands: a pipe, a terminal, another device.
bool IsStream(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// The same for all names of one file, be it there or not; empty when that cannot be told.
std::string Identity(const std::string& path) {
  if (IsStandardOutput(path)) return "-";
  struct stat file {};
  if (::stat(path.c_str(), &file) == 0) return std::to_string(file.st_dev) + ":" + std::to_string(file.st_ino);
  std::error_code error;
  const fs::path absolute = fs::absolute(FollowLinks(path), error);
  if (error) return "";
  const fs::path canonical = fs::weakly_canonical(absolute, error);
  return error ? "" : canonical.string();
}

/// Identities of many files, each found once: every output is compared with all others.
std::vector<std::string> Identities(std::span<const NamedFile> files) {
  std::vector<std::string> identities;
  for (const NamedFile& file : files) identities.push_back(Identity(file.path));
  return identities;
}

bool IsRedirectionOfStdout(const std::string& path) {
  struct stat file {};
  struct stat out {};
  return ::stat(path.c_str(), &file) == 0 && ::fstat(STDOUT_FILENO, &out) == 0 && S_ISREG(file.st_mode) &&
         file.st_dev == out.st_dev && file.st_ino == out.st_ino;
}

bool WriteAll(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// A file under a temporary name beside its target; removed unless committed.
class StagedFile {
 public:
  explicit StagedFile(std::string path) : path_(std::move(path)), target_(FollowLinks(path_)) {}
  StagedFile(StagedFile&& other) noexcept
      : path_(std::move(other.path_)),
        target_(std::move(other.target_)),
        temporary_(std::exchange(other.temporary_, {})),
        descriptor_(std::exchange(other.descriptor_, -1)) {}
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;
  StagedFile& operator=(StagedFile&&) = delete;
  ~StagedFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }

  Result<void> Open() {
    const fs::path directory = target_.has_parent_path() ? target_.parent_path() : ".";
    while (descriptor_ < 0) {
      // A name may be taken by what a process of that number left when it was killed: the next one is tried.
      static std::atomic<std::uint64_t> names = 0;
      const std::string name = ".pendulum." + std::to_string(::getpid()) + "." + std::to_string(names++) + ".tmp";
      const std::string temporary = directory / name;
      descriptor_ = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor_ >= 0) {
        temporary_ = temporary;
      } else if (errno != EEXIST) {
        break;
      }
    }
    if (descriptor_ < 0) return CannotWrite(path_, SystemWords(errno));
    return {};
  }

  Result<void> Write(std::string_view text) {
    KeepPermissions();
    if (!WriteAll(descriptor_, text) || ::fsync(descriptor_) != 0) return CannotWrite(path_, SystemWords(errno));
    if (::close(std::exchange(descriptor_, -1)) != 0) return CannotWrite(path_, SystemWords(errno));
    return {};
  }

  Result<void> Commit() {
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) return CannotWrite(path_, SystemWords(errno));
    temporary_.clear();
    return {};
  }

 private:
  /// Mode of the file to be replaced, and its owner where we may.
  void KeepPermissions() const {
    constexpr mode_t kPermissions = 07777;
    struct stat old {};
    if (::stat(target_.c_str(), &old) != 0) return;
    const bool owned = ::fchown(descriptor_, old.st_uid, old.st_gid) == 0;
    ::fchmod(descriptor_, old.st_mode & (owned ? kPermissions : 0777U));
  }

  std::string path_;
  fs::path target_;
  std::string temporary_;
  int descriptor_ = -1;
};

Result<void> CheckWritable(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return CannotWrite(path, "it is a directory");
  if (!fs::exists(status) && error && error != std::errc::no_such_file_or_directory) {
    return CannotWrite(path, error.message());
  }
  if (fs::exists(status) && ::access(path.c_str(), W_OK) != 0) return CannotWrite(path, SystemWords(errno));
  if (IsStream(path)) return {};
  return StagedFile(path).Open();
}

Result<void> WriteStream(const Output& output) {
  const bool standard = IsStandardOutput(output.path);
  const int descriptor = standard ? STDOUT_FILENO : ::open(output.path.c_str(), O_WRONLY | O_CLOEXEC);
  bool written = descriptor >= 0 && WriteAll(descriptor, output.text);
  int error = errno;
  if (!standard && descriptor >= 0 && ::close(descriptor) != 0 && written) {
    written = false;
    error = errno;
  }
  if (!written) return CannotWrite(standard ? "standard output" : output.path, SystemWords(error));
  return {};
}

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
  const std::vector<std::string> written = Identities(outputs);
  const std::vector<std::string> read = Identities(inputs);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const std::string& path = outputs[i].path;
    const auto refuse = [&](const std::string& why) {
      return Error(StatusCode::kInvalidArgument,
                   std::string(outputs[i].flag).append(" ").append(path).append(" ").append(why));
    };
    std::error_code error;
    const bool device = fs::is_character_file(path, error);
    const bool comparable = !device && !written[i].empty();
    for (std::size_t k = i + 1; comparable && k < outputs.size(); ++k) {
      if (written[k] == written[i]) return refuse("is the output of " + outputs[k].flag + " too");
    }
    for (std::size_t k = 0; comparable && k < inputs.size(); ++k) {
      if (read[k] == written[i]) return refuse("would overwrite the input of " + inputs[k].flag);
    }
    if (IsStandardOutput(path)) continue;
    if (IsRedirectionOfStdout(path)) return refuse("is where standard output goes; give - instead");
    if (auto writable = CheckWritable(path); !writable) return writable;
  }
  return {};
}

Result<void> WriteOutputs(std::span<const Output> outputs) {
  std::vector<StagedFile> files;
  for (const Output& output : outputs) {
    if (IsStandardOutput(output.path) || IsStream(output.path)) continue;
    files.emplace_back(output.path);
    if (auto opened = files.back().Open(); !opened) return opened;
    if (auto written = files.back().Write(output.text); !written) return written;
  }
  for (StagedFile& file : files) {
    if (auto committed = file.Commit(); !committed) return committed;
  }
  for (const Output& output : outputs) {
    if (!IsStandardOutput(output.path) && !IsStream(output.path)) continue;
    if (auto written = WriteStream(output); !written) return written;
  }
  return {};
}

}  // namespace pendulum
