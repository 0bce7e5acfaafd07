// SPDX-License-Identifier: Apache-2.0
#include "service/request_parser.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>
#include <vector>

#include <boost/asio/buffer.hpp>

#include "pendulum/base/format.h"
#include "pendulum/service/media_type.h"

namespace pendulum::wire {
namespace {

/// Limit for an incomplete line with a chunk's size, and for an incomplete trailer, in bytes.
constexpr std::size_t kMaxBetweenChunks = std::size_t{8} << 10;

constexpr std::size_t kFirstCapacity = std::size_t{64} << 10;

tl::unexpected<Refused> Malformed(std::string detail) { return tl::unexpected(Refused{400, std::move(detail)}); }

/// Describes the byte at `i` of a head if it is forbidden. Beast would accept some of these as blanks and would join
/// folded lines.
std::optional<std::string> WrongByte(std::string_view bytes, std::size_t i) {
  const auto byte = static_cast<unsigned char>(bytes[i]);
  const bool is_last = i + 1 == bytes.size();
  if (byte == '\n') {
    if (i == 0 || bytes[i - 1] != '\r') return "a line of the request's head ends without CR";
    if (!is_last && (bytes[i + 1] == ' ' || bytes[i + 1] == '\t')) {
      return "a field of the request's head is folded over several lines; send it in one line";
    }
  } else if (byte == '\r') {
    if (!is_last && bytes[i + 1] != '\n') return "there is a CR within a line of the request's head";
  } else if ((byte < ' ' && byte != '\t') || byte == 0x7f) {
    return "there is a control character in the request's head; this port speaks HTTP/1.1 without TLS";
  }
  return std::nullopt;
}

}  // namespace

Refused BodyTooLong(std::size_t max_body) { return {413, "the request's body is longer than " + SizeText(max_body)}; }

Refused TooMuchAtOnce() { return {429, "too many bytes are being received and sent; try again later"}; }

RequestParser::RequestParser(std::size_t max_head, std::size_t max_body, ByteBudget& budget)
    : max_head_(max_head), max_body_(max_body), held_(budget) {
  header_limit(static_cast<std::uint32_t>(max_head));
  // Append checks the limit, after the handler has seen the head. Without a limit Boost 1.74 would refuse every length.
  body_limit(std::numeric_limits<std::uint64_t>::max());
}

tl::expected<std::size_t, Refused> RequestParser::HeadSize(std::string_view bytes) {
  for (std::size_t i = scanned_ - std::min<std::size_t>(scanned_, 1); i < bytes.size(); ++i) {
    if (i >= max_head_) {
      return tl::unexpected(
          Refused{431, "the request's line and fields are longer than " + std::to_string(max_head_) + " bytes"});
    }
    if (auto wrong = WrongByte(bytes, i)) return Malformed(*wrong);
    const std::string_view until = bytes.substr(0, i + 1);
    if (until.ends_with("\r\n\r\n")) return until.size();
    if (until.ends_with("\r\n") && bytes.find('\r') + 1 == i && until.find(" HTTP/") == std::string_view::npos) {
      return Malformed("the first line is not a request line of HTTP/1.1");
    }
  }
  scanned_ = bytes.size();
  return 0;
}

tl::expected<std::size_t, Refused> RequestParser::ReadHead(std::string_view bytes) {
  auto size = HeadSize(bytes);
  if (!size || *size == 0) return size;
  Code code;
  put(boost::asio::const_buffer(bytes.data(), *size), code);
  if (code) return Malformed("the request's head is not HTTP/1.1: " + code.message());
  if (auto refused = ReadFields()) return tl::unexpected(std::move(*refused));
  eager(true);
  return size;
}

std::optional<Refused> RequestParser::ReadFields() {
  head_.keeps_alive = head_.is_http11 && keep_alive();
  const std::size_t hosts = request_.Fields("Host").size();
  if (hosts > 1 || (hosts == 0 && head_.is_http11)) {
    return Refused{400, "the request has " + std::to_string(hosts) + " Host fields; HTTP/1.1 requires exactly one"};
  }
  if (auto refused = ReadLength()) return refused;
  if (auto refused = ReadTarget()) return refused;
  for (const std::string_view expected : request_.Fields("Expect")) {
    if (!IsSameWord(expected, "100-continue")) {
      return Refused{417, "the request expects \"" + std::string(expected) + "\"; only 100-continue is supported"};
    }
    head_.expects_continue = head_.is_http11;
  }
  return std::nullopt;
}

std::optional<Refused> RequestParser::ReadLength() {
  const auto lengths = request_.Fields("Content-Length"), codings = request_.Fields("Transfer-Encoding");
  if (lengths.size() + codings.size() > 1) {
    return Refused{400, "the length of the request's body is given more than once"};
  }
  if (!codings.empty()) {
    if (!head_.is_http11 || !IsSameWord(codings[0], "chunked")) {
      return Refused{400, "a Transfer-Encoding other than chunked, or one in HTTP/1.0, is not supported"};
    }
    head_.is_chunked = true;
  }
  if (lengths.empty()) return std::nullopt;
  const char* end = lengths[0].data() + lengths[0].size();
  const auto read = std::from_chars(lengths[0].data(), end, head_.content_length);
  if (read.ec != std::errc() || read.ptr != end) {
    return Refused{400, "Content-Length \"" + std::string(lengths[0]) + "\" is not a number of bytes"};
  }
  return std::nullopt;
}

std::optional<Refused> RequestParser::ReadTarget() {
  std::string& target = request_.target;
  if (request_.method == "CONNECT" || request_.method == "TRACE") {
    return Refused{400, "method " + request_.method + " is not supported"};
  }
  constexpr std::string_view kScheme = "http://";
  if (IsSameWord(target.substr(0, kScheme.size()), kScheme)) {  // as sent to a proxy; RFC 9112, section 3.2.2
    const std::size_t path = std::min(target.find_first_of("/?", kScheme.size()), target.size());
    const std::string authority = target.substr(kScheme.size(), path - kScheme.size());
    const auto host = request_.Field("Host");
    if (!host || !IsSameWord(*host, authority)) {
      return Refused{400, "the request's target names host \"" + authority + "\", but its Host field names another"};
    }
    target.erase(0, path);
    if (!target.starts_with('/')) target.insert(0, "/");
  }
  if (target.starts_with('/') || (target == "*" && request_.method == "OPTIONS")) return std::nullopt;
  return Refused{400, "the request's target must be a path that begins with /"};
}

tl::expected<std::size_t, Refused> RequestParser::ReadBody(std::string_view bytes) {
  Code code;
  const std::size_t taken = put(boost::asio::const_buffer(bytes.data(), bytes.size()), code);
  if (refused_) return tl::unexpected(std::move(*refused_));
  if (code && code != boost::beast::http::error::need_more) {
    return Malformed("the request's body is not chunked as in HTTP/1.1: " + code.message());
  }
  if (bytes.size() - taken > kMaxBetweenChunks && !is_done()) {
    return Malformed("the line of a chunk's size, or the trailer, is longer than " + std::to_string(kMaxBetweenChunks) +
                     " bytes");
  }
  return taken;
}

void RequestParser::Forget() {
  request_ = HttpRequest();
  held_.Release();
}

std::size_t RequestParser::Append(View body, Code& code) {
  std::string& text = request_.body;
  if (body.size() > max_body_ - text.size()) {
    refused_ = BodyTooLong(max_body_);
  } else if (!held_.Take(body.size())) {
    refused_ = TooMuchAtOnce();
  }
  if (refused_) {
    code = boost::beast::http::error::body_limit;
    return 0;
  }
  const std::size_t size = text.size() + body.size();
  if (size > text.capacity()) {  // allocates at most the size if it is known
    const std::size_t more = std::max(kFirstCapacity, 2 * size);
    text.reserve(head_.is_chunked ? more : std::min<std::size_t>(more, head_.content_length));
  }
  text.append(body.data(), body.size());
  return body.size();
}

void RequestParser::on_request_impl(boost::beast::http::verb, View method, View target, int version, Code&) {
  request_.method = std::string(method);
  request_.target = std::string(target);
  head_.is_http11 = version == 11;
}

void RequestParser::on_response_impl(int, View, int, Code&) {}

void RequestParser::on_field_impl(boost::beast::http::field, View name, View value, Code&) {
  if (!has_head_) request_.fields.push_back({std::string(name), std::string(value)});
}

void RequestParser::on_header_impl(Code&) { has_head_ = true; }

void RequestParser::on_body_init_impl(const boost::optional<std::uint64_t>&, Code&) {}

std::size_t RequestParser::on_body_impl(View body, Code& code) { return Append(body, code); }

void RequestParser::on_chunk_header_impl(std::uint64_t size, View, Code& code) {
  if (size <= max_body_ - request_.body.size()) return;
  refused_ = BodyTooLong(max_body_);
  code = boost::beast::http::error::body_limit;
}

std::size_t RequestParser::on_chunk_body_impl(std::uint64_t, View body, Code& code) { return Append(body, code); }

void RequestParser::on_finish_impl(Code&) {}

}  // namespace pendulum::wire
