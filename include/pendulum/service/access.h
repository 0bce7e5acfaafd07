// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/service/http.h"
#include "pendulum/service/problem.h"

namespace pendulum {

/// The token and the host names with which clients may use the service.
struct AccessRules {
  std::string token;                       ///< Clients must send it; empty: no token is needed.
  std::vector<std::string> allowed_hosts;  ///< Host names in addition to loopback names: "lab.example", or with a port.
};

/// Who may request a path. The page's own files and the health check are open to anybody.
enum class Audience { kAnybody, kTokenHolders };

/// Checks the head of a request; std::nullopt: the request is allowed. Problems: no Host or several (400); a Host that
/// is not allowed, or a browser's cross-site request (403); no token or a wrong one (401).
std::optional<Problem> RefuseAccess(const HttpRequest& request, const AccessRules& rules, Audience audience);

/// Whether two secrets are equal. The time does not depend on their lengths or on the position of a difference.
bool IsSameSecret(std::string_view one, std::string_view other);

/// Whether an authority, "localhost:8080", is a name of this machine: localhost and names below it, 127.0.0.0/8, [::1],
/// at any port. A web page that resolves its own name to this machine (DNS rebinding) sends its own name instead.
bool IsLoopback(std::string_view authority);

/// Whether an authority is in the list. Entries without a port match any port; case is ignored.
bool IsListedHost(std::string_view authority, const std::vector<std::string>& allowed_hosts);

/// Whether a browser sent the request from another origin: Sec-Fetch-Site says so and the user did not follow a link,
/// or Origin differs from Host. Clients other than browsers send neither field.
bool IsCrossSite(const HttpRequest& request);

}  // namespace pendulum
