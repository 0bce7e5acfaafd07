// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/service/http.h"
#include "pendulum/service/problem.h"

namespace pendulum {

/// Who may ask.
struct AccessRules {
  std::string token;                       ///< That a client must know; empty: none.
  std::vector<std::string> allowed_hosts;  ///< Beside those of loopback: "lab.example", or with its port.
};

/// What is behind a path: anybody may see the page's own files and whether the service lives.
enum class Audience { kAnybody, kTokenHolders };

/// Why the head of a request refuses it, if it does: no Host or several (400); a Host that is not allowed, or a
/// browser's cross-site request (403); no token or a wrong one (401).
std::optional<Problem> RefuseAccess(const HttpRequest& request, const AccessRules& rules, Audience audience);

/// Whether two secrets are the same, in a time that tells neither where they differ nor how long they are.
bool IsSameSecret(std::string_view one, std::string_view other);

/// Whether an authority, "localhost:8080", is a name of this machine: localhost and names below it, 127.0.0.0/8, [::1],
/// at any port. A page on the web that makes its own name resolve here (DNS rebinding) comes with another.
bool IsLoopback(std::string_view authority);

/// Whether an authority is in the list, at any port where the entry has none; letters in either case.
bool IsListedHost(std::string_view authority, const std::vector<std::string>& allowed_hosts);

/// Whether a browser sent it from another origin: Sec-Fetch-Site says so, unless somebody follows a link to it, or
/// Origin is another than Host. What is no browser has neither field.
bool IsCrossSite(const HttpRequest& request);

}  // namespace pendulum
