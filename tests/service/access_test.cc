// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/access.h"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::access_test {
namespace {

using testing::HasSubstr;

constexpr const char* kToken = "correct horse+battery/staple==";

using Fields = std::vector<HttpField>;

HttpRequest Request(const std::string& method, Fields fields, const std::string& target = "/v1/fits") {
  return {method, target, std::move(fields), ""};
}

/// Result of RefuseAccess: "403 the sentence", or "allowed".
std::string Answer(const HttpRequest& request, const AccessRules& rules, Audience audience = Audience::kTokenHolders) {
  const auto problem = RefuseAccess(request, rules, audience);
  return problem ? std::to_string(problem->status()) + " " + problem->detail : "allowed";
}

std::string AnswerOfHost(const std::string& host, const std::vector<std::string>& allowed_hosts = {}) {
  return Answer(Request("GET", {{"Host", host}}), {"", allowed_hosts});
}

std::string AnswerOfToken(const std::string& authorization) {
  return Answer(Request("GET", {{"Host", "lab.example"}, {"Authorization", authorization}}), {kToken, {}});
}

/// Whether a request with these fields in addition to its Host is cross-site.
bool IsForeign(const std::string& method, Fields fields, const std::string& host = "localhost:8080") {
  fields.push_back({"Host", host});
  return IsCrossSite(Request(method, std::move(fields)));
}

// ---- Hosts ---------------------------------------------------------------------------------------------------------

// RFC 6761, section 6.3 (localhost), RFC 1122, section 3.2.1.3 (127.0.0.0/8), RFC 4291, section 2.5.3 (::1).
TEST(IsLoopback, AcceptsTheNamesOfThisMachine) {
  for (const char* host :
       {"localhost", "localhost:8080", "LocalHost:1", "localhost.", "a.localhost", "a.b.localhost:80", "127.0.0.1",
        "127.0.0.1.", "127.0.0.1:65535", "127.255.255.254", "127.1.2.3:0", "[::1]", "[::1]:8080",
        "[0:0:0:0:0:0:0:1]:80", "[0000::0001]", "localhost:"}) {
    EXPECT_TRUE(IsLoopback(host)) << host;
  }
}

TEST(IsLoopback, RejectsOtherHosts) {
  for (const char* host : {"",
                           "example.com",
                           "localhost.example.com",
                           "localhost.example.com:8080",
                           "notlocalhost",
                           "127.0.0.1.example.com",
                           "128.0.0.1",
                           "10.0.0.1",
                           "0.0.0.0",
                           "192.168.1.5",
                           "127.1",
                           "2130706433",
                           "0x7f.0.0.1",
                           "0177.0.0.1",
                           "127.0.0.256",
                           "127.0.0.1.1",
                           "[::]",
                           "[::2]",
                           "[::ffff:127.0.0.1]",
                           "::1",
                           "[::1",
                           "::1]",
                           "[::1]x",
                           "[::1%lo]",
                           "[localhost]",
                           "localhost:x",
                           "localhost:65536",
                           "localhost:-1",
                           "localhost:80:80",
                           "localhost:+80",
                           "user@localhost",
                           "localhost/",
                           "http://localhost",
                           "localhost evil",
                           "localhost,evil.example",
                           "loc%61lhost",
                           "127.0.0.1 ",
                           ".",
                           "..",
                           ":8080",
                           "localhost\r\n",
                           "\xEF\xBD\x8Cocalhost"}) {
    EXPECT_FALSE(IsLoopback(host)) << host;
  }
  EXPECT_FALSE(IsLoopback(std::string("localhost\0.evil.example", 22)));
  EXPECT_FALSE(IsLoopback(std::string("127.0.0.1\0", 10)));
  EXPECT_FALSE(IsLoopback(std::string("[::1\0]", 6)));
}

TEST(IsListedHost, ComparesNamesAndListedPorts) {
  const std::vector<std::string> list = {"lab.example", "Bench.Example:8080", "[2001:db8::5]"};
  for (const char* host : {"lab.example", "LAB.example:1", "lab.example.", "bench.example:8080", "[2001:db8::5]:80"}) {
    EXPECT_TRUE(IsListedHost(host, list)) << host;
  }
  for (const char* host : {"example", "x.lab.example", "lab.example.evil", "bench.example", "bench.example:80",
                           "[2001:db8::6]", "", "*", "lab.example:x"}) {
    EXPECT_FALSE(IsListedHost(host, list)) << host;
  }
  EXPECT_FALSE(IsListedHost("evil.example", {"*", "", "evil.example/", "."}));
  EXPECT_FALSE(IsListedHost("lab.example", {}));
}

TEST(RefuseAccess, RefusesAForeignHostWithoutAToken) {
  EXPECT_EQ(AnswerOfHost("localhost:8080"), "allowed");
  EXPECT_EQ(AnswerOfHost("evil.example:8080"),
            "403 the host \"evil.example:8080\" is not a name of this service; use localhost, or start it with "
            "--allowed_hosts and that name");
  EXPECT_EQ(AnswerOfHost("lab.example:8080", {"lab.example"}), "allowed");
  EXPECT_EQ(Answer(Request("GET", {{"host", "evil.example"}}), {"", {}}, Audience::kAnybody).substr(0, 3), "403");
}

TEST(RefuseAccess, AllowsAnyHostWithAToken) {
  const Fields fields = {{"Host", "whatever.example"}, {"Authorization", std::string("Bearer ") + kToken}};
  EXPECT_EQ(Answer(Request("GET", fields), {kToken, {}}), "allowed");
}

// RFC 9112, section 3.2: a server must answer 400 to a request without Host and to one with several.
TEST(RefuseAccess, RefusesARequestWithoutExactlyOneHost) {
  EXPECT_EQ(Answer(Request("GET", {}), {}), "400 the request has 0 Host fields; it must have one (RFC 9112)");
  EXPECT_EQ(Answer(Request("GET", {{"Host", "localhost"}, {"HOST", "localhost"}}), {}),
            "400 the request has 2 Host fields; it must have one (RFC 9112)");
  EXPECT_EQ(Answer(Request("GET", {{"Host", ""}}), {}).substr(0, 3), "403");
}

// RFC 9112, section 3.2.2: a target in absolute form overrides Host; here both must be allowed.
TEST(RefuseAccess, ChecksTheHostOfAnAbsoluteTarget) {
  const Fields local = {{"Host", "localhost"}}, foreign = {{"Host", "evil.example"}};
  EXPECT_EQ(Answer(Request("GET", local, "http://localhost/v1/fits"), {}), "allowed");
  EXPECT_EQ(Answer(Request("GET", local, "http://evil.example/v1/fits"), {}).substr(0, 3), "403");
  EXPECT_EQ(Answer(Request("GET", local, "http://localhost@evil.example/"), {}).substr(0, 3), "403");
  EXPECT_EQ(Answer(Request("GET", foreign, "http://localhost/v1/fits"), {}).substr(0, 3), "403");
}

// ---- Tokens --------------------------------------------------------------------------------------------------------

TEST(IsSameSecret, ComparesBytes) {
  EXPECT_TRUE(IsSameSecret("", ""));
  EXPECT_TRUE(IsSameSecret(std::string("a\0b", 3), std::string("a\0b", 3)));
  EXPECT_FALSE(IsSameSecret(std::string("a\0b", 3), std::string("a\0c", 3)));
  EXPECT_FALSE(IsSameSecret("a", ""));
  EXPECT_FALSE(IsSameSecret("token", "Token"));
  EXPECT_FALSE(IsSameSecret("token", "token "));
  EXPECT_FALSE(IsSameSecret("token", "toke"));
}

// RFC 9110, section 11.1: the scheme in upper or lower case, followed by one or more blanks.
TEST(RefuseAccess, AcceptsTheRightToken) {
  EXPECT_EQ(AnswerOfToken(std::string("Bearer ") + kToken), "allowed");
  EXPECT_EQ(AnswerOfToken(std::string("bearer   ") + kToken), "allowed");
  EXPECT_EQ(AnswerOfToken(std::string("BEARER ") + kToken + " "), "allowed");
}

TEST(RefuseAccess, RefusesAWrongToken) {
  const std::string another = "401 the token of the request is wrong; send the one in the service's --token_file";
  const std::string right = kToken;
  for (const std::string& token : {right.substr(1), right + "x", right + right, std::string("x"), "C" + right.substr(1),
                                   std::string(1 << 20, 'x'), right + std::string(1, '\0')}) {
    EXPECT_EQ(AnswerOfToken("Bearer " + token), another);
  }
  for (const std::string& value : {right, std::string("Bearer"), std::string("Bearer "), "Basic " + right,
                                   "Bearer" + right, std::string(""), "Bearer\t" + right}) {
    EXPECT_EQ(AnswerOfToken(value),
              "401 the Authorization of the request is not a token; send one, as Authorization: Bearer TOKEN")
        << value;
  }
}

TEST(RefuseAccess, RefusesARequestWithoutAToken) {
  const Fields host = {{"Host", "localhost"}};
  EXPECT_EQ(Answer(Request("GET", host), {kToken, {}}),
            "401 the request has no token; send it as Authorization: Bearer TOKEN");
  EXPECT_EQ(Answer(Request("GET", host), {kToken, {}}, Audience::kAnybody), "allowed");
  const Fields twice = {{"Host", "localhost"},
                        {"Authorization", std::string("Bearer ") + kToken},
                        {"authorization", std::string("Bearer ") + kToken}};
  EXPECT_THAT(Answer(Request("GET", twice), {kToken, {}}),
              HasSubstr("401 the Authorization of the request is not a token"));
}

// RFC 6750, section 3.1.
TEST(RefuseAccess, NamesAnErrorInTheChallengeOnlyForAWrongToken) {
  const auto challenge = [](Fields fields) {
    fields.push_back({"Host", "localhost"});
    const auto problem = RefuseAccess(Request("GET", std::move(fields)), {kToken, {}}, Audience::kTokenHolders);
    return problem && problem->fields.size() == 1 ? problem->fields[0].name + ": " + problem->fields[0].value : "none";
  };
  EXPECT_EQ(challenge({}), "WWW-Authenticate: Bearer realm=\"pendulum\"");
  EXPECT_EQ(challenge({{"Authorization", "Bearer x"}}),
            "WWW-Authenticate: Bearer realm=\"pendulum\", error=\"invalid_token\"");
}

// ---- Browsers ------------------------------------------------------------------------------------------------------

// Fields that Chromium 156 sends when a page of the service calls fetch(), including Fetch Metadata and Origin.
TEST(IsCrossSite, AllowsTheServicesOwnPage) {
  EXPECT_FALSE(IsForeign("POST", {{"Origin", "http://localhost:8080"},
                                  {"Sec-Fetch-Site", "same-origin"},
                                  {"Sec-Fetch-Mode", "cors"},
                                  {"Sec-Fetch-Dest", "empty"}}));
  EXPECT_FALSE(IsForeign("GET", {{"Sec-Fetch-Site", "same-origin"}, {"Sec-Fetch-Mode", "no-cors"}}));
  EXPECT_FALSE(IsForeign("GET", {{"Sec-Fetch-Site", "none"}, {"Sec-Fetch-Mode", "navigate"}}));
}

// Node's fetch sends only Sec-Fetch-Mode: cors; curl and Python send no such field.
TEST(IsCrossSite, AllowsClientsThatAreNoBrowser) {
  EXPECT_FALSE(IsForeign("POST", {{"sec-fetch-mode", "cors"}}));
  EXPECT_FALSE(IsForeign("POST", {}));
  EXPECT_FALSE(IsForeign("DELETE", {{"User-Agent", "curl/7.88.1"}, {"Accept", "*/*"}}));
}

// W3C Fetch Metadata, section 2.4: another port or subdomain is same-site.
TEST(IsCrossSite, RefusesOtherSites) {
  for (const char* site : {"cross-site", "same-site", "something-new", ""}) {
    EXPECT_TRUE(IsForeign("POST", {{"Sec-Fetch-Site", site}})) << site;
    EXPECT_TRUE(IsForeign("GET", {{"Sec-Fetch-Site", site}, {"Sec-Fetch-Mode", "cors"}})) << site;
    EXPECT_TRUE(
        IsForeign("GET", {{"Sec-Fetch-Site", site}, {"Sec-Fetch-Mode", "no-cors"}, {"Sec-Fetch-Dest", "script"}}))
        << site;
    EXPECT_TRUE(IsForeign("GET", {{"Sec-Fetch-Site", site}})) << site;
  }
  EXPECT_TRUE(IsForeign("GET", {{"Sec-Fetch-Site", "same-origin"}, {"sec-fetch-site", "cross-site"}}));
}

TEST(IsCrossSite, AllowsALinkOnAnotherSite) {
  const HttpField site = {"Sec-Fetch-Site", "cross-site"}, mode = {"Sec-Fetch-Mode", "navigate"};
  EXPECT_FALSE(IsForeign("GET", {site, mode, {"Sec-Fetch-Dest", "document"}}));
  EXPECT_FALSE(IsForeign("GET", {site, mode}));
  EXPECT_TRUE(IsForeign("GET", {site, mode, {"Sec-Fetch-Dest", "iframe"}}));
  EXPECT_TRUE(IsForeign("POST", {site, mode, {"Sec-Fetch-Dest", "document"}}));  // a form
  EXPECT_TRUE(IsForeign("DELETE", {site, mode}));
  EXPECT_TRUE(IsForeign("GET", {site, mode, {"Sec-Fetch-Mode", "cors"}}));
}

// RFC 6454, sections 5 and 6: scheme, host and port are compared; a missing port is the scheme's default.
TEST(IsCrossSite, ComparesOriginWithHost) {
  const auto foreign = [](const std::string& origin, const std::string& host) {
    return IsForeign("POST", {{"Origin", origin}}, host);
  };
  EXPECT_FALSE(foreign("http://localhost:8080", "localhost:8080"));
  EXPECT_FALSE(foreign("http://LOCALHOST:8080", "LocalHost:8080"));
  EXPECT_FALSE(foreign("http://[::1]:8080", "[::1]:8080"));
  EXPECT_FALSE(foreign("http://localhost", "localhost"));
  EXPECT_FALSE(foreign("http://localhost", "localhost:80"));
  EXPECT_FALSE(foreign("https://lab.example", "lab.example"));  // behind a proxy
  EXPECT_FALSE(foreign("https://lab.example", "lab.example:443"));
  for (const char* origin :
       {"http://localhost:8081", "http://localhost", "http://127.0.0.1:8080", "http://evil.example",
        "http://localhost.evil.example:8080", "http://localhost:8080.evil.example", "https://localhost",
        "chrome-extension://abc", "file://", "localhost:8080", "", "http://localhost:8080/",
        "http://evil@localhost:8080", "http://localhost:8080 http://evil.example", "NULL"}) {
    EXPECT_TRUE(foreign(origin, "localhost:8080")) << origin;
    EXPECT_TRUE(IsForeign("GET", {{"Origin", origin}})) << origin;
  }
  EXPECT_TRUE(IsForeign("POST", {{"Origin", "http://localhost:8080"}, {"origin", "http://evil.example"}}));
  EXPECT_TRUE(foreign("http://localhost:443", "localhost"));
  EXPECT_TRUE(IsCrossSite(Request("POST", {{"Origin", "http://localhost"}})));  // no Host
}

// The origin of a sandboxed frame or a file:// page is null (WHATWG HTML, section 7.1.1).
TEST(IsCrossSite, RefusesOriginNullForWrites) {
  EXPECT_TRUE(IsForeign("POST", {{"Origin", "null"}}));
  EXPECT_TRUE(IsForeign("DELETE", {{"Origin", "null"}}));
  EXPECT_FALSE(IsForeign("GET", {{"Origin", "null"}}));
  EXPECT_FALSE(IsForeign("HEAD", {{"Origin", "null"}}));
  EXPECT_TRUE(IsForeign("GET", {{"Origin", "null"}, {"Sec-Fetch-Site", "cross-site"}}));
}

TEST(RefuseAccess, RefusesAnotherSiteWithAnyToken) {
  const std::string fault =
      "403 the request comes from a page of another site; this service answers only its own page and programs";
  EXPECT_EQ(Answer(Request("POST", {{"Host", "localhost"}, {"Origin", "http://evil.example"}}), {}), fault);
  EXPECT_EQ(Answer(Request("POST", {{"Host", "lab.example"},
                                    {"Sec-Fetch-Site", "cross-site"},
                                    {"Authorization", std::string("Bearer ") + kToken}}),
                   {kToken, {}}),
            fault);
  EXPECT_EQ(Answer(Request("GET", {{"Host", "localhost"}, {"Sec-Fetch-Site", "cross-site"}}), {}, Audience::kAnybody),
            fault);
}

}  // namespace
}  // namespace pendulum::access_test
