// SPDX-License-Identifier: Apache-2.0
#include "service/answer_head.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ostream>  // Boost 1.74 does not include it
#include <string_view>

#include <boost/beast/http/status.hpp>

#include "pendulum/service/media_type.h"

namespace pendulum::wire {
namespace {

bool IsServerField(const std::string& name) {
  constexpr std::array<const char*, 4> kOurs = {"Connection", "Content-Length", "Date", "Transfer-Encoding"};
  return std::ranges::any_of(kOurs, [&](const char* ours) { return IsSameWord(ours, name); });
}

std::string Printable(std::string value) {
  std::ranges::replace_if(
      value, [](char c) { return (static_cast<unsigned char>(c) < ' ' && c != '\t') || c == 0x7f; }, ' ');
  return value;
}

std::string Reason(int status) {
  const auto reason = boost::beast::http::obsolete_reason(static_cast<boost::beast::http::status>(status));
  return reason == "<unknown-status>" ? "" : std::string(reason);
}

}  // namespace

bool MayHaveBody(int status) { return status >= 200 && status != 204 && status != 304; }

std::string HttpDate(std::time_t time) {
  constexpr std::array<const char*, 7> kDays = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  constexpr std::array<const char*, 12> kMonths = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                   "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  std::tm utc = {};
  ::gmtime_r(&time, &utc);
  std::array<char, 64> text = {};
  std::snprintf(text.data(), text.size(), "%s, %02d %s %04d %02d:%02d:%02d GMT", kDays.at(utc.tm_wday), utc.tm_mday,
                kMonths.at(utc.tm_mon), utc.tm_year + 1900, utc.tm_hour, utc.tm_min, utc.tm_sec);
  return text.data();
}

std::string AnswerHead(const HttpResponse& response, const Framing& framing, std::time_t now) {
  std::string head = "HTTP/1.1 " + std::to_string(response.status) + " " + Reason(response.status) + "\r\n";
  for (const HttpField& field : response.fields) {
    if (IsToken(field.name) && !IsServerField(field.name)) head += field.name + ": " + Printable(field.value) + "\r\n";
  }
  head += "Date: " + HttpDate(now) + "\r\n";
  if (framing.length) head += "Content-Length: " + std::to_string(*framing.length) + "\r\n";
  if (framing.is_chunked) head += "Transfer-Encoding: chunked\r\n";
  return head + (framing.keeps_alive ? "Connection: keep-alive\r\n\r\n" : "Connection: close\r\n\r\n");
}

}  // namespace pendulum::wire
