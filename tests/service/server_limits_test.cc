// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/service/served.h"

namespace pendulum::server_limits_test {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

class ServerLimitsTest : public Served {
 protected:
  /// Fills the threads of the fits and their queue: 2 running and 3 waiting requests.
  std::vector<RawClient> FillFits() {
    std::vector<RawClient> clients;
    for (int i = 0; i < 5; ++i) {
      clients.push_back(Connect());
      clients.back().Send(Get("/fit"));
      const std::size_t all = clients.size();
      EXPECT_TRUE(Eventually([&] { return server_->Count().running + server_->Count().waiting == all; }));
    }
    EXPECT_TRUE(Eventually([&] { return handler_.waiting == 2; }));
    return clients;
  }
};

TEST_F(ServerLimitsTest, RejectsATooLongHead) {
  options_.max_head = 1000;
  Start();
  const std::string before = "GET / HTTP/1.1\r\nHost: a\r\nX: ", after = "\r\n\r\n";
  const std::size_t room = 1000 - before.size() - after.size();
  EXPECT_EQ(Connect().Ask(before + std::string(room, 'x') + after).status, 200);
  EXPECT_EQ(Connect().Ask(before + std::string(room + 1, 'x') + after).status, 431);
  RawClient endless = Connect();
  const RawAnswer answer = endless.Ask("GET /" + std::string(5000, 'x'));
  EXPECT_EQ(answer.status, 431);
  EXPECT_THAT(answer.body, HasSubstr("1000 bytes"));
  EXPECT_TRUE(endless.IsEnded());
}

TEST_F(ServerLimitsTest, RejectsATooLargeBodyBeforeReadingIt) {
  Start();
  EXPECT_EQ(Connect().Ask(Post("/", std::string(100'000, 'x'))).status, 200);
  RawClient client = Connect();
  const RawAnswer answer = client.Ask("POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 100001\r\n\r\n");
  EXPECT_EQ(answer.status, 413);
  EXPECT_THAT(answer.body, HasSubstr("100000 bytes"));
  EXPECT_EQ(Connect().Ask("POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 18446744073709551615\r\n\r\n").status, 413);
  EXPECT_EQ(handler_.calls, 1);
}

TEST_F(ServerLimitsTest, ChecksAccessBeforeTheBodyLength) {
  Start();
  EXPECT_EQ(Connect().Ask("POST /refused HTTP/1.1\r\nHost: a\r\nContent-Length: 100001\r\n\r\n").status, 401);
}

TEST_F(ServerLimitsTest, RejectsABodyThatGrowsTooLargeInChunks) {
  Start();
  RawClient client = Connect();
  client.Send("POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n");
  const std::string chunk = "2710\r\n" + std::string(10'000, 'x') + "\r\n";
  for (int i = 0; i < 10; ++i) client.Send(chunk);
  client.Send("1\r\nx\r\n");
  EXPECT_EQ(client.Read().status, 413);
  EXPECT_EQ(handler_.calls, 0);
  EXPECT_TRUE(Eventually([&] { return server_->Count().buffered == 0; }));
}

TEST_F(ServerLimitsTest, RejectsATooLargeChunkBeforeReadingIt) {
  Start();
  for (const std::string size : {"186a1", "ffffffffffffffff"}) {  // 100001
    EXPECT_EQ(Connect().Ask("POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n" + size + "\r\n").status,
              413);
  }
  EXPECT_EQ(handler_.calls, 0);
}

TEST_F(ServerLimitsTest, AnswersAClientThatSendsFarTooMuch) {
  Start();
  RawClient client = Connect();
  client.Send("POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 600000\r\n\r\n");
  client.Send(std::string(600'000, 'x'));
  EXPECT_EQ(client.Read().status, 413);
}

TEST_F(ServerLimitsTest, LimitsAllBodiesTogether) {
  options_.max_connections = 20;
  Start();
  std::vector<RawClient> clients;
  for (int i = 0; i < 3; ++i) {  // each announces 100000 bytes and sends all but the last one
    clients.push_back(Connect());
    clients.back().Send("POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 100000\r\n\r\n" + std::string(99'999, 'x'));
  }
  EXPECT_TRUE(Eventually([&] { return server_->Count().buffered == 299'997; }));
  EXPECT_EQ(Connect().Ask(Post("/", "abc")).status, 200);
  RawClient one_more = Connect();
  const RawAnswer answer = one_more.Ask(Post("/", "abcd"));
  EXPECT_EQ(answer.status, 429);
  EXPECT_EQ(answer["retry-after"], "1");
  for (RawClient& client : clients) EXPECT_EQ(client.Ask("x").status, 200);
  EXPECT_TRUE(Eventually([&] { return server_->Count().buffered == 0; }));
  EXPECT_EQ(Connect().Ask(Post("/", "abcd")).status, 200);
}

TEST_F(ServerLimitsTest, RefusesOnlyRequestsForAFullLane) {
  Start();
  std::vector<RawClient> fits = FillFits();
  EXPECT_EQ(server_->Count().waiting, 3);
  RawClient client = Connect();
  const RawAnswer answer = client.Ask(Post("/fit", "data"));
  EXPECT_EQ(answer.status, 429);
  EXPECT_EQ(answer["retry-after"], "1");
  EXPECT_EQ(client.Ask(Get("/quick")).body, "GET /quick\n") << "on the same connection";
  EXPECT_EQ(client.Ask(Get("/readings")).body, "GET /readings\n");
  handler_.gate.count_down();
  for (RawClient& fit : fits) EXPECT_EQ(fit.Read().status, 200);
  EXPECT_EQ(client.Ask(Get("/fit")).status, 200);
}

TEST_F(ServerLimitsTest, DropsARequestThatWaitsTooLong) {
  options_.wait_time = milliseconds(1000);  // a busy machine can take 50 ms to receive five requests
  Start();
  std::vector<RawClient> fits = FillFits();
  std::this_thread::sleep_for(milliseconds(1200));
  handler_.gate.count_down();
  std::vector<int> statuses;
  for (RawClient& fit : fits) statuses.push_back(fit.Read().status);
  EXPECT_THAT(statuses, testing::ElementsAre(200, 200, 408, 408, 408));
}

TEST_F(ServerLimitsTest, ServesWaitingRequestsInOrder) {
  options_.fit_threads = 1;
  std::string order;
  handler_.answer = [&](const HttpRequest& request) {
    order += request.target.back();
    return HttpResponse{200, {}, "", nullptr};
  };
  Start();
  std::vector<RawClient> clients;
  for (const std::string target : {"/fit1", "/fit2", "/fit3", "/fit4"}) {
    clients.push_back(Connect());
    clients.back().Send(Get(target));
    const std::size_t all = clients.size();
    EXPECT_TRUE(Eventually([&] { return server_->Count().running + server_->Count().waiting == all; }));
  }
  handler_.gate.count_down();
  for (RawClient& client : clients) EXPECT_EQ(client.Read().status, 200);
  EXPECT_EQ(order, "1234");
}

TEST_F(ServerLimitsTest, ReportsTooManyConnections) {
  options_.max_connections = 4;
  options_.yield_time = std::chrono::minutes(1);
  Start();
  std::vector<RawClient> clients;
  for (int i = 0; i < 4; ++i) {
    clients.push_back(Connect());
    EXPECT_EQ(clients.back().Ask(Get("/")).status, 200);
  }
  RawClient client = Connect();
  client.Send(Get("/"));
  const RawAnswer answer = client.Read();
  EXPECT_EQ(answer.status, 503);
  EXPECT_EQ(answer["retry-after"], "1");
  EXPECT_TRUE(client.IsEnded());
  clients.pop_back();
  EXPECT_TRUE(Eventually([&] { return server_->Count().connections == 3; }));
  EXPECT_EQ(Connect().Ask(Get("/")).status, 200);
}

// Connections without a request, or with an endless head, must not block other clients.
TEST_F(ServerLimitsTest, ClosesIdleConnectionsForNewOnes) {
  options_.max_connections = 4;
  options_.yield_time = milliseconds(0);
  Start();
  RawClient fit = Connect();
  fit.Send(Get("/fit"));
  EXPECT_TRUE(Eventually([&] { return handler_.waiting == 1; }));
  RawClient slow = Connect();
  EXPECT_TRUE(Eventually([&] { return server_->Count().connections == 2; }));
  RawClient silent = Connect(), idle = Connect();
  EXPECT_TRUE(Eventually([&] { return server_->Count().connections == 4; }));
  slow.Send("GET / HTTP/1.1\r\nHost:");
  EXPECT_EQ(idle.Ask(Get("/")).status, 200);
  RawClient first = Connect(), second = Connect();
  EXPECT_EQ(first.Ask(Get("/")).status, 200);
  EXPECT_EQ(second.Ask(Get("/")).status, 200);
  EXPECT_TRUE(slow.IsEnded());
  EXPECT_TRUE(silent.IsEnded());
  handler_.gate.count_down();
  EXPECT_EQ(fit.Read().status, 200) << "a connection whose request is processed is not closed";
}

TEST_F(ServerLimitsTest, RejectsAFloodOfConnections) {
  options_.max_connections = 4;
  options_.yield_time = std::chrono::minutes(1);
  Start();
  {
    std::vector<RawClient> clients;
    for (int i = 0; i < 200; ++i) clients.push_back(Connect());
    EXPECT_TRUE(Eventually([&] { return server_->Count().accepted == 200; }));
    EXPECT_EQ(server_->Count().connections, 4);
  }
  EXPECT_TRUE(Eventually([&] { return server_->Count().connections == 0; }));
  EXPECT_EQ(Connect().Ask(Get("/")).status, 200);
}

TEST_F(ServerLimitsTest, RejectsARequestThatArrivesTooSlowly) {
  options_.request_time = milliseconds(200);
  Start();
  RawClient head = Connect(), body = Connect(), chunk = Connect();
  head.Send("GET / HTTP/1.1\r\nHost:");
  body.Send("POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 9\r\n\r\nfour");
  chunk.Send("POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n5\r\nfour");
  for (RawClient* client : {&head, &body, &chunk}) {
    const RawAnswer answer = client->Read();
    EXPECT_EQ(answer.status, 408);
    EXPECT_EQ(answer["retry-after"], "1");
    EXPECT_TRUE(client->IsEnded());
  }
}

TEST_F(ServerLimitsTest, DoesNotAnswerEmptyLines) {
  options_.request_time = milliseconds(200);
  Start();
  RawClient client = Connect();
  client.Send("\r\n\r\n");
  EXPECT_TRUE(client.IsEnded());
  EXPECT_TRUE(answered().empty());
}

TEST_F(ServerLimitsTest, DoesNotExtendTheTimeLimitWithEachByte) {
  options_.request_time = milliseconds(200);
  Start();
  RawClient client = Connect();
  client.Send("GET / HTTP/1.1\r\nHost: a\r\nExpect: 100-continue\r\nX: ");
  const bool is_cut_off = Eventually([&] {
    client.Send("x");
    return !answered().empty();
  });
  ASSERT_TRUE(is_cut_off);
  EXPECT_EQ(answered()[0].status, 408);
}

TEST_F(ServerLimitsTest, ClosesAConnectionWithoutARequest) {
  options_.idle_time = milliseconds(2000);  // a busy machine may take a second until the first request arrives
  Start();
  RawClient used = Connect();
  EXPECT_EQ(used.Ask(Get("/")).status, 200);
  EXPECT_TRUE(Connect().IsEnded());
  EXPECT_TRUE(used.IsEnded());
  EXPECT_EQ(answered().size(), 1) << "a connection without a request gets no answer";
}

TEST_F(ServerLimitsTest, DropsAnAnswerThatIsNotRead) {
  options_.request_time = milliseconds(200);
  handler_.answer = [](const HttpRequest&) { return HttpResponse{200, {}, std::string(30'000'000, 'x'), nullptr}; };
  Start();
  RawClient client = Connect(4096);
  client.Send(Get("/large"));
  EXPECT_TRUE(Eventually([&] { return answered().size() == 1; }));
  EXPECT_LT(answered()[0].bytes, 30'000'000);
  EXPECT_TRUE(Eventually([&] { return server_->Count().connections == 0 && server_->Count().buffered == 0; }));
}

TEST_F(ServerLimitsTest, RejectsRequestsWhileAnswersAreUnread) {
  handler_.answer = [](const HttpRequest& request) {
    return HttpResponse{200, {}, std::string(request.target == "/large" ? 30'000'000 : 3, 'x'), nullptr};
  };
  Start();
  RawClient large = Connect(4096);
  large.Send(Get("/large"));
  EXPECT_TRUE(Eventually([&] { return server_->Count().buffered == 30'000'000; }));
  EXPECT_EQ(Connect().Ask(Get("/small")).status, 429);
  large.Reset();
  EXPECT_TRUE(Eventually([&] { return server_->Count().buffered == 0; }));
  EXPECT_EQ(Connect().Ask(Get("/small")).status, 200);
}

TEST_F(ServerLimitsTest, WaitsForFileDescriptors) {
  Start();
  RawClient early = Connect();
  EXPECT_EQ(early.Ask(Get("/")).status, 200);
  const int lowest = ::dup(0);
  ::close(lowest);
  rlimit before = {};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit for_one_more = {static_cast<rlim_t>(lowest) + 1, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &for_one_more), 0);
  RawClient late = Connect();  // takes the last file descriptor, so accept fails
  EXPECT_TRUE(late.is_connected());
  late.Send(Get("/late"));
  EXPECT_EQ(early.Ask(Get("/")).status, 200) << "while accept fails";
  EXPECT_EQ(server_->Count().accepted, 1);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_EQ(late.Read().body, "GET /late\n");
}

TEST_F(ServerLimitsTest, ServesOtherClientsDespiteTwoHundredSlowClients) {
  options_.request_time = milliseconds(60'000);
  Start();
  std::vector<RawClient> slow;
  for (int i = 0; i < 200; ++i) slow.push_back(Connect());
  const std::string request = Post("/fit", "body");
  RawClient quick = Connect();
  for (std::size_t i = 0; i + 1 < request.size(); ++i) {
    for (RawClient& client : slow) EXPECT_TRUE(client.Send(request.substr(i, 1)));
    const bool is_asking = i % 10 == 0;
    EXPECT_TRUE(!is_asking || quick.Ask(Post("/quick", "body")).status == 200);
  }
  EXPECT_EQ(server_->Count().connections, 201);
  EXPECT_TRUE(Eventually([&] { return server_->Count().running == 0; })) << "no slow client blocks a thread";
}

}  // namespace
}  // namespace pendulum::server_limits_test
