// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <boost/beast/http/basic_parser.hpp>
#include <tl/expected.hpp>

#include "pendulum/service/http.h"
#include "service/byte_budget.h"

namespace pendulum::wire {

/// Why the server itself refuses a request.
struct Refused {
  int status;
  std::string detail;
};

/// The request's body is longer than it may be.
Refused BodyTooLong(std::size_t max_body);

/// There is no memory left for what comes in and goes out.
Refused TooMuchAtOnce();

/// What a head says beside the request's own words.
struct RequestHead {
  bool keeps_alive = false;  ///< Another request may follow on the connection.
  bool is_http11 = true;
  bool is_chunked = false, expects_continue = false;
  std::uint64_t content_length = 0;
};

/// One request, from the bytes of a connection as they come. Stricter than Beast where two readings are possible, so
/// that no proxy in front of it takes one request for two (RFC 9112, section 11.2).
class RequestParser final : private boost::beast::http::basic_parser<true> {
 public:
  RequestParser(std::size_t max_head, std::size_t max_body, ByteBudget& budget);

  /// Takes the head if it is whole: bytes to be taken away, 0 where it is not. `bytes`: all from its first byte on.
  tl::expected<std::size_t, Refused> ReadHead(std::string_view bytes);

  /// Takes what belongs to the body: bytes to be taken away.
  tl::expected<std::size_t, Refused> ReadBody(std::string_view bytes);

  bool is_done() const { return basic_parser::is_done(); }

  const RequestHead& head() const { return head_; }

  /// As far as it has come.
  HttpRequest& request() { return request_; }

  /// Once it is answered: gives back what the request has of memory and budget.
  void Forget();

 private:
  using Code = boost::beast::error_code;
  using View = boost::beast::string_view;

  tl::expected<std::size_t, Refused> HeadSize(std::string_view bytes);
  std::optional<Refused> ReadFields();
  std::optional<Refused> ReadLength();
  std::optional<Refused> ReadTarget();
  std::size_t Append(View body, Code& code);

  void on_request_impl(boost::beast::http::verb verb, View method, View target, int version, Code& code) override;
  void on_response_impl(int status, View reason, int version, Code& code) override;
  void on_field_impl(boost::beast::http::field field, View name, View value, Code& code) override;
  void on_header_impl(Code& code) override;
  void on_body_init_impl(const boost::optional<std::uint64_t>& length, Code& code) override;
  std::size_t on_body_impl(View body, Code& code) override;
  void on_chunk_header_impl(std::uint64_t size, View extensions, Code& code) override;
  std::size_t on_chunk_body_impl(std::uint64_t remain, View body, Code& code) override;
  void on_finish_impl(Code& code) override;

  std::size_t max_head_, max_body_;
  HeldBytes held_;
  std::size_t scanned_ = 0;
  HttpRequest request_;
  RequestHead head_;
  bool has_head_ = false;           ///< Fields that come later are trailers, which nobody asks for.
  std::optional<Refused> refused_;  ///< Of the body.
};

}  // namespace pendulum::wire
