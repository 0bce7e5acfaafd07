// SPDX-License-Identifier: Apache-2.0
// Serves fits and the web page over HTTP: flags, signals, log and exit codes.
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
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
#include "pendulum/base/try.h"
#include "pendulum/base/utc_time.h"
#include "pendulum/batch/fit_store.h"
#include "pendulum/service/fitting_service.h"
#include "pendulum/service/server.h"
#include "tools/run_tool.h"
#include "tools/serve_pendulum_options.h"

namespace pendulum {
namespace {

constexpr std::string_view kName = "serve_pendulum";

constexpr const char* kUsage =
    "Fits recordings of a pendulum over HTTP, by a web page or by requests.\n"
    "\n"
    "  serve_pendulum --store fits.sqlite\n"
    "\n"
    "Then http://localhost:8080 is the page, and curl --data-binary @run.csv --header 'Content-Type: text/csv'\n"
    "http://localhost:8080/v1/fits?model=coulomb gives the JSON of fit_pendulum; /openapi.json lists all\n"
    "requests.\n"
    "SIGTERM or Ctrl-C stops it when the requests in progress are answered; batches continue at the next start.\n"
    "\n"
    "Exit codes: 0 stopped, 2 wrong flags, 3 token file not found, 4 a store or token file that cannot be read, 70 a\n"
    "bug, 73 the port or the store is not available, 75 another process writes to the store.\n"
    "\n";

using Flags = ServePendulumFlags;

std::vector<ToolFlag<Flags>> FlagTable() {
  return {
      {"port", &Flags::port, "Port to listen on; 0 chooses a free port and prints it; default 8080."},
      {"address", &Flags::address,
       "Address to listen on, IPv4 or IPv6; default 127.0.0.1, which only this machine can reach."},
      {"store", &Flags::store,
       "SQLite file that stores the fits, with the tables of refit_pendulums; created if it does not exist."},
      {"threads", &Flags::threads, "Number of fits at a time; default 0, one per core."},
      {"token_file", &Flags::token_file,
       "File whose first line is the token that a client must send; default the environment variable PENDULUM_TOKEN, "
       "or no token. Needed for an --address that other machines can reach."},
      {"allowed_hosts", &Flags::allowed_hosts,
       "Host names that clients may use besides localhost, separated by commas, such as the name of a proxy; default "
       "none, or any name if there is a token."},
      {"max_body_mb", &Flags::max_body_mb, "Largest body of a request, MiB; default 32."},
      {"max_samples", &Flags::max_samples, "Longest recording, in samples; default 200000."},
      {"fit_seconds", &Flags::fit_seconds,
       "Longest time of one fit, s; a fit of a batch may take four times as long; default 30."},
      {"max_queue", &Flags::max_queue,
       "Number of requests that may wait for a thread; a further request is refused with 429; default 64."},
      {"max_batch_runs", &Flags::max_batch_runs, "Number of recordings in batches that may wait; default 10000."},
      {"max_connections", &Flags::max_connections, "Number of connections at a time; default 512."},
      {"request_seconds", &Flags::request_seconds, "Longest time to receive a request, s; default 30."},
      {"stop_seconds", &Flags::stop_seconds,
       "How long fits in progress may continue when the service stops, s; default 20."},
      {"live", &Flags::live,
       "File that a running record_pendulum --out writes, to show the recording live on the page; default none."},
      {"docs", &Flags::docs,
       "Folder of the user guide, shown at /docs; default the guide installed with this program."},
  };
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

Result<int> Work(const Flags& flags) {
  ASSIGN_OR_RETURN(const auto token, ReadToken(flags.token_file, std::getenv("PENDULUM_TOKEN")));
  ASSIGN_OR_RETURN(auto options, MakeServePendulumOptions(flags, token));
  options.service.say = LogWithTime;
  if (options.service.docs.empty()) {
    std::error_code fault;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", fault);
    if (!fault) options.service.docs = InstalledGuide(program);
  }
  const sigset_t signals = EndingSignals();
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // before any thread starts, so all threads inherit it
  ASSIGN_OR_RETURN(auto store, FitStore::Open(options.store));
  ASSIGN_OR_RETURN(const auto service, FittingService::Begin(options.service, std::move(store)));
  ASSIGN_OR_RETURN(const auto server, Server::Listen(options.server, *service, [&](const Answered& answered) {
                     service->Count(answered);
                     Log(answered);
                   }));
  service->CountServer([&] { return server->Count(); });
  const SignalWatch watch(*server, *service, flags.stop_seconds);
  std::cout << kName << ": listening on " << AddressText(options.server, server->port()) << '\n' << std::flush;
  server->Run();
  return 0;
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) {
  return pendulum::RunTool(pendulum::kName, __FILE__, pendulum::kUsage, pendulum::FlagTable(), pendulum::Work, argc,
                           argv);
}
