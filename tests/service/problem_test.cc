// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/problem.h"

#include <chrono>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace pendulum::problem_test {
namespace {

using Json = nlohmann::ordered_json;
using std::chrono::seconds;

/// The value of a field of an answer; "none" unless there is exactly one.
std::string FieldOf(const HttpResponse& response, const std::string& name) {
  std::vector<std::string> values;
  for (const HttpField& field : response.fields) {
    if (field.name == name) values.push_back(field.value);
  }
  return values.size() == 1 ? values.front() : "none";
}

Json JsonOf(const Problem& problem) { return Json::parse(ProblemResponse(problem).body); }

/// "status code exit_code" of an answer; a dash for no exit code.
std::string Figures(const Problem& problem) {
  const HttpResponse response = ProblemResponse(problem);
  const Json json = Json::parse(response.body);
  EXPECT_EQ(response.status, json["status"]);
  EXPECT_EQ(response.status, problem.status());
  EXPECT_EQ(json["code"], problem.code());
  EXPECT_EQ(json["type"], "urn:pendulum:problem:" + std::string(problem.code()));
  return json["status"].dump() + " " + json["code"].get<std::string>() + " " +
         (json["exit_code"].is_null() ? "-" : json["exit_code"].dump());
}

// RFC 9457, section 3: the five members, and extensions at the same level.
TEST(ProblemResponse, IsAnObjectOfProblemDetails) {
  const HttpResponse response = ProblemResponse(ProblemOf(Status{StatusCode::kDataLoss, "run.csv:118: no time"}));
  EXPECT_EQ(response.status, 422);
  EXPECT_EQ(FieldOf(response, "Content-Type"), "application/problem+json");
  EXPECT_FALSE(response.events);
  EXPECT_EQ(response.body,
            R"({"type":"urn:pendulum:problem:unusable_data","title":"The data cannot be read","status":422,)"
            R"("detail":"run.csv:118: no time","code":"unusable_data","exit_code":4})"
            "\n");
}

TEST(ProblemResponse, HasTheFlagsToTryAsParameters) {
  const Status status{
      StatusCode::kInvalidArgument, "no unit", "", {"--unit deg", "--value_column gyro z (rad/s)", "--fast"}};
  const Json json = Json::parse(ProblemResponse(ProblemOf(status)).body);
  const Json parameters = {{"unit", "deg"}, {"value_column", "gyro z (rad/s)"}, {"fast", "true"}};
  EXPECT_EQ(json["try"], parameters);
}

// The exit codes are those that the tools give (src/docs/reference.md).
TEST(ProblemOf, MapsEachStatusCodeToHttpStatusAndExitCode) {
  const auto figures = [](StatusCode code) { return Figures(ProblemOf(Status{code, "why"})); };
  EXPECT_EQ(figures(StatusCode::kInvalidArgument), "400 bad_request 2");
  EXPECT_EQ(figures(StatusCode::kNotFound), "404 not_found 3");
  EXPECT_EQ(figures(StatusCode::kDataLoss), "422 unusable_data 4");
  EXPECT_EQ(figures(StatusCode::kFailedPrecondition), "422 no_swing 5");
  EXPECT_EQ(figures(StatusCode::kCannotWrite), "507 cannot_write 73");
  EXPECT_EQ(figures(StatusCode::kTryAgain), "503 stopping 75");
  EXPECT_EQ(figures(StatusCode::kInternal), "500 internal 70");
}

TEST(ProblemOf, GivesCodesForHttpRefusals) {
  const auto figures = [](int status) { return Figures(ProblemOf(status, "why")); };
  EXPECT_EQ(figures(400), "400 bad_request 2");
  EXPECT_EQ(figures(403), "403 forbidden -");
  EXPECT_EQ(figures(404), "404 not_found 3");
  EXPECT_EQ(figures(408), "408 timed_out 75");
  EXPECT_EQ(figures(409), "409 conflict -");
  EXPECT_EQ(figures(413), "413 too_large 4");
  EXPECT_EQ(figures(415), "415 unsupported_media_type -");
  EXPECT_EQ(figures(417), "417 expectation_failed -");
  EXPECT_EQ(figures(429), "429 too_many_requests 75");
  EXPECT_EQ(figures(431), "431 headers_too_large -");
  EXPECT_EQ(figures(500), "500 internal 70");
  EXPECT_EQ(figures(503), "503 stopping 75");
  EXPECT_EQ(figures(507), "507 cannot_write 73");
}

TEST(ProblemOf, TreatsAnUnknownStatusByItsClass) {
  EXPECT_EQ(ProblemOf(418, "why").status(), 400);
  EXPECT_EQ(ProblemOf(422, "why").status(), 400);  // several kinds share this status
  EXPECT_EQ(ProblemOf(0, "why").status(), 400);
  EXPECT_EQ(ProblemOf(505, "why").status(), 500);
  EXPECT_EQ(ProblemOf(999, "why").status(), 500);
}

TEST(Problem, HasAUniqueCodeAndTitleForEachKind) {
  std::set<std::string> codes, titles;
  constexpr int kKinds = 19;
  for (int i = 0; i < kKinds; ++i) {
    const Json json = JsonOf({static_cast<ProblemKind>(i), "why", {}});
    codes.insert(json["code"].get<std::string>());
    titles.insert(json["title"].get<std::string>());
  }
  EXPECT_EQ(codes.size(), kKinds);
  EXPECT_EQ(titles.size(), kKinds);
  EXPECT_EQ(static_cast<int>(ProblemKind::kCannotWrite), kKinds - 1);  // the last one
  EXPECT_EQ(Figures({ProblemKind::kKeyReused, "why", {}}), "422 idempotency_key_reused -");
  EXPECT_EQ(Figures({ProblemKind::kTooManySamples, "why", {}}), "422 too_many_samples -");
}

// RFC 9110, sections 15.5.9 and 15.6.4, and RFC 6585, section 4.
TEST(ProblemOf, SetsRetryAfterIfUseful) {
  for (const int status : {408, 429, 503}) {
    const HttpResponse response = ProblemResponse(ProblemOf(status, "why"));
    EXPECT_GE(std::stoi(FieldOf(response, "Retry-After")), 1) << status;
  }
  EXPECT_NE(FieldOf(ProblemResponse(ProblemOf(Status{StatusCode::kTryAgain, "why"})), "Retry-After"), "none");
  for (const int status : {400, 404, 413, 431, 500, 507}) {
    EXPECT_EQ(FieldOf(ProblemResponse(ProblemOf(status, "why")), "Retry-After"), "none") << status;
  }
}

// RFC 9110, section 10.2.3: a whole number of seconds.
TEST(RetryLater, GivesTheNumberOfSeconds) {
  const auto after = [](seconds wait) {
    return FieldOf(ProblemResponse(RetryLater(ProblemKind::kTooManyRequests, "why", wait)), "Retry-After");
  };
  EXPECT_EQ(after(seconds{120}), "120");
  EXPECT_EQ(after(seconds{0}), "1");
  EXPECT_EQ(after(seconds{-5}), "1");
  EXPECT_EQ(Figures(RetryLater(ProblemKind::kConflict, "why")), "409 conflict -");
}

// RFC 6750, section 3: at least one parameter, and no error if the request had no token.
TEST(Unauthorized, ChallengesTheClient) {
  const HttpResponse none = ProblemResponse(Unauthorized("there is no token"));
  EXPECT_EQ(none.status, 401);
  EXPECT_EQ(FieldOf(none, "WWW-Authenticate"), "Bearer realm=\"pendulum\"");
  EXPECT_EQ(FieldOf(ProblemResponse(Unauthorized("another token", "invalid_token")), "WWW-Authenticate"),
            "Bearer realm=\"pendulum\", error=\"invalid_token\"");
  EXPECT_EQ(Figures(Unauthorized("why")), "401 unauthorized -");
}

// RFC 9110, section 15.5.6.
TEST(MethodNotAllowed, ListsTheAllowedMethods) {
  const HttpResponse response = ProblemResponse(MethodNotAllowed("PO\r\nST", "GET, DELETE"));
  EXPECT_EQ(response.status, 405);
  EXPECT_EQ(FieldOf(response, "Allow"), "GET, DELETE");
  EXPECT_EQ(Json::parse(response.body)["detail"],
            R"(the method "PO\x0d\x0aST" is not allowed here; allowed are GET, DELETE)");
}

// Unicode 15, section 3.9: U+FFFD for each invalid byte of UTF-8; other characters follow RFC 8259, section 7.
TEST(ProblemResponse, AcceptsADetailOfAnyBytes) {
  EXPECT_EQ(JsonOf({ProblemKind::kUnusableData, "a\xFF\"\\\n" + std::string(1, '\0') + "π", {}})["detail"],
            "a\uFFFD\"\\\n" + std::string(1, '\0') + "π");
  const std::string body = ProblemResponse({ProblemKind::kUnusableData, "a\nb", {}}).body;
  EXPECT_EQ(body.find('\n'), body.size() - 1);
  EXPECT_EQ(JsonOf({ProblemKind::kInternal, std::string(100'000, 'x'), {}})["detail"].get<std::string>().size(),
            100'000);
}

}  // namespace
}  // namespace pendulum::problem_test
