// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/request_target.h"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::request_target_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

using Query = std::vector<std::pair<std::string, std::string>>;

std::string PathOf(const std::string& target) {
  const auto parsed = ParseTarget(target);
  return parsed ? parsed->path : "refused: " + parsed.error().message();
}

Query QueryOf(const std::string& query) {
  const auto parsed = ParseTarget("/a?" + query);
  EXPECT_TRUE(parsed) << query << ": " << parsed.error().message();
  return parsed ? parsed->query : Query();
}

/// The error message for a refused target.
std::string FaultOf(const std::string& target) {
  const auto parsed = ParseTarget(target);
  if (parsed) return "not refused";
  EXPECT_EQ(parsed.error().code, StatusCode::kInvalidArgument);
  return parsed.error().message();
}

// ---- The path ------------------------------------------------------------------------------------------------------

TEST(ParseTarget, GivesPathAndQueryOfAPlainTarget) {
  const auto target = ParseTarget("/v1/fits?model=drag&limit=5");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/v1/fits");
  EXPECT_THAT(target->query, ElementsAre(Pair("model", "drag"), Pair("limit", "5")));
  EXPECT_EQ(PathOf("/"), "/");
  EXPECT_EQ(PathOf("/?a=1"), "/");
  EXPECT_EQ(PathOf("/app.js"), "/app.js");
}

// RFC 3986, section 2.1: digits in upper or lower case; 2.3: an escaped unreserved character equals the character.
TEST(ParseTarget, DecodesEscapesInThePath) {
  EXPECT_EQ(PathOf("/v1/%66its"), "/v1/fits");
  EXPECT_EQ(PathOf("/%7Euser/%7euser/~"), "/~user/~user/~");
  EXPECT_EQ(PathOf("/a%20b+c"), "/a b+c");  // a plus sign means a blank only in a query
  EXPECT_EQ(PathOf("/100%25"), "/100%");
  EXPECT_EQ(PathOf("/%2525"), "/%25");  // decoded only once
  EXPECT_EQ(PathOf("/a%3Fb%23c"), "/a?b#c");
  EXPECT_EQ(PathOf("/a:@!$&'()*,;=-._"), "/a:@!$&'()*,;=-._");
}

// RFC 3986, section 2.5: "A" with grave accent is %C3%80, KATAKANA LETTER A is %E3%82%A2.
TEST(ParseTarget, ReadsLettersBeyondAscii) {
  EXPECT_EQ(PathOf("/%C3%80/%E3%82%A2/\u00C0"), "/\u00C0/\u30A2/\u00C0");
  EXPECT_THAT(QueryOf("name=%F0%9F%95%B0"), ElementsAre(Pair("name", "\U0001F570")));
}

// RFC 9112, section 3.2.2: a server must accept the absolute form; RFC 3986, section 3.1: schemes ignore case.
TEST(ParseTarget, AcceptsTheAbsoluteForm) {
  EXPECT_EQ(PathOf("http://www.example.org/pub/WWW/TheProject.html"), "/pub/WWW/TheProject.html");
  EXPECT_EQ(PathOf("HTTPS://localhost:8080/a?b=c"), "/a");
  EXPECT_EQ(PathOf("http://localhost"), "/");
  EXPECT_EQ(AuthorityOf("http://www.example.org/pub"), "www.example.org");
  EXPECT_EQ(AuthorityOf("http://localhost:8080?a=/b"), "localhost:8080");
  EXPECT_EQ(AuthorityOf("Http://[::1]:80"), "[::1]:80");
  EXPECT_EQ(AuthorityOf("/http://evil.example/"), "");
  EXPECT_EQ(AuthorityOf(""), "");
  EXPECT_THAT(FaultOf("http:///v1/fits"), HasSubstr("has no host"));
  EXPECT_THAT(FaultOf("http://"), HasSubstr("has no host"));
}

TEST(ParseTarget, RefusesOtherForms) {
  const std::string rule = "does not begin with a slash; write /v1/fits";
  EXPECT_EQ(FaultOf(""), "the path \"\" " + rule);
  EXPECT_EQ(FaultOf("*"), "the path \"*\" " + rule);
  EXPECT_EQ(FaultOf("localhost:80"), "the path \"localhost:80\" " + rule);
  EXPECT_EQ(FaultOf("v1/fits"), "the path \"v1/fits\" " + rule);
  EXPECT_EQ(FaultOf("?a=1"), "the path \"\" " + rule);
  EXPECT_EQ(FaultOf("ftp://localhost/a"), "the path \"ftp://localhost/a\" " + rule);
  EXPECT_THAT(FaultOf("/v1/fits#top"), HasSubstr("has a fragment"));
  EXPECT_THAT(FaultOf("/v1/fits?a=1#top"), HasSubstr("has a fragment"));
}

TEST(ParseTarget, RefusesInvalidSegments) {
  for (const char* target : {"/.", "/..", "/v1/../etc", "/v1/.", "/%2e%2E/etc", "/.%2e", "/a/%2e/b"}) {
    EXPECT_THAT(FaultOf(target), HasSubstr("is not a name; write the path without it")) << target;
  }
  for (const char* target : {"//", "//v1", "/v1//fits", "/v1/", "/v1/fits/?a=1", "///"}) {
    EXPECT_THAT(FaultOf(target), HasSubstr("is empty; write one slash, and none at the end")) << target;
  }
  for (const char* target : {"/a\\b", "/..\\..\\etc", "/a%5Cb", "/a%2fb", "/%2F", "/..%2F..%2Fetc"}) {
    EXPECT_THAT(FaultOf(target), HasSubstr("contains a slash or backslash, which no name has")) << target;
  }
  EXPECT_EQ(PathOf("/..."), "/...");
  EXPECT_EQ(PathOf("/..a/a../.a"), "/..a/a../.a");
}

TEST(ParseTarget, RefusesInvalidEscapes) {
  for (const char* escape : {"%", "%4", "%%", "%4G", "%G4", "%-1", "% 41", "%u0041", "%+1", "%0x41"}) {
    EXPECT_THAT(FaultOf("/" + std::string(escape)), HasSubstr("write a percent sign as %25")) << escape;
    EXPECT_THAT(FaultOf("/a?b=" + std::string(escape)), HasSubstr("write a percent sign as %25")) << escape;
    EXPECT_THAT(FaultOf("/a?" + std::string(escape) + "=b"), HasSubstr("write a percent sign as %25")) << escape;
  }
  EXPECT_EQ(FaultOf("/run%"),
            "the path segment \"run%\" has a % without two hexadecimal digits after it; write a percent sign as %25");
}

// Ill-formed sequences: Unicode 15, table 3-8 and the following tables; RFC 3629, section 10.
TEST(ParseTarget, RefusesInvalidUtf8) {
  for (const char* bytes :
       {"%80",          "%FF",          "%C0%80",    "%C0%AF",    "%C1%BF",       "%E0%80%AF",    "%E0%9F%BF",
        "%F0%80%80%AF", "%F0%8F%BF%BF", "%ED%A0%80", "%ED%BF%BF", "%F4%90%80%80", "%F5%80%80%80", "%C3",
        "%E3%82",       "%F0%9F%95",    "%C3%28",    "%E3%28%A2", "%F0%9F%28%B0", "\xFF",         "%E1%80%E2"}) {
    EXPECT_THAT(FaultOf("/" + std::string(bytes)), HasSubstr("is not UTF-8")) << bytes;
    EXPECT_THAT(FaultOf("/a?b=" + std::string(bytes)), HasSubstr("is not UTF-8")) << bytes;
  }
  for (const char* bytes :
       {"%C2%A0", "%DF%BF", "%E0%A0%80", "%ED%9F%BF", "%EE%80%80", "%EF%BF%BF", "%F0%90%80%80", "%F4%8F%BF%BF"}) {
    EXPECT_EQ(QueryOf("b=" + std::string(bytes)).size(), 1) << bytes;
  }
}

TEST(ParseTarget, RefusesControlCharacters) {
  for (const char* bytes : {"%00", "%0A", "%0d", "%1B[2J", "%1F", "%7F", "%09", "\t", "\x01", "%C2%80", "%C2%9B"}) {
    EXPECT_THAT(FaultOf("/" + std::string(bytes)), HasSubstr("has a control character")) << bytes;
    EXPECT_THAT(FaultOf("/a?name=" + std::string(bytes)), HasSubstr("has a control character")) << bytes;
  }
  EXPECT_THAT(FaultOf(std::string("/a\0b", 4)), HasSubstr("has a control character"));
}

// ---- The query -----------------------------------------------------------------------------------------------------

// WHATWG, URL Standard, section 5.1 (application/x-www-form-urlencoded parsing): its example, and + as a blank.
TEST(ParseTarget, ReadsFormEncodedQueries) {
  EXPECT_THAT(QueryOf("a=b&c"), ElementsAre(Pair("a", "b"), Pair("c", "")));
  EXPECT_THAT(QueryOf("a+b=c+d&e=%2B"), ElementsAre(Pair("a b", "c d"), Pair("e", "+")));
  EXPECT_THAT(QueryOf("a=b=c&d=="), ElementsAre(Pair("a", "b=c"), Pair("d", "=")));
  EXPECT_THAT(QueryOf("&a=1&&b=2&"), ElementsAre(Pair("a", "1"), Pair("b", "2")));
  EXPECT_THAT(QueryOf(""), IsEmpty());
  EXPECT_THAT(QueryOf("&&"), IsEmpty());
  EXPECT_THAT(QueryOf("a=%26%3D%3F%23&b=/?:@"), ElementsAre(Pair("a", "&=?#"), Pair("b", "/?:@")));
}

// Output of Python's urllib.parse.urlencode({"name": "Öl & Wasser/1+1", "init": "inertia=0.01,viscous=2e-3", "path":
// "C:\\a"}).
TEST(ParseTarget, ReadsTargetsWrittenByPython) {
  EXPECT_THAT(
      QueryOf("name=%C3%96l+%26+Wasser%2F1%2B1&init=inertia%3D0.01%2Cviscous%3D2e-3&path=C%3A%5Ca"),
      ElementsAre(Pair("name", "Öl & Wasser/1+1"), Pair("init", "inertia=0.01,viscous=2e-3"), Pair("path", "C:\\a")));
}

TEST(ParseTarget, RefusesARepeatedParameter) {
  EXPECT_EQ(FaultOf("/v1/fits?model=drag&limit=1&model=drag"),
            "the query parameter \"model\" is given twice; keep one of them");
  EXPECT_THAT(FaultOf("/v1/fits?model=drag&%6dodel"), HasSubstr("is given twice"));
  EXPECT_THAT(QueryOf("model=a&Model=b"), ElementsAre(Pair("model", "a"), Pair("Model", "b")));
}

TEST(ParseTarget, RefusesAParameterWithoutAName) {
  EXPECT_EQ(FaultOf("/v1/fits?=drag"), "the query parameter \"=drag\" has no name; write name=value");
  EXPECT_THAT(FaultOf("/v1/fits?a=1&="), HasSubstr("has no name"));
}

TEST(ParseTarget, ReadsManyParameters) {
  constexpr int kMany = 100'000;
  std::string query;
  for (int i = 0; i < kMany; ++i) query += "&p" + std::to_string(i) + "=" + std::to_string(i);
  const Query parsed = QueryOf(query);
  ASSERT_EQ(parsed.size(), kMany);
  EXPECT_THAT(parsed.back(), Pair("p99999", "99999"));
}

TEST(ParseTarget, LimitsTheLengthOfItsMessages) {
  const std::string much(100'000, 'x');
  for (const std::string& target : {"/" + much + "%", "/a?" + much + "=%", "/a?" + much + "&" + much,
                                    "/a?b=" + much + "%FF", "/" + much + "/", much}) {
    EXPECT_LT(FaultOf(target).size(), 300);
  }
}

}  // namespace
}  // namespace pendulum::request_target_test
