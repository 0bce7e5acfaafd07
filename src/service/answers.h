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

/// JSON in the format of the tools: indented by two, with a line break at the end.
HttpResponse JsonAnswer(const nlohmann::ordered_json& json, int status = 200);

HttpResponse TextAnswer(std::string_view content_type, std::string body);

/// A text that browsers save as a file of that name (RFC 6266).
HttpResponse FileAnswer(std::string_view content_type, std::string body, std::string_view name);

HttpResponse ProblemAnswer(const Status& status);

/// kWrongRequest: the query has a parameter that is not in `names`; the message suggests the nearest one.
Result<void> CheckQuery(const RequestTarget& target, const std::vector<std::string_view>& names);

/// The value of a query parameter; empty if it is missing.
std::string QueryValue(const RequestTarget& target, std::string_view name);

/// The value of a query parameter as an integer, at least 1; `otherwise` if it is missing. kInvalidArgument: not such a
/// number.
Result<std::int64_t> QueryNumber(const RequestTarget& target, std::string_view name, std::int64_t otherwise);

/// A random identifier of letters and digits: 96 bits.
std::string MakeId();

/// The requested part of a list: at most `limit` entries, with numbers below `before`.
struct ListPage {
  int limit = 50;
  std::optional<std::int64_t> before;
};

/// The page that the query parameters `limit` (at most 500) and `before` request. Returns the errors of QueryNumber.
Result<ListPage> PageOf(const RequestTarget& target);

/// A run in the form of lists and batches.
nlohmann::ordered_json ItemOf(const ListedFit& fit);

/// A batch without its runs.
nlohmann::ordered_json ItemOf(const ListedBatch& batch);

/// A page of a list with `next`: the value of `before` for the following page, null if this page was not full.
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
