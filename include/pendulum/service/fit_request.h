// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <tl/expected.hpp>

#include "pendulum/batch/fit_store.h"
#include "pendulum/identify/identify.h"
#include "pendulum/identify/identify_options.h"
#include "pendulum/request/named_flags.h"
#include "pendulum/service/http.h"
#include "pendulum/service/problem.h"
#include "pendulum/service/request_target.h"

namespace pendulum {

/// A value, or the problem of a request.
template <typename T>
using ResultOrProblem = tl::expected<T, Problem>;

inline tl::unexpected<Problem> Refused(const Status& status) { return tl::unexpected(ProblemOf(status)); }
inline tl::unexpected<Problem> Refused(ProblemKind kind, std::string detail) {
  return tl::unexpected(Problem{kind, std::move(detail), {}});
}

/// Limits of one request.
struct RequestLimits {
  std::size_t max_samples = 200'000;  ///< Lines of a recording.
  std::size_t max_runs = 10'000;      ///< Recordings of a batch.
};

/// A client's request for fits.
struct FitRequest {
  FlagTexts flags;          ///< The given flags; missing flags have their defaults.
  IdentifyOptions options;  ///< The options that the flags set.
  std::vector<NamedBytes> data;
  SharedFile rig, calibration;
  std::string name;  ///< Of a single fit; empty if not given.
};

/// Name of recordings sent without a name.
inline constexpr const char* kUnnamed = "data";

/// Reads the request for one fit. The body is the recording (text/csv), a form (multipart/form-data) with the parts
/// data, rig, calibration, sensor (the flag of this name) and options, or a JSON object with all of these but sensor.
/// The query has flags and the `name` of the fit, which is also the name of a recording without a file name. Problems:
/// as RunFlagsOf and MakeIdentifyOptions; an unknown or repeated part, another content type, too many lines.
ResultOrProblem<FitRequest> ParseFitRequest(const HttpRequest& http, const RequestTarget& target,
                                            const RequestLimits& limits);

/// Reads the request for a batch: as ParseFitRequest, but the body is a form with one or more parts named data.
ResultOrProblem<FitRequest> ParseBatchRequest(const HttpRequest& http, const RequestTarget& target,
                                              const RequestLimits& limits);

/// Reads the body {"name": "..."} of a request that names a fit. An empty name removes it. Problems: another content
/// type or member; control characters; more than 200 characters.
ResultOrProblem<std::string> ParseNameRequest(const HttpRequest& http);

/// Reads the changes of a refit from the query and, if there is a body, from a JSON object. A flag with an empty value
/// removes the previous flag. A new rig or calibration replaces the previous one; null removes it.
ResultOrProblem<FitRequest> ParseRefitRequest(const HttpRequest& http, const RequestTarget& target, FlagTexts flags,
                                              RunFiles files);

/// The options of one run of the service with these flags and this calibration. Errors as RunFlagsOf and
/// MakeIdentifyOptions; kInvalidArgument: the flag release is `all`.
Result<IdentifyOptions> IdentifyOptionsOf(const FlagTexts& flags, const SharedFile& calibration);

/// kUnsupportedMediaType: the body has none of these types, or has a content coding.
ResultOrProblem<void> CheckKind(const HttpRequest& request, std::span<const std::string_view> types);

/// The flags of a stored run, and the options they set. kDataLoss: the stored text is damaged.
Result<FlagTexts> FlagsOf(const FitOrder& order);
Result<IdentifyOptions> OptionsOf(const FitOrder& order);

/// Converts a JSON object of strings, numbers and booleans to flags. kInvalidArgument: it contains an array or an
/// object.
Result<FlagTexts> FlagTextsOf(const nlohmann::ordered_json& object);

/// Flags as a JSON object of strings.
nlohmann::ordered_json JsonOf(const FlagTexts& flags);

}  // namespace pendulum
