// SPDX-License-Identifier: Apache-2.0
// Tests of FittingService without a socket: simulations, calibrations, models, metrics, page, guide, live recording.
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/version.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/recording/sensor.h"
#include "service/routes.h"
#include "tests/service/asked_service.h"

namespace pendulum::fitting_service_other_test {
namespace {

using asked_service::AnswerOf;
using asked_service::FieldOf;
using asked_service::Fields;
using asked_service::FileText;
using asked_service::Json;
using asked_service::Recording;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class FittingServiceOtherTest : public asked_service::ServiceTest {};

// ---- Simulations ---------------------------------------------------------------------------------------------------

constexpr const char* kSimulation =
    "set=inertia%3D0.044,viscous%3D0.0011,coulomb%3D0.0022,release_angle%3D0.4,release_time%3D0.3&duration=8&rate=40&"
    "noise=0.1&seed=7";

TEST_F(FittingServiceOtherTest, SimulatesRecordingsThatAFitRecovers) {
  const HttpResponse response = Ask("POST", std::string("/v1/simulations?") + kSimulation);
  ASSERT_EQ(response.status, 200) << response.body;
  const Json json = Json::parse(response.body);
  EXPECT_EQ(json["truth"].at("inertia"), 0.044) << json["truth"].dump(2);
  const HttpResponse fit = Post("/v1/fits?model=coulomb", "text/csv", json["recording"].get<std::string>());
  ASSERT_EQ(fit.status, 200) << fit.body;
  const Json inertia = Json::parse(fit.body)["fits"][0]["parameters"]["inertia"];
  EXPECT_NEAR(inertia["estimate"].get<double>(), 0.044, 5 * inertia["std_error"].get<double>());
}

TEST_F(FittingServiceOtherTest, SimulatesTheSameFromQueryAndBody) {
  const std::string query = Ask("POST", std::string("/v1/simulations?") + kSimulation).body;
  const Json body = {{"set", "inertia=0.044,viscous=0.0011,coulomb=0.0022,release_angle=0.4,release_time=0.3"},
                     {"duration", 8},
                     {"rate", 40},
                     {"noise", 0.1},
                     {"seed", 7},
                     {"rig", nullptr}};
  EXPECT_EQ(Post("/v1/simulations", "application/json", body.dump()).body, query);
  const HttpResponse csv = Ask("POST", std::string("/v1/simulations?") + kSimulation, {{"Accept", "text/csv"}});
  EXPECT_THAT(FieldOf(csv, "Content-Type"), StartsWith("text/csv"));
  EXPECT_EQ(csv.body, Json::parse(query)["recording"].get<std::string>());
}

TEST_F(FittingServiceOtherTest, SimulatesWithARig) {
  const Json body = {{"set", "inertia=0.079,viscous=0.002,release_angle=0.4,release_time=0.3"},
                     {"model", "viscous"},
                     {"rig", {{"gravity_torque", {{"value", 1.8}}}}}};
  const HttpResponse response = Post("/v1/simulations", "application/json", body.dump());
  ASSERT_EQ(response.status, 200) << response.body;
  EXPECT_EQ(Json::parse(response.body)["truth"].at("inertia"), 0.079) << response.body.substr(0, 400);
}

TEST_F(FittingServiceOtherTest, RefusesInvalidSimulations) {
  const auto answer = [&](const std::string& query) { return AnswerOf(Ask("POST", "/v1/simulations?" + query)); };
  EXPECT_THAT(answer("durration=1"),
              StartsWith("400 'durration' is not a parameter of this request; did you mean 'duration'?"));
  EXPECT_THAT(answer("duration=1e9&rate=1e9"),
              StartsWith("413 --duration times --rate gives more samples than this service accepts, 200000"));
  EXPECT_THAT(answer("duration=-1"), StartsWith("400 --duration"));
  EXPECT_THAT(answer("out=x.csv"), StartsWith("400 'out' is not a parameter of this request"));
  EXPECT_THAT(AnswerOf(Post("/v1/simulations?seed=1", "application/json", R"({"seed": 1})")),
              StartsWith("400 --seed is given in the query and in the body"));
  EXPECT_THAT(AnswerOf(Post("/v1/simulations", "application/json", "[")), StartsWith("400 the body:"));
  EXPECT_THAT(AnswerOf(Post("/v1/simulations", "application/json", R"({"rig": 3})")), StartsWith("4"));
}

// ---- Calibrations --------------------------------------------------------------------------------------------------

// The published line of the textbook's table: 0.1985 x - 49.6077 (src/docs/examples.md).
TEST_F(FittingServiceOtherTest, CalibratesTheTextbooksTable) {
  const std::string table = FileText("datasets/textbook_calibration.csv");
  const HttpResponse response = Post("/v1/calibrations?bits=10", "text/csv", table);
  ASSERT_EQ(response.status, 200) << response.body;
  const Json json = Json::parse(response.body);
  EXPECT_NEAR(json["calibration"]["coefficients"][0].get<double>(), -49.6077, 5e-5);
  EXPECT_NEAR(json["calibration"]["coefficients"][1].get<double>(), 0.1985, 5e-5);
  EXPECT_EQ(json["calibration"]["input_range"], Json::array({0, 1023}));
  EXPECT_EQ(json["order"], 1);
  ASSERT_EQ(json["points"].size(), 7U);
  const Json& point = json["points"][3];  // src/docs/rigs_and_calibration.md: 261 counts, 0 deg
  EXPECT_EQ(point["reading"], 261);
  EXPECT_EQ(point["angle"], 0);
  EXPECT_NEAR(point["fitted"].get<double>(), 2.21, 5e-3);
  EXPECT_NEAR(point["residual"].get<double>(), -2.21, 5e-3);
  EXPECT_NEAR(point["left_out"].get<double>(), -2.58, 5e-3);
  EXPECT_NEAR(json["leave_one_out_rms"].get<double>(), 1.32, 5e-3);
  EXPECT_THAT(json["text"].get<std::string>(), HasSubstr("-49.6077 + 0.198544 x deg"));
  EXPECT_TRUE(ParseCalibration(json["calibration"].dump(), "calibration"));  // a fit accepts it
}

TEST_F(FittingServiceOtherTest, HasNoLeaveOneOutResultForTwoPoints) {
  const HttpResponse response = Post("/v1/calibrations", "text/csv", "counts,angle_deg\n0,0\n100,20\n");
  ASSERT_EQ(response.status, 200) << response.body;
  const Json json = Json::parse(response.body);
  EXPECT_TRUE(json["leave_one_out_rms"].is_null());
  EXPECT_TRUE(json["points"][0]["left_out"].is_null());
}

TEST_F(FittingServiceOtherTest, RefusesInvalidTables) {
  EXPECT_THAT(AnswerOf(Post("/v1/calibrations", "text/csv", "")), StartsWith("422 table"));
  EXPECT_THAT(AnswerOf(Post("/v1/calibrations", "text/csv", "counts,angle_deg\n1,x\n")), StartsWith("422 table:2:"));
  EXPECT_THAT(AnswerOf(Post("/v1/calibrations?order=9", "text/csv", "")), StartsWith("400 --order is 9"));
  EXPECT_THAT(AnswerOf(Post("/v1/calibrations?bit=9", "text/csv", "")), StartsWith("400 'bit' is not a parameter"));
}

// ---- Models and examples -------------------------------------------------------------------------------------------

std::set<std::string> Names(const Json& list) {
  std::set<std::string> names;
  for (const Json& name : list) names.insert(name);
  return names;
}

// Nesting follows from the formulas of the laws (MODEL.md eq. (2.4) to (2.8)); no model is nested in a
// model with another gravity.
TEST_F(FittingServiceOtherTest, ReportsWhichModelsAreNested) {
  const std::map<std::string, std::set<std::string>> expected = {
      {"viscous", {"coulomb", "drag", "stribeck", "asymmetric", "dahl", "load"}},
      {"coulomb", {"drag", "stribeck", "asymmetric", "dahl"}},
      {"linear", {"linear_coulomb", "linear_drag", "linear_stribeck", "linear_dahl"}},
      {"linear_coulomb", {"linear_drag", "linear_stribeck", "linear_dahl"}}};
  const Json models = JsonAt("/v1/models")["models"];
  EXPECT_EQ(models.size(), MotionModels().size());
  for (const Json& model : models) {
    const std::string name = model["name"];
    const std::set<std::string> nested_in = Names(model["nested_in"]);
    EXPECT_EQ(nested_in, expected.count(name) == 0 ? std::set<std::string>() : expected.at(name)) << name;
    EXPECT_FALSE(model["label"].get<std::string>().empty() || model["about"].get<std::string>().empty());
    EXPECT_FALSE(model["equation"].get<std::string>().empty());
    EXPECT_EQ(model["parameters"][0]["name"], "inertia");
    EXPECT_EQ(model["parameters"][0]["unit"], "kg m^2");
    EXPECT_TRUE(model["parameters"][0]["upper"].is_null());  // JSON has no infinity
  }
}

TEST_F(FittingServiceOtherTest, HasExamplesThatCanBeFitted) {
  const Json list = JsonAt("/v1/examples")["examples"];
  ASSERT_EQ(list.size(), 3U);
  for (const Json& item : list) {
    const std::string name = item["name"];
    const Json example = JsonAt("/v1/examples/" + name);
    EXPECT_EQ(example["title"], item["title"]);
    EXPECT_EQ(example["rig"].is_null(), !item["has_rig"].get<bool>());
    const Json body = {{"data", example["recording"]},
                       {"rig", example["rig"]},
                       {"options", {{"models", example["models"]}, {"closed_form_only", true}}}};
    // Checks only that all names in `models` are models.
    const std::string answer = AnswerOf(Post("/v1/fits", "application/json", body.dump()));
    EXPECT_THAT(answer, Not(HasSubstr("there is no model"))) << name;
    const Json one = {
        {"data", example["recording"]}, {"rig", example["rig"]}, {"options", {{"closed_form_only", true}}}};
    EXPECT_EQ(Post("/v1/fits", "application/json", one.dump()).status, 200) << name;
  }
  EXPECT_EQ(AnswerOf(Get("/v1/examples/none")), "404 there is no example 'none'; GET /v1/examples lists them");
}

// ---- The service itself --------------------------------------------------------------------------------------------

TEST_F(FittingServiceOtherTest, IsHealthyUntilItStops) {
  EXPECT_EQ(JsonAt("/healthz"), (Json{{"status", "ok"}, {"version", std::string(kVersion)}}));
  Service().Stop();
  EXPECT_EQ(Get("/healthz").status, 503);
  EXPECT_EQ(Json::parse(Get("/healthz").body)["status"], "stopping");
}

TEST_F(FittingServiceOtherTest, ReportsTheStopToStoppedFits) {
  Service().Stop();
  Service().StopFits();
  const HttpResponse response = Post("/v1/fits?model=viscous", "text/csv", Recording());
  EXPECT_EQ(AnswerOf(response), "503 the service is being stopped");
  EXPECT_FALSE(FieldOf(response, "Retry-After").empty());
}

/// The value in a line of the metrics; NaN if there is none.
double MetricOf(const std::string& text, const std::string& name) {
  const std::size_t at = ("\n" + text).find("\n" + name + " ");
  return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + name.size() + 1));
}

TEST_F(FittingServiceOtherTest, CountsItsWork) {
  Fitted();
  (void)Post("/v1/fits", "text/csv", asked_service::RestingRecording());
  Service().Count({"GET", "/v1/fits/abc?x=1", "127.0.0.1:1", 404, 10, std::chrono::microseconds(3000)});
  Service().Count({"GET", "/v1/fits/def", "127.0.0.1:1", 404, 10, std::chrono::microseconds(3000)});
  Service().Count({"BREW", "/coffee\n", "127.0.0.1:1", 400, 10, std::chrono::microseconds(3000)});
  Service().CountServer([] {
    ServerCounts counts;
    counts.connections = 5;
    counts.accepted = 9;
    return counts;
  });
  const HttpResponse response = Get("/metrics");
  EXPECT_EQ(FieldOf(response, "Content-Type"), "text/plain; version=0.0.4; charset=utf-8");
  const std::string& text = response.body;
  EXPECT_EQ(MetricOf(text, "pendulum_http_requests_total{method=\"GET\",route=\"/v1/fits/{id}\",status=\"404\"}"), 2);
  EXPECT_EQ(MetricOf(text, "pendulum_http_requests_total{method=\"other\",route=\"other\",status=\"400\"}"), 1);
  EXPECT_EQ(MetricOf(text, "pendulum_fits_total{kind=\"request\",outcome=\"converged\"}"), 1);
  EXPECT_EQ(MetricOf(text, "pendulum_fits_total{kind=\"request\",outcome=\"failed\"}"), 1);
  EXPECT_EQ(MetricOf(text, "pendulum_http_open_connections"), 5);
  EXPECT_EQ(MetricOf(text, "pendulum_http_connections_total"), 9);
  EXPECT_EQ(MetricOf(text, "pendulum_batch_runs_waiting"), 0);
  EXPECT_GT(MetricOf(text, "process_resident_memory_bytes"), 1e6);
  EXPECT_THAT(text, HasSubstr("pendulum_build_info{version=\"" + std::string(kVersion) + "\"} 1"));
}

TEST_F(FittingServiceOtherTest, DescribesExactlyItsRoutes) {
  const Json document = JsonAt("/openapi.json");
  EXPECT_THAT(document["openapi"].get<std::string>(), StartsWith("3.1"));
  std::set<std::string> described, answered;
  for (const auto& [path, item] : document["paths"].items()) {
    std::string pattern = path;  // the path with placeholders for its variable parts
    if (const std::size_t open = pattern.find('{'); open != std::string::npos) {
      pattern.replace(open, pattern.find('}') - open + 1, "{id}");
    }
    for (const char* method : {"get", "post", "delete", "put", "patch"}) {
      if (item.contains(method)) described.insert(std::string(method) + " " + pattern);
    }
  }
  for (const Route& route : Routes()) {
    if (route.audience == Audience::kAnybody && route.path != "/healthz") continue;  // files of the page
    std::string method(route.method);
    for (char& c : method) c = static_cast<char>(c - 'A' + 'a');
    answered.insert(method + " " + std::string(route.path));
  }
  EXPECT_EQ(described, answered);
  EXPECT_TRUE(document["components"]["schemas"]["Result"].contains("properties"));
}

// ---- The page ------------------------------------------------------------------------------------------------------

TEST_F(FittingServiceOtherTest, ServesThePageAtEachPath) {
  const std::string page = Get("/").body;
  EXPECT_THAT(page,
              AllOf(HasSubstr("/app.js"), HasSubstr(R"("name":"from","label":"From")"), Not(HasSubstr("@FLAGS@"))));
  for (const char* path : {"/fits", "/fits/abc", "/batches/abc", "/compare?ids=a,b", "/calibration", "/live"}) {
    const HttpResponse response = Get(path);
    EXPECT_EQ(response.status, 200) << path;
    EXPECT_EQ(response.body, page) << path;
    EXPECT_THAT(FieldOf(response, "Content-Type"), StartsWith("text/html")) << path;
  }
  EXPECT_THAT(FieldOf(Get("/app.js"), "Content-Type"), StartsWith("text/javascript"));
  EXPECT_THAT(FieldOf(Get("/app.css"), "Content-Type"), StartsWith("text/css"));
}

// With this policy a browser runs and displays only files of the service.
TEST_F(FittingServiceOtherTest, RestrictsThePageToItsOwnFiles) {
  const HttpResponse response = Get("/");
  const std::string policy = FieldOf(response, "Content-Security-Policy");
  for (const char* rule : {"default-src 'none'", "script-src 'self'", "style-src 'self'", "connect-src 'self'",
                           "base-uri 'none'", "form-action 'none'", "frame-ancestors 'none'"}) {
    EXPECT_THAT(policy, HasSubstr(rule));
  }
  EXPECT_THAT(policy, Not(HasSubstr("unsafe")));
  EXPECT_THAT(response.body, Not(HasSubstr("<style")));
  EXPECT_THAT(response.body, Not(HasSubstr(" style=")));
  EXPECT_THAT(response.body, Not(HasSubstr(" onclick=")));
  for (std::size_t at = response.body.find("<script"); at != std::string::npos;
       at = response.body.find("<script", at + 1)) {
    EXPECT_THAT(response.body.substr(at, response.body.find('>', at) - at),
                AnyOf(HasSubstr("src="), HasSubstr("application/json")));  // JSON data is not run as a script
  }
}

TEST_F(FittingServiceOtherTest, SendsTheSameSecurityFieldsEverywhere) {
  for (const HttpResponse& response :
       {Get("/"), Get("/v1/fits"), Get("/none"), Get("/healthz"), Get("/openapi.json"), Get("/v1/fits/none"),
        Ask("PATCH", "/v1/fits"), Service().Refusal(413, "too much")}) {
    EXPECT_EQ(FieldOf(response, "X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(FieldOf(response, "Referrer-Policy"), "no-referrer");
    EXPECT_EQ(FieldOf(response, "Cross-Origin-Resource-Policy"), "same-origin");
    EXPECT_THAT(FieldOf(response, "Content-Security-Policy"), StartsWith("default-src 'none'"));
  }
}

TEST_F(FittingServiceOtherTest, SendsThePageOnceUntilItChanges) {
  const std::string tag = FieldOf(Get("/app.js"), "ETag");
  const HttpResponse again = Ask("GET", "/app.js", {{"If-None-Match", tag}});
  EXPECT_EQ(again.status, 304);
  EXPECT_EQ(again.body, "");
  EXPECT_EQ(FieldOf(again, "ETag"), tag);
  EXPECT_EQ(Ask("GET", "/app.js", {{"If-None-Match", "\"other\""}}).status, 200);
}

// ---- The user guide ------------------------------------------------------------------------------------------------

TEST_F(FittingServiceOtherTest, ServesTheGuide) {
  options_.docs = folder_ / "html";
  folder_.Write("html/index.html", "<p>Guide</p>");
  folder_.Write("html/pictures/report.png", "\x89PNG");
  for (const char* path : {"/docs", "/docs/"}) {
    const HttpResponse home = Get(path);
    EXPECT_EQ(home.status, 302) << path;
    EXPECT_EQ(FieldOf(home, "Location"), "/docs/index.html") << path;
  }
  const HttpResponse page = Get("/docs/index.html");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.body, "<p>Guide</p>");
  EXPECT_THAT(FieldOf(page, "Content-Type"), StartsWith("text/html"));
  const std::string policy = FieldOf(page, "Content-Security-Policy");
  EXPECT_THAT(policy, AllOf(StartsWith("default-src 'none'"), HasSubstr("script-src 'self'"),
                            HasSubstr("style-src 'self'"), Not(HasSubstr("connect-src"))));
  EXPECT_EQ(FieldOf(Get("/docs/pictures/report.png"), "Content-Type"), "image/png");
  const HttpResponse again = Ask("GET", "/docs/index.html", {{"If-None-Match", FieldOf(page, "ETag")}});
  EXPECT_EQ(again.status, 304);
  EXPECT_EQ(Ask("HEAD", "/docs/index.html").status, 200);
  EXPECT_EQ(Ask("POST", "/docs/index.html").status, 405);
}

TEST_F(FittingServiceOtherTest, ServesNothingOutsideTheGuide) {
  options_.docs = folder_ / "html";
  folder_.Write("html/index.html", "<p>Guide</p>");
  folder_.Write("secret.html", "secret");
  std::filesystem::create_symlink(folder_ / "secret.html", folder_ / "html/link.html");
  for (const char* path : {"/docs/../secret.html", "/docs/%2e%2e/secret.html", "/docs/..%2fsecret.html",
                           "/docs//secret.html", "/docs/..%5csecret.html", "/docs/%2fetc%2fpasswd"}) {
    EXPECT_THAT(AnswerOf(Get(path)), StartsWith("400 ")) << path;
  }
  for (const char* path : {"/docs/link.html", "/docs/none.html", "/docs/...", "/docs/index.html.bak"}) {
    EXPECT_THAT(AnswerOf(Get(path)), StartsWith("404 the user guide has no file")) << path;
  }
}

TEST_F(FittingServiceOtherTest, ReportsThatTheGuideIsNotInstalled) {
  EXPECT_THAT(AnswerOf(Get("/docs/index.html")), StartsWith("404 the user guide is not installed"));
}

TEST_F(FittingServiceOtherTest, TellsABrowserHowToGetTheGuide) {
  const HttpResponse page = Ask("GET", "/docs/index.html", {{"Accept", "text/html,application/xhtml+xml,*/*;q=0.8"}});
  EXPECT_EQ(page.status, 404);
  EXPECT_THAT(FieldOf(page, "Content-Type"), StartsWith("text/html"));
  EXPECT_THAT(page.body, AllOf(HasSubstr("scripts/docs"), HasSubstr("--docs build/docs"), Not(HasSubstr("<script"))));
  EXPECT_THAT(FieldOf(page, "Content-Security-Policy"), StartsWith("default-src 'none'"));
}

// ---- The live recording --------------------------------------------------------------------------------------------

TEST_F(FittingServiceOtherTest, HasNoLiveRecordingByDefault) {
  for (const char* path : {"/v1/live", "/v1/live/events", "/v1/live/recording"}) {
    EXPECT_THAT(AnswerOf(Get(path)), StartsWith("404 this service watches no recording; start serve_pendulum with"));
  }
}

TEST_F(FittingServiceOtherTest, ShowsTheLiveRecording) {
  options_.live = folder_ / "run.csv";
  EXPECT_EQ(JsonAt("/v1/live")["state"], "waiting");
  EXPECT_EQ(Get("/v1/live/recording").status, 404);
  folder_.Write("run.csv", Recording());
  const Json live = JsonAt("/v1/live");
  EXPECT_EQ(live["state"], "ended");
  EXPECT_EQ(live["name"], "run.csv");
  EXPECT_EQ(live["samples"], 320);
  EXPECT_EQ(Get("/v1/live/recording").body, Recording());
  const HttpResponse events = Get("/v1/live/events");
  ASSERT_TRUE(events.events);
  EXPECT_THAT(events.events().text, HasSubstr("event: state\ndata: "));
}

}  // namespace
}  // namespace pendulum::fitting_service_other_test
