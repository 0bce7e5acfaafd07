// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/service/fitting_service.h"
#include "pendulum/service/server.h"

namespace pendulum {

/// The flags of serve_pendulum as given.
struct ServePendulumFlags {
  int port = 8080;
  std::string address = "127.0.0.1";
  std::string store;
  int threads = 0;
  std::string token_file;
  std::string allowed_hosts;  ///< Separated by commas.
  int max_body_mb = 32;
  int max_samples = 200'000;
  int fit_seconds = 30;
  int max_queue = 64;
  int max_batch_runs = 10'000;
  int max_connections = 512;
  int request_seconds = 30;
  int stop_seconds = 20;
  std::string live;
  std::string docs;
  std::vector<std::string> positional;  ///< Arguments that belong to no flag: an error.
};

/// The task of serve_pendulum.
struct ServePendulumOptions {
  std::string store;  ///< Path.
  ServerOptions server;
  ServiceOptions service;
};

/// Converts flags to options. `token`: from the token file or the environment; empty: none. kInvalidArgument: a flag is
/// missing or wrong, the folder of the guide does not exist, or other machines could use the service without a token.
Result<ServePendulumOptions> MakeServePendulumOptions(const ServePendulumFlags& flags, const std::string& token);

/// The folder in which an installation has the user guide: ../share/doc/pendulum/html beside the program's folder.
std::string InstalledGuide(const std::filesystem::path& program);

/// The token in the first line of a file; without a file PENDULUM_TOKEN from the environment; empty if neither is
/// given. kInvalidArgument: shorter than 16 characters, or with characters other than visible ASCII. Errors as
/// ReadFile.
Result<std::string> ReadToken(const std::string& token_file, const char* from_environment);

}  // namespace pendulum
