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

/// What users see of an error: "run.csv:118:5: the sentence", or the sentence alone. Code never looks into it.
std::string MessageAt(const std::string& place, const std::string& sentence);

/// An error: a code, where it is, and a sentence with the quantity, its value, the rule it broke and what to do.
struct Status {
  StatusCode code;
  std::string sentence;
  /// What the sentence is about, as the user named it, from the outer to the inner: a file, perhaps with line and
  /// column, or a flag: "run.csv", "run.csv:118:5", "run.csv: free swing 2", "--model". Empty: the sentence says it.
  std::string place = {};
  /// Flags with which the same request would succeed, each as "--name value" without quotes; empty: none are known.
  /// The tools print the command with these flags, and the service returns them.
  std::vector<std::string> try_flags = {};

  std::string message() const { return MessageAt(place, sentence); }
};

/// A value, or the Status that explains why there is none.
template <typename T>
using Result = tl::expected<T, Status>;

/// Returns an error from a function that returns Result<T>.
inline tl::unexpected<Status> Error(StatusCode code, std::string sentence) {
  return tl::unexpected<Status>(Status{code, std::move(sentence)});
}

/// The same with the place of the error; see Status::place.
inline tl::unexpected<Status> ErrorAt(StatusCode code, std::string place, std::string sentence) {
  return tl::unexpected<Status>(Status{code, std::move(sentence), std::move(place)});
}

/// An error kDataLoss of a file or of a place in it.
inline tl::unexpected<Status> Fault(std::string place, std::string sentence) {
  return ErrorAt(StatusCode::kDataLoss, std::move(place), std::move(sentence));
}

/// The error within an outer place: of column a at "run.csv" it is at "run.csv: column a". An empty place adds nothing.
tl::unexpected<Status> Within(const std::string& place, Status status);

/// The error with flags that would help: return WithTry(Error(code, message), {"--unit deg"}). See Status::try_flags.
inline tl::unexpected<Status> WithTry(tl::unexpected<Status> error, std::vector<std::string> flags) {
  error.value().try_flags = std::move(flags);
  return error;
}

/// The process exit code of an error. Codes 0 and 1 belong to fits that ran (see ExitCode(Termination) in
/// fit_report.h). kInvalidArgument 2, kNotFound 3, kDataLoss 4, kFailedPrecondition 5, kCannotWrite 73, kTryAgain 75,
/// kInternal 70.
int ExitCode(StatusCode code);

}  // namespace pendulum
