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

/// Whose query a route takes.
enum class QueryKind {
  kNone,  ///< No parameters.
  kOwn,   ///< The answer itself checks them.
};

/// A path and a method that are answered.
struct Route {
  std::string_view method;
  std::string_view path;  ///< "/v1/fits/{id}"
  Lane lane;
  Audience audience;
  QueryKind query;
  Answer answer;
};

std::span<const Route> Routes();

/// A path as a route has it: whether it is an instance of the route's, and what stands for {id} in it.
struct Match {
  const Route* route = nullptr;  ///< Null: of that method there is none.
  std::string id;
  std::string allowed;  ///< The methods that the path has, "GET, HEAD, POST"; empty: there is no such path.
};

Match FindRoute(std::string_view method, std::string_view path);

/// What the path of a target is an instance of; "other" for none.
std::string_view PatternOf(std::string_view path);

}  // namespace pendulum
