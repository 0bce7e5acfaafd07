// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pendulum/base/warning.h"
#include "pendulum/batch/overview.h"
#include "pendulum/batch/run_statistics.h"

namespace pendulum {

/// How the runs of a store ended, in numbers and examples.
struct RunCounts {
  std::string text;  ///< "197 of 200 recordings fitted; 1 missing, 1 refused, 1 with a former result only".
  std::int64_t runs = 0;
  std::int64_t fitted = 0;            ///< The fit of the recommended law converged.
  std::int64_t not_converged = 0;     ///< It did not.
  std::int64_t missing = 0;           ///< There is no such recording.
  std::int64_t refused = 0;           ///< Could not be read or fitted.
  std::int64_t without_rig_file = 0;  ///< Of these, runs whose rig or calibration is missing.
  std::int64_t pending = 0;           ///< Not fitted yet.
  std::int64_t stale = 0;             ///< Only a former result is there; the last attempt failed.
  std::int64_t unlisted = 0;          ///< Not among the recordings of the last refit, nor among `runs`.
  bool is_complete = true;            ///< No refit was stopped before its end, and none is running.
  struct Run {
    std::string id, reason;
  };
  std::vector<Run> missing_runs, refused_runs, stale_runs;  ///< At most ten each, in the order of the manifest.
};

/// What the last refit did to the runs of its manifest.
struct RefitNews {
  std::string began, ended;           ///< RFC 3339, UTC; empty: not known, or not ended.
  std::int64_t fresh = 0, again = 0;  ///< Runs that it tried for the first time, and again.
  std::string text = {};              ///< In a sentence; empty: not known.
};

/// A run in the list of runs.
struct ListedRun {
  std::string id;
  std::string level;    ///< good, caution, bad or waiting.
  std::string state;    ///< "fitted", "refused", ...
  std::string text;     ///< Why it is not simply fitted, or how well the law describes it; may be empty.
  std::string law;      ///< The recommended or only law; empty: none.
  std::string fitted;   ///< When its rows were stored, RFC 3339, UTC; empty: not known.
  std::string news;     ///< new or again, if the last refit tried it; otherwise empty.
  std::string command;  ///< Makes the report of the run; empty: not known.
};

/// Which runs were taken for repeats of one pendulum.
struct Grouping {
  std::string by;          ///< column, true_values, rig, folder or all.
  std::string name;        ///< "rig", "bench", "folder", "true values"; empty: all runs are one group.
  bool is_stated = false;  ///< A flag, the manifest or the true values say so; otherwise it is an assumption.
  std::int64_t pendulums = 0, smallest = 0, largest = 0;  ///< Number of groups, and the runs of a group.
  std::size_t unlike = 0;                                 ///< Groups whose runs differ too much for repeats.
  bool is_compared = false;                               ///< Whether some runs are compared as repeats.
  std::string text;                                       ///< In one or two sentences.
  std::string otherwise;                                  ///< How to say otherwise; may be empty.
};

/// A run that disagrees with the others of its pendulum, and the parameter in which it differs most.
struct DisagreeingRun {
  std::string id, parameter;
  double estimate = 0, others = 0;  ///< Its value and the weighted mean of the others, in the parameter's unit.
  double z = std::numeric_limits<double>::quiet_NaN();  ///< As of an Outlier; NaN: not known.
};

/// A parameter of the pendulum over its runs without outliers (MODEL.md eq. (10.5)).
struct RunsMean {
  std::string parameter, unit;
  double mean = 0;
  double total_std_error = 0;  ///< Contains the scatter of the runs, and the errors that all of them share.
  std::size_t runs = 0;
};

/// The test of the runs of one pendulum for agreement in all parameters together (Agreement).
struct GroupAgreement {
  std::optional<std::string> group;  ///< std::nullopt: all runs are one group.
  std::size_t runs = 0;
  double statistic = 0;
  int dof = 0;
  double p = 1;
  std::vector<DisagreeingRun> outliers;
  std::vector<RunsMean> means;  ///< Of each parameter.
};

/// Runs that disagree with the other runs of their pendulum, by the test of a joint fit (FindDisagreeing).
struct RunAgreement {
  std::string law;
  std::size_t groups = 0, disagreeing = 0;  ///< Tested groups, and those that disagree; 0: there is nothing to compare.
  std::vector<GroupAgreement> rows;         ///< The smallest p first; not all if there are many.
  std::set<std::string> outliers;           ///< Ids of the runs that are named; few.
};

/// A run whose value does not fit its group (Outlier).
struct OutlyingRun {
  std::string id;
  std::optional<std::string> group;    ///< std::nullopt: all runs are one group.
  double estimate = 0, std_error = 0;  ///< std_error: NaN if there is none.
  double z = 0;
};

/// The slope of a quantity over a column of the manifest, or over the order of the runs.
struct TrendSummary {
  Trend trend;
  std::string column;
  bool is_of_dates = false;  ///< The abscissa is in days since 1970-01-01.
  bool is_moving = false;    ///< p is below one in a hundred.
  std::string slope, text;   ///< slope: "1.2e-06 ± 3e-07 kg m^2 per day".
  struct Point {
    double x = 0, y = 0, std_error = 0;  ///< std_error: NaN if there is none.
    std::string id;
    std::optional<std::string> group;  ///< std::nullopt: all runs are one group.
  };
  std::vector<Point> points;  ///< Every n-th, if there are many.
};

/// A parameter or derived quantity of one law, in one unit, over all runs.
struct QuantitySummary {
  std::string law, name, unit;
  bool is_derived = false;
  std::size_t runs = 0;
  Distribution distribution = {};
  std::optional<double> median_std_error, median_repeat_error;
  std::optional<Repeatability> repeatability = {};
  std::vector<std::string> repeated_groups = {};  ///< Names of the groups of `repeatability`.
  std::string repeatability_text = {};            ///< What it says, or why there is none.
  std::vector<OutlyingRun> outliers = {};         ///< The largest z first; not all if there are many.
  std::size_t outliers_total = 0;
  std::optional<TrendSummary> trend = {};
};

/// Whether the errors of a law agree with the scatter between recordings.
struct ErrorVerdict {
  std::string law;
  std::string verdict;  ///< not_compared, too_small, too_large, few or agrees.
  std::string level;    ///< good or caution.
  std::string text;
};

/// What was fitted, and with what.
struct StoreFacts {
  std::string path, manifest_sha256;
  std::int64_t runs = 0, pending = 0, fits = 0;
  std::vector<std::string> versions, cpus;
};

/// Statistics of all runs of a store (Summarize).
struct StoreSummary {
  RunCounts headline = {};
  Grouping grouping = {};
  std::string main_law = {};  ///< The law of the conclusions; empty if there is none.
  std::vector<ErrorVerdict> verdicts = {};
  RunAgreement agreement = {};
  std::string disagreement = {};  ///< The recordings that disagree with their repeats, in a sentence; may be empty.
  RefitNews news = {};
  std::vector<ListedRun> runs = {};  ///< Those that need a look first; not all if there are many.
  StoreFacts store = {};
  std::string trend_by = {};  ///< The column of trends; empty: the order of the runs.
  StoreOverview overview = {};
  std::vector<QuantitySummary> quantities = {};
  std::vector<Warning> warnings = {};

  /// Whether this is one of the parameters, not derived, of the main law.
  bool IsMainParameter(const QuantitySummary& quantity) const {
    return quantity.law == main_law && !quantity.is_derived;
  }
};

}  // namespace pendulum
