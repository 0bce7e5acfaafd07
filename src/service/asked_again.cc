// SPDX-License-Identifier: Apache-2.0
#include "service/asked_again.h"

#include <string>
#include <string_view>
#include <utility>

#include "pendulum/base/sha256.h"
#include "pendulum/service/idempotency_key.h"
#include "pendulum/service/media_type.h"
#include "service/answers.h"
#include "service/batch_answers.h"
#include "service/fit_answers.h"

namespace pendulum {
namespace {

std::string Without(std::string_view part, std::string_view text) {
  if (part.empty()) return std::string(text);
  std::string rest;
  rest.reserve(text.size());
  for (std::size_t next = text.find(part); next != std::string_view::npos; next = text.find(part)) {
    rest += text.substr(0, next);
    text.remove_prefix(next + part.size());
  }
  return rest.append(text);
}

/// What makes two requests the same.
Result<std::string> HashOf(const HttpRequest& http) {
  const std::string head = http.method + " " + http.target + "\n";
  const auto field = http.Field("Content-Type");
  const auto type = field ? ParseMediaType(*field) : Result<MediaType>(MediaType{});
  if (!type) return tl::unexpected(type.error());
  // A form has a boundary of its own each time it is sent.
  const std::string_view boundary = type->Parameter("boundary").value_or("");
  return Sha256(head + type->type + "\n" + Without(boundary, http.body));
}

/// The answer that a request got before.
HttpResponse AnswerAt(ServiceState& state, const Call& call, const std::string& location) {
  const bool is_batch = location.starts_with("/v1/batches/");
  const Call again{call.http, {location, {}}, location.substr(location.rfind('/') + 1)};
  HttpResponse response = is_batch ? GetBatch(state, again) : GetFit(state, again);
  if (response.status == 200 && is_batch) response.status = 202;
  if (response.status < 300) response.fields.push_back({"Location", location});
  response.fields.push_back({"Idempotency-Replayed", "true"});
  return response;
}

/// A key that is taken for as long as this is.
class TakenKey {
 public:
  TakenKey(KeysUnderWay& keys, const std::string& key) : keys_(keys), key_(key), is_taken_(keys.Begin(key)) {}
  TakenKey(const TakenKey&) = delete;
  TakenKey& operator=(const TakenKey&) = delete;
  TakenKey(TakenKey&&) = delete;
  TakenKey& operator=(TakenKey&&) = delete;
  ~TakenKey() {
    if (is_taken_) keys_.End(key_);
  }

  bool is_taken() const { return is_taken_; }

 private:
  KeysUnderWay& keys_;
  const std::string& key_;
  bool is_taken_;
};

}  // namespace

HttpResponse AnswerOnce(ServiceState& state, const Call& call,
                        const std::function<HttpResponse(const std::optional<RequestKey>&)>& answer) {
  const auto key = IdempotencyKey(call.http);
  if (!key) return ProblemAnswer(key.error());
  if (key->empty()) return answer(std::nullopt);
  const auto hash = HashOf(call.http);
  if (!hash) return ProblemAnswer(hash.error());
  const TakenKey taken(state.keys, *key);
  if (!taken.is_taken()) {
    return ProblemResponse(
        RetryLater(ProblemKind::kConflict, "another request with this Idempotency-Key is being worked on"));
  }
  const auto known = state.store->FindAnswer(*key);
  if (!known) return ProblemAnswer(known.error());
  if (!*known) return answer(RequestKey{*key, *hash});
  if ((*known)->request_sha256 == *hash) return AnswerAt(state, call, (*known)->location);
  return ProblemResponse({ProblemKind::kKeyReused,
                          "this Idempotency-Key came with another request before; take a new key for a new request",
                          {}});
}

}  // namespace pendulum
