// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/service/fitting_service.h"
#include "pendulum/service/server.h"

namespace pendulum {

/// The flags of serve_pendulum as they were given.
struct ServePendulumFlags {
  int port = 8080;
  std::string address = "127.0.0.1";
  std::string store;
  int threads = 0;
  std::string token_file;
  std::string allowed_hosts;  ///< Between commas.
  int max_body_mb = 32;
  int max_samples = 200'000;
  int fit_seconds = 30;
  int max_queue = 64;
  int max_batch_runs = 10'000;
  int max_connections = 512;
  int request_seconds = 30;
  int stop_seconds = 20;
  std::string live;
  std::vector<std::string> positional;  ///< What belongs to no flag: a mistake.
};

/// What serve_pendulum is to do.
struct ServePendulumOptions {
  std::string store;  ///< Path.
  ServerOptions server;
  ServiceOptions service;
};

/// Turns flags into options; `token` is what the token file or the environment has, empty for none.
/// kInvalidArgument: a flag is missing or wrong, or others than this machine could ask without a token.
Result<ServePendulumOptions> MakeServePendulumOptions(const ServePendulumFlags& flags, const std::string& token);

/// The token that a file has in its first line, or else the environment's PENDULUM_TOKEN; empty: neither is there.
/// kInvalidArgument: shorter than 16 characters, or with others than visible ASCII ones. Errors as ReadFile.
Result<std::string> ReadToken(const std::string& token_file, const char* from_environment);

}  // namespace pendulum
