// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/fit_request.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace pendulum::fit_request_test {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Pair;
using testing::StartsWith;
using testing::UnorderedElementsAre;

using Json = nlohmann::ordered_json;

constexpr const char* kCsv = "time_s,angle_deg\n0,10\n0.1,9\n";
constexpr const char* kRig = R"({"gravity_torque": 1.8})";
constexpr const char* kCalibration = R"({"input": "counts", "angle_unit": "deg", "coefficients": [-49.6, 0.2]})";
constexpr const char* kForm = "multipart/form-data; boundary=X";

HttpRequest Post(const std::string& target, const std::string& type, std::string body) {
  std::vector<HttpField> fields = {{"Host", "localhost"}};
  if (!type.empty()) fields.push_back({"Content-Type", type});
  return {"POST", target, std::move(fields), std::move(body)};
}

/// A part of a form with the boundary X.
std::string Part(const std::string& name, const std::string& content, const std::string& filename = "") {
  return "--X\r\nContent-Disposition: form-data; name=\"" + name + "\"" +
         (filename.empty() ? "" : "; filename=\"" + filename + "\"") + "\r\n\r\n" + content + "\r\n";
}

std::string Form(const std::string& parts) { return parts + "--X--\r\n"; }

RequestTarget TargetOf(const HttpRequest& request) { return ParseTarget(request.target).value(); }

ResultOrProblem<FitRequest> Fit(const HttpRequest& request, const RequestLimits& limits = {}) {
  return ParseFitRequest(request, TargetOf(request), limits);
}

ResultOrProblem<FitRequest> Batch(const HttpRequest& request, const RequestLimits& limits = {}) {
  return ParseBatchRequest(request, TargetOf(request), limits);
}

/// "400 the sentence" for a problem, otherwise "taken".
std::string Answer(const ResultOrProblem<FitRequest>& request) {
  return request ? "taken" : std::to_string(request.error().status()) + " " + request.error().detail;
}

// ---- Three kinds of body -------------------------------------------------------------------------------------------

TEST(ParseFitRequest, AcceptsAPlainRecording) {
  for (const char* type : {"text/csv", "text/csv; charset=utf-8", "TEXT/CSV", "text/plain", "application/octet-stream",
                           "application/zip", "application/x-matlab-data"}) {
    const auto request = Fit(Post("/v1/fits?model=drag&from=0.5&name=run%201.csv", type, kCsv));
    ASSERT_TRUE(request) << type << ": " << request.error().detail;
    ASSERT_EQ(request->data.size(), 1U);
    EXPECT_EQ(request->data[0].name, "run 1.csv");
    EXPECT_EQ(request->data[0].bytes, kCsv);
    EXPECT_FALSE(request->rig || request->calibration);
    EXPECT_THAT(request->flags, UnorderedElementsAre(Pair("model", "drag"), Pair("from", "0.5")));
    EXPECT_THAT(request->options.models, ElementsAre("drag"));
    EXPECT_EQ(request->options.swing.from, 0.5);
    EXPECT_EQ(request->options.fit.threads, 1);
    EXPECT_EQ(request->options.read.most_unpacked_bytes, 134'217'728);  // 128 MiB
  }
}

TEST(ParseFitRequest, HasTheDefaultsOfTheCommandLine) {
  const auto request = Fit(Post("/v1/fits", "text/csv", kCsv));
  ASSERT_TRUE(request) << request.error().detail;
  EXPECT_EQ(request->data[0].name, kUnnamed);
  EXPECT_THAT(request->flags, IsEmpty());
  EXPECT_THAT(request->options.models, ElementsAre("coulomb"));
}

TEST(ParseFitRequest, AcceptsAForm) {
  const auto request = Fit(Post("/v1/fits?from=1", kForm,
                                Form(Part("options", R"({"models": "viscous,coulomb", "seed": 7, "to": 2.5})") +
                                     Part("data", kCsv, "C:\\lab\\run.csv") + Part("rig", kRig, "my_rig.json") +
                                     Part("calibration", kCalibration))));
  ASSERT_TRUE(request) << request.error().detail;
  ASSERT_EQ(request->data.size(), 1U);
  EXPECT_EQ(request->data[0].name, "run.csv");  // without the folders that old browsers send
  EXPECT_EQ(request->data[0].bytes, kCsv);
  EXPECT_EQ(request->rig->name, "my_rig.json");
  EXPECT_EQ(request->rig->bytes, kRig);
  EXPECT_EQ(request->calibration->name, "calibration");
  EXPECT_EQ(request->calibration->bytes, kCalibration);
  EXPECT_THAT(request->options.models, ElementsAre("viscous", "coulomb"));
  EXPECT_EQ(request->options.swing.from, 1.0);
  EXPECT_EQ(request->options.swing.to, 2.5);
  EXPECT_EQ(request->flags.at("seed"), "7");
}

TEST(ParseFitRequest, AcceptsAJsonObject) {
  const Json body = {{"name", "ünïcode.csv"},
                     {"data", kCsv},
                     {"rig", {{"gravity_torque", {{"value", 1.8}}}}},
                     {"calibration", nullptr},
                     {"options", {{"model", "viscous"}, {"from", 0.25}, {"closed_form_only", true}}}};
  const auto request = Fit(Post("/v1/fits", "application/json", body.dump()));
  ASSERT_TRUE(request) << request.error().detail;
  EXPECT_EQ(request->data.at(0).name, "ünïcode.csv");
  EXPECT_EQ(request->data[0].bytes, kCsv);
  EXPECT_EQ(Json::parse(request->rig->bytes), body["rig"]);
  EXPECT_FALSE(request->calibration);
  EXPECT_THAT(request->flags,
              UnorderedElementsAre(Pair("model", "viscous"), Pair("from", "0.25"), Pair("closed_form_only", "true")));
  EXPECT_TRUE(request->options.closed_form_only);
}

TEST(ParseFitRequest, ShortensFileNamesBetweenCharacters) {
  std::string name = "x";
  while (name.size() < 300) name += "ü";  // two bytes each, so the 200th byte is the first of a pair
  const auto request = Fit(Post("/v1/fits", kForm, Form(Part("data", kCsv, name))));
  ASSERT_TRUE(request) << request.error().detail;
  EXPECT_EQ(request->data[0].name, name.substr(0, 199));
}

TEST(ParseFitRequest, KeepsTheNameInTheQueryBesideThatOfTheFile) {
  const auto form = Fit(Post("/v1/fits?name=mine", kForm, Form(Part("data", kCsv, "run.csv"))));
  ASSERT_TRUE(form) << form.error().detail;
  EXPECT_EQ(form->name, "mine");
  EXPECT_EQ(form->data[0].name, "run.csv");
}

TEST(ParseNameRequest, CountsCharactersInsteadOfBytes) {
  std::string name;
  for (int i = 0; i < 200; ++i) name += "ü";
  const auto parse = [](const std::string& body, const std::string& type = "application/json") {
    const auto read = ParseNameRequest({"PATCH", "/v1/fits/1", {{"Content-Type", type}}, body});
    return read ? *read : std::to_string(read.error().status()) + " " + read.error().detail;
  };
  EXPECT_EQ(parse(Json{{"name", name}}.dump()), name);
  EXPECT_EQ(parse(R"({"name": "a"})", "application/merge-patch+json"), "a");
  EXPECT_EQ(parse(R"({"name": ""})"), "");
  EXPECT_EQ(parse(Json{{"name", name + "x"}}.dump()), "400 name has 201 characters; it must have 1 to 200");
  EXPECT_EQ(parse(R"({"name": "a\nb"})"), "400 name \"a\\x0ab\" has control characters; leave them out");
  for (const char* body : {"{}", R"({"name": 3})", R"({"name": "a", "rig": null})"}) {
    EXPECT_THAT(parse(body), EndsWith("it must have one member, name, a text")) << body;
  }
  EXPECT_THAT(parse("a", "text/plain"), StartsWith("415 "));
}

// ---- Refused requests ----------------------------------------------------------------------------------------------

TEST(ParseFitRequest, RefusesOtherContentTypes) {
  constexpr const char* kWanted = "; it must be text/csv, multipart/form-data or application/json";
  EXPECT_EQ(Answer(Fit(Post("/v1/fits", "", kCsv))), std::string("415 the body has no Content-Type") + kWanted);
  EXPECT_EQ(Answer(Fit(Post("/v1/fits", "image/png", kCsv))),
            std::string("415 the Content-Type is \"image/png\"") + kWanted);
  EXPECT_THAT(Answer(Fit(Post("/v1/fits", "application/x-www-form-urlencoded", kCsv))),
              HasSubstr("the default of curl"));
  HttpRequest request = Post("/v1/fits", "text/csv", kCsv);
  request.fields.push_back({"Content-Encoding", "gzip"});
  EXPECT_EQ(Answer(Fit(request)), "415 the body has Content-Encoding \"gzip\"; send it as it is, without one");
  request.fields.back().value = " Identity ";
  EXPECT_EQ(Answer(Fit(request)), "taken");
}

// An invalid Content-Type is shown, not reported as missing.
TEST(ParseFitRequest, ShowsAnInvalidContentType) {
  EXPECT_THAT(Answer(Fit(Post("/v1/fits", "csv", kCsv))), HasSubstr("\"csv\""));
}

struct WrongFit {
  std::string answer, target, type, body;
};

TEST(ParseFitRequest, RefusesAndExplainsInvalidRequests) {
  const std::string data = Part("data", kCsv);
  const std::vector<WrongFit> wrong = {
      {"400 --modle is not a flag of this request; did you mean --model?", "/v1/fits?modle=drag", "text/csv", kCsv},
      {"400 --from has an empty value; leave the flag out for its default", "/v1/fits?from=", "text/csv", kCsv},
      {"400 --model and --models are the same flag; give only one of them", "/v1/fits?model=drag&models=drag",
       "text/csv", kCsv},
      {"400 --release all gives several results for a recording, but a request has one; give the number of a release",
       "/v1/fits?release=all", "text/csv", kCsv},
      {"400 name has 0 characters; it must have 1 to 200", "/v1/fits?name=", "text/csv", kCsv},
      {"400 name has 201 characters; it must have 1 to 200", "/v1/fits?name=" + std::string(201, 'n'), "text/csv",
       kCsv},
      {"400 --model is given in the query and in options; leave one of them out", "/v1/fits?model=drag", kForm,
       Form(data + Part("options", R"({"model": "drag"})"))},
      {"400 --model is given in the query and in options; leave one of them out", "/v1/fits?model=drag",
       "application/json", R"({"data": "", "options": {"model": "drag"}})"},
      {"400 the form has a part \"file\"; it may have data, rig, calibration, sensor and options", "/v1/fits", kForm,
       Form(data + Part("file", "x"))},
      {"400 the form has two parts rig; leave one of them out", "/v1/fits", kForm,
       Form(data + Part("rig", "{}") + Part("rig", "{}"))},
      {"400 the form has two parts options; leave one of them out", "/v1/fits", kForm,
       Form(data + Part("options", "{}") + Part("options", "{}"))},
      {"400 the request has 2 recordings (parts data), but a fit has one; use POST /v1/batches for several", "/v1/fits",
       kForm, Form(data + data)},
      {"400 the request has 0 recordings (parts data), but a fit has one; use POST /v1/batches for several", "/v1/fits",
       kForm, Form(Part("rig", "{}"))},
      {"400 the request has 0 recordings (parts data), but a fit has one; use POST /v1/batches for several", "/v1/fits",
       "application/json", "{}"},
      {"400 \"daat\" is \"x\"; the body may have data and name (texts), rig, calibration and options (objects)",
       "/v1/fits", "application/json", R"({"data": "", "daat": "x"})"},
      {"400 \"data\" is 3; the body may have data and name (texts), rig, calibration and options (objects)", "/v1/fits",
       "application/json", R"({"data": 3})"},
      {"400 \"options\" is null; the body may have data and name (texts), rig, calibration and options (objects)",
       "/v1/fits", "application/json", R"({"data": "", "options": null})"},
      {"400 rig is \"mine\"; it must be an object or null", "/v1/fits", "application/json",
       R"({"data": "", "rig": "mine"})"},
      {"400 name has 0 characters; it must have 1 to 200", "/v1/fits", "application/json",
       R"({"data": "", "name": ""})"},
      {"400 --from is an array; it must be a text, a number, true or false", "/v1/fits", "application/json",
       R"({"data": "", "options": {"from": [1]}})"},
      {"400 --to is null; it must be a text, a number, true or false", "/v1/fits", kForm,
       Form(data + Part("options", R"({"to": null})"))},
      {"400 the body: the key \"data\" is given twice; keep one of them", "/v1/fits", "application/json",
       R"({"data": "", "data": ""})"},
  };
  for (const WrongFit& fit : wrong) EXPECT_EQ(Answer(Fit(Post(fit.target, fit.type, fit.body))), fit.answer);
}

TEST(ParseFitRequest, ReportsInvalidJson) {
  EXPECT_THAT(Answer(Fit(Post("/v1/fits", "application/json", "{\n\"data\": x}"))),
              StartsWith("400 the body:2:9: this is not JSON ("));
  EXPECT_THAT(Answer(Fit(Post("/v1/fits", "application/json", "[]"))),
              StartsWith("400 the body: the request is an array; it must be an object"));
  EXPECT_THAT(Answer(Fit(Post("/v1/fits", kForm, Form(Part("data", kCsv) + Part("options", "{"))))),
              StartsWith("400 options:1:2: this is not JSON ("));
  EXPECT_THAT(Answer(Fit(Post("/v1/fits", kForm, "nothing"))), StartsWith("400 "));
  EXPECT_THAT(Answer(Fit(Post("/v1/fits", "multipart/form-data", Form(Part("data", kCsv))))), StartsWith("400 "));
}

TEST(ParseFitRequest, AcceptsTheMaximumNumberOfLines) {
  const RequestLimits limits{3, 10};
  const std::string lines = "t,x\n1,1\n2,2\n";
  EXPECT_EQ(Answer(Fit(Post("/v1/fits", "text/csv", lines), limits)), "taken");
  EXPECT_EQ(Answer(Fit(Post("/v1/fits?name=run.csv", "text/csv", lines + "3,3\n"), limits)),
            "413 run.csv: the recording has 4 lines, but this service accepts at most 3 samples; send a part of it, or "
            "use fit_pendulum");
}

// A batch of ten thousand runs stores the options ten thousand times.
TEST(ParseBatchRequest, LimitsTheLengthOfOptions) {
  const auto answer = [](std::size_t blanks) {
    const std::string options = R"({"model": "drag)" + std::string(blanks, ' ') + "\"}";
    return Answer(Batch(Post("/v1/batches", kForm, Form(Part("data", kCsv) + Part("options", options)))));
  };
  EXPECT_EQ(answer(8177), "413 the options have 8193 bytes, but may have only 8192; leave some out");
  EXPECT_THAT(answer(8176), Not(StartsWith("413")));
}

// Names are used in files and messages. A name in JSON with control characters is refused, as in a query
// (RequestTarget); in the filename of a form they are replaced.
TEST(ParseFitRequest, AcceptsNoControlCharactersInNames) {
  for (const auto& request : {Fit(Post("/v1/fits", "application/json", R"({"data": "", "name": "a\nb"})")),
                              Fit(Post("/v1/fits", "application/json", R"({"data": "", "name": "a\u001b[2J"})")),
                              Fit(Post("/v1/fits", kForm, Form(Part("data", kCsv, "a%0D%0Ab"))))}) {
    const std::string name = request ? request->data.at(0).name : "";
    EXPECT_TRUE(std::ranges::none_of(name, [](char c) { return c >= 0 && c < ' '; })) << name;
  }
}

// ---- Batches -------------------------------------------------------------------------------------------------------

TEST(ParseBatchRequest, AcceptsManyRecordingsWithSharedFiles) {
  const auto request = Batch(Post(
      "/v1/batches?model=viscous", kForm,
      Form(Part("data", "1", "a.csv") + Part("rig", kRig) + Part("data", "2", "b.csv") + Part("data", "3", "a.csv"))));
  ASSERT_TRUE(request) << request.error().detail;
  ASSERT_EQ(request->data.size(), 3U);
  EXPECT_EQ(request->data[0].name, "a.csv");
  EXPECT_EQ(request->data[1].bytes, "2");
  EXPECT_EQ(request->data[2].name, "a.csv");
  EXPECT_EQ(request->rig->bytes, kRig);
  EXPECT_THAT(request->options.models, ElementsAre("viscous"));
}

TEST(ParseBatchRequest, RefusesAndExplainsInvalidRequests) {
  const std::string data = Part("data", kCsv, "run.csv");
  EXPECT_EQ(Answer(Batch(Post("/v1/batches", "text/csv", kCsv))),
            "415 the Content-Type is \"text/csv\"; it must be multipart/form-data");
  EXPECT_EQ(Answer(Batch(Post("/v1/batches?name=a", kForm, Form(data)))),
            "400 name is for a single fit; in a batch each part has a name");
  EXPECT_EQ(Answer(Batch(Post("/v1/batches", kForm, Form(Part("rig", "{}"))))),
            "400 the form has no part data; a batch needs at least one");
  EXPECT_EQ(Answer(Batch(Post("/v1/batches", kForm, Form(data + data + data)), {100, 2})),
            "413 the batch has 3 recordings, but this service accepts at most 2; send several batches");
  EXPECT_THAT(Answer(Batch(Post("/v1/batches", kForm, Form(data)), {2, 10})),
              StartsWith("413 run.csv: the recording has 3 lines"));
  EXPECT_THAT(Answer(Batch(Post("/v1/batches?modle=drag", kForm, Form(data)))),
              StartsWith("400 --modle is not a flag"));
}

// ---- Refits --------------------------------------------------------------------------------------------------------

/// A refit of a run with these flags, a rig and a calibration.
ResultOrProblem<FitRequest> Refit(const std::string& query, const std::string& body = "",
                                  const std::string& type = "application/json") {
  const HttpRequest request = Post("/v1/fits/1/refits" + query, body.empty() ? "" : type, body);
  return ParseRefitRequest(request, TargetOf(request), {{"model", "drag"}, {"from", "0.5"}},
                           {{"run.csv", kCsv}, Share({"rig", kRig}), Share({"calibration", kCalibration})});
}

TEST(ParseRefitRequest, KeepsAllInputsIfNothingIsChanged) {
  const auto request = Refit("");
  ASSERT_TRUE(request) << request.error().detail;
  EXPECT_THAT(request->flags, UnorderedElementsAre(Pair("model", "drag"), Pair("from", "0.5")));
  EXPECT_EQ(request->data.at(0).name, "run.csv");
  EXPECT_EQ(request->data[0].bytes, kCsv);
  EXPECT_TRUE(request->rig && request->calibration);
}

TEST(ParseRefitRequest, ChangesAddsAndRemovesFlags) {
  const auto query = Refit("?models=viscous,coulomb&to=3&from=&name=again");
  ASSERT_TRUE(query) << query.error().detail;
  EXPECT_THAT(query->flags, UnorderedElementsAre(Pair("models", "viscous,coulomb"), Pair("to", "3")));
  EXPECT_EQ(query->name, "again");
  const auto body = Refit("", R"({"options": {"from": 0.75, "model": ""}})");
  ASSERT_TRUE(body) << body.error().detail;
  EXPECT_THAT(body->flags, ElementsAre(Pair("from", "0.75")));
  EXPECT_THAT(body->options.models, ElementsAre("coulomb"));  // the default
}

TEST(ParseRefitRequest, ReplacesOrRemovesRigAndCalibration) {
  const auto request = Refit("", R"({"rig": {"gravity_torque": {"value": 2}}, "calibration": null})");
  ASSERT_TRUE(request) << request.error().detail;
  EXPECT_EQ(Json::parse(request->rig->bytes)["gravity_torque"]["value"], 2);
  EXPECT_FALSE(request->calibration);
}

TEST(ParseRefitRequest, RefusesAndExplainsInvalidRequests) {
  EXPECT_EQ(Answer(Refit("", R"({"data": "x"})")), "400 a refit uses the stored recording; leave data out");
  EXPECT_EQ(Answer(Refit("", kCsv, "text/csv")),
            "415 the Content-Type is \"text/csv\"; it must be application/json, or the body must be empty");
  EXPECT_EQ(Answer(Refit("?modle=drag")), "400 --modle is not a flag of this request; did you mean --model?");
  EXPECT_EQ(Answer(Refit("?model=drag&models=drag")),
            "400 --model and --models are the same flag; give only one of them");
  EXPECT_EQ(
      Answer(Refit("?release=all")),
      "400 --release all gives several results for a recording, but a request has one; give the number of a release");
  EXPECT_THAT(Answer(Refit("", R"({"name": ""})")), StartsWith("400 "));
}

// An unknown flag, or a name in the body, would otherwise be ignored silently.
TEST(ParseRefitRequest, IgnoresNothingSilently) {
  EXPECT_EQ(Answer(Refit("?modle=")), "400 --modle is not a flag of this request; did you mean --model?");
  const auto named = Refit("", R"({"name": "again"})");
  EXPECT_TRUE(!named || named->name == "again");
}

// ---- Flags as JSON -------------------------------------------------------------------------------------------------

TEST(JsonOf, IsReadBackAsTheSameFlags) {
  const FlagTexts flags = {{"model", "drag"}, {"init", "a=\"1\",\\ü"}, {"from", "0.1"}};
  const auto back = FlagTextsOf(JsonOf(flags));
  ASSERT_TRUE(back) << back.error().message();
  EXPECT_EQ(*back, flags);
}

TEST(FlagTextsOf, WritesNumbersAndSwitchesAsText) {
  const auto flags = FlagTextsOf({{"from", 0.1}, {"seed", 18446744073709551615U}, {"closed_form_only", false}});
  ASSERT_TRUE(flags) << flags.error().message();
  EXPECT_EQ(flags->at("from"), "0.1");
  EXPECT_EQ(flags->at("seed"), "18446744073709551615");
  EXPECT_EQ(flags->at("closed_form_only"), "false");
}

TEST(OptionsOf, ReportsUnknownFlagsInAStore) {
  FitOrder order;
  order.flags = "model=drag";
  ASSERT_FALSE(OptionsOf(order));
  EXPECT_EQ(OptionsOf(order).error().code, StatusCode::kDataLoss);
  order.flags = R"({"model": "drag"})";
  EXPECT_THAT(OptionsOf(order)->models, ElementsAre("drag"));
}

}  // namespace
}  // namespace pendulum::fit_request_test
