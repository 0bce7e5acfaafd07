// SPDX-License-Identifier: Apache-2.0
#include "recording/in_child.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <string_view>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pendulum {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kHasShadowMemory = true;
#elif defined(__has_feature)
constexpr bool kHasShadowMemory = __has_feature(address_sanitizer);
#else
constexpr bool kHasShadowMemory = false;
#endif

constexpr char kComplete = 'E';  // The last byte of what comes whole.

void Limit(int resource, rlim_t most) {
  const rlimit limit{most, most};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

bool WriteAll(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// Bytes that this process has for data, which a child begins with.
rlim_t DataInUse() {
  rlim_t pages = 0;
  std::ifstream counts("/proc/self/statm");
  for (int field = 0; field < 6; ++field) counts >> pages;  // total, resident, shared, code, nothing, data
  return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

/// The child: other threads of the process are not there, and nothing of theirs may be waited for.
[[noreturn]] void BeChild(int descriptor, const std::function<std::string()>& work, int seconds, rlim_t in_use) {
  constexpr rlim_t kMemory = rlim_t{1} << 32;
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU}) std::signal(signal, SIG_DFL);
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, standard);
  Limit(RLIMIT_CORE, 0);
  Limit(RLIMIT_CPU, seconds);
  if (!kHasShadowMemory) Limit(RLIMIT_DATA, in_use + kMemory);
  try {
    if (WriteAll(descriptor, work())) WriteAll(descriptor, {&kComplete, 1});
  } catch (...) {
    std::_Exit(1);
  }
  std::_Exit(0);
}

std::string ReadAll(int descriptor) {
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  std::string bytes;
  while (true) {
    const std::size_t used = bytes.size();
    bytes.resize(used + std::max(used, kBlock));
    const ssize_t got = ::read(descriptor, bytes.data() + used, bytes.size() - used);
    bytes.resize(used + (got > 0 ? static_cast<std::size_t>(got) : 0));
    if (got == 0 || (got < 0 && errno != EINTR)) return bytes;
  }
}

tl::unexpected<Status> NoProcess() {
  return Error(StatusCode::kTryAgain, "no process could be started to read it in; try again");
}

}  // namespace

Result<std::string> InChild(const std::function<std::string()>& work, int seconds) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) return NoProcess();
  const auto [from, to] = pipe;
  const rlim_t in_use = DataInUse();
  const pid_t child = ::fork();
  if (child == 0) BeChild(to, work, seconds, in_use);
  ::close(to);
  std::string bytes = child < 0 ? "" : ReadAll(from);
  ::close(from);
  if (child < 0) return NoProcess();
  int ended = 0;
  while (::waitpid(child, &ended, 0) < 0 && errno == EINTR) continue;
  if (!bytes.ends_with(kComplete)) return Error(StatusCode::kDataLoss, "");
  bytes.pop_back();
  return bytes;
}

}  // namespace pendulum
