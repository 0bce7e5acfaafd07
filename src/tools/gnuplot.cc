// SPDX-License-Identifier: Apache-2.0
#include "tools/gnuplot.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <string_view>
#include <system_error>
#include <vector>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "pendulum/base/format.h"

namespace pendulum {
namespace {

constexpr const char* kMissing = "plot needs gnuplot; install gnuplot-nox";

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// A file without a name, deleted when closed. With pipes, parent and child could wait for each other forever; with
/// files they cannot.
using TemporaryFile = std::unique_ptr<std::FILE, Close>;

std::string Contents(std::FILE* file) {
  std::string text;
  std::array<char, 65536> block{};
  std::fseek(file, 0, SEEK_SET);
  while (const std::size_t got = std::fread(block.data(), 1, block.size(), file)) text.append(block.data(), got);
  return text;
}

/// Standard input, output and error of the child.
struct ChildFiles {
  std::array<TemporaryFile, 3> files = {TemporaryFile(std::tmpfile()), TemporaryFile(std::tmpfile()),
                                        TemporaryFile(std::tmpfile())};

  bool IsOpen() const { return files[0] != nullptr && files[1] != nullptr && files[2] != nullptr; }

  bool Put(const std::string& input) {
    std::FILE* file = files[0].get();
    const bool written = std::fwrite(input.data(), 1, input.size(), file) == input.size() && std::fflush(file) == 0;
    std::fseek(file, 0, SEEK_SET);
    return written;
  }
};

/// Runs gnuplot and waits. `status` gets its exit status, 0 on success; returns the error of posix_spawnp.
std::error_code Spawn(std::vector<std::string> arguments, const ChildFiles& child, int& status) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  for (int i = 0; i < 3; ++i) ::posix_spawn_file_actions_adddup2(&actions, ::fileno(child.files.at(i).get()), i);
  pid_t process = 0;
  const int error = ::posix_spawnp(&process, argv[0], &actions, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return {error, std::generic_category()};
  while (::waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) return {errno, std::generic_category()};
  }
  return {};
}

/// The first line that is not blank, quoted for a message.
std::string FirstWords(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t\n"), text.size());
  return Quoted(text.substr(begin, text.find('\n', begin) - begin));
}

Result<std::string> RunChild(const std::vector<std::string>& arguments, const std::string& input) {
  ChildFiles child;
  if (!child.IsOpen() || !child.Put(input)) {
    return Error(StatusCode::kCannotWrite, "plot: cannot write a temporary file; free space in /tmp");
  }
  int status = 0;
  const std::error_code error = Spawn(arguments, child, status);
  if (error == std::errc::no_such_file_or_directory) return Error(StatusCode::kCannotWrite, kMissing);
  if (error) return Error(StatusCode::kCannotWrite, "plot: cannot run gnuplot: " + error.message());
  if (status == 0) return Contents(child.files[1].get());
  return Error(StatusCode::kCannotWrite, "plot: gnuplot failed: " + FirstWords(Contents(child.files[2].get())));
}

}  // namespace

Result<void> CheckGnuplot() {
  return RunChild({"gnuplot", "--version"}, "").map([](const std::string&) {});
}

Result<std::string> RunGnuplot(const std::string& script) { return RunChild({"gnuplot", "-d", "-"}, script); }

}  // namespace pendulum
