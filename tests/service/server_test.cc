// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/server.h"

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/served.h"

namespace pendulum::server_test {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class ServerTest : public Served {};

TEST_F(ServerTest, AnswersManyRequestsOnOneConnection) {
  Start();
  RawClient client = Connect();
  for (int i = 0; i < 20; ++i) {
    const std::string target = "/echo?i=" + std::to_string(i);
    const RawAnswer answer = client.Ask(i % 2 == 0 ? Get(target) : Post(target, "body"));
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.body, (i % 2 == 0 ? "GET " + target + "\n" : "POST " + target + "\nbody"));
    EXPECT_EQ(answer["connection"], "keep-alive");
  }
  EXPECT_EQ(server_->Count().accepted, 1);
  EXPECT_EQ(server_->Count().answered, 20);
  EXPECT_EQ(server_->Count().refused, 0);
}

TEST_F(ServerTest, ReplacesTheContentLengthOfTheHandlerAndAddsTheDate) {
  handler_.answer = [](const HttpRequest&) {
    return HttpResponse{201, {{"Location", "/v1/fits/1"}, {"Content-Length", "7"}}, "made", nullptr};
  };
  Start();
  const RawAnswer answer = Connect().Ask(Get("/"));
  EXPECT_THAT(answer.head, StartsWith("HTTP/1.1 201 Created\r\n"));
  EXPECT_EQ(answer["location"], "/v1/fits/1");
  EXPECT_EQ(answer["content-length"], "4");
  EXPECT_EQ(answer.body, "made");
  EXPECT_THAT(answer["date"], testing::MatchesRegex("..., [0-9]+ ... [0-9]+ [0-9]+:[0-9]+:[0-9]+ GMT"));
}

TEST_F(ServerTest, AnswersPipelinedRequestsInTheirOrder) {
  Start();
  RawClient client = Connect();
  client.Send(Get("/first") + Post("/second", "two") + "\r\n" + Get("/third") + Get("/refused") + Get("/fifth"));
  EXPECT_EQ(client.Read().body, "GET /first\n");
  EXPECT_EQ(client.Read().body, "POST /second\ntwo");
  EXPECT_EQ(client.Read().body, "GET /third\n");
  EXPECT_EQ(client.Read().status, 401);
  EXPECT_EQ(client.Read().body, "GET /fifth\n");
}

TEST_F(ServerTest, AcceptsARequestByteByByte) {
  Start();
  RawClient client = Connect();
  for (const char byte : Post("/slow", "body") + Get("/next")) client.Send({&byte, 1});
  EXPECT_EQ(client.Read().body, "POST /slow\nbody");
  EXPECT_EQ(client.Read().body, "GET /next\n");
}

TEST_F(ServerTest, JoinsChunksAndDropsTrailers) {
  std::vector<std::string> names;
  handler_.answer = [&](const HttpRequest& request) {
    for (const HttpField& field : request.fields) names.push_back(field.name);
    return HttpResponse{200, {}, request.body, nullptr};
  };
  Start();
  RawClient client = Connect();
  client.Send(
      "POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: Chunked\r\n\r\n"
      "5\r\nchunk\r\n3;name=value\r\ned \r\nA\r\n0123456789\r\n0\r\nAuthorization: Bearer x\r\n\r\n" +
      Get("/next"));
  EXPECT_EQ(client.Read().body, "chunked 0123456789");
  EXPECT_EQ(client.Read().status, 200);
  EXPECT_THAT(names, Each(Not("Authorization")));
}

TEST_F(ServerTest, AnswersHeadWithTheHeadOfGet) {
  Start();
  RawClient client = Connect();
  const RawAnswer head = client.Ask("HEAD /page HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const RawAnswer get = client.Ask(Get("/page"));
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head["content-length"], std::to_string(get.body.size()));
  EXPECT_EQ(get.body, "GET /page\n") << "the handler gets HEAD as GET";
  EXPECT_TRUE(Eventually([&] { return answered().size() == 2; }));
  EXPECT_EQ(answered()[0].method, "HEAD");
  EXPECT_EQ(answered()[1].method, "GET");
}

TEST_F(ServerTest, SendsNoBodyAndNoLengthWithStatus204) {
  handler_.answer = [](const HttpRequest& request) {
    return HttpResponse{request.target == "/gone" ? 204 : 200, {}, "text", nullptr};
  };
  Start();
  RawClient client = Connect();
  const RawAnswer none = client.Ask(Get("/gone"));
  EXPECT_EQ(none.status, 204);
  EXPECT_EQ(none["content-length"], "");
  EXPECT_EQ(client.Ask(Get("/there")).body, "text");
}

TEST_F(ServerTest, ClosesOnRequest) {
  Start();
  RawClient client = Connect();
  const RawAnswer answer = client.Ask(Get("/", "Connection: close\r\n"));
  EXPECT_EQ(answer["connection"], "close");
  EXPECT_TRUE(client.IsEnded());
}

TEST_F(ServerTest, ServesHttp10AndClosesAfterwards) {
  Start();
  RawClient client = Connect();
  const RawAnswer answer = client.Ask("GET /old HTTP/1.0\r\nConnection: keep-alive\r\n\r\n");
  EXPECT_EQ(answer.body, "GET /old\n");
  EXPECT_EQ(answer["connection"], "close");
  EXPECT_TRUE(client.IsEnded());
}

TEST_F(ServerTest, AcceptsTheTargetOfAProxy) {
  Start();
  RawClient client = Connect();
  EXPECT_EQ(client.Ask("GET http://localhost:80/path?a=b HTTP/1.1\r\nHost: localhost:80\r\n\r\n").body,
            "GET /path?a=b\n");
  EXPECT_EQ(client.Ask("GET HTTP://localhost HTTP/1.1\r\nHost: localhost\r\n\r\n").body, "GET /\n");
  EXPECT_EQ(client.Ask("GET http://other/ HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 400);
}

TEST_F(ServerTest, IgnoresAnUpgrade) {
  Start();
  const RawAnswer answer = Connect().Ask(Get("/", "Connection: Upgrade\r\nUpgrade: websocket\r\n"));
  EXPECT_EQ(answer.status, 200);
}

TEST_F(ServerTest, SendsContinueOnceTheHeadIsAccepted) {
  Start();
  RawClient client = Connect();
  client.Send("POST /a HTTP/1.1\r\nHost: a\r\nContent-Length: 4\r\nExpect: 100-continue\r\n\r\n");
  EXPECT_EQ(client.Read().status, 100);
  client.Send("body");
  EXPECT_EQ(client.Read().body, "POST /a\nbody");
}

TEST_F(ServerTest, ReadsNoBodyOfARejectedHead) {
  Start();
  RawClient client = Connect();
  const RawAnswer answer =
      client.Ask("POST /refused HTTP/1.1\r\nHost: a\r\nContent-Length: 4\r\nExpect: 100-continue\r\n\r\n");
  EXPECT_EQ(answer.status, 401) << "and not 100";
  EXPECT_EQ(answer["www-authenticate"], "Bearer");
  EXPECT_EQ(answer["connection"], "close");
  EXPECT_EQ(handler_.calls, 0);
}

TEST_F(ServerTest, LetsARejectedClientReadTheAnswer) {
  Start();
  RawClient client = Connect();
  client.Send("POST /refused HTTP/1.1\r\nHost: a\r\nContent-Length: 90000\r\n\r\n");
  client.Send(std::string(90'000, 'x'));
  EXPECT_EQ(client.Read().body, "who is there?");
}

TEST_F(ServerTest, KeepsAConnectionAfterRejectingABodylessRequest) {
  Start();
  RawClient client = Connect();
  EXPECT_EQ(client.Ask(Get("/refused")).status, 401);
  EXPECT_EQ(client.Ask(Get("/")).status, 200);
}

TEST_F(ServerTest, AnswersAClientThatHasEndedSending) {
  Start();
  RawClient client = Connect();
  client.Send(Post("/half", "body"));
  client.EndSending();
  EXPECT_EQ(client.Read().body, "POST /half\nbody");
  EXPECT_TRUE(client.IsEnded());
}

TEST_F(ServerTest, TellsTheHandlerOfAFitThatTheClientHasGone) {
  Start();
  std::atomic<int> gone = 0;
  handler_.gate.count_down();
  handler_.answer = [&](const HttpRequest& request) {
    if (Eventually([&] { return request.client_gone.stop_requested(); })) ++gone;
    return HttpResponse{200, {}, "", nullptr};
  };
  RawClient closed = Connect(), reset = Connect();
  closed.Send(Post("/fit/closed", "body"));
  reset.Send(Post("/fit/reset", "body"));
  EXPECT_TRUE(Eventually([&] { return handler_.waiting == 2; }));
  closed.Close();
  reset.Reset();
  EXPECT_TRUE(Eventually([&] { return gone == 2; }));
}

TEST_F(ServerTest, KeepsTheFitOfAClientThatHasOnlyEndedSending) {
  Start();
  RawClient client = Connect();
  client.Send(Post("/fit", "body"));
  client.EndSending();
  EXPECT_EQ(client.Read().status, 102);  // asks whether the client is there
  handler_.answer = [](const HttpRequest& request) {
    return HttpResponse{200, {}, request.client_gone.stop_requested() ? "gone" : "there", nullptr};
  };
  handler_.gate.count_down();
  EXPECT_EQ(client.Read().body, "there");
}

TEST_F(ServerTest, ReportsAClientThatEndsWithinItsRequest) {
  Start();
  for (const std::string begun : {"GET / HT", "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 9\r\n\r\nfour"}) {
    RawClient client = Connect();
    client.Send(begun);
    client.EndSending();
    EXPECT_EQ(client.Read().status, 400) << begun;
  }
}

TEST_F(ServerTest, SurvivesAnExceptionOfTheHandler) {
  Start();
  RawClient client = Connect();
  const RawAnswer answer = client.Ask(Get("/throw"));
  EXPECT_EQ(answer.status, 500);
  EXPECT_EQ(answer.body, "the handler's bug");
  EXPECT_EQ(client.Ask(Get("/after")).body, "GET /after\n");
}

TEST_F(ServerTest, RemovesLineBreaksFromFieldValues) {
  handler_.answer = [](const HttpRequest&) {
    return HttpResponse{200, {{"X-Name", "run\r\nSet-Cookie: a=b"}, {"Bad\r\nName", "v"}, {"X", "y"}}, "", nullptr};
  };
  Start();
  const RawAnswer answer = Connect().Ask(Get("/"));
  EXPECT_EQ(answer.fields.count("set-cookie"), 0);
  EXPECT_EQ(answer["x-name"], "run  Set-Cookie: a=b");
  EXPECT_THAT(answer.head, Not(HasSubstr("Name: v")));
  EXPECT_EQ(answer["x"], "y");
}

TEST_F(ServerTest, ReplacesAnInvalidStatusBy500) {
  handler_.answer = [](const HttpRequest&) { return HttpResponse{0, {}, "", nullptr}; };
  Start();
  EXPECT_EQ(Connect().Ask(Get("/")).status, 500);
}

TEST_F(ServerTest, SendsAnAnswerOfManyPieces) {
  std::string text(5'000'000, ' ');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>('a' + i % 23);
  handler_.answer = [&](const HttpRequest&) { return HttpResponse{200, {}, text, nullptr}; };
  Start();
  RawClient client = Connect();
  EXPECT_EQ(client.Ask(Get("/")).body, text);
  EXPECT_TRUE(Eventually([&] { return server_->Count().buffered == 0; }));
}

TEST_F(ServerTest, ServesSixtyFourClientsAtOnce) {
  options_.max_queue = 64;
  Start();
  std::vector<std::thread> clients;
  std::atomic<int> right = 0;
  for (int i = 0; i < 64; ++i) {
    clients.emplace_back([&, i] {
      RawClient client = Connect();
      for (int k = 0; k < 10; ++k) {
        const std::string body = std::to_string(1000 * i + k);
        right += client.Ask(Post("/x", body)).body == "POST /x\n" + body ? 1 : 0;
      }
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(right, 640);
  EXPECT_EQ(handler_.calls, 640);
}

TEST_F(ServerTest, ReportsEachAnswer) {
  Start();
  RawClient client = Connect();
  const RawAnswer answer = client.Ask(Post("/some?where", "body"));
  EXPECT_TRUE(Eventually([&] { return answered().size() == 1; }));
  const Answered report = answered().at(0);
  EXPECT_EQ(report.method, "POST");
  EXPECT_EQ(report.target, "/some?where");
  EXPECT_EQ(report.peer, "127.0.0.1");
  EXPECT_EQ(report.status, 200);
  EXPECT_EQ(report.bytes, answer.head.size() + answer.body.size());
  EXPECT_GT(report.time.count(), 0);
}

TEST(Listen, RefusesAnInvalidAddress) {
  EchoHandler handler;
  ServerOptions options;
  options.address = "localhost.example";
  const auto server = Server::Listen(options, handler, nullptr);
  ASSERT_FALSE(server);
  EXPECT_EQ(server.error().code, StatusCode::kInvalidArgument);
  EXPECT_THAT(server.error().message(), HasSubstr("address \"localhost.example\""));
}

TEST(Listen, ReportsAPortInUse) {
  EchoHandler handler;
  ServerOptions options;
  options.port = 0;
  const auto first = Server::Listen(options, handler, nullptr);
  ASSERT_TRUE(first);
  options.port = (*first)->port();
  const auto second = Server::Listen(options, handler, nullptr);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, StatusCode::kCannotWrite);
  EXPECT_THAT(second.error().message(), HasSubstr("127.0.0.1:" + std::to_string(options.port)));
}

TEST(Listen, AcceptsAnIpv6Address) {
  EchoHandler handler;
  ServerOptions options;
  options.address = "::1";
  options.port = 0;
  const auto server = Server::Listen(options, handler, nullptr);
  // A machine may lack this address; the system reports that when binding.
  EXPECT_TRUE(server ? (*server)->port() > 0 : server.error().code == StatusCode::kCannotWrite);
}

}  // namespace
}  // namespace pendulum::server_test
