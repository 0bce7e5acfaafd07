// SPDX-License-Identifier: Apache-2.0
#include "service/repeated_request.h"

#include <string>
#include <string_view>
#include <utility>

#include "pendulum/base/sha256.h"
#include "pendulum/base/try.h"
#include "pendulum/service/form_data.h"
#include "pendulum/service/idempotency_key.h"
#include "pendulum/service/media_type.h"
#include "service/answers.h"
#include "service/batch_answers.h"
#include "service/fit_answers.h"

namespace pendulum {
namespace {

/// A text with its length, so that concatenated texts stay distinguishable.
std::string Framed(std::string_view text) { return std::to_string(text.size()) + ":" + std::string(text); }

/// The content of a form without its boundary, which differs in every request.
Result<std::string> FormText(std::string_view content_type, std::string_view body) {
  ASSIGN_OR_RETURN(const auto parts, ParseFormData(content_type, body));
  std::string text;
  for (const FormPart& part : parts) {
    text += Framed(part.name) + Framed(part.filename) + Framed(part.content_type) + Framed(part.content);
  }
  return text;
}

/// A hash that is equal for equal requests.
Result<std::string> HashOf(const HttpRequest& http) {
  const std::string_view type = http.Field("Content-Type").value_or("");
  const std::string head = Framed(http.method) + Framed(http.target);
  if (!LowerCase(type).starts_with("multipart/form-data")) return Sha256(head + Framed(type) + http.body);
  ASSIGN_OR_RETURN(const auto form, FormText(type, http.body));
  return Sha256(head + form);
}

/// The earlier answer to a request.
HttpResponse AnswerAt(ServiceState& state, const Call& call, const std::string& location) {
  const bool is_batch = location.starts_with("/v1/batches/");
  const Call again{call.http, {location, {}}, location.substr(location.rfind('/') + 1)};
  HttpResponse response = is_batch ? GetBatch(state, again) : GetFit(state, again);
  if (response.status == 200 && is_batch) response.status = 202;
  if (response.status < 300) response.fields.push_back({"Location", location});
  response.fields.push_back({"Idempotency-Replayed", "true"});
  return response;
}

/// Reserves a key during its lifetime.
class ReservedKey {
 public:
  ReservedKey(KeysInProgress& keys, const std::string& key) : keys_(keys), key_(key), is_reserved_(keys.Begin(key)) {}
  ReservedKey(const ReservedKey&) = delete;
  ReservedKey& operator=(const ReservedKey&) = delete;
  ReservedKey(ReservedKey&&) = delete;
  ReservedKey& operator=(ReservedKey&&) = delete;
  ~ReservedKey() {
    if (is_reserved_) keys_.End(key_);
  }

  bool is_reserved() const { return is_reserved_; }

 private:
  KeysInProgress& keys_;
  const std::string& key_;
  bool is_reserved_;
};

}  // namespace

HttpResponse AnswerOnce(ServiceState& state, const Call& call,
                        const std::function<HttpResponse(const std::optional<RequestKey>&)>& answer) {
  const auto key = IdempotencyKey(call.http);
  if (!key) return ProblemAnswer(key.error());
  if (key->empty()) return answer(std::nullopt);
  const auto hash = HashOf(call.http);
  if (!hash) return ProblemAnswer(hash.error());
  const ReservedKey taken(state.keys, *key);
  if (!taken.is_reserved()) {
    return ProblemResponse(
        RetryLater(ProblemKind::kConflict, "another request with this Idempotency-Key is in progress"));
  }
  const auto known = state.store->FindAnswer(*key);
  if (!known) return ProblemAnswer(known.error());
  if (!*known) return answer(RequestKey{*key, *hash});
  if ((*known)->request_sha256 == *hash) return AnswerAt(state, call, (*known)->location);
  return ProblemResponse({ProblemKind::kKeyReused,
                          "this Idempotency-Key was used for another request; use a new key for a new request",
                          {}});
}

}  // namespace pendulum
