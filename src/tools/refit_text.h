// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/batch/compare_stores.h"
#include "pendulum/batch/prune.h"
#include "pendulum/batch/refit.h"
#include "pendulum/batch/store.h"
#include "pendulum/batch/store_summary.h"

namespace pendulum {

/// What a reader of a batch needs first, in at most 20 lines of 80 columns: how many recordings were fitted, which were
/// taken for repeats of one pendulum, whether these agree, and the parameters of the main law. `store`: its
/// path.
std::string SummaryText(const StoreSummary& summary, const std::string& store);

/// The parameters of the main law, a line each: name, median, standard deviation over the recordings ("-" if there is
/// none) and unit, separated by blanks.
std::string QuietText(const StoreSummary& summary);

/// The content of a store as text: runs, fits by model and status, failures by reason.
Result<std::string> StatusText(Store& store);

/// "14 files are left out because of the name (13 *.json, 1 *.png); ...".
std::string LeftOutText(const std::map<std::string, std::int64_t>& left_out);

/// "2 files are left out because of the column path, which manifests and exports ... have (a.csv, b.csv)".
std::string ListsText(const std::vector<std::string>& lists);

/// "; 2 keep a former result (--replace_by_failures replaces it)"; empty for none.
std::string KeptText(std::int64_t stale);

/// What a refit did: "3 runs tried, 2 were current; 1 could not be fitted". These counts are of both kinds of runs.
std::string RefitText(const RefitCounts& counts);

/// Why runs that should have a current result have none, apart from those that keep a former one, as the end of a
/// sentence: "; no run has a current result"; empty if there is no such reason.
std::string WithoutResultText(const StoreCounts& counts);

/// What a prune of a store removes, or would remove.
std::string PruneText(const Prunable& prunable, bool dry_run);

/// The differences between two stores as text.
std::string ComparisonText(const StoreComparison& comparison, const std::string& before, const std::string& after);

/// "1200 of 2000 runs (60 %), 1850 a second, 1 s left, 3 could not be fitted".
std::string ProgressText(const RefitCounts& counts, double seconds);

/// Shows the progress of a refit: on a terminal a bar that is redrawn a few times a second, elsewhere a plain line from
/// time to time.
class RefitProgress {
 public:
  using Clock = std::chrono::steady_clock;

  /// `name`: the tool's name, which begins plain lines. `descriptor`: for the output, such as STDERR_FILENO. `between`:
  /// time between plain lines.
  RefitProgress(std::string name, int descriptor, std::chrono::milliseconds between = std::chrono::seconds(10));

  /// Tests pass `now`; the default is the current time.
  void Show(const RefitCounts& counts, Clock::time_point now = Clock::now());

  /// Ends the bar's line.
  void Finish();

 private:
  std::string name_;
  int descriptor_;
  bool is_terminal_;
  std::chrono::milliseconds between_;  // between two updates
  bool has_drawn_ = false;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
};

}  // namespace pendulum
