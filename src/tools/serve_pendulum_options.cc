// SPDX-License-Identifier: Apache-2.0
#include "tools/serve_pendulum_options.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <system_error>

#include "pendulum/base/file.h"
#include "pendulum/base/try.h"
#include "pendulum/request/flag_values.h"

namespace pendulum {
namespace {

/// A number flag with its value and limits.
struct NumberFlag {
  std::string_view name;
  int value, least, most;
};

Result<void> CheckNumbers(const ServePendulumFlags& flags) {
  constexpr int kDay = 86'400;
  const std::array numbers = {
      NumberFlag{"--port", flags.port, 0, 65'535},
      NumberFlag{"--threads", flags.threads, 0, 256},
      NumberFlag{"--max_body_mb", flags.max_body_mb, 1, 512},
      NumberFlag{"--max_samples", flags.max_samples, 100, 10'000'000},
      NumberFlag{"--fit_seconds", flags.fit_seconds, 1, kDay},
      NumberFlag{"--max_queue", flags.max_queue, 1, 100'000},
      NumberFlag{"--max_batch_runs", flags.max_batch_runs, 1, 10'000'000},
      NumberFlag{"--max_connections", flags.max_connections, 2, 100'000},
      NumberFlag{"--request_seconds", flags.request_seconds, 1, kDay},
      NumberFlag{"--stop_seconds", flags.stop_seconds, 0, kDay},
  };
  for (const NumberFlag& number : numbers) {
    if (number.value >= number.least && number.value <= number.most) continue;
    return BadFlag(std::string(number.name) + " is " + std::to_string(number.value) + "; it must be " +
                   std::to_string(number.least) + " to " + std::to_string(number.most));
  }
  return {};
}

bool IsLoopbackAddress(const std::string& address) { return address.starts_with("127.") || address == "::1"; }

Result<void> CheckRemoteAccess(const ServePendulumFlags& flags, const std::string& token) {
  if (!token.empty() || IsLoopbackAddress(flags.address)) return {};
  return BadFlag("--address " + flags.address +
                 " is open to other machines, so a token is needed: give a file with --token_file, or set "
                 "PENDULUM_TOKEN; use 127.0.0.1 for this machine only");
}

Result<void> CheckHosts(const ServePendulumFlags& flags) {
  constexpr std::string_view kOfHosts = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._[]:";
  for (const std::string& host : Split(flags.allowed_hosts, ',')) {
    if (!host.empty() && host.find_first_not_of(kOfHosts) == std::string::npos) continue;
    return BadFlag("--allowed_hosts names '" + host + "'; it must be a host such as lab.example or lab.example:8443");
  }
  return {};
}

ServerOptions ServerOptionsOf(const ServePendulumFlags& flags) {
  constexpr std::size_t kMegabyte = std::size_t{1} << 20U;
  ServerOptions server;
  server.address = flags.address;
  server.port = static_cast<std::uint16_t>(flags.port);
  server.fit_threads = flags.threads;
  server.max_queue = static_cast<std::size_t>(flags.max_queue);
  server.max_connections = static_cast<std::size_t>(flags.max_connections);
  server.max_body = static_cast<std::size_t>(flags.max_body_mb) * kMegabyte;
  constexpr std::size_t kBodiesAtOnce = 4;
  server.max_buffered = std::max(server.max_buffered, kBodiesAtOnce * server.max_body);
  server.request_time = std::chrono::seconds(flags.request_seconds);
  server.wait_time = std::chrono::seconds(flags.fit_seconds);
  constexpr std::chrono::seconds kLastAnswers{5};  // to send the answers of fits that are stopped
  server.stop_time = std::chrono::seconds(flags.stop_seconds) + kLastAnswers;
  return server;
}

ServiceOptions ServiceOptionsOf(const ServePendulumFlags& flags, const std::string& token) {
  ServiceOptions service;
  service.limits.max_samples = static_cast<std::size_t>(flags.max_samples);
  service.limits.max_runs = static_cast<std::size_t>(flags.max_batch_runs);
  service.access = {token, Split(flags.allowed_hosts, ',')};
  service.fit_time = std::chrono::seconds(flags.fit_seconds);
  service.threads = flags.threads;
  service.live = flags.live;
  service.docs = flags.docs;
  return service;
}

}  // namespace

Result<ServePendulumOptions> MakeServePendulumOptions(const ServePendulumFlags& flags, const std::string& token) {
  if (!flags.positional.empty()) return BadFlag("'" + flags.positional.front() + "' does not belong to a flag");
  if (flags.store.empty()) {
    return BadFlag("--store is missing: the file that stores the fits, created if it does not exist");
  }
  RETURN_IF_ERROR(CheckNumbers(flags));
  RETURN_IF_ERROR(CheckHosts(flags));
  std::error_code fault;
  if (!flags.docs.empty() && !std::filesystem::is_directory(flags.docs, fault)) {
    return BadFlag("--docs names '" + flags.docs + "'; there is no such folder");
  }
  RETURN_IF_ERROR(CheckRemoteAccess(flags, token));
  return ServePendulumOptions{flags.store, ServerOptionsOf(flags), ServiceOptionsOf(flags, token)};
}

std::string InstalledGuide(const std::filesystem::path& program) {
  return program.parent_path().parent_path() / "share/doc/pendulum/html";
}

Result<std::string> ReadToken(const std::string& token_file, const char* from_environment) {
  std::string token = from_environment == nullptr ? "" : from_environment;
  std::string where = "PENDULUM_TOKEN";
  if (!token_file.empty()) {
    constexpr std::uintmax_t kMaxBytes = 4096;
    auto text = ReadFile(token_file, "token", kMaxBytes);
    if (!text) return text;
    token = text->substr(0, text->find_first_of("\r\n"));
    where = token_file;
    if (token.empty())
      return ErrorAt(StatusCode::kInvalidArgument, where, "the first line is empty; it must be the token");
  }
  if (token.empty()) return token;
  constexpr std::size_t kShortest = 16;
  const bool is_visible = std::ranges::all_of(token, [](char c) { return c > ' ' && c <= '~'; });
  if (token.size() >= kShortest && is_visible) return token;
  return ErrorAt(StatusCode::kInvalidArgument, where,
                 "the token must have at least " + std::to_string(kShortest) +
                     " visible ASCII characters, and no blanks; openssl rand -hex 32 makes one");
}

}  // namespace pendulum
