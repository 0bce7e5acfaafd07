// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/served.h"

namespace pendulum::malformed_requests_test {
namespace {

using testing::HasSubstr;

class MalformedRequestsTest : public Served {
 protected:
  /// Sends bytes followed by a second request, which must not be parsed, and returns everything received until the end.
  RawAnswer Ask(const std::string& bytes) {
    RawClient client = Connect();
    client.Send(bytes + Get("/smuggled"));
    const RawAnswer answer = client.Read();
    EXPECT_TRUE(client.ReadAll().empty()) << "after " << bytes.substr(0, 1000);
    EXPECT_EQ(answer["connection"], "close") << bytes.substr(0, 1000);
    return answer;
  }

  void ExpectRefused(const std::vector<std::string>& all) {
    Start();
    for (const std::string& bytes : all) EXPECT_EQ(Ask(bytes).status, 400) << bytes.substr(0, 1000);
    EXPECT_EQ(handler_.calls, 0);
    EXPECT_EQ(Connect().Ask(Get("/")).status, 200);
  }
};

TEST_F(MalformedRequestsTest, AreRefusedForTwoLengths) {  // RFC 9112, section 6.3 and 11.2
  const std::string post = "POST / HTTP/1.1\r\nHost: a\r\n", body = "\r\n0\r\n\r\n";
  ExpectRefused({
      post + "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n" + body,
      post + "Transfer-Encoding: chunked\r\nContent-Length: 5\r\n" + body,
      post + "Content-Length: 5\r\nContent-Length: 6\r\n" + body,
      post + "Content-Length: 5\r\nContent-Length: 5\r\n" + body,
      post + "Content-Length: 5, 5\r\n" + body,
      post + "Content-Length: 0, 0\r\n" + body,
      post + "Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n" + body,
      post + "Transfer-Encoding: chunked\r\nTransfer-Encoding: identity\r\n" + body,
      post + "Transfer-Encoding: identity\r\nContent-Length: 5\r\n" + body,
  });
}

TEST_F(MalformedRequestsTest, AreRefusedIfTheLengthIsUnknown) {
  const std::string post = "POST / HTTP/1.1\r\nHost: a\r\n", body = "\r\n0\r\n\r\n";
  ExpectRefused({
      post + "Transfer-Encoding: gzip, chunked\r\n" + body,
      post + "Transfer-Encoding: chunked, gzip\r\n" + body,
      post + "Transfer-Encoding: chunked, chunked\r\n" + body,
      post + "Transfer-Encoding: xchunked\r\n" + body,
      post + "Transfer-Encoding: \"chunked\"\r\n" + body,
      post + "Transfer-Encoding:\r\n" + body,
      post +
          "Transfer-Encoding: \x0b"
          "chunked\r\n" +
          body,
      "POST / HTTP/1.0\r\nHost: a\r\nTransfer-Encoding: chunked\r\n" + body,
      post + "Content-Length: +5\r\n" + body,
      post + "Content-Length: -5\r\n" + body,
      post + "Content-Length: 0x5\r\n" + body,
      post + "Content-Length: 5.0\r\n" + body,
      post + "Content-Length: 5 5\r\n" + body,
      post + "Content-Length:\r\n" + body,
      post + "Content-Length: 99999999999999999999\r\n" + body,
      post + "Content-Length: 18446744073709551616\r\n" + body,
  });
}

TEST_F(MalformedRequestsTest, AreRefusedForAmbiguousHeads) {
  using namespace std::string_literals;  // NOLINT: for the NUL within
  ExpectRefused({
      "GET / HTTP/1.1\r\nHost: a\r\nX: one\r\n two\r\n\r\n",
      "GET / HTTP/1.1\r\nHost: a\r\nX: one\r\n\ttwo\r\n\r\n",
      "GET / HTTP/1.1\r\n Host: a\r\n\r\n",
      "GET / HTTP/1.1\r\nHost: a\r\nX: \0\r\n\r\n"s,
      "GET /\0 HTTP/1.1\r\nHost: a\r\n\r\n"s,
      "GET / HTTP/1.1\nHost: a\n\n",
      "GET / HTTP/1.1\r\nHost: a\r\nX: b\n\r\n",
      "GET / HTTP/1.1\r\nHost: a\r\nX: b\rc\r\n\r\n",
      "GET / HTTP/1.1\r\nHost: a\r\nContent-Length : 5\r\n\r\n",
      "GET / HTTP/1.1\r\nHost: a\r\nX\tY: 5\r\n\r\n",
      "GET / HTTP/1.1\r\nHost: a\r\nno colon\r\n\r\n",
      "GET / HTTP/1.1\r\nHost: a\r\n: empty\r\n\r\n",
      "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n",
      "GET / HTTP/1.1\r\n\r\n",
      "GET  / HTTP/1.1\r\nHost: a\r\n\r\n",
      "GET / a HTTP/1.1\r\nHost: a\r\n\r\n",
      "GET / HTTP/1.1 \r\nHost: a\r\n\r\n",
      " GET / HTTP/1.1\r\nHost: a\r\n\r\n",
      "GE(T / HTTP/1.1\r\nHost: a\r\n\r\n",
  });
}

TEST_F(MalformedRequestsTest, AreRefusedIfMeantForAnotherService) {
  ExpectRefused({
      "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
      "GET / HTTP/1.2\r\nHost: a\r\n\r\n",
      "GET / HTTP/3.0\r\nHost: a\r\n\r\n",
      "GET / HTTPS/1.1\r\nHost: a\r\n\r\n",
      "CONNECT a:443 HTTP/1.1\r\nHost: a\r\n\r\n",
      "TRACE / HTTP/1.1\r\nHost: a\r\n\r\n",
      "GET path HTTP/1.1\r\nHost: a\r\n\r\n",
      "GET * HTTP/1.1\r\nHost: a\r\n\r\n",
      "GET ftp://a/ HTTP/1.1\r\nHost: a\r\n\r\n",
      "GET http://a@b/ HTTP/1.1\r\nHost: b\r\n\r\n",
  });
}

TEST_F(MalformedRequestsTest, AreAnsweredEarlyIfNotHttp) {
  Start();
  for (const std::string& bytes : {std::string("\x16\x03\x01\x02\x00\x01", 6), std::string("GET /\r\n"),
                                   std::string("EHLO there\r\n"), std::string("GET / HTTP/1.1\n")}) {
    RawClient client = Connect();
    EXPECT_EQ(client.Ask(bytes).status, 400) << bytes;
    EXPECT_TRUE(client.IsEnded());
  }
}

TEST_F(MalformedRequestsTest, AreRefusedForInvalidChunks) {
  const std::string post = "POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n";
  ExpectRefused({
      post + "x\r\nabc\r\n0\r\n\r\n",
      post + "-3\r\nabc\r\n0\r\n\r\n",
      post + "3\r\nabcd\r\n0\r\n\r\n",
      post + "3\nabc\r\n0\r\n\r\n",
      post + "\r\n3\r\nabc\r\n0\r\n\r\n",
      post + "3 x\r\nabc\r\n0\r\n\r\n",
      post + "10000000000000003\r\nabc\r\n0\r\n\r\n",
      post + "3\r\nabc\r\n0\r\nTransfer-Encoding: chunked\r\n\r\n",
      post + "3\r\nabc\r\n0\r\nno colon\r\n\r\n",
      post + "3;" + std::string(100'000, 'x') + "\r\nabc\r\n0\r\n\r\n",
      post + "3\r\nabc\r\n0\r\nX: " + std::string(100'000, 'x') + "\r\n\r\n",
  });
}

TEST_F(MalformedRequestsTest, AreRefusedForAnUnknownExpectation) {
  Start();
  const RawAnswer answer = Ask("POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 4\r\nExpect: 200-ok\r\n\r\nbody");
  EXPECT_EQ(answer.status, 417);
  EXPECT_THAT(answer.body, HasSubstr("\"200-ok\""));
}

TEST_F(MalformedRequestsTest, AreAlwaysAnswered) {
  Start();
  const std::string valid = Post("/path?a=b", "a body", "X-Some: thing\r\nConnection: close\r\n");
  std::mt19937 random(20261123);
  const auto any = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  for (int i = 0; i < 500; ++i) {
    std::string bytes = valid;
    for (std::size_t k = 0; k <= any(3); ++k) {
      const std::size_t at = any(bytes.size());
      switch (any(3)) {
        case 0: bytes[at] = static_cast<char>(any(256)); break;
        case 1: bytes.erase(at, any(8)); break;
        default: bytes.insert(at, bytes.substr(any(bytes.size()), any(12))); break;
      }
      if (bytes.empty()) bytes = "x";
    }
    RawClient client = Connect();
    client.Send(bytes);
    client.EndSending();
    const std::string all = client.ReadAll();
    EXPECT_TRUE(all.empty() || all.starts_with("HTTP/1.1 ")) << bytes;
    EXPECT_TRUE(!all.empty() || bytes.find_first_not_of("\r\n") == std::string::npos) << bytes;
  }
  EXPECT_EQ(Connect().Ask(Get("/")).status, 200);
}

}  // namespace
}  // namespace pendulum::malformed_requests_test
