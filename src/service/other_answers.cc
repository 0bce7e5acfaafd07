// SPDX-License-Identifier: Apache-2.0
#include "service/other_answers.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "pendulum/base/json.h"
#include "pendulum/base/sha256.h"
#include "pendulum/base/try.h"
#include "pendulum/base/version.h"
#include "pendulum/model/friction/registry.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/nesting.h"
#include "pendulum/recording/calibration/calibrate.h"
#include "pendulum/recording/calibration/calibration_table.h"
#include "pendulum/report/calibration_text.h"
#include "pendulum/report/equation.h"
#include "pendulum/report/json_parts.h"
#include "pendulum/request/calibration_flags.h"
#include "pendulum/request/simulation.h"
#include "pendulum/request/simulation_text.h"
#include "pendulum/service/fit_request.h"
#include "pendulum/web/service_page.h"
#include "service/answers.h"
#include "service/guide_files.h"
#include "service/service_files.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

FlagTexts QueryFlags(const RequestTarget& target) { return {target.query.begin(), target.query.end()}; }

/// A simulation from the query, or from a JSON object that may contain a rig.
struct SimulationRequest {
  FlagTexts flags;
  std::optional<Rig> rig;
};

Result<SimulationRequest> ParseSimulationRequest(const Call& call) {
  SimulationRequest request{QueryFlags(call.target), std::nullopt};
  if (call.http.body.empty()) return request;
  auto json = ParseJsonObject(call.http.body, "the body", "simulation", R"({"set": "inertia=0.079,..."})");
  if (!json) return Error(StatusCode::kInvalidArgument, json.error().message());
  if (json->contains("rig") && !(*json)["rig"].is_null()) {
    ASSIGN_OR_RETURN(auto rig, ParseRig(JsonText((*json)["rig"]), "rig"));
    request.rig = std::move(rig);
  }
  json->erase("rig");
  ASSIGN_OR_RETURN(const auto flags, FlagTextsOf(*json));
  for (const auto& [name, text] : flags) {
    if (request.flags.emplace(name, text).second) continue;
    return Error(StatusCode::kInvalidArgument, "--" + name + " is given in the query and in the body");
  }
  return request;
}

ResultOrProblem<void> CheckSimulatedSamples(const SimulationFlags& flags, const RequestLimits& limits) {
  const double samples = flags.duration * flags.rate;
  if (!(samples > static_cast<double>(limits.max_samples))) return {};
  return Refused(ProblemKind::kTooLarge, "--duration times --rate gives more samples than this service accepts, " +
                                             std::to_string(limits.max_samples) + "; use simulate_pendulum for more");
}

bool WantsCsv(const HttpRequest& http) {
  return http.Field("Accept").value_or("").find("text/csv") != std::string_view::npos;
}

bool WantsPage(const HttpRequest& http) {
  return http.Field("Accept").value_or("").find("text/html") != std::string_view::npos;
}

/// For browsers: the links of the page to the guide lead here if the guide is not installed.
HttpResponse NoGuidePage() {
  constexpr std::string_view kPage = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>The user guide is not installed</title>
<link rel="stylesheet" href="/app.css">
</head>
<body>
<main class="page service">
<h1>The user guide is not installed</h1>
<p>The packages contain the guide. A build from the sources has it only if mkdocs and KaTeX are there.
Run these commands in the folder of the sources, and start <code>serve_pendulum</code> again, with your other flags:</p>
<pre><code>scripts/docs
serve_pendulum --docs build/docs</code></pre>
<p>The same text, to read without a build, is in the folder <code>src/docs</code>; begin with <code>index.md</code>.</p>
<p><a href="/">Back to the service</a></p>
</main>
</body>
</html>
)";
  HttpResponse response = TextAnswer("text/html; charset=utf-8", std::string(kPage));
  response.status = 404;
  return response;
}

Json PointsJson(const CalibrationTable& table, const CalibrationFit& fit) {
  Json points = Json::array();
  for (Eigen::Index i = 0; i < table.size(); ++i) {
    points.push_back({{"reading", table.reading[i]},
                      {"angle", table.angle[i]},
                      {"fitted", table.angle[i] - fit.residual[i]},
                      {"residual", fit.residual[i]},
                      {"left_out", fit.left_out.size() > i ? Json(fit.left_out[i]) : Json(nullptr)}});
  }
  return points;
}

Json CoefficientJson(const CoefficientText& coefficient) {
  const auto& [value, error] = coefficient.value;
  return {
      {"name", coefficient.name}, {"text", value + (error.empty() ? "" : " ± " + error)}, {"unit", coefficient.unit}};
}

Json ParameterJson(const ParameterInfo& info) {
  return {{"name", info.name},
          {"symbol", info.symbol},
          {"unit", info.unit},
          {"lower", NumberOrNull(info.lower)},
          {"upper", NumberOrNull(info.upper)}};
}

/// A model with the description of its friction law, or of its gravity if that is not the default.
Json ModelJson(const MotionModel& model) {
  std::string label, about;
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    label = F::kTitle;
    about = F::kAbout;
  });
  if (model.gravity != Gravity()) {
    label += " and " + std::string(model.gravity.title());
    about = model.gravity.about();
  }
  Json nested_in = Json::array(), parameters = Json::array();
  for (const MotionModel& richer : MotionModels()) {
    if (richer.name != model.name && FindNesting(model, richer)) nested_in.push_back(richer.name);
  }
  for (const ParameterInfo& info : PhysicalParameters(model)) parameters.push_back(ParameterJson(info));
  return {{"name", model.name},
          {"label", label},
          {"about", about},
          {"gravity", model.gravity.name()},
          {"equation", SymbolicEquation(model)},
          {"nested_in", std::move(nested_in)},
          {"parameters", std::move(parameters)}};
}

Json ExampleItem(const Example& example) {
  return {{"name", example.name},
          {"title", example.title},
          {"about", example.about},
          {"models", example.models},
          {"has_rig", !example.rig.empty()}};
}

HttpResponse NoLive() {
  return ProblemAnswer({StatusCode::kNotFound,
                        "this service watches no recording; start serve_pendulum with --live run.csv, the file that "
                        "record_pendulum --out run.csv writes"});
}

std::string EntityTagOf(std::string_view content) { return "\"" + Sha256(content).value_or("").substr(0, 32) + "\""; }

/// A file of the page; a browser loads it again only after a change.
HttpResponse PageFile(const Call& call, std::string_view type, std::string_view content, const std::string& tag) {
  const bool is_known = call.http.Field("If-None-Match").value_or("").find(tag) != std::string_view::npos;
  HttpResponse response = TextAnswer(type, is_known ? "" : std::string(content));
  if (is_known) response.status = 304;
  response.fields.push_back({"ETag", tag});
  response.fields.push_back({"Cache-Control", "no-cache"});
  return response;
}

}  // namespace

HttpResponse PostSimulation(ServiceState& state, const Call& call) {
  if (auto checked = CheckQuery(call.target, SimulationFlagNames()); !checked) return ProblemAnswer(checked.error());
  constexpr std::array<std::string_view, 1> kTypes = {"application/json"};
  if (auto checked = call.http.body.empty() ? ResultOrProblem<void>() : CheckKind(call.http, kTypes); !checked) {
    return ProblemResponse(checked.error());
  }
  const auto request = ParseSimulationRequest(call);
  if (!request) return ProblemAnswer(request.error());
  const auto flags = SimulationFlagsOf(request->flags);
  if (!flags) return ProblemAnswer(flags.error());
  if (auto checked = CheckSimulatedSamples(*flags, state.options.limits); !checked) {
    return ProblemResponse(checked.error());
  }
  const auto simulation = MakeSimulation(*flags, request->rig);
  if (!simulation) return ProblemAnswer(simulation.error());
  auto csv = SimulatedCsv(*simulation, flags->seed);
  if (!csv) return ProblemAnswer(csv.error());
  if (WantsCsv(call.http)) return TextAnswer("text/csv; charset=utf-8", *std::move(csv));
  const auto truth = Json::parse(TruthJson(*simulation, flags->seed));
  return JsonAnswer({{"recording", *std::move(csv)}, {"truth", truth}});
}

HttpResponse PostCalibration(ServiceState& /*state*/, const Call& call) {
  if (auto checked = CheckQuery(call.target, CalibrationFlagNames()); !checked) return ProblemAnswer(checked.error());
  constexpr std::array<std::string_view, 2> kTypes = {"text/csv", "text/plain"};
  if (auto checked = CheckKind(call.http, kTypes); !checked) return ProblemResponse(checked.error());
  const auto flags = CalibrationFlagsOf(QueryFlags(call.target));
  if (!flags) return ProblemAnswer(flags.error());
  const auto options = MakeCalibrationOptions(*flags);
  if (!options) return ProblemAnswer(options.error());
  const auto table = ParseCalibrationTable(call.http.body, "table");
  if (!table) return ProblemAnswer(table.error());
  const auto fit = CalibrateTable(*table, *options);
  if (!fit) return ProblemAnswer(fit.error());
  const auto rms = fit->LeaveOneOutRms();
  return JsonAnswer({{"calibration", fit->calibration.source},
                     {"order", fit->order},
                     {"coefficients", ArrayOf(CoefficientTexts(*table, *fit), CoefficientJson)},
                     {"points", PointsJson(*table, *fit)},
                     {"leave_one_out_rms", rms ? Json(*rms) : Json(nullptr)},
                     {"text", CalibrationText(*table, *fit)}});
}

HttpResponse GetModels(ServiceState& /*state*/, const Call& /*call*/) {
  Json models = Json::array();
  for (const MotionModel& model : MotionModels()) models.push_back(ModelJson(model));
  return JsonAnswer({{"models", std::move(models)}});
}

HttpResponse ListExamples(ServiceState& /*state*/, const Call& /*call*/) {
  Json examples = Json::array();
  for (const Example& example : Examples()) examples.push_back(ExampleItem(example));
  return JsonAnswer({{"examples", std::move(examples)}});
}

HttpResponse GetExample(ServiceState& /*state*/, const Call& call) {
  for (const Example& example : Examples()) {
    if (example.name != call.id) continue;
    Json json = ExampleItem(example);
    json.erase("has_rig");
    json["recording"] = example.recording;
    json["rig"] = example.rig.empty() ? Json(nullptr) : Json::parse(example.rig);
    return JsonAnswer(json);
  }
  return ProblemAnswer({StatusCode::kNotFound, "there is no example '" + call.id + "'; GET /v1/examples lists them"});
}

HttpResponse GetLive(ServiceState& state, const Call& /*call*/) {
  if (!state.live) return NoLive();
  state.live->Poll();
  return TextAnswer("application/json", state.live->StatusJson() + "\n");
}

HttpResponse GetLiveEvents(ServiceState& state, const Call& /*call*/) {
  if (!state.live) return NoLive();
  HttpResponse response;
  response.events = state.live->Listen();
  return response;
}

HttpResponse GetLiveRecording(ServiceState& state, const Call& /*call*/) {
  if (!state.live) return NoLive();
  auto bytes = state.live->Bytes();
  if (!bytes) return ProblemAnswer(bytes.error());
  return FileAnswer("text/csv; charset=utf-8", *std::move(bytes), state.live->Status().name);
}

HttpResponse GetHealth(ServiceState& state, const Call& /*call*/) {
  const bool is_stopping = state.is_stopping;
  return JsonAnswer({{"status", is_stopping ? "stopping" : "ok"}, {"version", kVersion}}, is_stopping ? 503 : 200);
}

HttpResponse GetMetrics(ServiceState& state, const Call& /*call*/) {
  return TextAnswer("text/plain; version=0.0.4; charset=utf-8", state.metrics.Text(state.queue.waiting()));
}

HttpResponse GetOpenApi(ServiceState& /*state*/, const Call& /*call*/) {
  static const std::string document = OpenApiDocument();
  return TextAnswer("application/json", document);
}

HttpResponse GetPage(ServiceState& /*state*/, const Call& call) {
  static const std::string tag = EntityTagOf(FilledServicePage());
  return PageFile(call, "text/html; charset=utf-8", FilledServicePage(), tag);
}

HttpResponse GetScript(ServiceState& /*state*/, const Call& call) {
  static const std::string tag = EntityTagOf(ServiceScript());
  return PageFile(call, "text/javascript; charset=utf-8", ServiceScript(), tag);
}

HttpResponse GetStyle(ServiceState& /*state*/, const Call& call) {
  static const std::string tag = EntityTagOf(ServiceStyle());
  return PageFile(call, "text/css; charset=utf-8", ServiceStyle(), tag);
}

HttpResponse GetGuide(ServiceState& /*state*/, const Call& /*call*/) {
  HttpResponse response;
  response.status = 302;
  response.fields.push_back({"Location", "/docs/index.html"});
  return response;
}

HttpResponse GetGuideFile(ServiceState& state, const Call& call) {
  const auto file = ReadGuideFile(state.options.docs, call.id);
  if (!file) {
    const bool is_installed = ReadGuideFile(state.options.docs, "index.html").has_value();
    return !is_installed && WantsPage(call.http) ? NoGuidePage() : ProblemAnswer(file.error());
  }
  HttpResponse response = PageFile(call, file->type, file->bytes, EntityTagOf(file->bytes));
  // Its search is a script. No script may send or fetch anything: the operator may choose any folder.
  response.fields.push_back({"Content-Security-Policy",
                             "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; base-uri "
                             "'none'; form-action 'none'; frame-ancestors 'none'"});
  return response;
}

}  // namespace pendulum
