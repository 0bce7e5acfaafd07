// SPDX-License-Identifier: Apache-2.0
// Serves fits over HTTP, and the page: flags, signals, log and exit codes.
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <gflags/gflags.h>
#include <pthread.h>
#include <unistd.h>

#include "pendulum/base/staged_file.h"
#include "pendulum/base/utc_time.h"
#include "pendulum/batch/fit_store.h"
#include "pendulum/service/fitting_service.h"
#include "pendulum/service/server.h"
#include "tools/run_tool.h"
#include "tools/serve_pendulum_options.h"

DEFINE_int32(port, 8080, "Port to listen on; 0 chooses a free port and prints it; default 8080.");
DEFINE_string(address, "127.0.0.1",
              "Address to listen on, IPv4 or IPv6; default 127.0.0.1, which only this machine can reach.");
DEFINE_string(store, "",
              "File that stores the fits (SQLite, with the tables of refit_pendulums); created if it does not exist.");
DEFINE_int32(threads, 0, "Fits at a time; default 0, as many as there are cores.");
DEFINE_string(token_file, "",
              "File whose first line is the token that a client must send; default the environment variable "
              "PENDULUM_TOKEN, or none. Needed for an --address that other machines reach.");
DEFINE_string(allowed_hosts, "",
              "Host names that clients may use besides localhost, between commas, such as a proxy's; default none, and "
              "any with a token.");
DEFINE_int32(max_body_mb, 32, "Largest body of a request, MiB; default 32.");
DEFINE_int32(max_samples, 200000, "Longest recording, in samples; default 200000.");
DEFINE_int32(fit_seconds, 30, "Longest time of one fit, s; one of a batch has four times as long; default 30.");
DEFINE_int32(max_queue, 64, "Requests that may wait for a thread; one more is refused with 429; default 64.");
DEFINE_int32(max_batch_runs, 10000, "Recordings of batches that may wait; default 10000.");
DEFINE_int32(max_connections, 512, "Connections at a time; default 512.");
DEFINE_int32(request_seconds, 30, "Longest time for a request to come in, s; default 30.");
DEFINE_int32(stop_seconds, 20, "How long fits in progress may take when the service stops, s; default 20.");
DEFINE_string(live, "",
              "The file that a running record_pendulum --out writes, to show it live on the page; default none.");
DEFINE_string(docs, "", "Folder of the user guide, shown at /docs; default the guide installed with this program.");

namespace pendulum {
namespace {

constexpr std::string_view kName = "serve_pendulum";

constexpr const char* kUsage =
    "Fits recordings of a pendulum over HTTP, and shows a page for it.\n"
    "\n"
    "  serve_pendulum --store fits.sqlite\n"
    "\n"
    "Then http://localhost:8080 is the page, and curl --data-binary @run.csv --header 'Content-Type: text/csv'\n"
    "http://localhost:8080/v1/fits?model=coulomb gives the JSON of fit_pendulum; /openapi.json has the rest.\n"
    "SIGTERM or Ctrl-C stops it when the requests in progress are answered; batches continue at the next start.\n"
    "\n"
    "Exit codes: 0 stopped, 2 wrong flags, 3 token file not found, 4 a store or token file that cannot be read, 70 a\n"
    "bug, 73 the port or the store is not available, 75 another process writes to the store.\n"
    "\n";

ServePendulumFlags CurrentFlags(const std::vector<std::string>& positional) {
  ServePendulumFlags flags;
  flags.port = FLAGS_port;
  flags.address = FLAGS_address;
  flags.store = FLAGS_store;
  flags.threads = FLAGS_threads;
  flags.token_file = FLAGS_token_file;
  flags.allowed_hosts = FLAGS_allowed_hosts;
  flags.max_body_mb = FLAGS_max_body_mb;
  flags.max_samples = FLAGS_max_samples;
  flags.fit_seconds = FLAGS_fit_seconds;
  flags.max_queue = FLAGS_max_queue;
  flags.max_batch_runs = FLAGS_max_batch_runs;
  flags.max_connections = FLAGS_max_connections;
  flags.request_seconds = FLAGS_request_seconds;
  flags.stop_seconds = FLAGS_stop_seconds;
  flags.live = FLAGS_live;
  flags.docs = FLAGS_docs;
  flags.positional = positional;
  return flags;
}

/// Prints one line on standard error in a single write, so lines of several threads do not mix.
void LogWithTime(const std::string& words) { (void)WriteAll(STDERR_FILENO, UtcTimeText() + " " + words + "\n"); }

sigset_t EndingSignals() {
  sigset_t signals;
  ::sigemptyset(&signals);
  ::sigaddset(&signals, SIGINT);
  ::sigaddset(&signals, SIGTERM);
  return signals;
}

/// Waits for SIGINT or SIGTERM, which all threads block, and stops the server. Fits that exceed the stop time are
/// stopped too. A second signal ends the process at once.
class SignalWatch {
 public:
  SignalWatch(Server& server, FittingService& service, int stop_seconds)
      : thread_([this, &server, &service, stop_seconds] { Wait(server, service, stop_seconds); }) {}
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;
  SignalWatch(SignalWatch&&) = delete;
  SignalWatch& operator=(SignalWatch&&) = delete;

  ~SignalWatch() {
    is_over_ = true;
    ::pthread_kill(thread_.native_handle(), SIGINT);
    thread_.join();
  }

 private:
  void Wait(Server& server, FittingService& service, int stop_seconds) {
    const sigset_t signals = EndingSignals();
    int signal = 0;
    ::sigwait(&signals, &signal);
    if (is_over_) return;
    LogWithTime("stopping");
    service.Stop();
    server.Stop();
    const timespec patience{stop_seconds, 0};
    if (::sigtimedwait(&signals, nullptr, &patience) < 0) {
      service.StopFits();
      ::sigwait(&signals, &signal);
    }
    if (!is_over_) ::_exit(kInterrupted);
  }

  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

/// Logs one line per answer, without the request's query and body.
void Log(const Answered& answered) {
  constexpr std::size_t kMaxShown = 200;
  std::string path = answered.target.substr(0, std::min(answered.target.find('?'), kMaxShown));
  std::ranges::replace_if(
      path, [](char c) { return c <= ' ' || c > '~'; }, '?');  // control characters could control a terminal
  LogWithTime(answered.peer + " " + answered.method + " " + path + " " + std::to_string(answered.status) + " " +
              std::to_string(answered.bytes) + " B " + std::to_string(answered.time.count() / 1000) + " ms");
}

std::string AddressText(const ServerOptions& options, std::uint16_t port) {
  const bool is_v6 = options.address.find(':') != std::string::npos;
  return "http://" + (is_v6 ? "[" + options.address + "]" : options.address) + ":" + std::to_string(port);
}

Result<int> Work(const std::vector<std::string>& positional) {
  const ServePendulumFlags flags = CurrentFlags(positional);
  const auto token = ReadToken(flags.token_file, std::getenv("PENDULUM_TOKEN"));
  if (!token) return tl::unexpected(token.error());
  auto options = MakeServePendulumOptions(flags, *token);
  if (!options) return tl::unexpected(options.error());
  options->service.say = LogWithTime;
  if (options->service.docs.empty()) {
    std::error_code fault;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", fault);
    if (!fault) options->service.docs = InstalledGuide(program);
  }
  const sigset_t signals = EndingSignals();
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // before any thread starts, so all threads inherit it
  auto store = FitStore::Open(options->store);
  if (!store) return tl::unexpected(store.error());
  const auto service = FittingService::Begin(options->service, *std::move(store));
  if (!service) return tl::unexpected(service.error());
  const auto server = Server::Listen(options->server, **service, [&](const Answered& answered) {
    (*service)->Count(answered);
    Log(answered);
  });
  if (!server) return tl::unexpected(server.error());
  (*service)->CountServer([&] { return (*server)->Count(); });
  const SignalWatch watch(**server, **service, flags.stop_seconds);
  std::cout << kName << ": listening on " << AddressText(options->server, (*server)->port()) << '\n' << std::flush;
  (*server)->Run();
  return 0;
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) {
  return pendulum::RunTool({pendulum::kName, __FILE__, pendulum::kUsage, pendulum::Work}, argc, argv);
}
