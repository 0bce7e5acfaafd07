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

/// A request refused by the server itself.
struct Refused {
  int status;
  std::string detail;
};

/// The request's body exceeds the limit.
Refused BodyTooLong(std::size_t max_body);

/// The memory for bodies and answers is exhausted.
Refused TooMuchAtOnce();

/// Properties of a request's head other than its fields.
struct RequestHead {
  bool keeps_alive = false;  ///< Another request may follow on the connection.
  bool is_http11 = true;
  bool is_chunked = false, expects_continue = false;
  std::uint64_t content_length = 0;
};

/// Parses one request from the bytes of a connection. It refuses ambiguous heads that Beast accepts, because a proxy
/// might see another end of the request and take one request for two (RFC 9112, section 11.2).
class RequestParser final : private boost::beast::http::basic_parser<true> {
 public:
  RequestParser(std::size_t max_head, std::size_t max_body, ByteBudget& budget);

  /// Parses a complete head and returns its bytes; 0 if it is incomplete. `bytes`: all bytes of the request so far.
  tl::expected<std::size_t, Refused> ReadHead(std::string_view bytes);

  /// Parses bytes of the body and returns their number.
  tl::expected<std::size_t, Refused> ReadBody(std::string_view bytes);

  bool is_done() const { return basic_parser::is_done(); }

  const RequestHead& head() const { return head_; }

  /// The part of the request that was received so far.
  HttpRequest& request() { return request_; }

  /// Frees the memory and budget of an answered request.
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
  bool has_head_ = false;           ///< Later fields are trailers, which are ignored.
  std::optional<Refused> refused_;  ///< Reason to refuse the body.
};

}  // namespace pendulum::wire
