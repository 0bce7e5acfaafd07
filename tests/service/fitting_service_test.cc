// SPDX-License-Identifier: Apache-2.0
// Tests of FittingService without a socket: single fits, repeated requests, refits, and lists of fits.
#include "pendulum/service/fitting_service.h"

#include <set>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/sha256.h"
#include "pendulum/identify/identify.h"
#include "pendulum/report/json.h"
#include "pendulum/report/series.h"
#include "tests/service/asked_service.h"

namespace pendulum::fitting_service_test {
namespace {

using asked_service::AnswerOf;
using asked_service::FieldOf;
using asked_service::Fields;
using asked_service::FileText;
using asked_service::FormOf;
using asked_service::IdOf;
using asked_service::Json;
using asked_service::kForm;
using asked_service::PartOf;
using asked_service::Recording;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::SizeIs;
using testing::StartsWith;
using testing::StrCaseEq;

class FittingServiceTest : public asked_service::ServiceTest {};

/// The fit that fit_pendulum makes with these models.
Identification FitOf(const std::vector<std::string>& models, RunFiles files) {
  return IdentifyBytes(small_batch::OptionsFor(models), std::move(files)).value();
}

std::string ResultOf(const Identification& run) {
  Json json = ToJson(run);
  json["recordings"][0]["path"] = nullptr;
  return json.dump(2) + "\n";
}

// ---- Fitting -------------------------------------------------------------------------------------------------------

TEST_F(FittingServiceTest, AnswersWithTheResultOfFitPendulum) {
  const HttpResponse response = Post("/v1/fits?model=viscous", "text/csv", Recording());
  ASSERT_EQ(response.status, 200) << response.body;
  EXPECT_EQ(FieldOf(response, "Content-Type"), "application/json");
  EXPECT_EQ(response.body, ResultOf(FitOf({"viscous"}, {{"run.csv", Recording()}, {}, {}})));
  EXPECT_THAT(FieldOf(response, "Location"), MatchesRegex("/v1/fits/[0-9a-f]{24}"));
  const HttpResponse again = Get(FieldOf(response, "Location"));
  EXPECT_EQ(again.status, 200);
  EXPECT_EQ(again.body, response.body);
}

TEST_F(FittingServiceTest, AnswersTheSameToEachKindOfBody) {
  const std::string rig = small_batch::kRigText;
  const std::string expected = ResultOf(FitOf({"viscous", "coulomb"}, {{"a", Recording()}, Share({"rig", rig}), {}}));
  const HttpResponse form = Post("/v1/fits?models=viscous,coulomb", kForm,
                                 FormOf(PartOf("data", Recording(), "run.csv") + PartOf("rig", rig)));
  EXPECT_EQ(form.body, expected);
  const Json body = {
      {"data", Recording()}, {"rig", Json::parse(rig)}, {"options", {{"model", "viscous,coulomb"}}}, {"name", "n"}};
  EXPECT_EQ(Post("/v1/fits", "application/json", body.dump()).body, expected);
}

TEST_F(FittingServiceTest, KeepsAnswersAcrossARestart) {
  const HttpResponse response = Post("/v1/fits?model=viscous&name=run.csv", "text/csv", Recording());
  const std::string location = FieldOf(response, "Location");
  const std::string series = Get(location + "/series").body;
  End();
  EXPECT_EQ(Get(location).body, response.body);
  EXPECT_EQ(Get(location + "/series").body, series);  // the fit is repeated
  EXPECT_THAT(IdsAt("/v1/fits"), ElementsAre(IdOf(location)));
}

TEST_F(FittingServiceTest, ExplainsWhyARecordingCannotBeFitted) {
  const HttpResponse rest = Post("/v1/fits", "text/csv", asked_service::RestingRecording());
  EXPECT_EQ(AnswerOf(rest), "422 the reading is constant: no swing");  // the sentence of fit_pendulum
  EXPECT_EQ(Json::parse(rest.body)["code"], "no_swing");
  EXPECT_EQ(Json::parse(rest.body)["exit_code"], 5);
  const HttpResponse backwards = Post("/v1/fits?name=run.csv", "text/csv", "time_s,angle_rad\n0,x\n");
  EXPECT_THAT(AnswerOf(backwards), StartsWith("422 run.csv:2:"));
  EXPECT_EQ(Json::parse(backwards.body)["code"], "unusable_data");
  EXPECT_EQ(AnswerOf(Post("/v1/fits?model=magic", "text/csv", Recording())).substr(0, 4), "400 ");
  EXPECT_THAT(IdsAt("/v1/fits"), IsEmpty());  // failed fits are not stored
}

// A fit stopped at any time is either refused or complete; a partial result is never stored.
TEST_F(FittingServiceTest, StopsAFitThatTakesTooLong) {
  const std::string whole = ResultOf(FitOf({"viscous", "coulomb", "drag"}, {{"a", Recording()}, {}, {}}));
  std::size_t stopped = 0, done = 0;
  for (int limit = 1; limit <= 100'000 && done == 0; limit *= 3) {
    options_.fit_time = std::chrono::milliseconds(limit);
    End();
    const HttpResponse response = Post("/v1/fits?models=viscous,coulomb,drag", "text/csv", Recording());
    if (response.status == 200) {
      EXPECT_EQ(response.body, whole) << limit << " ms";
      ++done;
      continue;
    }
    ++stopped;
    EXPECT_THAT(AnswerOf(response), StartsWith("408 the fit was not done after ")) << limit;
    EXPECT_EQ(Json::parse(response.body)["code"], "timed_out");
    EXPECT_FALSE(FieldOf(response, "Retry-After").empty());
  }
  EXPECT_GT(stopped, 0U);
  EXPECT_EQ(done, 1U);
  EXPECT_THAT(IdsAt("/v1/fits"), SizeIs(done));
}

TEST_F(FittingServiceTest, ServesManyClientsAtOnce) {
  constexpr int kThreads = 4, kFits = 3;
  const std::string expected = ResultOf(FitOf({"viscous"}, {{"a", Recording()}, {}, {}}));
  FittingService& service = Service();
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < kFits; ++i) {
        const HttpRequest request{
            "POST", "/v1/fits?model=viscous", {{"Host", "localhost"}, {"Content-Type", "text/csv"}}, Recording()};
        EXPECT_EQ(service.Handle(request).body, expected);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  const auto ids = IdsAt("/v1/fits");
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), kThreads * kFits);
}

// ---- Repeated requests ---------------------------------------------------------------------------------------------

TEST_F(FittingServiceTest, AnswersOncePerKey) {
  const Fields key = {{"Idempotency-Key", "k1"}};
  const HttpResponse first = Post("/v1/fits?model=viscous", "text/csv", Recording(), key);
  EXPECT_EQ(FieldOf(first, "Idempotency-Replayed"), "");
  const HttpResponse again = Post("/v1/fits?model=viscous", "text/csv", Recording(), key);
  EXPECT_EQ(again.status, 200);
  EXPECT_EQ(again.body, first.body);
  EXPECT_EQ(FieldOf(again, "Location"), FieldOf(first, "Location"));
  EXPECT_EQ(FieldOf(again, "Idempotency-Replayed"), "true");
  for (const HttpResponse& other : {Post("/v1/fits?model=viscous", "text/csv", Recording() + "\n", key),
                                    Post("/v1/fits?model=drag", "text/csv", Recording(), key)}) {
    EXPECT_EQ(AnswerOf(other),
              "422 this Idempotency-Key was used for another request; use a new key for a new request");
    EXPECT_EQ(Json::parse(other.body)["code"], "idempotency_key_reused");
  }
  EXPECT_THAT(IdsAt("/v1/fits"), SizeIs(1));
  EXPECT_NE(FieldOf(Post("/v1/fits?model=viscous", "text/csv", Recording()), "Location"), FieldOf(first, "Location"));
}

TEST_F(FittingServiceTest, RecognizesAFormWithAnotherBoundary) {
  const Fields key = {{"Idempotency-Key", "k1"}};
  const std::string form = FormOf(PartOf("data", Recording(), "run.csv") + PartOf("options", R"({"model":"viscous"})"));
  std::string other = form;
  for (std::size_t at = other.find("--X"); at != std::string::npos; at = other.find("--X", at + 1)) {
    other.replace(at, 3, "--QZ81");
  }
  const HttpResponse first = Post("/v1/fits", kForm, form, key);
  ASSERT_EQ(first.status, 200) << first.body;
  const HttpResponse again = Post("/v1/fits", "multipart/form-data; boundary=QZ81", other, key);
  EXPECT_EQ(FieldOf(again, "Location"), FieldOf(first, "Location"));
  EXPECT_EQ(FieldOf(again, "Idempotency-Replayed"), "true");
}

// A short boundary may also occur in the data. Two forms that differ only at such a place are different requests.
TEST_F(FittingServiceTest, DistinguishesFormsWhoseDataContainTheBoundary) {
  const Fields key = {{"Idempotency-Key", "k1"}};
  const auto post = [&](const std::string& name) {
    const std::string head = "--7\r\nContent-Disposition: form-data; name=\"data\"; filename=\"" + name + "\"\r\n\r\n";
    return Post("/v1/fits?model=viscous", "multipart/form-data; boundary=7", head + Recording() + "\r\n--7--\r\n", key);
  };
  ASSERT_EQ(post("run1.csv").status, 200);
  EXPECT_EQ(post("run17.csv").status, 422);
}

TEST_F(FittingServiceTest, ForgetsTheKeyOfAFailedRequest) {
  const Fields key = {{"Idempotency-Key", "k1"}};
  EXPECT_EQ(Post("/v1/fits", "text/csv", "x", key).status, 422);
  EXPECT_EQ(Post("/v1/fits?model=viscous", "text/csv", Recording(), key).status, 200);
  EXPECT_EQ(Post("/v1/fits", "text/csv", Recording(), {{"Idempotency-Key", ""}}).status, 400);
}

TEST_F(FittingServiceTest, RemembersAKeyAfterARestart) {
  const Fields key = {{"Idempotency-Key", "k1"}};
  const HttpResponse first = Post("/v1/fits?model=viscous", "text/csv", Recording(), key);
  End();
  const HttpResponse again = Post("/v1/fits?model=viscous", "text/csv", Recording(), key);
  EXPECT_EQ(again.body, first.body);
  EXPECT_EQ(FieldOf(again, "Idempotency-Replayed"), "true");
}

// Of several simultaneous requests with one key, one is answered. The others must wait or get the same answer.
TEST_F(FittingServiceTest, FitsOncePerKeyForConcurrentRequests) {
  FittingService& service = Service();
  std::vector<HttpResponse> responses(4);
  std::vector<std::thread> threads;
  for (HttpResponse& response : responses) {
    threads.emplace_back([&] {
      response = service.Handle({"POST",
                                 "/v1/fits?model=viscous",
                                 {{"Host", "localhost"}, {"Content-Type", "text/csv"}, {"Idempotency-Key", "k1"}},
                                 Recording()});
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const HttpResponse& response : responses) {
    if (response.status == 200) continue;
    EXPECT_EQ(AnswerOf(response), "409 another request with this Idempotency-Key is in progress");
    EXPECT_FALSE(FieldOf(response, "Retry-After").empty());
  }
  EXPECT_THAT(IdsAt("/v1/fits"), SizeIs(1));
}

// ---- Stored data ---------------------------------------------------------------------------------------------------

TEST_F(FittingServiceTest, ReportsACalibrationTableAsTheCalibrationOfTheResult) {
  const std::string text = "time_s,reading_volts" + Recording().substr(Recording().find('\n'));
  const std::string table = "volts,angle_deg\n-2,-120\n-1,-60\n0,0\n1,60\n2,120\n";
  const HttpResponse response =
      Post("/v1/fits?model=viscous", kForm,
           FormOf(PartOf("data", text, "run.csv") + PartOf("calibration", table, "table.csv")));
  ASSERT_EQ(response.status, 200) << response.body;
  const Json request = JsonAt(FieldOf(response, "Location") + "/request");
  EXPECT_EQ(request["calibration"], Json::parse(response.body)["recordings"][0]["calibration"]);
  EXPECT_FALSE(request["calibration"].is_null());
}

TEST_F(FittingServiceTest, ReportsTheInputsOfAFit) {
  const std::string rig = small_batch::kRigText;
  const HttpResponse response = Post("/v1/fits?from=0", kForm,
                                     FormOf(PartOf("data", Recording(), "swing ü 1.csv") + PartOf("rig", rig) +
                                            PartOf("options", R"({"model": "viscous", "seed": 3})")));
  ASSERT_EQ(response.status, 200) << response.body;
  const std::string location = FieldOf(response, "Location");
  const Json request = JsonAt(location + "/request");
  EXPECT_EQ(request["id"], IdOf(location));
  EXPECT_THAT(request["created"].get<std::string>(), MatchesRegex("20..-..-..T..:..:..Z"));
  EXPECT_TRUE(request["batch"].is_null() && request["calibration"].is_null());
  EXPECT_EQ(request["options"], (Json{{"from", "0"}, {"model", "viscous"}, {"seed", "3"}}));
  EXPECT_EQ(request["rig"], Json::parse(rig));
  EXPECT_EQ(request["data_sha256"], Sha256(Recording()).value());
  const HttpResponse recording = Get(location + "/recording");
  EXPECT_EQ(recording.body, Recording());
  EXPECT_THAT(FieldOf(recording, "Content-Type"), StartsWith("text/csv"));
  EXPECT_THAT(FieldOf(recording, "Content-Disposition"),
              StrCaseEq("attachment; filename*=UTF-8''swing%20%c3%bc%201.csv"));
}

TEST_F(FittingServiceTest, GivesSeriesResidualsReportAndMarkdown) {
  const std::string location = Fitted("?model=viscous&name=my%20run.csv");
  const Identification run = FitOf({"viscous"}, {{"", Recording()}, {}, {}});
  const HttpResponse series = Get(location + "/series");
  EXPECT_EQ(series.status, 200);
  EXPECT_EQ(series.body, ToSeriesJsonText(run));
  const Json sections = Json::parse(Get(location + "/sections").body);
  EXPECT_EQ(sections[0]["id"], "data");
  EXPECT_EQ(sections[0]["blocks"][0]["rows"][0]["text"], "my run.csv");
  const HttpResponse residuals = Get(location + "/residuals");
  EXPECT_THAT(FieldOf(residuals, "Content-Type"), StartsWith("text/csv"));
  EXPECT_EQ(residuals.body, ToResidualCsv(run, 0, 0));
  const HttpResponse report = Get(location + "/report");
  EXPECT_THAT(report.body, StartsWith("<!doctype html>"));
  EXPECT_THAT(report.body, HasSubstr("my run.csv"));
  EXPECT_EQ(FieldOf(report, "Content-Disposition"), "attachment; filename*=UTF-8''my%20run.csv.html");
  EXPECT_THAT(FieldOf(report, "Content-Security-Policy"), HasSubstr("sandbox"));  // a file, not the service's page
  const HttpResponse markdown = Get(location + "/markdown");
  EXPECT_THAT(FieldOf(markdown, "Content-Type"), StartsWith("text/markdown"));
  EXPECT_THAT(markdown.body, HasSubstr("my run.csv"));
}

TEST_F(FittingServiceTest, HasNoResidualsForClosedFormsOnly) {
  const std::string location = Fitted("?model=viscous&closed_form_only=true");
  EXPECT_EQ(Get(location + "/residuals").status, 404);
  EXPECT_EQ(Get(location + "/markdown").status, 200);
  EXPECT_EQ(Get(location + "/series").status, 200);
}

TEST_F(FittingServiceTest, GivesAllSamplesRegardlessOfTheWindow) {
  const Json samples = JsonAt(Fitted("?model=viscous&from=2&to=7") + "/samples");
  EXPECT_EQ(samples["samples"], 320);  // 8 s at 40 Hz
  EXPECT_EQ(samples["unit"], "rad");
  EXPECT_EQ(samples["time_s"].size(), 320U);
  EXPECT_EQ(samples["measured"].size(), 320U);
  EXPECT_EQ(samples["time_s"][0], 0.0);
  EXPECT_NEAR(samples["measured"][0].get<double>(), 0.4, 0.02);  // the pendulum is held at the release angle
}

TEST_F(FittingServiceTest, ThinsLongRecordings) {
  const std::string path = "datasets/recorded.csv";
  const HttpResponse response = Post("/v1/fits?closed_form_only=true", "text/csv", FileText(path));
  ASSERT_EQ(response.status, 200) << response.body;
  const Json samples = JsonAt(FieldOf(response, "Location") + "/samples");
  EXPECT_GT(samples["samples"], 9000);  // 46 s at 200 Hz
  EXPECT_LE(samples["time_s"].size(), 4000U);
  EXPECT_EQ(samples["time_s"].size(), samples["measured"].size());
}

// ---- Refits --------------------------------------------------------------------------------------------------------

TEST_F(FittingServiceTest, RefitsTheSameRecordingWithOtherOptions) {
  const std::string rig = small_batch::kRigText;
  const HttpResponse first =
      Post("/v1/fits?model=viscous&seed=3", kForm, FormOf(PartOf("data", Recording(), "run.csv") + PartOf("rig", rig)));
  const std::string location = FieldOf(first, "Location");
  const HttpResponse refit = Ask("POST", location + "/refits?model=coulomb&seed=");
  ASSERT_EQ(refit.status, 200) << refit.body;
  EXPECT_EQ(refit.body, ResultOf(FitOf({"coulomb"}, {{"a", Recording()}, Share({"rig", rig}), {}})));
  const std::string other = FieldOf(refit, "Location");
  EXPECT_NE(other, location);
  EXPECT_EQ(JsonAt(other + "/request")["options"], (Json{{"model", "coulomb"}}));
  EXPECT_EQ(JsonAt(other + "/request")["name"], "run.csv");
  EXPECT_EQ(Get(location).body, first.body);  // the first fit is unchanged
  const HttpResponse without_rig = Post(location + "/refits", "application/json", R"({"rig": null})");
  EXPECT_TRUE(Json::parse(without_rig.body)["rig"].is_null()) << without_rig.body;
  EXPECT_EQ(AnswerOf(Ask("POST", "/v1/fits/none/refits")), "404 there is no fit none; it may have been deleted");
}

TEST_F(FittingServiceTest, RejectsARefitOfADeletedFit) {
  const std::string location = Fitted();
  const std::string refit = FieldOf(Ask("POST", location + "/refits?model=coulomb"), "Location");
  ASSERT_EQ(Ask("DELETE", location).status, 204);
  EXPECT_EQ(Ask("POST", location + "/refits").status, 404);
  EXPECT_EQ(Get(refit + "/recording").body, Recording());  // the refit still has its recording
}

// ---- Lists and deleting --------------------------------------------------------------------------------------------

TEST_F(FittingServiceTest, ListsItsFits) {
  const std::string first = Fitted("?model=viscous&name=first.csv"), second = Fitted("?models=viscous,coulomb");
  const Json list = JsonAt("/v1/fits");
  ASSERT_EQ(list["fits"].size(), 2U);
  EXPECT_TRUE(list["next"].is_null());
  const Json& item = list["fits"][1];
  EXPECT_EQ(item["id"], IdOf(first));
  EXPECT_EQ(item["name"], "first.csv");
  EXPECT_EQ(item["file"], "first.csv");
  EXPECT_EQ(item["state"], "done");
  EXPECT_EQ(item["exit_code"], 0);
  EXPECT_EQ(item["reason"], "");
  EXPECT_TRUE(item["batch"].is_null() && item["recommended"].is_null());
  const Json result = JsonAt(first);
  EXPECT_EQ(item["models"][0]["model"], "viscous");
  EXPECT_EQ(item["models"][0]["status"], "converged");
  EXPECT_EQ(item["models"][0]["parameters"]["inertia"]["estimate"],
            result["fits"][0]["parameters"]["inertia"]["estimate"]);
  EXPECT_EQ(item["models"][0]["parameters"]["inertia"]["total_std_error"],
            result["fits"][0]["parameters"]["inertia"]["total_std_error"]);
  EXPECT_EQ(item["window_s"], result["recordings"][0]["window_s"]);
  EXPECT_EQ(item["models"][0]["rms_residual"], result["recordings"][0]["fits"][0]["statistics"]["rms_residual_rad"]);
  EXPECT_EQ(list["fits"][0]["recommended"], JsonAt(second)["comparison"]["recommended"]);
  EXPECT_THAT(IdsAt("/v1/fits?model=coulomb"), ElementsAre(IdOf(second)));
  EXPECT_THAT(IdsAt("/v1/fits?name=FIRST"), ElementsAre(IdOf(first)));
  EXPECT_THAT(IdsAt("/v1/fits?status=failed"), IsEmpty());
  EXPECT_THAT(IdsAt("/v1/fits?since=2999-01-01T00:00:00Z"), IsEmpty());
}

TEST_F(FittingServiceTest, ListsInPages) {
  std::vector<std::string> expected;
  for (int i = 0; i < 3; ++i) {
    expected.insert(expected.begin(), IdOf(Fitted("?closed_form_only=true&name=" + std::to_string(i))));
  }
  const Json first = JsonAt("/v1/fits?limit=2");
  EXPECT_THAT(IdsAt("/v1/fits?limit=2"), ElementsAre(expected[0], expected[1]));
  EXPECT_THAT(IdsAt("/v1/fits?limit=2&before=" + first["next"].dump()), ElementsAre(expected[2]));
  EXPECT_THAT(IdsAt("/v1/fits?limit=99999"), SizeIs(3));
}

TEST_F(FittingServiceTest, RenamesAFit) {
  const HttpResponse sent =
      Post("/v1/fits?model=viscous&name=Heavy%20bob", kForm, FormOf(PartOf("data", Recording(), "run.csv")));
  const std::string location = FieldOf(sent, "Location");
  EXPECT_EQ(JsonAt(location + "/request")["name"], "Heavy bob");
  EXPECT_EQ(JsonAt(location + "/request")["file"], "run.csv");
  const auto rename = [&](const std::string& name) {
    const HttpResponse renamed =
        Ask("PATCH", location, {{"Content-Type", "application/json"}}, Json{{"name", name}}.dump());
    EXPECT_EQ(renamed.status, 200) << renamed.body;
    return Json::parse(renamed.body);
  };
  EXPECT_EQ(rename("Lïght bob"), (Json{{"id", IdOf(location)}, {"name", "Lïght bob"}, {"file", "run.csv"}}));
  EXPECT_EQ(JsonAt("/v1/fits?name=light")["fits"].size(), 0U);  // only ASCII letters match in both cases
  EXPECT_EQ(JsonAt("/v1/fits?name=GHT%20BOB")["fits"][0]["name"], "Lïght bob");
  const std::string refit = FieldOf(Ask("POST", location + "/refits?model=coulomb"), "Location");
  EXPECT_EQ(JsonAt(refit + "/request")["name"], "Lïght bob");
  EXPECT_EQ(FieldOf(Get(location + "/recording"), "Content-Disposition"), "attachment; filename*=UTF-8''run.csv");
  EXPECT_EQ(rename("")["name"], "run.csv");
  EXPECT_EQ(AnswerOf(Ask("PATCH", "/v1/fits/none", {{"Content-Type", "application/json"}}, R"({"name": "a"})")),
            "404 there is no fit none; it may have been deleted");
}

TEST_F(FittingServiceTest, StopsTheFitOfAClientThatHasGone) {
  std::stop_source gone;
  gone.request_stop();
  const HttpResponse response = Service().Handle(
      {"POST", "/v1/fits", {{"Host", "localhost"}, {"Content-Type", "text/csv"}}, Recording(), gone.get_token()});
  EXPECT_EQ(AnswerOf(response), "408 the fit was cancelled; send it again if it is still wanted");
  EXPECT_THAT(IdsAt("/v1/fits"), IsEmpty());
}

TEST_F(FittingServiceTest, DeletesAFitWithItsFiles) {
  const std::string location = Fitted();
  const HttpResponse deleted = Ask("DELETE", location);
  EXPECT_EQ(deleted.status, 204);
  EXPECT_EQ(deleted.body, "");
  for (const char* part : {"", "/request", "/recording", "/samples", "/series", "/residuals", "/report", "/markdown"}) {
    EXPECT_EQ(AnswerOf(Get(location + part)), "404 there is no fit " + IdOf(location) + "; it may have been deleted");
  }
  EXPECT_EQ(Ask("DELETE", location).status, 404);
}

}  // namespace
}  // namespace pendulum::fitting_service_test
