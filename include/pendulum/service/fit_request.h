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

/// A value, or why a request has no answer.
template <typename T>
using OrProblem = tl::expected<T, Problem>;

inline tl::unexpected<Problem> Refused(const Status& status) { return tl::unexpected(ProblemOf(status)); }
inline tl::unexpected<Problem> Refused(ProblemKind kind, std::string detail) {
  return tl::unexpected(Problem{kind, std::move(detail), {}});
}

/// How much one request may ask for.
struct RequestLimits {
  std::size_t max_samples = 200'000;  ///< Lines of a recording.
  std::size_t max_runs = 10'000;      ///< Recordings of a batch.
};

/// What a client asks to be fitted.
struct FitRequest {
  FlagTexts flags;          ///< As they were given; all that they do not say has its default.
  IdentifyOptions options;  ///< What they ask.
  std::vector<NamedBytes> data;
  SharedFile rig, calibration;
};

/// Where recordings have no name of their own.
inline constexpr const char* kUnnamed = "data";

/// Reads the request for one fit: its body is the recording (text/csv), a form (multipart/form-data) with the parts
/// data, rig, calibration and options, or a JSON object of these; its query has flags, and the recording's `name`.
/// Problems: as RunFlagsOf and MakeRunOptions; an unknown or doubled part, another kind of content, too many lines.
OrProblem<FitRequest> ParseFitRequest(const HttpRequest& http, const RequestTarget& target,
                                      const RequestLimits& limits);

/// The same for a batch: a form with one or more parts data.
OrProblem<FitRequest> ParseBatchRequest(const HttpRequest& http, const RequestTarget& target,
                                        const RequestLimits& limits);

/// The changes that a refit asks for: flags whose empty values take away those there were, and a rig or calibration
/// (null takes it away) instead of those there were, as query or JSON object.
OrProblem<FitRequest> ParseRefitRequest(const HttpRequest& http, const RequestTarget& target, FlagTexts flags,
                                        RunFiles files);

/// What flags ask of one run of the service, which has that calibration. Errors as RunFlagsOf and MakeRunOptions;
/// kInvalidArgument: release all.
Result<IdentifyOptions> RunOptionsOf(const FlagTexts& flags, const SharedFile& calibration);

/// kUnsupportedMediaType: the body is of none of these types, or in some coding.
OrProblem<void> CheckKind(const HttpRequest& request, std::span<const std::string_view> types);

/// The flags of a run that was kept, and what they ask of it. kDataLoss: the store has other than it was given.
Result<FlagTexts> FlagsOf(const FitOrder& order);
Result<IdentifyOptions> OptionsOf(const FitOrder& order);

/// A JSON object of texts, numbers and switches as flags. kInvalidArgument: an array or an object in it.
Result<FlagTexts> FlagTextsOf(const nlohmann::ordered_json& object);

/// Flags as a JSON object of texts.
nlohmann::ordered_json JsonOf(const FlagTexts& flags);

}  // namespace pendulum
