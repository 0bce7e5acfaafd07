// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "pendulum/service/access.h"
#include "pendulum/service/http.h"
#include "service/service_state.h"

namespace pendulum {

/// Query parameters of a route.
enum class QueryKind {
  kNone,  ///< No parameters.
  kOwn,   ///< The handler checks them.
};

/// A path and a method with a handler.
struct Route {
  std::string_view method;
  std::string_view path;  ///< "/v1/fits/{id}"
  Lane lane;
  Audience audience;
  QueryKind query;
  Answer answer;
};

std::span<const Route> Routes();

/// The route of a path, and the text in place of {id}.
struct Match {
  const Route* route = nullptr;  ///< nullptr: no route has this path and method.
  std::string id;
  std::string allowed;  ///< The methods of the path, "GET, HEAD, POST"; empty: unknown path.
};

Match FindRoute(std::string_view method, std::string_view path);

/// The pattern that a target's path matches; "other" if none.
std::string_view PatternOf(std::string_view path);

}  // namespace pendulum
