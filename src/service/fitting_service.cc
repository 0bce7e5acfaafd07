// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/fitting_service.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "pendulum/base/try.h"
#include "pendulum/service/problem.h"
#include "pendulum/service/request_target.h"
#include "service/answers.h"
#include "service/routes.h"
#include "service/service_state.h"

namespace pendulum {
namespace {

/// All content of the page comes as files from this server; injected code does not run.
constexpr const char* kPagePolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// No script of other answers runs, even if a browser displays them.
constexpr const char* kDataPolicy = "default-src 'none'; frame-ancestors 'none'; sandbox";

/// Adds the security fields that every answer has.
HttpResponse WithSecurityFields(HttpResponse response) {
  const auto type = std::ranges::find(response.fields, "Content-Type", &HttpField::name);
  const bool is_file =
      std::ranges::find(response.fields, "Content-Disposition", &HttpField::name) != response.fields.end();
  const bool is_page = type != response.fields.end() && type->value.starts_with("text/html") && !is_file;
  if (std::ranges::find(response.fields, "Content-Security-Policy", &HttpField::name) == response.fields.end()) {
    response.fields.push_back({"Content-Security-Policy", is_page ? kPagePolicy : kDataPolicy});
  }
  response.fields.push_back({"X-Content-Type-Options", "nosniff"});
  response.fields.push_back({"Referrer-Policy", "no-referrer"});
  response.fields.push_back({"Cross-Origin-Resource-Policy", "same-origin"});
  if (std::ranges::find(response.fields, "Cache-Control", &HttpField::name) == response.fields.end()) {
    response.fields.push_back({"Cache-Control", "no-store"});
  }
  return response;
}

HttpResponse SecureProblem(const Problem& problem) { return WithSecurityFields(ProblemResponse(problem)); }

/// The method whose route answers a request: HEAD is answered as GET, and the server drops the content.
std::string_view MethodOf(const HttpRequest& request) {
  return request.method == "HEAD" ? "GET" : std::string_view(request.method);
}

/// As ParseTarget, but /docs/ means /docs: people add a slash to the address of the guide, as for folders elsewhere.
Result<RequestTarget> TargetOf(std::string_view target) { return ParseTarget(target == "/docs/" ? "/docs" : target); }

}  // namespace

FittingService::FittingService(std::unique_ptr<ServiceState> state) : state_(std::move(state)) {}

FittingService::~FittingService() = default;

Result<std::unique_ptr<FittingService>> FittingService::Begin(const ServiceOptions& options,
                                                              std::unique_ptr<FitStore> store) {
  std::unique_ptr<ServiceState> state;
  try {
    state = std::make_unique<ServiceState>(options, std::move(store));
  } catch (const std::system_error& error) {
    return Error(StatusCode::kTryAgain,
                 std::string("the service cannot start, ") + error.what() + "; end other processes");
  }
  RETURN_IF_ERROR(state->queue.Begin(options.threads));
  return std::make_unique<FittingService>(std::move(state));
}

Lane FittingService::LaneOf(const HttpRequest& request) const {
  const auto target = TargetOf(request.target);
  if (!target) return Lane::kQuick;
  const Match match = FindRoute(MethodOf(request), target->path);
  return match.route == nullptr ? Lane::kQuick : match.route->lane;
}

std::optional<HttpResponse> FittingService::RefuseHead(const HttpRequest& request) const {
  const auto target = TargetOf(request.target);
  const Match match = target ? FindRoute(MethodOf(request), target->path) : Match{};
  // Access is checked first, so an unauthorized client cannot find out which paths exist.
  const Audience audience = match.route == nullptr ? Audience::kTokenHolders : match.route->audience;
  if (const auto refused = RefuseAccess(request, state_->options.access, audience)) return SecureProblem(*refused);
  if (!target) return SecureProblem(ProblemOf(target.error()));
  if (match.allowed.empty()) {
    return SecureProblem(
        {ProblemKind::kNotFound, "there is nothing at " + target->path + "; GET /openapi.json lists the paths", {}});
  }
  if (match.route == nullptr) return SecureProblem(MethodNotAllowed(request.method, match.allowed));
  if (match.route->query == QueryKind::kOwn) return std::nullopt;
  if (const auto checked = CheckQuery(*target, {}); !checked) return SecureProblem(ProblemOf(checked.error()));
  return std::nullopt;
}

HttpResponse FittingService::Handle(const HttpRequest& request) {
  if (auto refused = RefuseHead(request)) return *std::move(refused);
  auto target = TargetOf(request.target);
  const Match match = FindRoute(MethodOf(request), target->path);
  return WithSecurityFields(match.route->answer(*state_, {request, *std::move(target), match.id}));
}

HttpResponse FittingService::Refusal(int status, const std::string& detail) const {
  return SecureProblem(ProblemOf(status, detail));
}

void FittingService::Count(const Answered& answered) {
  constexpr std::array<std::string_view, 5> kMethods = {"GET", "HEAD", "POST", "PATCH", "DELETE"};
  const bool is_known = std::ranges::find(kMethods, answered.method) != kMethods.end();
  const auto target = TargetOf(answered.target);
  state_->metrics.CountAnswer(is_known ? answered.method : "other",
                              std::string(target ? PatternOf(target->path) : "other"), answered.status, answered.time);
}

void FittingService::CountServer(std::function<ServerCounts()> counts) {
  state_->metrics.set_server(std::move(counts));
}

void FittingService::Stop() {
  state_->is_stopping = true;
  state_->queue.Stop();
}

void FittingService::StopFits() {
  state_->fitter.StopAll();
  state_->batch_fitter.StopAll();
  state_->readings_limit.StopAll();
}

}  // namespace pendulum
