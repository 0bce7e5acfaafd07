// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/served.h"

namespace pendulum::server_events_test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

/// /events sends the numbers 1 to 3, one at a time; /endless never ends, /silent sends nothing, /large sends large
/// events, /broken throws.
class ServerEventsTest : public Served {
 protected:
  ServerEventsTest() {
    handler_.answer = [&](const HttpRequest& request) {
      HttpResponse response;
      if (request.target == "/events") response.events = UpTo(3);
      if (request.target == "/endless") response.events = UpTo(1'000'000);
      if (request.target == "/silent") response.events = [] { return EventText(); };
      if (request.target == "/large") response.events = [] { return EventText{std::string(30'000'000, 'x'), false}; };
      if (request.target == "/broken") response.events = []() -> EventText { throw std::runtime_error("a bug"); };
      return response;
    };
  }

  NextEvents UpTo(int last) {
    return [this, last, next = 1]() mutable {
      ++asked_;
      const int number = next++;
      return EventText{"data: " + std::to_string(number) + "\n\n", number == last};
    };
  }

  /// A client whose stream has begun.
  RawClient Listening(const std::string& target) {
    RawClient client = Connect();
    client.Send(Get(target));
    EXPECT_THAT(client.ReadUntil("\r\n\r\n"), HasSubstr("HTTP/1.1 200 OK\r\n"));
    return client;
  }

  std::atomic<int> asked_ = 0;
};

TEST_F(ServerEventsTest, ArriveInOrderAndEnd) {
  Start();
  RawClient client = Connect();
  const RawAnswer answer = client.Ask(Get("/events"));
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer["content-type"], "text/event-stream");
  EXPECT_EQ(answer["cache-control"], "no-store");
  EXPECT_EQ(answer["connection"], "close");
  EXPECT_EQ(answer.fields.count("content-length"), 0);
  EXPECT_EQ(answer.body, "data: 1\n\ndata: 2\n\ndata: 3\n\n");
  EXPECT_TRUE(client.IsEnded());
  EXPECT_TRUE(Eventually([&] { return server_->Count().streams == 0; }));
  EXPECT_EQ(answered().size(), 1);
}

TEST_F(ServerEventsTest, ArriveWithoutChunksOverHttp10) {
  Start();
  const RawAnswer answer = Connect().Ask("GET /events HTTP/1.0\r\n\r\n");
  EXPECT_EQ(answer.fields.count("transfer-encoding"), 0);
  EXPECT_EQ(answer.body, "data: 1\n\ndata: 2\n\ndata: 3\n\n");
}

TEST_F(ServerEventsTest, AreNotSentForHead) {
  Start();
  RawClient client = Connect();
  const RawAnswer answer = client.Ask("HEAD /events HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_EQ(answer["content-type"], "text/event-stream");
  EXPECT_EQ(client.Ask(Get("/")).status, 200) << "on the same connection";
  EXPECT_EQ(asked_, 0);
}

TEST_F(ServerEventsTest, ArriveOneByOneAtSeveralClients) {
  Start();
  std::vector<RawClient> clients;
  for (int i = 0; i < 10; ++i) clients.push_back(Listening("/endless"));
  for (const std::string number : {"1", "2", "3"}) {
    for (RawClient& client : clients) EXPECT_THAT(client.ReadUntil("\n\n"), EndsWith("data: " + number + "\n\n"));
  }
  EXPECT_EQ(server_->Count().streams, 10);
}

TEST_F(ServerEventsTest, EndForAClientThatDisconnects) {
  Start();
  for (const bool is_reset : {false, true}) {
    for (const std::string target : {"/endless", "/silent"}) {
      RawClient client = Listening(target);
      EXPECT_EQ(server_->Count().streams, 1);
      if (is_reset) client.Reset();
      client.Close();
      EXPECT_TRUE(Eventually([&] { return server_->Count().streams == 0 && server_->Count().connections == 0; }));
    }
  }
  const int asked = asked_;
  EXPECT_EQ(Connect().Ask(Get("/")).status, 200);
  EXPECT_EQ(asked_, asked) << "no events are requested without a client";
}

TEST_F(ServerEventsTest, EndForAClientThatDoesNotRead) {
  options_.request_time = std::chrono::milliseconds(200);
  Start();
  RawClient client = Connect(4096);
  client.Send(Get("/large"));
  EXPECT_TRUE(Eventually([&] { return answered().size() == 1; }));
  EXPECT_LT(answered()[0].bytes, 30'000'000);
  EXPECT_EQ(server_->Count().streams, 0);
}

TEST_F(ServerEventsTest, MayLastLongerThanARequest) {
  options_.request_time = std::chrono::milliseconds(100);
  options_.idle_time = std::chrono::milliseconds(100);
  Start();
  RawClient client = Listening("/endless");
  for (int i = 1; i <= 5; ++i) {  // a tenth of a second each
    EXPECT_THAT(client.ReadUntil("\n\n"), EndsWith("data: " + std::to_string(i) + "\n\n"));
  }
}

TEST_F(ServerEventsTest, AreKeptOpenByComments) {
  options_.max_silence = std::chrono::milliseconds(100);
  Start();
  RawClient client = Listening("/silent");
  for (int i = 0; i < 2; ++i) EXPECT_EQ(client.ReadUntil("\n\n\r\n"), "3\r\n:\n\n\r\n");
}

TEST_F(ServerEventsTest, EndWithoutTheLastChunkAfterAnException) {
  Start();
  RawClient client = Listening("/broken");
  EXPECT_THAT(client.ReadAll(), Not(HasSubstr("0\r\n\r\n")));
  EXPECT_EQ(Connect().Ask(Get("/")).status, 200);
}

TEST_F(ServerEventsTest, LeaveHalfOfTheConnectionsForRequests) {
  options_.max_connections = 6;
  Start();
  std::vector<RawClient> clients;
  for (int i = 0; i < 3; ++i) clients.push_back(Listening("/endless"));
  RawClient client = Connect();
  const RawAnswer answer = client.Ask(Get("/endless"));
  EXPECT_EQ(answer.status, 429);
  EXPECT_EQ(answer["retry-after"], "1");
  EXPECT_EQ(client.Ask(Get("/")).status, 200);
  clients.pop_back();
  EXPECT_TRUE(Eventually([&] { return server_->Count().streams == 2; }));
  clients.push_back(Listening("/endless"));
}

TEST_F(ServerEventsTest, EndWhenTheServerStops) {
  options_.stop_time = std::chrono::milliseconds(3'600'000);
  Start();
  RawClient talking = Listening("/endless"), silent = Listening("/silent"), deaf = Connect(4096);
  deaf.Send(Get("/large"));
  EXPECT_TRUE(Eventually([&] { return server_->Count().streams == 3; }));
  StopAndJoin();
  EXPECT_THAT(talking.ReadAll(), EndsWith("0\r\n\r\n"));
  EXPECT_EQ(silent.ReadAll(), "0\r\n\r\n");
}

}  // namespace
}  // namespace pendulum::server_events_test
