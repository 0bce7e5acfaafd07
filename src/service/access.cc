// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/access.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <openssl/crypto.h>

#include "pendulum/base/format.h"
#include "pendulum/base/sha256.h"
#include "pendulum/service/media_type.h"
#include "pendulum/service/request_target.h"

namespace pendulum {
namespace {

// ---- Authorities ---------------------------------------------------------------------------------------------------

/// "Lab.Example.:8080" as host "lab.example" and port "8080".
struct Authority {
  std::string host, port;

  bool operator==(const Authority& other) const = default;
};

bool IsPort(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && end == text.data() + text.size();
}

bool IsHostName(std::string_view host) {
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '_';
  };
  return !host.empty() && host != "." && std::ranges::all_of(host, is_letter);
}

bool IsBracketedAddress(const std::string& host) {
  in6_addr address{};
  return host.starts_with('[') && host.ends_with(']') &&
         ::inet_pton(AF_INET6, host.substr(1, host.size() - 2).c_str(), &address) == 1;
}

/// std::nullopt if the text is not a host with an optional port (RFC 9110, section 7.2).
std::optional<Authority> ParseAuthority(std::string_view text) {
  if (text.find('\0') != std::string_view::npos) return std::nullopt;
  const std::size_t bracket = text.find(']');
  const std::size_t colon = text.find(':', bracket == std::string_view::npos ? 0 : bracket);
  Authority authority{LowerCase(text.substr(0, colon)),
                      std::string(colon == std::string_view::npos ? "" : text.substr(colon + 1))};
  if (!authority.port.empty() && !IsPort(authority.port)) return std::nullopt;
  if (IsBracketedAddress(authority.host)) return authority;
  if (!IsHostName(authority.host)) return std::nullopt;
  if (authority.host.ends_with('.')) authority.host.pop_back();  // the dot of the DNS root
  return authority;
}

/// The authority of an Origin (RFC 6454, section 6.1), with the default port of its scheme if it has none.
std::optional<Authority> ParseOrigin(std::string_view origin) {
  const bool is_secure = origin.starts_with("https://");
  if (!is_secure && !origin.starts_with("http://")) return std::nullopt;
  auto authority = ParseAuthority(origin.substr(origin.find("//") + 2));
  if (authority && authority->port.empty()) authority->port = is_secure ? "443" : "80";
  return authority;
}

bool IsOwnOrigin(std::string_view origin, std::string_view host) {
  const auto theirs = ParseOrigin(origin);
  auto ours = ParseAuthority(host);
  if (!theirs || !ours) return false;
  if (ours->port.empty()) ours->port = origin.starts_with("https://") ? "443" : "80";
  return *theirs == *ours;
}

// ---- Requests ------------------------------------------------------------------------------------------------------

/// Whether the user typed the address or follows a link to it, in a window and not in a frame.
bool IsNavigation(const HttpRequest& request) {
  const auto is_or_absent = [&request](std::string_view name, std::string_view value) {
    const auto values = request.Fields(name);
    return values.empty() || (values.size() == 1 && values.front() == value);
  };
  return request.method == "GET" && !request.Fields("sec-fetch-mode").empty() &&
         is_or_absent("sec-fetch-mode", "navigate") && is_or_absent("sec-fetch-dest", "document");
}

bool IsFromElsewhere(std::string_view fetch_site) { return fetch_site != "same-origin" && fetch_site != "none"; }

bool IsForeignOrigin(const HttpRequest& request, std::string_view origin, std::string_view host) {
  if (origin == "null") return request.method != "GET" && request.method != "HEAD";
  return !IsOwnOrigin(origin, host);
}

std::optional<Problem> RefuseHost(const HttpRequest& request, const AccessRules& rules) {
  const auto hosts = request.Fields("host");
  if (hosts.size() != 1) {
    return ProblemOf(Status{StatusCode::kInvalidArgument, "the request has " + std::to_string(hosts.size()) +
                                                              " Host fields; it must have one (RFC 9112)"});
  }
  if (!rules.token.empty()) return std::nullopt;
  std::vector<std::string_view> named = {hosts.front()};
  if (const auto authority = AuthorityOf(request.target); !authority.empty()) named.push_back(authority);
  for (const std::string_view host : named) {
    if (IsLoopback(host) || IsListedHost(host, rules.allowed_hosts)) continue;
    return Problem{ProblemKind::kForbidden,
                   "the host " + Quoted(host) + " is not a name of this service; use localhost, or start it with " +
                       "--allowed_hosts and that name",
                   {}};
  }
  return std::nullopt;
}

std::optional<Problem> RefuseToken(const HttpRequest& request, const std::string& token) {
  constexpr std::string_view kScheme = "bearer ";
  const auto values = request.Fields("authorization");
  if (values.empty()) {
    return Unauthorized("the request has no token; send it as Authorization: Bearer TOKEN");
  }
  const std::string_view value = WithoutBlanks(values.front());
  if (values.size() > 1 || LowerCase(value.substr(0, kScheme.size())) != kScheme) {
    return Unauthorized("the Authorization of the request is not a token; send one, as Authorization: Bearer TOKEN");
  }
  if (IsSameSecret(WithoutBlanks(value.substr(kScheme.size())), token)) return std::nullopt;
  return Unauthorized("the token of the request is wrong; send the one in the service's --token_file", "invalid_token");
}

}  // namespace

bool IsSameSecret(std::string_view one, std::string_view other) {
  const auto ours = Sha256(one), theirs = Sha256(other);  // hashes have equal lengths
  return ours && theirs && ours->size() == theirs->size() &&
         CRYPTO_memcmp(ours->data(), theirs->data(), ours->size()) == 0;
}

bool IsLoopback(std::string_view authority) {
  constexpr std::uint32_t kLoopbackNet = 127;
  const auto parsed = ParseAuthority(authority);
  if (!parsed) return false;
  const std::string& host = parsed->host;
  if (host == "localhost" || host.ends_with(".localhost")) return true;  // RFC 6761, section 6.3
  in_addr address{};
  if (::inet_pton(AF_INET, host.c_str(), &address) == 1) return ntohl(address.s_addr) >> 24 == kLoopbackNet;
  in6_addr address6{};
  return IsBracketedAddress(host) && ::inet_pton(AF_INET6, host.substr(1, host.size() - 2).c_str(), &address6) == 1 &&
         std::ranges::equal(address6.s6_addr, in6addr_loopback.s6_addr);
}

bool IsListedHost(std::string_view authority, const std::vector<std::string>& allowed_hosts) {
  const auto host = ParseAuthority(authority);
  return host && std::ranges::any_of(allowed_hosts, [&](const std::string& entry) {
           const auto allowed = ParseAuthority(entry);
           return allowed && allowed->host == host->host && (allowed->port.empty() || allowed->port == host->port);
         });
}

bool IsCrossSite(const HttpRequest& request) {
  const auto sites = request.Fields("sec-fetch-site");
  if (std::ranges::any_of(sites, IsFromElsewhere) && !IsNavigation(request)) return true;
  const auto hosts = request.Fields("host");
  return std::ranges::any_of(request.Fields("origin"), [&](std::string_view origin) {
    return IsForeignOrigin(request, origin, hosts.size() == 1 ? hosts.front() : "");
  });
}

std::optional<Problem> RefuseAccess(const HttpRequest& request, const AccessRules& rules, Audience audience) {
  if (auto refused = RefuseHost(request, rules)) return refused;
  if (IsCrossSite(request)) {
    return Problem{ProblemKind::kForbidden,
                   "the request comes from a page of another site; this service answers only its own page and programs",
                   {}};
  }
  if (rules.token.empty() || audience == Audience::kAnybody) return std::nullopt;
  return RefuseToken(request, rules.token);
}

}  // namespace pendulum
