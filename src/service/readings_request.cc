// SPDX-License-Identifier: Apache-2.0
#include "service/readings_request.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "pendulum/analysis/readings_at.h"
#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/base/try.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

Result<ReadingsRequest> RequestOf(const Json& body) {
  constexpr std::array<std::string_view, 3> kMembers = {"parameters", "model", "recording"};
  ReadingsRequest request;
  for (const auto& [name, value] : body.items()) {
    if (std::ranges::find(kMembers, name) == kMembers.end()) {
      return Error(StatusCode::kInvalidArgument,
                   "the body has an unknown member " + Quoted(name) + "; its members are " + NameList(kMembers));
    }
  }
  const auto wrong = [&](const std::string& name, const Json& value, const std::string& rule) {
    return Error(StatusCode::kInvalidArgument, name + " is " + JsonForMessage(value) + "; it must be " + rule);
  };
  const Json parameters = body.value("parameters", Json());
  if (!parameters.is_object()) return wrong("parameters", parameters, "an object of numbers");
  for (const auto& [name, value] : parameters.items()) {
    if (!value.is_number()) return wrong("the parameter " + Quoted(name), value, "a number");
    request.values.emplace(name, value.get<double>());
  }
  if (const Json model = body.value("model", Json("")); model.is_string()) {
    request.model = model.get<std::string>();
  } else {
    return wrong("model", model, "a name");
  }
  if (const Json recording = body.value("recording", Json(0U)); recording.is_number_unsigned()) {
    request.recording = recording.get<std::size_t>();
  } else {
    return wrong("recording", recording, "a whole number from 0");
  }
  return request;
}

/// Index of the fit of this model; of the main fit if the model is empty.
Result<std::size_t> FindFit(const Identification& run, const std::string& model) {
  if (model.empty()) return run.MainFit();
  std::vector<std::string_view> models;
  for (const FitReport& fit : run.fits) models.push_back(fit.model.name);
  const auto found = std::ranges::find(models, model);
  if (found != models.end()) return static_cast<std::size_t>(found - models.begin());
  return Error(StatusCode::kInvalidArgument,
               "model is " + Quoted(model) + "; this run has fits of " + NameList(models));
}

}  // namespace

ResultOrProblem<ReadingsRequest> ParseReadingsRequest(const HttpRequest& http) {
  constexpr std::array<std::string_view, 1> kTypes = {"application/json"};
  RETURN_IF_ERROR(CheckKind(http, kTypes));
  const auto body =
      ParseJsonObject(http.body, "the body", "request", R"({"parameters": {"inertia": 0.08}})", http.body.size());
  if (!body) return Refused(ProblemKind::kWrongRequest, body.error().message());
  auto request = RequestOf(*body);
  if (!request) return Refused(request.error());
  return *std::move(request);
}

Result<Json> ReadingsJson(const Identification& run, const ReadingsRequest& request, const std::stop_token& stop) {
  constexpr Eigen::Index kMaxSamples = 4000;
  if (run.fits.empty()) {
    return Error(StatusCode::kNotFound, "this run has only closed forms and no fit, so it has no parameters");
  }
  if (request.recording >= run.recordings.size()) {
    return Error(StatusCode::kInvalidArgument, "recording is " + std::to_string(request.recording) + "; this run has " +
                                                   std::to_string(run.recordings.size()) + ", the first of which is 0");
  }
  ASSIGN_OR_RETURN(const std::size_t fit, FindFit(run, request.model));
  const Recording& used = run.recordings[request.recording].used;
  ASSIGN_OR_RETURN(const Eigen::VectorXd readings,
                   ReadingsAt(used, run.FitOf(request.recording, fit), run.si_rig(), request.values, stop));
  const Eigen::Index stride = (used.size() + kMaxSamples - 1) / kMaxSamples;
  Json time = Json::array(), value = Json::array();
  double squares = 0;
  for (Eigen::Index i = 0; i < used.size(); i += stride) {
    time.push_back(used.time[i]);
    value.push_back(readings[i]);
    squares += std::pow(used.value[i] - readings[i], 2);
  }
  const double rms = std::sqrt(squares / static_cast<double>(value.size()));
  return Json{
      {"time_s", std::move(time)}, {"value", std::move(value)}, {"unit", used.value_unit()}, {"rms_residual", rms}};
}

}  // namespace pendulum
