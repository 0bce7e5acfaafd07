// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

namespace pendulum {

/// Why an operation could not be carried out. A fit that ran without converging is not an error: see Termination.
enum class StatusCode {
  kInvalidArgument,     ///< The request names something that does not exist, or contradicts itself.
  kNotFound,            ///< A named file does not exist.
  kDataLoss,            ///< A file exists but cannot be read as what it should be.
  kFailedPrecondition,  ///< The data are readable but contain no swing, or too little of one.
  kCannotWrite,         ///< An output cannot be written.
  kTryAgain,            ///< A resource is in use, for example by another process. A later attempt may succeed.
  kInternal,            ///< A bug in this program.
};

/// An error: a code, and a sentence with the quantity, its value, the rule it broke and what to do.
struct Status {
  StatusCode code;
  std::string message;
  /// Flags with which the same request would succeed, each as "--name value" without quotes; empty: none are known.
  /// The tools print the command with these flags, and the service returns them.
  std::vector<std::string> try_flags = {};
};

/// A value, or the Status that explains why there is none.
template <typename T>
using Result = tl::expected<T, Status>;

/// Returns an error from a function that returns Result<T>.
inline tl::unexpected<Status> Error(StatusCode code, std::string message) {
  return tl::unexpected<Status>(Status{code, std::move(message)});
}

/// The error with flags that would help: return WithTry(Error(code, message), {"--unit deg"}). See Status::try_flags.
inline tl::unexpected<Status> WithTry(tl::unexpected<Status> error, std::vector<std::string> flags) {
  error.value().try_flags = std::move(flags);
  return error;
}

/// The error of a part with another message, and the same code and flags to try.
inline tl::unexpected<Status> WithMessage(Status status, std::string message) {
  status.message = std::move(message);
  return tl::unexpected<Status>(std::move(status));
}

/// The process exit code of an error. Codes 0 and 1 belong to fits that ran (see ExitCode(Termination) in
/// fit_report.h). kInvalidArgument 2, kNotFound 3, kDataLoss 4, kFailedPrecondition 5, kCannotWrite 73, kTryAgain 75,
/// kInternal 70.
int ExitCode(StatusCode code);

}  // namespace pendulum
