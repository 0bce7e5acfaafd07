// SPDX-License-Identifier: Apache-2.0
// Any request gets a documented, well-formed answer. A fit or batch that it creates can be requested and deleted.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "pendulum/batch/fit_store.h"
#include "pendulum/service/fitting_service.h"
#include "tests/fuzz/require.h"

namespace pendulum {
namespace {

namespace fs = std::filesystem;

/// A service with small limits and a store in memory, for all inputs; each input deletes what it created.
class Asked {
 public:
  Asked() {
    const fs::path memory = "/dev/shm";
    folder_ = (fs::is_directory(memory) ? memory : fs::temp_directory_path()) /
              ("request_fuzzer_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    auto store = FitStore::Open(folder_ / "fits.sqlite");
    Require(store.has_value());
    ServiceOptions options;
    options.limits = {.max_samples = 200, .max_runs = 4};
    options.access.allowed_hosts = {"lab.example"};
    options.fit_time = std::chrono::milliseconds(200);
    options.threads = 1;
    auto service = FittingService::Begin(options, *std::move(store));
    Require(service.has_value());
    service_ = *std::move(service);
  }
  Asked(const Asked&) = delete;
  Asked& operator=(const Asked&) = delete;
  ~Asked() {
    service_.reset();
    std::error_code error;
    fs::remove_all(folder_, error);
  }

  HttpResponse Handle(const HttpRequest& request) {
    const auto refused = service_->RefuseHead(request);
    (void)service_->LaneOf(request);
    HttpResponse response = service_->Handle(request);
    Require(!refused || refused->status == response.status);
    return response;
  }

 private:
  fs::path folder_;
  std::unique_ptr<FittingService> service_;
};

std::string_view FieldOf(const HttpResponse& response, std::string_view name) {
  const auto found = std::ranges::find(response.fields, name, &HttpField::name);
  return found == response.fields.end() ? std::string_view() : std::string_view(found->value);
}

bool IsLine(std::string_view text) {
  return text.find_first_of(std::string_view("\r\n\0", 3)) == std::string_view::npos;
}

/// Whether a text is a JSON object or array.
bool IsStructured(const std::string& text) { return nlohmann::json::parse(text, nullptr, false).is_structured(); }

void CheckProblem(const HttpResponse& response) {
  Require(FieldOf(response, "Content-Type") == "application/problem+json");
  const auto problem = nlohmann::json::parse(response.body, nullptr, false);
  Require(problem.is_object() && problem["status"] == response.status);
  const auto& detail = problem["detail"].get_ref<const std::string&>();
  Require(!detail.empty() && detail.size() < 8192);
  Require(response.status != 401 || !FieldOf(response, "WWW-Authenticate").empty());
  Require(response.status != 405 || !FieldOf(response, "Allow").empty());
  const bool is_for_later = response.status == 408 || response.status == 429;
  Require(!is_for_later || !FieldOf(response, "Retry-After").empty());
}

void CheckAnswer(const HttpResponse& response) {
  constexpr std::array kStatuses = {200, 202, 204, 304, 400, 401, 403, 404, 405, 408, 409, 413, 415, 422, 429};
  Require(std::ranges::find(kStatuses, response.status) != kStatuses.end());
  for (const HttpField& field : response.fields)
    Require(!field.name.empty() && IsLine(field.name) && IsLine(field.value));
  Require(FieldOf(response, "X-Content-Type-Options") == "nosniff");
  if (response.status >= 400) return CheckProblem(response);
  if (FieldOf(response, "Content-Type") == "application/json") Require(IsStructured(response.body));
  if (!response.events) return;
  const EventText events = response.events();
  Require(events.text.empty() || events.text.ends_with("\n\n"));
}

/// "METHOD TARGET", lines "Name: value", an empty line, and the body, as in HTTP; a Host is added if missing.
HttpRequest RequestOf(std::string_view text) {
  const auto next_line = [&text] {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  };
  HttpRequest request;
  const std::string_view line = next_line();
  const std::size_t blank = line.find(' ');
  request.method = line.substr(0, blank);
  if (blank != std::string_view::npos) request.target = line.substr(blank + 1);
  for (std::string_view field = next_line(); !field.empty(); field = next_line()) {
    const std::size_t colon = field.find(':');
    if (colon == 0 || colon == std::string_view::npos || !IsLine(field)) continue;  // the server rejects such fields
    const std::size_t value = std::min(field.find_first_not_of(" \t", colon + 1), field.size());
    request.fields.push_back({std::string(field.substr(0, colon)), std::string(field.substr(value))});
  }
  if (!request.Field("Host")) request.fields.push_back({"Host", "localhost"});
  request.body = text;
  return request;
}

void Check(std::string_view text) {
  static Asked asked;
  const auto ask = [](const std::string& method, const std::string& target) {
    HttpResponse response = asked.Handle({method, target, {{"Host", "localhost"}}, ""});
    CheckAnswer(response);
    return response;
  };
  const HttpResponse response = asked.Handle(RequestOf(text));
  CheckAnswer(response);
  const std::string location(FieldOf(response, "Location"));
  if (location.empty()) return;
  const HttpResponse again = ask("GET", location);
  if (location.starts_with("/v1/fits/")) {
    Require(again.status == 200 && again.body == response.body);
    for (const char* part : {"/request", "/recording", "/samples"}) Require(ask("GET", location + part).status == 200);
    CheckAnswer(asked.Handle({"POST",
                              location + "/readings",
                              {{"Host", "localhost"}, {"Content-Type", "application/json"}},
                              R"({"parameters": {"inertia": 0.1}})"}));
    for (const char* part : {"/series", "/sections", "/residuals", "/markdown"}) ask("GET", location + part);
  } else {
    ask("GET", location + "/events");
  }
  Require(ask("DELETE", location).status == 204 && ask("GET", location).status == 404);
}

}  // namespace
}  // namespace pendulum

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pendulum::Check(pendulum::TextOf(data, size));
  return 0;
}
