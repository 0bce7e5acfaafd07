// SPDX-License-Identifier: Apache-2.0
// Readings of a fit for other values of its parameters: what is answered, what is refused, and that it waits for no
// fit.
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <latch>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/service/server.h"
#include "tests/service/asked_service.h"
#include "tests/service/served.h"

namespace pendulum::fitting_service_readings_test {
namespace {

using asked_service::AnswerOf;
using asked_service::FieldOf;
using asked_service::Json;
using asked_service::Recording;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class FittingServiceReadingsTest : public asked_service::ServiceTest {
 protected:
  FittingServiceReadingsTest() { options_.readings_time = std::chrono::minutes(10); }

  HttpResponse Readings(const std::string& location, const Json& body) {
    return Post(location + "/readings", "application/json", body.dump());
  }

  Json ReadingsAt(const std::string& location, const Json& body) {
    const HttpResponse response = Readings(location, body);
    EXPECT_EQ(response.status, 200) << response.body;
    EXPECT_EQ(FieldOf(response, "Content-Type"), "application/json");
    return Json::parse(response.body);
  }

  std::string Refused(const std::string& location, const Json& body) { return AnswerOf(Readings(location, body)); }
};

void ExpectNear(const Json& values, const Json& expected, double shift, double error) {
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_NEAR(values[i].get<double>(), expected[i].get<double>() + shift, error) << i;
  }
}

// ---- Answers -------------------------------------------------------------------------------------------------------

TEST_F(FittingServiceReadingsTest, AreTheFittedReadingsAtTheEstimates) {
  const std::string location = Fitted("?models=viscous,coulomb");
  const Json series = JsonAt(location + "/series")[0], result = JsonAt(location);
  for (const Json& fit : result["fits"]) {
    const std::string model = fit["model"];
    const Json readings = ReadingsAt(location, {{"parameters", Json::object()}, {"model", model}, {"recording", 0}});
    EXPECT_EQ(readings["time_s"], series["time_s"]);
    EXPECT_EQ(readings["unit"], series["unit"]);
    ExpectNear(readings["value"], series["models"][model]["fitted"], 0, 1e-8);
    EXPECT_NEAR(readings["rms_residual"].get<double>(), fit["statistics"]["rms_residual_rad"].get<double>(), 1e-8);
  }
  const Json recommended = {{"parameters", Json::object()}, {"model", result["comparison"]["recommended"]}};
  EXPECT_EQ(ReadingsAt(location, {{"parameters", Json::object()}}), ReadingsAt(location, recommended));
}

TEST_F(FittingServiceReadingsTest, FollowAChangedParameter) {
  const std::string location = Fitted();
  const Json series = JsonAt(location + "/series")[0], recording = JsonAt(location)["recordings"][0];
  const double zero = recording["fits"][0]["parameters"]["zero_angle"]["estimate"], shift = 0.5;
  const Json readings = ReadingsAt(location, {{"parameters", {{"zero_angle", zero + shift}}}});
  ExpectNear(readings["value"], series["models"]["viscous"]["fitted"], shift, 1e-8);
  // The mean of the residuals is nearly 0, so the shift adds to them in quadrature.
  EXPECT_NEAR(readings["rms_residual"].get<double>(), shift, 0.01 * shift);
}

TEST_F(FittingServiceReadingsTest, AreThinnedToAtMost4000Samples) {
  SyntheticOptions options = small_batch::Truth(1);
  options.duration = 90;
  options.sample_rate = 100;
  const HttpResponse fit = Post("/v1/fits?model=viscous", "text/csv", small_batch::RecordingText(options));
  ASSERT_EQ(fit.status, 200) << fit.body;
  const std::string location = FieldOf(fit, "Location");
  const Json series = JsonAt(location + "/series")[0];
  const Json readings = ReadingsAt(location, {{"parameters", Json::object()}});
  const std::size_t stride = (series["time_s"].size() + 3999) / 4000;
  ASSERT_GT(stride, 1);
  ASSERT_EQ(readings["time_s"].size(), (series["time_s"].size() + stride - 1) / stride);
  double squares = 0;
  for (std::size_t i = 0; i < readings["time_s"].size(); ++i) {
    EXPECT_EQ(readings["time_s"][i], series["time_s"][stride * i]);
    squares += std::pow(series["measured"][stride * i].get<double>() - readings["value"][i].get<double>(), 2);
  }
  const double rms = std::sqrt(squares / static_cast<double>(readings["time_s"].size()));
  EXPECT_NEAR(readings["rms_residual"].get<double>(), rms, 1e-9 * rms);
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

TEST_F(FittingServiceReadingsTest, NameWhatIsWrongInTheRequest) {
  const std::string location = Fitted();
  const Json none = Json::object();
  EXPECT_THAT(Refused(location, {{"parameters", {{"drag", 0.1}}}}),
              StartsWith("400 this fit of model viscous has no parameter 'drag'; it has inertia, viscous, "));
  EXPECT_THAT(Refused(location, {{"parameters", {{"inertia", -1}}}}), StartsWith("400 inertia is -1 "));
  EXPECT_EQ(Refused(location, {{"parameters", {{"inertia", "big"}}}}),
            "400 the parameter \"inertia\" is \"big\"; it must be a number");
  EXPECT_EQ(Refused(location, {{"parameters", {{"inertia", nullptr}}}}),
            "400 the parameter \"inertia\" is null; it must be a number");
  EXPECT_EQ(Refused(location, {{"parameters", none}, {"model", "magic"}}),
            "400 model is \"magic\"; this run has fits of viscous");
  EXPECT_EQ(Refused(location, {{"parameters", none}, {"model", 3}}), "400 model is 3; it must be a name");
  EXPECT_EQ(Refused(location, {{"parameters", none}, {"recording", 1}}),
            "400 recording is 1; this run has 1, the first of which is 0");
  EXPECT_EQ(Refused(location, {{"parameters", none}, {"recording", -1}}),
            "400 recording is -1; it must be a whole number from 0");
  EXPECT_EQ(Refused(location, {{"parameter", none}}),
            "400 the body has an unknown member \"parameter\"; its members are parameters, model, recording");
  EXPECT_EQ(Refused(location, none), "400 parameters is null; it must be an object of numbers");
  EXPECT_THAT(AnswerOf(Post(location + "/readings", "application/json", "{")), StartsWith("400 the body"));
  EXPECT_THAT(AnswerOf(Post(location + "/readings", "application/json", R"({"parameters": {"inertia": 1e999}})")),
              StartsWith("400 the body"));
  EXPECT_THAT(AnswerOf(Post(location + "/readings", "text/csv", "inertia\n1\n")), StartsWith("415 "));
}

TEST_F(FittingServiceReadingsTest, NeedAFit) {
  const Json body = {{"parameters", Json::object()}};
  EXPECT_EQ(Refused("/v1/fits/none", body).substr(0, 3), "404");
  const std::string location = Fitted("?closed_form_only=true");
  EXPECT_EQ(Refused(location, body), "404 this run has only closed forms and no fit, so it has no parameters");
  const std::string deleted = Fitted();
  EXPECT_EQ(Ask("DELETE", deleted).status, 204);
  EXPECT_EQ(Refused(deleted, body).substr(0, 3), "404");
}

TEST_F(FittingServiceReadingsTest, NeedAFitInMemory) {
  const std::string location = Fitted();
  const Json body = {{"parameters", Json::object()}};
  const Json before = ReadingsAt(location, body);
  End();
  const HttpResponse lost = Readings(location, body);
  EXPECT_THAT(AnswerOf(lost), AllOf(StartsWith("409 the service does not hold this fit in memory; ask for "),
                                    HasSubstr(location + "/series")));
  EXPECT_EQ(Json::parse(lost.body)["code"], "conflict");
  EXPECT_EQ(FieldOf(lost, "Retry-After"), "");
  EXPECT_EQ(Get(location + "/series").status, 200);
  EXPECT_EQ(ReadingsAt(location, body), before);
}

TEST_F(FittingServiceReadingsTest, AreNotGivenForMoreSamplesThanAreHeld) {
  const Json body = {{"parameters", Json::object()}};
  const std::string held = Fitted();
  const int samples = JsonAt(held)["recordings"][0]["used_samples"];
  options_.max_remembered = samples;
  End();
  EXPECT_EQ(Get(held + "/series").status, 200);
  SyntheticOptions longer = small_batch::Truth(1);
  longer.duration *= 2;
  const HttpResponse fit = Post("/v1/fits?model=viscous", "text/csv", small_batch::RecordingText(longer));
  const std::string location = FieldOf(fit, "Location");
  const int used = Json::parse(fit.body)["recordings"][0]["used_samples"];
  ASSERT_GT(used, samples);
  for (int i = 0; i < 2; ++i) {
    const HttpResponse refused = Readings(location, body);
    EXPECT_EQ(AnswerOf(refused), "422 this fit used " + std::to_string(used) +
                                     " samples; readings for other values are given for at most " +
                                     std::to_string(samples) + ", so fit a shorter window (from, to)");
    EXPECT_EQ(Json::parse(refused.body)["code"], "too_many_samples");
    EXPECT_EQ(Get(location + "/series").status, 200);
  }
  ReadingsAt(held, body);  // the longer fit did not make the service forget it
}

/// A recording of a pendulum that moves from its first sample.
std::string MovingRecording() {
  SyntheticOptions options = small_batch::Truth(1);
  options.release_time = 0;
  options.release_angle = 0.3;
  options.initial_rate = 1;
  return small_batch::RecordingText(options);
}

// 1e5 rad/s are 16 000 turns per second; with 1e300 rad/s numbers overflow. The steps of a motion are limited.
TEST_F(FittingServiceReadingsTest, AreNotGivenForExtremeValues) {
  const std::string location = FieldOf(Post("/v1/fits?model=viscous", "text/csv", MovingRecording()), "Location");
  for (const double rate : {1e5, 1e300}) {
    EXPECT_THAT(Refused(location, {{"parameters", {{"initial_rate", rate}}}}),
                StartsWith("400 with these values there is no motion that can be computed: "));
  }
}

TEST_F(FittingServiceReadingsTest, AreNotGivenForValuesThatTakeTooLong) {
  options_.readings_time = std::chrono::milliseconds(0);
  const std::string location = FieldOf(Post("/v1/fits?model=viscous", "text/csv", MovingRecording()), "Location");
  const HttpResponse slow = Readings(location, {{"parameters", {{"initial_rate", 1e5}}}});
  EXPECT_EQ(AnswerOf(slow),
            "400 with these values the motion was not computed after 0 s, the time limit; choose values nearer to the "
            "estimates");
  EXPECT_EQ(FieldOf(slow, "Retry-After"), "");
}

TEST_F(FittingServiceReadingsTest, EndWhenTheServiceStops) {
  const std::string location = Fitted();
  Service().Stop();
  Service().StopFits();
  const HttpResponse stopped = Readings(location, {{"parameters", Json::object()}});
  EXPECT_EQ(AnswerOf(stopped), "503 the service is being stopped");
  EXPECT_NE(FieldOf(stopped, "Retry-After"), "");
}

// ---- While fits run ------------------------------------------------------------------------------------------------

/// A service whose requests of Lane::kFit wait until they are let go.
class HeldFits : public HttpHandler {
 public:
  explicit HeldFits(FittingService& service) : service_(service) {}

  Lane LaneOf(const HttpRequest& request) const override { return service_.LaneOf(request); }
  std::optional<HttpResponse> RefuseHead(const HttpRequest& request) const override {
    return service_.RefuseHead(request);
  }
  HttpResponse Refusal(int status, const std::string& detail) const override {
    return service_.Refusal(status, detail);
  }
  HttpResponse Handle(const HttpRequest& request) override {
    if (LaneOf(request) == Lane::kFit) {
      ++held;
      gate.wait();
    }
    return service_.Handle(request);
  }

  std::atomic<int> held = 0;
  std::latch gate{1};

 private:
  FittingService& service_;
};

TEST_F(FittingServiceReadingsTest, AreAnsweredWhileAllFitThreadsAreBusy) {
  const std::string location = Fitted();
  const std::string expected = Readings(location, {{"parameters", {{"viscous", 0.01}}}}).body;
  HeldFits held(Service());
  ServerOptions options;
  options.port = 0;
  options.fit_threads = 2;
  auto server = Server::Listen(options, held, nullptr);
  ASSERT_TRUE(server) << server.error().message();
  std::thread thread([&] { (*server)->Run(); });
  std::vector<RawClient> fits;
  for (int i = 0; i < 2 * options.fit_threads; ++i) {  // half of them wait
    fits.emplace_back((*server)->port());
    fits.back().Send(pendulum::Get(location + "/series"));
  }
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (held.held < options.fit_threads && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  EXPECT_EQ(held.held, options.fit_threads);
  const std::string request = pendulum::Post(location + "/readings", R"({"parameters": {"viscous": 0.01}})",
                                             "Content-Type: application/json\r\n");
  RawClient client((*server)->port());
  for (int i = 0; i < 3; ++i) {
    const RawAnswer answer = client.Ask(request);
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.body, expected);
  }
  EXPECT_EQ(held.held, options.fit_threads);  // still busy
  held.gate.count_down();
  for (RawClient& fit : fits) EXPECT_EQ(fit.Read().status, 200);
  fits.clear();
  client.Close();
  (*server)->Stop();
  thread.join();
}

}  // namespace
}  // namespace pendulum::fitting_service_readings_test
