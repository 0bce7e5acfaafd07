// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/server.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <optional>
#include <set>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

#include "pendulum/base/try.h"
#include "service/connection.h"

namespace pendulum {
namespace {

namespace asio = boost::asio;
using boost::asio::ip::tcp;
using ErrorCode = boost::system::error_code;

/// Pause after a failed accept, for example without free file descriptors; an immediate retry would fail too.
constexpr std::chrono::milliseconds kAfterFailedAccept{100};

/// Limit for rejected connections that get an answer at the same time; further ones are closed without an answer.
constexpr std::size_t kMaxRejected = 64;

std::size_t ThreadsOf(int threads) {
  return threads > 0 ? static_cast<std::size_t>(threads) : std::max(1U, std::thread::hardware_concurrency());
}

}  // namespace

struct Server::State {
  State(ServerOptions wanted, HttpHandler& handler, std::function<void(const Answered&)> answered)
      : options(std::move(wanted)),
        budget(options.max_buffered),
        acceptor(io),
        pause(io),
        stop_timer(io),
        work(io.get_executor()),
        quick(ThreadsOf(options.quick_threads), options.max_queue),
        fits(ThreadsOf(options.fit_threads), options.max_queue),
        readings(ThreadsOf(options.readings_threads), options.max_queue),
        serving{.options = options,
                .handler = handler,
                .answered = std::move(answered),
                .io = io,
                .budget = budget,
                .quick = quick,
                .fits = fits,
                .readings = readings,
                .closed = [this](const auto& c) { Forget(c); }} {}

  Result<void> Bind();
  void Accept();
  void CloseLongestIdle();
  void AddConnection(tcp::socket socket);
  void Forget(const std::shared_ptr<wire::Connection>& connection);
  void BeginStop();
  void EndStop();
  void DropAll();
  void CloseLanes();

  // The order matters: each member is destroyed before the members to which it refers.
  const ServerOptions options;
  wire::ByteBudget budget;
  asio::io_context io{1};
  tcp::acceptor acceptor;
  asio::steady_timer pause, stop_timer;
  std::optional<asio::executor_work_guard<asio::io_context::executor_type>> work;
  std::set<std::shared_ptr<wire::Connection>> connections, rejected;
  std::atomic<std::size_t> open = 0;
  std::atomic<std::uint64_t> accepted = 0;
  std::uint16_t port = 0;
  wire::WorkQueue quick, fits, readings;
  wire::Serving serving;
};

Result<void> Server::State::Bind() {
  const std::string name = options.address + ":" + std::to_string(options.port);
  ErrorCode code;
  const asio::ip::address address = asio::ip::make_address(options.address, code);
  if (code) {
    return Error(StatusCode::kInvalidArgument,
                 "address \"" + options.address + "\": not an IPv4 or IPv6 address; give one such as 127.0.0.1 or ::1");
  }
  const tcp::endpoint endpoint(address, options.port);
  acceptor.open(endpoint.protocol(), code);
  if (!code) acceptor.set_option(tcp::acceptor::reuse_address(true), code);
  if (!code) acceptor.bind(endpoint, code);
  if (!code) acceptor.listen(asio::socket_base::max_listen_connections, code);
  if (!code) port = acceptor.local_endpoint(code).port();
  if (!code) return {};
  return Error(StatusCode::kCannotWrite,
               "cannot listen on " + name + ": " + code.message() + "; choose another address or port");
}

void Server::State::Accept() {
  acceptor.async_accept([this](const ErrorCode& code, tcp::socket socket) {
    if (!acceptor.is_open()) return;
    if (!code) {
      Accept();  // first, so an exception below affects only this connection
      return AddConnection(std::move(socket));
    }
    pause.expires_after(kAfterFailedAccept);
    pause.async_wait([this](const ErrorCode&) {
      if (acceptor.is_open()) Accept();
    });
  });
}

/// Closes the connection that has been idle longest, so idle connections cannot block new clients.
void Server::State::CloseLongestIdle() {
  const auto waiting_time = [](const auto& connection) { return connection->waited(); };
  const auto longest = std::ranges::max_element(connections, {}, waiting_time);
  if (longest == connections.end() || waiting_time(*longest) <= options.yield_time) return;
  const auto longest_idle = connections.extract(longest);  // keeps it alive while it reports its end
  longest_idle.value()->Close();
}

void Server::State::AddConnection(tcp::socket socket) {
  ++accepted;
  if (connections.size() >= options.max_connections) CloseLongestIdle();
  const bool exceeds_limit = connections.size() >= options.max_connections;
  if (exceeds_limit && rejected.size() >= kMaxRejected) return;
  const auto connection = std::make_shared<wire::Connection>(std::move(socket), serving);
  (exceeds_limit ? rejected : connections).insert(connection);
  open = connections.size();
  if (!exceeds_limit) return connection->Start();
  connection->RejectConnection(503, "too many connections are open; try again later");
}

void Server::State::Forget(const std::shared_ptr<wire::Connection>& connection) {
  connections.erase(connection);
  rejected.erase(connection);
  open = connections.size();
  EndStop();
}

void Server::State::BeginStop() {
  ErrorCode ignored;
  acceptor.close(ignored);
  pause.cancel();
  stop_timer.expires_after(options.stop_time);
  stop_timer.async_wait([this](const ErrorCode& code) {
    if (!code) DropAll();
  });
  const auto all = connections;
  for (const auto& connection : all) connection->Finish();
  EndStop();
}

void Server::State::EndStop() {
  if (acceptor.is_open() || !connections.empty()) return;
  stop_timer.cancel();
  work.reset();
}

void Server::State::DropAll() {
  auto all = connections;
  all.merge(rejected);
  for (const auto& connection : all) connection->Close();
  io.stop();
}

void Server::State::CloseLanes() {
  for (wire::WorkQueue* const lane : {&quick, &fits, &readings}) lane->Close();
}

Result<std::unique_ptr<Server>> Server::Listen(const ServerOptions& options, HttpHandler& handler,
                                               std::function<void(const Answered&)> answered) {
  try {
    auto state = std::make_unique<State>(options, handler, std::move(answered));
    RETURN_IF_ERROR(state->Bind());
    return std::make_unique<Server>(std::move(state));
  } catch (const std::exception& error) {
    return Error(StatusCode::kTryAgain, std::string("the server cannot start, ") + error.what() +
                                            "; use fewer threads, or end other processes");
  }
}

Server::Server(std::unique_ptr<State> state) : state_(std::move(state)) {}

Server::~Server() { state_->CloseLanes(); }

std::uint16_t Server::port() const { return state_->port; }

void Server::Run() {
  state_->Accept();
  for (bool is_done = false; !is_done;) {
    try {
      state_->io.run();
      is_done = true;
    } catch (const std::exception&) {  // out of memory for this connection; its time limit will close it
      continue;
    }
  }
  state_->CloseLanes();
}

void Server::Stop() {
  if (state_->serving.is_stopping.exchange(true)) return;
  asio::post(state_->io, [state = state_.get()] { state->BeginStop(); });
}

bool Server::is_stopping() const { return state_->serving.is_stopping; }

ServerCounts Server::Count() const {
  const State& state = *state_;
  return {.connections = state.open,
          .waiting = state.quick.waiting() + state.fits.waiting() + state.readings.waiting(),
          .running = state.quick.running() + state.fits.running() + state.readings.running(),
          .streams = state.serving.streams,
          .buffered = state.budget.taken(),
          .accepted = state.accepted,
          .answered = state.serving.answers,
          .refused = state.serving.refusals};
}

}  // namespace pendulum
