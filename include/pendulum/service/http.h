// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pendulum {

/// A header field. Names are compared without regard to case (RFC 9110, section 5.1).
struct HttpField {
  std::string name, value;
};

/// A request as it came, nothing decoded. Header fields have no line breaks; a field that came twice stands twice.
struct HttpRequest {
  std::string method;  ///< "GET"
  std::string target;  ///< Path and query as on the request line: "/v1/fits?model=drag".
  std::vector<HttpField> fields;
  std::string body;  ///< Whole, without its transfer coding.

  /// The value of a field; none where it is not there. Of several the first.
  std::optional<std::string_view> Field(std::string_view name) const;

  /// The values of all fields of that name, in their order.
  std::vector<std::string_view> Fields(std::string_view name) const;
};

/// What a stream of server-sent events has to say since it was asked last.
struct EventText {
  std::string text;      ///< Whole events, each with its empty line; may be empty.
  bool is_last = false;  ///< Nothing will follow.
};

/// Asked some ten times a second, from one thread at a time, while the client listens.
using NextEvents = std::function<EventText()>;

struct HttpResponse {
  int status = 200;
  std::vector<HttpField> fields;  ///< Without Content-Length, Date and Connection, which the server adds.
  std::string body;
  NextEvents events;  ///< If set, a stream of events instead of a body.
};

/// Where the server lets a request wait: what is answered at once, and what calculates.
enum class Lane { kQuick, kFit };

/// What answers requests; any number of threads may ask at a time.
class HttpHandler {
 public:
  HttpHandler() = default;
  HttpHandler(const HttpHandler&) = delete;
  HttpHandler& operator=(const HttpHandler&) = delete;
  HttpHandler(HttpHandler&&) = delete;
  HttpHandler& operator=(HttpHandler&&) = delete;
  virtual ~HttpHandler() = default;

  virtual Lane LaneOf(const HttpRequest& request) const = 0;

  /// Whether its head alone refuses it, before its body is read: no token, a foreign host, a path that does not exist.
  virtual std::optional<HttpResponse> RefuseHead(const HttpRequest& request) const = 0;

  virtual HttpResponse Handle(const HttpRequest& request) = 0;

  /// The answer to what never becomes a request, or cannot be taken: 400, 408, 413, 417, 429, 431, 500, 503.
  virtual HttpResponse Refusal(int status, const std::string& detail) const = 0;
};

}  // namespace pendulum
