// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/batch/fit_store.h"
#include "pendulum/service/http.h"
#include "pendulum/service/problem.h"
#include "pendulum/service/request_target.h"

namespace pendulum {

/// JSON as the tools write it: indented by two, with a line break at its end.
HttpResponse JsonAnswer(const nlohmann::ordered_json& json, int status = 200);

HttpResponse TextAnswer(std::string_view content_type, std::string body);

/// Text that a browser keeps as a file of that name (RFC 6266).
HttpResponse FileAnswer(std::string_view content_type, std::string body, std::string_view name);

HttpResponse ProblemAnswer(const Status& status);

/// kWrongRequest: the query has a parameter that is none of these; the nearest is suggested.
Result<void> CheckQuery(const RequestTarget& target, const std::vector<std::string_view>& names);

/// The value of a query parameter; empty where it is not there.
std::string QueryValue(const RequestTarget& target, std::string_view name);

/// A whole number, at least 1, that a query parameter gives. kInvalidArgument: it is none.
Result<std::int64_t> QueryNumber(const RequestTarget& target, std::string_view name, std::int64_t otherwise);

/// Letters and digits that nobody guesses: 96 bits.
std::string MakeId();

/// What a client wants of a list: so many, with lesser numbers only.
struct ListPage {
  int limit = 50;
  std::optional<std::int64_t> before;
};

/// The page that a query asks for by limit, of which 500 are given at most, and before. Errors as QueryNumber.
Result<ListPage> PageOf(const RequestTarget& target);

/// A run as lists and batches show it.
nlohmann::ordered_json ItemOf(const ListedFit& fit);

/// A batch without its runs.
nlohmann::ordered_json ItemOf(const ListedBatch& batch);

/// A page of a list, and `next`: the number to ask for those before, null where it was not full.
template <typename Listed>
HttpResponse PageAnswer(const std::string& name, const std::vector<Listed>& all, std::int64_t Listed::*number,
                        int limit) {
  using Json = nlohmann::ordered_json;
  Json items = Json::array();
  for (const Listed& one : all) items.push_back(ItemOf(one));
  const bool is_full = static_cast<int>(all.size()) == limit;
  return JsonAnswer({{name, std::move(items)}, {"next", is_full ? Json(all.back().*number) : Json(nullptr)}});
}

}  // namespace pendulum
