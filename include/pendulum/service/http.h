// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

namespace pendulum {

/// A header field. Comparisons of names ignore case (RFC 9110, section 5.1).
struct HttpField {
  std::string name, value;
};

/// A request without any decoding. Header fields have no line breaks; a repeated field occurs once per repetition.
struct HttpRequest {
  std::string method;  ///< "GET"
  std::string target;  ///< Path and query as on the request line: "/v1/fits?model=drag".
  std::vector<HttpField> fields;
  std::string body;                  ///< Complete, without its transfer coding.
  std::stop_token client_gone = {};  ///< Requested when the client has closed the connection (Lane::kFit).

  /// The value of the first field of that name; std::nullopt if there is none.
  std::optional<std::string_view> Field(std::string_view name) const;

  /// The values of all fields of that name, in their order.
  std::vector<std::string_view> Fields(std::string_view name) const;
};

/// The new text of a stream of server-sent events since the last call.
struct EventText {
  std::string text;  ///< Complete events, each with the empty line that ends it. No text if there are no new events.
  bool is_last = false;  ///< No more events follow.
};

/// Returns the next events. Called about ten times a second, from one thread at a time, while the client is connected.
using NextEvents = std::function<EventText()>;

struct HttpResponse {
  int status = 200;
  std::vector<HttpField> fields;  ///< Without Content-Length, Date and Connection, which the server adds.
  std::string body;
  NextEvents events;  ///< If set, a stream of events instead of a body.
};

/// Queue of a request: kQuick for requests that are answered at once, kFit for requests that calculate, kReadings for
/// curves that follow a slider: they take milliseconds and wait for no fit.
enum class Lane { kQuick, kFit, kReadings };

/// Answers requests; called from any number of threads at a time.
class HttpHandler {
 public:
  HttpHandler() = default;
  HttpHandler(const HttpHandler&) = delete;
  HttpHandler& operator=(const HttpHandler&) = delete;
  HttpHandler(HttpHandler&&) = delete;
  HttpHandler& operator=(HttpHandler&&) = delete;
  virtual ~HttpHandler() = default;

  virtual Lane LaneOf(const HttpRequest& request) const = 0;

  /// Refuses a request by its head, before the body is read: no token, a foreign host, an unknown path. std::nullopt:
  /// the request is accepted.
  virtual std::optional<HttpResponse> RefuseHead(const HttpRequest& request) const = 0;

  virtual HttpResponse Handle(const HttpRequest& request) = 0;

  /// The answer to a malformed request or to a request beyond a limit: 400, 408, 413, 417, 429, 431, 500, 503.
  virtual HttpResponse Refusal(int status, const std::string& detail) const = 0;
};

}  // namespace pendulum
