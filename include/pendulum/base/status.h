// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace pendulum {

/// Why an operation could not be carried out. A fit that ran without converging is not an error: see Termination.
enum class StatusCode {
  kInvalidArgument,     ///< The caller asked for something that does not exist or contradicts itself.
  kNotFound,            ///< A file that was named is not there.
  kDataLoss,            ///< A file is there and cannot be read as what it should be.
  kFailedPrecondition,  ///< The data are readable and hold no swing, or too little of one.
  kCannotWrite,         ///< An output cannot be written.
  kTryAgain,            ///< Something else has it now, such as another process: the same later may succeed.
  kInternal,            ///< Our bug.
};

/// An error: its kind, and a sentence that names the quantity, its value, the rule it broke and what to do.
struct Status {
  StatusCode code;
  std::string message;
};

/// A value, or the Status that says why there is none.
template <typename T>
using Result = tl::expected<T, Status>;

/// Shorthand for returning an error from a function that returns Result<T>.
inline tl::unexpected<Status> Error(StatusCode code, std::string message) {
  return tl::unexpected<Status>(Status{code, std::move(message)});
}

/// The process exit code of an error; 0 and 1 belong to fits that ran (see ExitCode(Termination) in fit.h).
/// kInvalidArgument 2, kNotFound 3, kDataLoss 4, kFailedPrecondition 5, kCannotWrite 73, kTryAgain 75, kInternal 70.
int ExitCode(StatusCode code);

/// Something a user should know of a result that nevertheless stands: a stable code and a sentence.
struct Warning {
  std::string code;
  std::string message;
};

}  // namespace pendulum
