// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/request_target.h"

#include <algorithm>
#include <optional>
#include <set>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/base/utf8.h"
#include "pendulum/service/media_type.h"
#include "service/escapes.h"

namespace pendulum {
namespace {

tl::unexpected<Status> WrongTarget(std::string_view which, std::string_view text, std::string_view fault) {
  return Error(StatusCode::kInvalidArgument,
               "the " + std::string(which) + " " + Quoted(text) + " " + std::string(fault));
}

/// A decoded piece of a target. `which`: its name in messages.
Result<std::string> DecodedPiece(std::string_view piece, std::string_view which) {
  auto decoded = WithoutEscapes(piece);
  if (!decoded) {
    return WrongTarget(which, piece, "has a % without two hexadecimal digits after it; write a percent sign as %25");
  }
  for (std::string_view rest = *decoded; !rest.empty();) {
    const std::size_t length = Utf8Length(rest);
    if (length == 0) return WrongTarget(which, piece, "is not UTF-8; encode it as UTF-8, then as percent escapes");
    if (IsControl(rest.substr(0, length))) {
      return WrongTarget(which, piece, "has a control character; leave it out");
    }
    rest.remove_prefix(length);
  }
  return *std::move(decoded);
}

Result<std::string> DecodedSegment(std::string_view segment) {
  auto decoded = DecodedPiece(segment, "path segment");
  if (!decoded) return decoded;
  if (decoded->empty()) return WrongTarget("path segment", segment, "is empty; write one slash, and none at the end");
  if (*decoded == "." || *decoded == "..") {
    return WrongTarget("path segment", segment, "is not a name; write the path without it");
  }
  if (decoded->find_first_of("/\\") != std::string::npos) {
    return WrongTarget("path segment", segment, "contains a slash or backslash, which no name has");
  }
  return decoded;
}

Result<std::string> DecodedPath(std::string_view path) {
  if (!path.starts_with('/')) return WrongTarget("path", path, "does not begin with a slash; write /v1/fits");
  if (path == "/") return "/";
  std::string decoded;
  while (!path.empty()) {
    path.remove_prefix(1);  // the leading slash
    const std::string_view segment = path.substr(0, path.find('/'));
    auto name = DecodedSegment(segment);
    if (!name) return name;
    decoded += "/" + *name;
    path.remove_prefix(segment.size());
  }
  return decoded;
}

Result<std::string> DecodedFormText(std::string_view text, std::string_view which) {
  std::string blanks(text);
  std::ranges::replace(blanks, '+', ' ');
  return DecodedPiece(blanks, which);
}

Result<std::vector<std::pair<std::string, std::string>>> DecodedQuery(std::string_view query) {
  std::vector<std::pair<std::string, std::string>> parameters;
  std::set<std::string> names;
  while (!query.empty()) {
    const std::string_view item = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(query.size(), item.size() + 1));
    if (item.empty()) continue;  // as browsers do
    const std::size_t equals = item.find('=');
    auto name = DecodedFormText(item.substr(0, equals), "name of a query parameter");
    if (!name) return tl::unexpected(name.error());
    if (name->empty()) return WrongTarget("query parameter", item, "has no name; write name=value");
    ASSIGN_OR_RETURN(auto value, equals == std::string_view::npos
                                     ? Result<std::string>("")
                                     : DecodedFormText(item.substr(equals + 1), "value of " + Quoted(*name)));
    if (!names.insert(*name).second) return WrongTarget("query parameter", *name, "is given twice; keep one of them");
    parameters.emplace_back(*std::move(name), std::move(value));
  }
  return parameters;
}

/// Length of "http://" or "https://" at the beginning of a target in absolute form; 0 for other forms.
std::size_t SchemeLength(std::string_view target) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (IsSameWord(target.substr(0, scheme.size()), scheme)) return scheme.size();
  }
  return 0;
}

}  // namespace

std::string_view AuthorityOf(std::string_view target) {
  const std::size_t scheme = SchemeLength(target);
  if (scheme == 0) return {};
  target.remove_prefix(scheme);
  return target.substr(0, target.find_first_of("/?#"));
}

Result<RequestTarget> ParseTarget(std::string_view target) {
  if (const std::size_t scheme = SchemeLength(target); scheme > 0) {
    const std::string_view authority = AuthorityOf(target);
    if (authority.empty()) return WrongTarget("target", target, "has no host; write the path alone");
    target.remove_prefix(scheme + authority.size());
    if (target.empty()) target = "/";
  }
  if (target.find('#') != std::string_view::npos) {
    return WrongTarget("target", target, "has a fragment; write # as %23, or leave out what follows it");
  }
  const std::size_t mark = target.find('?');
  ASSIGN_OR_RETURN(auto path, DecodedPath(target.substr(0, mark)));
  ASSIGN_OR_RETURN(auto query, DecodedQuery(mark == std::string_view::npos ? "" : target.substr(mark + 1)));
  return RequestTarget{std::move(path), std::move(query)};
}

}  // namespace pendulum
