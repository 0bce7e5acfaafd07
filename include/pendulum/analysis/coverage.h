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

/// How a coverage study is made.
struct CoverageOptions {
  int count = 1000;        ///< Recordings, or sets of them; at least 1.
  int runs = 1;            ///< Recordings of a set, fitted together; 1: each alone.
  std::uint64_t seed = 1;  ///< Recording i (0-based) has seed + i, number k of set i seed + i · runs + k.
  int threads = 0;         ///< 0: as many as there are cores. The result does not depend on it.
  std::function<void(int done)> progress;  ///< Called with the recordings done so far, by one thread at a time.
};

/// What the fits of all recordings make of one parameter.
struct CoverageRow {
  std::string parameter;
  std::string unit;
  bool at_bound = false;                  ///< The truth is at the parameter's bound.
  int covered = 0, without_interval = 0;  ///< Recordings whose 95 % interval contains the truth; that have none.
  double coverage = 0, coverage_lower = 0, coverage_upper = 1;  ///< covered / recordings and its BinomialInterval95.
  std::optional<double> rms_error;                              ///< Of the estimates of converged fits, in `unit`.
  /// Root mean square of error / Cramér-Rao bound of its recording, of converged fits; absent where there is no bound.
  std::optional<double> error_over_bound;
  /// Mean standard error / rms error, of the fits that give a standard error.
  std::optional<double> std_error_over_error;
  bool covers = false, precise = false;  ///< Coverage and error are as the scenario's rule asks.

  bool passes() const { return covers && precise; }
};

/// A scenario, simulated and fitted again and again.
struct CoverageStudy {
  CoverageScenario scenario;
  int recordings = 0;  ///< Or sets.
  int runs = 1;        ///< Recordings of a set.
  int converged = 0;
  int failed = 0;                 ///< Without any report; the others have one and did not converge.
  std::vector<CoverageRow> rows;  ///< P, in FitParameters' order.
};

/// Simulates the recordings of a scenario and fits each with FitRecording, from start values found in its data; of sets
/// all together with FitJointly, released from 0.7 to 1.3 times the scenario's angle, and counts what is shared. An
/// interval with one end is unbounded on the other side; none, or no such parameter in the report, does not cover.
/// kInvalidArgument, kFailedPrecondition: as SimulateRecording, of the first recording that cannot be made; count or
/// threads out of their domain. Cost: some milliseconds a recording.
Result<CoverageStudy> StudyCoverage(const CoverageScenario& scenario, const CoverageOptions& options);

/// 95 % interval of a probability after `successes` of `trials` (Clopper & Pearson, Biometrika 26:404, 1934).
struct BinomialInterval {
  double lower = 0, upper = 1;
};
BinomialInterval BinomialInterval95(int successes, int trials);

}  // namespace pendulum
