// SPDX-License-Identifier: Apache-2.0
#include "service/answers.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <random>
#include <utility>

#include "pendulum/base/json.h"
#include "pendulum/base/try.h"
#include "pendulum/report/estimate_texts.h"
#include "pendulum/report/json_parts.h"
#include "pendulum/request/flag_values.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kHexDigits = "0123456789abcdef";

/// RFC 8187, section 3.2.1: keeps attr-char and escapes all other bytes.
std::string Escaped(std::string_view text) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789!#$&+-.^_`|~";
  std::string escaped;
  for (const char c : text) {
    if (kPlain.find(c) != std::string_view::npos) {
      escaped += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    escaped += {'%', kHexDigits[byte >> 4U], kHexDigits[byte & 15U]};
  }
  return escaped;
}

Json ParameterItem(const ListedParameter& parameter) {
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
  Json item = {{"estimate", number(parameter.estimate)},
               {"std_error", number(parameter.std_error)},
               {"total_std_error", number(parameter.total_std_error)},
               {"unit", parameter.unit}};
  AddTexts(item);
  return item;
}

Json ModelItem(const ListedModel& model) {
  Json parameters = Json::object();
  for (const ListedParameter& parameter : model.parameters) parameters[parameter.name] = ParameterItem(parameter);
  return {{"model", model.model},
          {"status", model.status},
          {"reason", model.reason},
          {"rms_residual", model.rms_residual ? Json(*model.rms_residual) : Json(nullptr)},
          {"residual_unit", TextOrNull(model.residual_unit)},
          {"parameters", std::move(parameters)}};
}

}  // namespace

HttpResponse JsonAnswer(const Json& json, int status) {
  constexpr int kIndent = 2;
  HttpResponse response = TextAnswer("application/json", JsonText(json, kIndent) + "\n");
  response.status = status;
  return response;
}

HttpResponse TextAnswer(std::string_view content_type, std::string body) {
  return {200, {{"Content-Type", std::string(content_type)}}, std::move(body), {}};
}

HttpResponse FileAnswer(std::string_view content_type, std::string body, std::string_view name) {
  HttpResponse response = TextAnswer(content_type, std::move(body));
  response.fields.push_back({"Content-Disposition", "attachment; filename*=UTF-8''" + Escaped(name)});
  return response;
}

HttpResponse ProblemAnswer(const Status& status) { return ProblemResponse(ProblemOf(status)); }

Result<void> CheckQuery(const RequestTarget& target, const std::vector<std::string_view>& names) {
  for (const auto& [name, value] : target.query) {
    if (std::ranges::find(names, name) != names.end()) continue;
    const std::string nearest = NearestName(name, names);
    return Error(StatusCode::kInvalidArgument,
                 "'" + name + "' is not a parameter of this request" +
                     (nearest.empty() ? "; GET /openapi.json lists them" : "; did you mean '" + nearest + "'?"));
  }
  return {};
}

std::string QueryValue(const RequestTarget& target, std::string_view name) {
  const auto found = std::ranges::find(target.query, name, &std::pair<std::string, std::string>::first);
  return found == target.query.end() ? "" : found->second;
}

Result<std::int64_t> QueryNumber(const RequestTarget& target, std::string_view name, std::int64_t otherwise) {
  const std::string text = QueryValue(target, name);
  if (text.empty()) return otherwise;
  std::int64_t number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && rest == text.data() + text.size() && number >= 1) return number;
  return Error(StatusCode::kInvalidArgument,
               std::string(name) + " is '" + text + "'; it must be a whole number, at least 1");
}

Result<ListPage> PageOf(const RequestTarget& target) {
  constexpr std::int64_t kMaxPageSize = 500;
  ListPage page;
  ASSIGN_OR_RETURN(const auto limit, QueryNumber(target, "limit", page.limit));
  ASSIGN_OR_RETURN(const auto before, QueryNumber(target, "before", 0));
  page.limit = static_cast<int>(std::min(limit, kMaxPageSize));
  if (before > 0) page.before = before;
  return page;
}

std::string MakeId() {
  constexpr int kWords = 3;
  std::random_device random;  // the system's generator, which cannot be predicted
  std::string id;
  for (int word = 0; word < kWords; ++word) {
    std::uint32_t bits = random();
    for (int digit = 0; digit < 8; ++digit, bits >>= 4U) id += kHexDigits[bits & 15U];
  }
  return id;
}

Json ItemOf(const ListedFit& fit) {
  Json models = Json::array();
  for (const ListedModel& model : fit.models) models.push_back(ModelItem(model));
  return {{"id", fit.id},
          {"name", fit.ShownName()},
          {"file", fit.file},
          {"created", fit.created},
          {"batch", fit.batch ? Json(*fit.batch) : Json(nullptr)},
          {"state", fit.exit_code ? "done" : "waiting"},
          {"exit_code", fit.exit_code ? Json(*fit.exit_code) : Json(nullptr)},
          {"reason", fit.reason},
          {"window_s", fit.window ? Json(*fit.window) : Json(nullptr)},
          {"recommended", fit.recommended ? Json(*fit.recommended) : Json(nullptr)},
          {"models", std::move(models)}};
}

Json ItemOf(const ListedBatch& batch) {
  return {{"id", batch.id},     {"created", batch.created}, {"runs", batch.runs},
          {"done", batch.done}, {"failed", batch.failed},   {"state", batch.done < batch.runs ? "running" : "done"}};
}

}  // namespace pendulum
