// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/served.h"

namespace pendulum::server_stop_test {
namespace {

using std::chrono::milliseconds;

class ServerStopTest : public Served {
 protected:
  /// Stops the server while `client` waits for a fit; the gate stays closed.
  RawClient StopDuringAFit() {
    RawClient client = Connect();
    client.Send(Get("/fit"));
    EXPECT_TRUE(Eventually([&] { return handler_.waiting == 1; }));
    server_->Stop();
    EXPECT_TRUE(server_->is_stopping());
    EXPECT_TRUE(Eventually([&] { return !Connect().is_connected(); }));
    return client;
  }
};

TEST_F(ServerStopTest, ReturnsAtOnceIfIdle) {
  options_.stop_time = milliseconds(3'600'000);
  Start();
  StopAndJoin();
  EXPECT_EQ(server_->Count().connections, 0);
}

TEST_F(ServerStopTest, ReturnsAtOnceIfStoppedBeforeRun) {
  auto server = Server::Listen(options_, handler_, nullptr);
  ASSERT_TRUE(server);
  (*server)->Stop();
  (*server)->Run();
  EXPECT_TRUE((*server)->is_stopping());
}

TEST_F(ServerStopTest, ClosesIdleConnections) {
  options_.stop_time = milliseconds(3'600'000);
  Start();
  RawClient fresh = Connect(), used = Connect();
  EXPECT_EQ(used.Ask(Get("/")).status, 200);
  EXPECT_TRUE(Eventually([&] { return server_->Count().connections == 2; }));
  StopAndJoin();
  EXPECT_TRUE(fresh.IsEnded());
  EXPECT_TRUE(used.IsEnded());
}

TEST_F(ServerStopTest, AnswersRequestsInProgressAndCloses) {
  Start();
  RawClient client = StopDuringAFit();
  handler_.gate.count_down();
  const RawAnswer answer = client.Read();
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body, "GET /fit\n");
  EXPECT_EQ(answer["connection"], "close");
  EXPECT_TRUE(client.IsEnded());
}

TEST_F(ServerStopTest, AnswersRequestsWaitingInALane) {
  options_.fit_threads = 1;
  Start();
  RawClient waiting = Connect();
  RawClient running = Connect();
  running.Send(Get("/fit"));
  EXPECT_TRUE(Eventually([&] { return handler_.waiting == 1; }));
  waiting.Send(Get("/fit?waits"));
  EXPECT_TRUE(Eventually([&] { return server_->Count().waiting == 1; }));
  StopAndJoin();
  EXPECT_EQ(running.Read().body, "GET /fit\n");
  EXPECT_EQ(waiting.Read().body, "GET /fit?waits\n");
}

TEST_F(ServerStopTest, ReadsTheRemainderOfAnAcceptedRequest) {
  Start();
  RawClient client = Connect();
  client.Send("POST /late HTTP/1.1\r\nHost: a\r\nContent-Length: 4\r\n\r\nbo");
  EXPECT_TRUE(Eventually([&] { return handler_.heads == 1; }));
  RawClient fit = StopDuringAFit();
  EXPECT_EQ(client.Ask("dy").body, "POST /late\nbody");
}

TEST_F(ServerStopTest, RefusesLaterRequests) {
  Start();
  RawClient client = Connect();
  client.Send(Get("/first") + "GET /second HTTP/1.1\r\nHo");
  EXPECT_EQ(client.Read().body, "GET /first\n");
  EXPECT_TRUE(Eventually([&] { return answered().size() == 1; })) << "the server now reads the second request";
  RawClient fit = StopDuringAFit();
  const RawAnswer answer = client.Ask("st: a\r\n\r\n");
  EXPECT_EQ(answer.status, 503);
  EXPECT_EQ(answer["retry-after"], "1");
  EXPECT_EQ(answer["connection"], "close");
  EXPECT_TRUE(client.IsEnded());
}

TEST_F(ServerStopTest, RespectsTheTimeLimit) {
  options_.stop_time = milliseconds(100);
  Start();
  RawClient slow = Connect();
  slow.Send("POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 4\r\n\r\nbo");
  EXPECT_TRUE(Eventually([&] { return handler_.heads == 1; }));
  RawClient client = StopDuringAFit();
  EXPECT_TRUE(client.IsEnded()) << "although its handler has not returned";
  EXPECT_TRUE(slow.IsEnded());
  EXPECT_EQ(server_->Count().running, 1);
  StopAndJoin();
  EXPECT_EQ(server_->Count().running, 0);
}

}  // namespace
}  // namespace pendulum::server_stop_test
