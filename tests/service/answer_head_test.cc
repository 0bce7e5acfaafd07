// SPDX-License-Identifier: Apache-2.0
#include "service/answer_head.h"

#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace pendulum::answer_head_test {
namespace {

using wire::AnswerHead;
using wire::HttpDate;
using wire::MayHaveBody;

TEST(HttpDate, MatchesTheStandardsExample) {
  EXPECT_EQ(HttpDate(784111777), "Sun, 06 Nov 1994 08:49:37 GMT");   // RFC 9110, section 5.6.7; date -d @784111777
  EXPECT_EQ(HttpDate(1709164800), "Thu, 29 Feb 2024 00:00:00 GMT");  // date -u -d @1709164800
}

TEST(AnswerHead, HasStatusFieldsAndFraming) {
  const HttpResponse response{404, {{"Content-Type", "text/plain"}}, "", nullptr};
  EXPECT_EQ(AnswerHead(response, {12, false, true}, 784111777),
            "HTTP/1.1 404 Not Found\r\nContent-Type: text/plain\r\nDate: Sun, 06 Nov 1994 08:49:37 GMT\r\n"
            "Content-Length: 12\r\nConnection: keep-alive\r\n\r\n");
  EXPECT_EQ(AnswerHead({200, {}, "", nullptr}, {std::nullopt, true, false}, 784111777),
            "HTTP/1.1 200 OK\r\nDate: Sun, 06 Nov 1994 08:49:37 GMT\r\nTransfer-Encoding: chunked\r\n"
            "Connection: close\r\n\r\n");
}

TEST(AnswerHead, OmitsFieldsReservedForTheServer) {
  const HttpResponse response{200,
                              {{"content-length", "1"},
                               {"TRANSFER-ENCODING", "chunked"},
                               {"Connection", "keep-alive"},
                               {"Date", "today"},
                               {"", "a"},
                               {"B c", "d"},
                               {"E:", "f"},
                               {"G\r\nH", "i"}},
                              "",
                              nullptr};
  EXPECT_EQ(AnswerHead(response, {}, 784111777),
            "HTTP/1.1 200 OK\r\nDate: Sun, 06 Nov 1994 08:49:37 GMT\r\nConnection: close\r\n\r\n");
}

TEST(AnswerHead, ReplacesControlCharactersByBlanks) {
  const HttpResponse response{200, {{"X", std::string("a\rb\nc\0d\te\x7f", 10) + "ü"}}, "", nullptr};
  EXPECT_EQ(AnswerHead(response, {}, 784111777),
            "HTTP/1.1 200 OK\r\nX: a b c d\te ü\r\nDate: Sun, 06 Nov 1994 08:49:37 GMT\r\nConnection: close\r\n\r\n");
}

TEST(AnswerHead, HasReasonPhrasesForAllUsedStatuses) {
  const auto line = [](int status) { return AnswerHead({status, {}, "", nullptr}, {}, 0).substr(0, 30); };
  EXPECT_EQ(line(431), "HTTP/1.1 431 Request Header Fi");
  EXPECT_EQ(line(429).substr(0, 26), "HTTP/1.1 429 Too Many Requ");
  EXPECT_EQ(line(507).substr(0, 25), "HTTP/1.1 507 Insufficient");
  EXPECT_EQ(line(555).substr(0, 15), "HTTP/1.1 555 \r\n");
}

TEST(MayHaveBody, FollowsTheStandard) {  // RFC 9110, section 6.4.1
  EXPECT_FALSE(MayHaveBody(100));
  EXPECT_FALSE(MayHaveBody(204));
  EXPECT_FALSE(MayHaveBody(304));
  EXPECT_TRUE(MayHaveBody(200));
  EXPECT_TRUE(MayHaveBody(404));
}

}  // namespace
}  // namespace pendulum::answer_head_test
