// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/batch/store.h"

namespace pendulum {

/// Numbers of fits of one law, by their status.
struct LawCounts {
  std::string law;
  std::int64_t fits = 0, converged = 0, not_converged = 0, not_identifiable = 0, failed = 0;
};

/// In how many runs with several laws one was recommended.
struct RecommendationCount {
  std::string law;  ///< Empty: none was recommended.
  std::int64_t runs = 0;
};

/// Fits that did not converge, with the same status, exit code and reason.
struct FailureCount {
  std::string status;
  int exit_code = 0;
  std::string reason;  ///< Without the file name; # stands for numbers that differ.
  std::int64_t fits = 0;
  std::vector<std::string> laws, examples;  ///< examples: ids of at most ten runs.
};

/// The counts of a store: the most frequent recommendation and failure first.
struct StoreOverview {
  std::vector<LawCounts> laws;
  std::vector<RecommendationCount> recommendations;
  std::vector<FailureCount> failures;
};

/// Counts the fits of a store. Errors: of the store.
Result<StoreOverview> Overview(Store& store);

}  // namespace pendulum
