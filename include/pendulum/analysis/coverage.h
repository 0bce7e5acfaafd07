// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pendulum/analysis/coverage_scenarios.h"
#include "pendulum/base/status.h"

namespace pendulum {

/// Size, seed and threads of a coverage study.
struct CoverageOptions {
  int count = 1000;        ///< Number of recordings, or of sets of recordings; at least 1.
  int runs = 1;            ///< Recordings per set, fitted together; 1: each recording alone.
  std::uint64_t seed = 1;  ///< Recording i (0-based) has seed + i; recording k of set i has seed + i · runs + k.
  int threads = 0;         ///< 0: one per core. The result does not depend on the number.
  std::function<void(int done)> progress;  ///< Called with the number of recordings done, by one thread at a time.
};

/// Statistics of one parameter over the fits of all recordings.
struct CoverageRow {
  std::string parameter;
  std::string unit;
  bool at_bound = false;     ///< The true value is at the parameter's bound.
  int covered = 0;           ///< Number of recordings whose total 95 % interval contains the true value.
  int without_interval = 0;  ///< Number of recordings without an interval.
  double coverage = 0, coverage_lower = 0, coverage_upper = 1;  ///< covered / recordings and its BinomialInterval95.
  std::optional<double> rms_error;                              ///< Of the estimates of converged fits, in `unit`.
  /// Root mean square, over converged fits, of error / Cramér-Rao bound of the same recording; absent without a bound.
  std::optional<double> error_over_bound;
  /// Mean total standard error / rms error, over the fits that give a standard error.
  std::optional<double> std_error_over_error;
  bool covers = false, precise = false;  ///< Coverage and error satisfy the scenario's rule.

  bool passes() const { return covers && precise; }
};

/// Results of a scenario that was simulated and fitted many times.
struct CoverageStudy {
  CoverageScenario scenario;
  int recordings = 0;  ///< Number of recordings, or of sets of recordings.
  int runs = 1;        ///< Recordings per set.
  int converged = 0;
  int failed = 0;                 ///< Number of fits without a report. A fit with a report may not have converged.
  std::vector<CoverageRow> rows;  ///< P, in FitParameters' order.
};

/// Simulates the recordings of a scenario and fits each with FitRecording, from start values found in its data. The
/// recordings of a set are fitted together with FitJointly; they are released from 0.7 to 1.3 times the scenario's
/// angle, and only shared parameters are counted. An interval with one end is unbounded on the other side. A missing
/// interval, or a parameter missing from the report, counts as not covered. Errors: as SimulateRecording, for the first
/// recording that cannot be made; kInvalidArgument also for count, runs or threads out of their domain. Cost: some
/// milliseconds per recording.
Result<CoverageStudy> StudyCoverage(const CoverageScenario& scenario, const CoverageOptions& options);

/// 95 % confidence interval of a probability after `successes` in `trials` (Clopper & Pearson, Biometrika 26:404,
/// 1934).
struct BinomialInterval {
  double lower = 0, upper = 1;
};
BinomialInterval BinomialInterval95(int successes, int trials);

}  // namespace pendulum
