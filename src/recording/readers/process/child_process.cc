// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/process/child_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <new>
#include <optional>
#include <string_view>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "pendulum/base/staged_file.h"

namespace pendulum {

#if defined(__SANITIZE_ADDRESS__)
const bool kMemoryIsLimited = false;
#elif defined(__has_feature)
const bool kMemoryIsLimited = !__has_feature(address_sanitizer);
#else
const bool kMemoryIsLimited = true;
#endif

namespace {

using Clock = std::chrono::steady_clock;

constexpr char kComplete = 'E';  // The last byte of a complete answer.
constexpr int kNoMemory = 2;     // Exit status of a process that ran out of memory.

void Limit(int resource, rlim_t soft, rlim_t hard) {
  const rlimit limit{soft, hard};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

/// Bytes of data memory used by this process, which a child inherits.
rlim_t DataInUse() {
  rlim_t pages = 0;
  std::ifstream counts("/proc/self/statm");
  for (int field = 0; field < 6; ++field) counts >> pages;  // total, resident, shared, code, unused, data
  return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

// ---- The child. It has only one thread and must not wait for a lock that another thread of the parent held ---------

/// The handlers of this process would write to descriptors that the child has closed. The parent answers signals that a
/// terminal or a service manager sends to all processes, and the child ends with the parent.
void ResetSignals() {
  for (int signal = 1; signal < NSIG; ++signal) std::signal(signal, SIG_DFL);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
  sigset_t none{};
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

/// Closes all descriptors except this one. Returns its new number, the first after the standard ones, which are
/// redirected to /dev/null.
int KeepOnlyDescriptor(int descriptor) {
  constexpr int kFirst = STDERR_FILENO + 1;
  const int above = ::fcntl(descriptor, F_DUPFD, kFirst);
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, standard);
  if (above != kFirst) ::dup2(above, kFirst);
  if (::close_range(kFirst + 1, ~0U, 0) == 0) return kFirst;
  const int most = static_cast<int>(::sysconf(_SC_OPEN_MAX));  // For kernels before 5.9
  for (int other = kFirst + 1; other < most; ++other) ::close(other);
  return kFirst;
}

[[noreturn]] void RunAsChild(int descriptor, pid_t parent, const std::function<std::string()>& work,
                             const ChildLimits& limits, rlim_t in_use) {
  ResetSignals();
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) std::_Exit(1);
  const int to = KeepOnlyDescriptor(descriptor);
  const auto seconds = static_cast<rlim_t>(limits.processor_seconds);
  Limit(RLIMIT_CORE, 0, 0);
  Limit(RLIMIT_CPU, seconds, seconds + 1);  // The soft limit sends SIGXCPU, the hard limit kills.
  if (kMemoryIsLimited) Limit(RLIMIT_DATA, in_use + limits.memory_bytes, in_use + limits.memory_bytes);
  try {
    if (WriteAll(to, work())) WriteAll(to, {&kComplete, 1});
  } catch (const std::bad_alloc&) {
    std::_Exit(kNoMemory);
  } catch (...) {
    std::_Exit(1);
  }
  std::_Exit(0);
}

// ---- The parent --------------------------------------------------------------------------------------------------

/// A running child process and the reading end of its pipe. The destructor ends the process.
class Child {
 public:
  Child(pid_t process, int from) : process_(process), from_(from) {}
  Child(const Child&) = delete;
  Child(Child&&) = delete;
  Child& operator=(const Child&) = delete;
  Child& operator=(Child&&) = delete;
  ~Child() {
    ::close(from_);
    if (process_ < 0) return;
    ::kill(process_, SIGKILL);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) continue;
  }

  int from() const { return from_; }

  /// The exit status of the process; std::nullopt if it still runs at the deadline.
  std::optional<int> WaitUntil(Clock::time_point deadline) {
    int ended = 0;
    while (::waitpid(process_, &ended, WNOHANG) == 0) {
      if (Clock::now() >= deadline) return std::nullopt;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    process_ = -1;
    return ended;
  }

 private:
  pid_t process_;
  int from_;
};

/// Reads all bytes up to the end of a pipe.
tl::expected<std::string, ChildFailure> ReadAll(int descriptor, Clock::time_point deadline, std::size_t max_bytes) {
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  std::string bytes;
  std::size_t used = 0;
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return tl::unexpected(ChildFailure::kOutOfTime);
    pollfd readable{descriptor, POLLIN, 0};
    const int ready = ::poll(&readable, 1, static_cast<int>(std::min<std::int64_t>(left, 1000)));
    if (ready <= 0) continue;  // the deadline is checked again
    if (used == bytes.size()) bytes.resize(std::min(used + std::max(used, kBlock), max_bytes + 1));
    const ssize_t got = ::read(descriptor, bytes.data() + used, bytes.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    used += static_cast<std::size_t>(got);
    if (used > max_bytes) return tl::unexpected(ChildFailure::kAnswerTooLarge);
  }
  bytes.resize(used);
  return bytes;
}

ChildFailure FailureOfStatus(std::optional<int> ended) {
  if (!ended || (WIFSIGNALED(*ended) && WTERMSIG(*ended) == SIGXCPU)) return ChildFailure::kOutOfTime;
  const bool is_killed = WIFSIGNALED(*ended) && WTERMSIG(*ended) == SIGKILL;  // memory ran out
  const bool has_no_memory = WIFEXITED(*ended) && WEXITSTATUS(*ended) == kNoMemory;
  return is_killed || has_no_memory ? ChildFailure::kOutOfMemory : ChildFailure::kCrashed;
}

}  // namespace

tl::expected<std::string, ChildFailure> RunInChildProcess(const std::function<std::string()>& work,
                                                          const ChildLimits& limits) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) return tl::unexpected(ChildFailure::kNotStarted);
  const auto [from, to] = pipe;
  const Clock::time_point deadline = Clock::now() + limits.time;
  const rlim_t in_use = DataInUse();
  const pid_t parent = ::getpid();
  const pid_t process = ::fork();
  if (process == 0) RunAsChild(to, parent, work, limits, in_use);
  ::close(to);
  Child child(process, from);
  if (process < 0) return tl::unexpected(ChildFailure::kNotStarted);
  try {
    auto bytes = ReadAll(child.from(), deadline, limits.answer_bytes + 1);
    if (!bytes) return bytes;
    if (!bytes->ends_with(kComplete)) return tl::unexpected(FailureOfStatus(child.WaitUntil(deadline)));
    bytes->pop_back();
    return bytes;
  } catch (const std::bad_alloc&) {
    return tl::unexpected(ChildFailure::kOutOfMemory);
  }
}

}  // namespace pendulum
