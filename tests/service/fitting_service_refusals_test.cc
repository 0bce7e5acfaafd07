// SPDX-License-Identifier: Apache-2.0
// Tests of FittingService without a socket: refused clients, paths, methods and parameters.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/asked_service.h"

namespace pendulum::fitting_service_refusals_test {
namespace {

using asked_service::AnswerOf;
using asked_service::FieldOf;
using asked_service::Fields;
using asked_service::Json;
using asked_service::Recording;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kToken = "0123456789abcdef";

class FittingServiceRefusalsTest : public asked_service::ServiceTest {
 protected:
  std::string Answer(const std::string& method, const std::string& target, const Fields& fields = {}) {
    return AnswerOf(Ask(method, target, fields));
  }

  /// Whether the request is refused by its head alone.
  bool IsRefusedAtOnce(const std::string& method, const std::string& target, Fields fields = {}) {
    fields.push_back({"Host", "localhost"});
    return Service().RefuseHead({method, target, std::move(fields), ""}).has_value();
  }
};

// ---- Unknown clients -----------------------------------------------------------------------------------------------

TEST_F(FittingServiceRefusalsTest, AnswersOnlyThisMachineByDefault) {
  EXPECT_THAT(Answer("GET", "/v1/fits", {{"Host", "evil.example"}}), StartsWith("403 "));
  EXPECT_THAT(Answer("GET", "/", {{"Host", "evil.example"}}), StartsWith("403 "));
  EXPECT_EQ(Answer("GET", "/v1/fits", {{"Host", "127.0.0.1:8080"}}), "200");
  EXPECT_THAT(Answer("POST", "/v1/fits", {{"Sec-Fetch-Site", "cross-site"}}), StartsWith("403 "));
  EXPECT_THAT(Answer("GET", "/v1/fits", {{"Origin", "http://evil.example"}}), StartsWith("403 "));
  EXPECT_EQ(Answer("GET", "/v1/fits", {{"Origin", "http://localhost"}}), "200");
}

TEST_F(FittingServiceRefusalsTest, AnswersAllowedHosts) {
  options_.access.allowed_hosts = {"lab.example"};
  EXPECT_EQ(Answer("GET", "/v1/fits", {{"Host", "lab.example"}}), "200");
  EXPECT_THAT(Answer("GET", "/v1/fits", {{"Host", "lab.example.evil"}}), StartsWith("403 "));
}

TEST_F(FittingServiceRefusalsTest, AnswersOnlyWithTheToken) {
  options_.access.token = kToken;
  const HttpResponse response = Ask("GET", "/v1/fits");
  EXPECT_EQ(response.status, 401);
  EXPECT_THAT(FieldOf(response, "WWW-Authenticate"), StartsWith("Bearer"));
  EXPECT_EQ(Answer("GET", "/v1/fits", {{"Authorization", std::string("Bearer ") + kToken}}), "200");
  for (const char* value : {"Bearer 0123456789abcdeg", "Bearer ", "Basic MDEyMzQ1Njc4OWFiY2RlZg==", kToken}) {
    EXPECT_THAT(Answer("GET", "/v1/fits", {{"Authorization", value}}), StartsWith("401 ")) << value;
  }
  for (const char* path : {"/healthz", "/", "/fits/abc", "/app.js", "/app.css"}) EXPECT_EQ(Answer("GET", path), "200");
  EXPECT_EQ(Answer("GET", "/docs"), "302");
  // Without a token the service does not reveal which paths exist.
  for (const char* path : {"/metrics", "/openapi.json", "/v1/models", "/v1/none", "/none", "/v1//x"}) {
    EXPECT_THAT(Answer("GET", path), StartsWith("401 ")) << path;
  }
  for (const char* method : {"POST", "DELETE", "PATCH"}) EXPECT_THAT(Answer(method, "/"), StartsWith("401 ")) << method;
}

// ---- Paths, methods, parameters ------------------------------------------------------------------------------------

TEST_F(FittingServiceRefusalsTest, RejectsUnknownPaths) {
  for (const char* path : {"/v1", "/v1/fit", "/v2/fits", "/v1/fits/a/b", "/v1/fits/a/series/x", "/index.html",
                           "/app.js.map", "/.git", "/V1/fits"}) {
    EXPECT_EQ(Answer("GET", path),
              "404 there is nothing at " + std::string(path) + "; GET /openapi.json lists the paths");
    EXPECT_TRUE(IsRefusedAtOnce("GET", path)) << path;
  }
  for (const char* path : {"/v1/fits/../fits", "/v1//fits", "/v1/fits/%00", "/%2e%2e/etc/passwd", "v1/fits", "",
                           "/v1/fits/a%2Fseries", "/v1/fits?limit=%zz", "/v1/fits?limit=1&limit=1"}) {
    EXPECT_THAT(Answer("GET", path), StartsWith("400 ")) << path;
  }
}

TEST_F(FittingServiceRefusalsTest, ListsTheAllowedMethods) {
  const auto allowed = [&](const std::string& method, const std::string& target) {
    const HttpResponse response = Ask(method, target);
    EXPECT_EQ(response.status, 405) << method << " " << target;
    EXPECT_TRUE(IsRefusedAtOnce(method, target));
    return FieldOf(response, "Allow");
  };
  EXPECT_EQ(allowed("PUT", "/v1/fits"), "POST, GET, HEAD");
  EXPECT_EQ(allowed("POST", "/v1/fits/abc"), "GET, HEAD, PATCH, DELETE");
  EXPECT_EQ(allowed("HEAD", "/v1/simulations"), "POST");
  EXPECT_EQ(allowed("DELETE", "/"), "GET, HEAD");
  EXPECT_EQ(allowed("get", "/v1/models"), "GET, HEAD");  // method names are case-sensitive (RFC 9110, section 9.1)
  EXPECT_EQ(Ask("HEAD", "/v1/models").status, 200);
}

TEST_F(FittingServiceRefusalsTest, RefusesUnknownParameters) {
  EXPECT_EQ(Answer("GET", "/v1/fits?limt=3"), "400 'limt' is not a parameter of this request; did you mean 'limit'?");
  EXPECT_THAT(Answer("GET", "/v1/batches?model=drag"), StartsWith("400 'model' is not a parameter of this request"));
  for (const char* target : {"/v1/fits/abc?x=1", "/v1/models?x", "/healthz?x=1", "/metrics?x=1", "/app.js?v=2"}) {
    EXPECT_THAT(Answer("GET", target), HasSubstr("is not a parameter of this request; GET /openapi.json")) << target;
    EXPECT_TRUE(IsRefusedAtOnce("GET", target)) << target;
  }
}

TEST_F(FittingServiceRefusalsTest, RefusesParametersOutOfRange) {
  for (const char* text : {"0", "-1", "1.5", "ten", "99999999999999999999", "1%20"}) {
    EXPECT_THAT(Answer("GET", std::string("/v1/fits?limit=") + text), StartsWith("400 limit is '")) << text;
    EXPECT_THAT(Answer("GET", std::string("/v1/fits?before=") + text), StartsWith("400 before is '")) << text;
    EXPECT_THAT(Answer("GET", std::string("/v1/batches?limit=") + text), StartsWith("400 limit is '")) << text;
  }
}

// Otherwise a typing error would return an empty list, or all fits.
TEST_F(FittingServiceRefusalsTest, RefusesAnInvalidTime) {
  Fitted("?closed_form_only=true");
  for (const char* text : {"yesterday", "2026-13-01T00:00:00Z", "now", "12", "2026-11-23T00:00:00Z%20x"}) {
    EXPECT_THAT(Answer("GET", std::string("/v1/fits?since=") + text), StartsWith("400 since is '")) << text;
  }
  EXPECT_EQ(Answer("GET", "/v1/fits?since=2026-11-23T00:00:00Z"), "200");
  EXPECT_EQ(Answer("GET", "/v1/fits?since=2026-11-23T01:00:00%2B01:00"), "200");
}

// ---- Lanes and refusals of the server ------------------------------------------------------------------------------

TEST_F(FittingServiceRefusalsTest, QueuesCalculationsInTheirOwnLane) {
  const auto lane = [&](const std::string& method, const std::string& target) {
    return Service().LaneOf({method, target, {}, ""});
  };
  for (const char* target : {"/v1/fits", "/v1/fits/a/refits", "/v1/batches", "/v1/simulations", "/v1/calibrations"}) {
    EXPECT_EQ(lane("POST", target), Lane::kFit) << target;
  }
  for (const char* target : {"/v1/fits/a/series", "/v1/fits/a/report", "/v1/fits/a/samples"}) {
    EXPECT_EQ(lane("GET", target), Lane::kFit) << target;
  }
  EXPECT_EQ(lane("POST", "/v1/fits/a/readings"), Lane::kReadings);
  for (const char* target : {"/v1/fits", "/v1/fits/a", "/healthz", "/metrics", "/", "/none", "//"}) {
    EXPECT_EQ(lane("GET", target), Lane::kQuick) << target;
  }
}

TEST_F(FittingServiceRefusalsTest, FormatsRefusalsForTheServer) {
  for (const int status : {400, 408, 413, 417, 429, 431, 500, 503}) {
    const HttpResponse response = Service().Refusal(status, "because");
    EXPECT_EQ(response.status, status);
    EXPECT_EQ(AnswerOf(response), std::to_string(status) + " because");
    EXPECT_EQ(FieldOf(response, "Retry-After").empty(), status != 408 && status != 429 && status != 503) << status;
  }
}

TEST_F(FittingServiceRefusalsTest, WritesNoLineBreaksIntoHeaderFields) {
  const HttpResponse fit = Post("/v1/fits?closed_form_only=true", "application/json",
                                Json{{"data", Recording()}, {"name", "a\r\nSet-Cookie: x=1"}}.dump());
  if (fit.status != 200) return;  // the service may refuse such a name
  for (const char* part : {"/recording", "/report", "/markdown"}) {
    for (const HttpField& field : Get(FieldOf(fit, "Location") + part).fields) {
      EXPECT_EQ(field.value.find_first_of("\r\n"), std::string::npos) << field.name;
    }
  }
}

}  // namespace
}  // namespace pendulum::fitting_service_refusals_test
