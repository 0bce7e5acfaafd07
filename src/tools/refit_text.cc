// SPDX-License-Identifier: Apache-2.0
#include "tools/refit_text.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <unistd.h>

#include "pendulum/base/format.h"
#include "pendulum/base/staged_file.h"
#include "pendulum/base/try.h"
#include "pendulum/batch/overview.h"
#include "pendulum/batch/quantity_text.h"
#include "pendulum/batch/run_statistics.h"
#include "pendulum/report/layout.h"
#include "pendulum/report/text_parts.h"
#include "tools/progress_line.h"
#include "tools/refit_commands.h"

namespace pendulum {
namespace {

using Cells = std::vector<std::string>;

std::string LawsText(const std::vector<LawCounts>& laws) {
  const std::vector<Column> columns = {
      {"model"},       {"fits", true}, {"converged", true}, {"not converged", true}, {"not identifiable", true},
      {"failed", true}};
  std::vector<Cells> rows;
  for (const LawCounts& law : laws) {
    rows.push_back({law.law});
    for (const std::int64_t count : {law.fits, law.converged, law.not_converged, law.not_identifiable, law.failed})
      rows.back().push_back(std::to_string(count));
  }
  return Heading("Fits") + AlignedTable(columns, rows, kTextIndent);
}

std::string RecommendationsText(const std::vector<RecommendationCount>& recommendations) {
  if (recommendations.empty()) return "";
  std::vector<Cells> rows;
  for (const auto& [law, runs] : recommendations) rows.push_back({law.empty() ? "none" : law, std::to_string(runs)});
  return Heading("Recommended") + AlignedTable({{"model"}, {"runs", true}}, rows, kTextIndent);
}

std::string FailuresText(const std::vector<FailureCount>& failures) {
  if (failures.empty()) return "";
  std::string text = Heading("Failed or not converged");
  for (const FailureCount& failure : failures) {
    const std::string first = "    " + std::to_string(failure.fits) + " x " + failure.status + ": ";
    text += Paragraph(Printable(failure.reason) + " (" + Printable(failure.examples.front()) + ")", first, kTextWidth);
  }
  return text;
}

std::string Row(const std::string& name, std::int64_t count) {
  return std::string(kTextIndent, ' ') + name + std::string(name.size() < 32 ? 32 - name.size() : 1, ' ') +
         std::to_string(count) + "\n";
}

std::string MovedText(const StoreComparison& comparison) {
  if (comparison.most_moved.empty()) return "";
  constexpr int kDigits = 3;
  std::vector<Cells> rows;
  for (const MovedParameter& moved : comparison.most_moved) {
    rows.push_back({Printable(moved.id), moved.model, moved.name, NumberText(moved.before, kTextDigits),
                    NumberText(moved.after, kTextDigits), moved.unit, NumberText(moved.errors, kDigits)});
  }
  return Heading("Moved by more than their errors") +
         AlignedTable(
             {{"run"}, {"model"}, {"parameter"}, {"before", true}, {"after", true}, {"unit"}, {"errors", true}}, rows,
             kTextIndent);
}

std::string ChangedText(const StoreComparison& comparison) {
  if (comparison.status_changes.empty()) return "";
  std::vector<Cells> rows;
  for (const ChangedStatus& status : comparison.status_changes) {
    rows.push_back({Printable(status.id), status.model, status.before, status.after});
  }
  return Heading("Ended with another status") +
         AlignedTable({{"run"}, {"model"}, {"before"}, {"after"}}, rows, kTextIndent);
}

std::string RemovedFitsText(const StoreComparison& comparison) {
  if (comparison.removed.empty()) return "";
  std::vector<Cells> rows;
  for (const RemovedFit& fit : comparison.removed) rows.push_back({Printable(fit.id), fit.model});
  return Heading("Missing or stale in the second store") + AlignedTable({{"run"}, {"model"}}, rows, kTextIndent);
}

// ---- The summary ----------------------------------------------------------------------------------------------------

constexpr std::size_t kSummaryLines = 20;

std::size_t LineCount(const std::string& text) { return static_cast<std::size_t>(std::ranges::count(text, '\n')); }

/// The law of the table, and how often it was recommended.
std::string LawText(const StoreSummary& summary) {
  std::int64_t compared = 0, recommended = 0;
  for (const auto& [law, runs] : summary.overview.recommendations) {
    compared += runs;
    if (law == summary.main_law) recommended += runs;
  }
  if (summary.main_law.empty() || compared == 0) return "";
  return "Law " + summary.main_law + ": recommended for " + std::to_string(recommended) + " of " +
         std::to_string(compared) + " recordings.";
}

std::string VerdictText(const StoreSummary& summary) {
  const auto found = std::ranges::find(summary.verdicts, summary.main_law, &ErrorVerdict::law);
  return found == summary.verdicts.end() ? "" : found->text;
}

std::string UnitText(const std::string& unit) { return unit == "1" ? "" : unit; }

/// The parameters of the main law: typical value, scatter between recordings, and the error that repeats are compared
/// with.
std::string ParametersText(const StoreSummary& summary, bool of_the_rig_only) {
  std::vector<Cells> rows;
  for (const QuantitySummary& quantity : summary.quantities) {
    if (!summary.IsMainParameter(quantity) || (of_the_rig_only && !IsOfTheRig(quantity.name))) continue;
    rows.push_back(
        {quantity.name, ValueText(quantity.distribution, quantity.distribution.median),
         quantity.runs == 1 ? "-" : SpreadText(quantity.distribution.std_dev), SpreadText(quantity.median_repeat_error),
         quantity.repeatability ? RatioText(quantity.repeatability->ScatterRatio()) : "", UnitText(quantity.unit)});
  }
  if (rows.empty()) return "";
  return AlignedTable({{summary.main_law},
                       {"median", true},
                       {"spread", true},
                       {"error of repeats", true},
                       {"scatter/error", true},
                       {"unit"}},
                      rows, kTextIndent);
}

/// The beginning of a reason; --details shows all of it.
std::string Beginning(const std::string& reason) {
  constexpr std::size_t kLongest = 90;  // bytes, of about two lines
  std::string text = Printable(reason.substr(0, reason.find("; ")));
  if (text.size() <= kLongest) return text;
  return text.substr(0, text.rfind(' ', kLongest)) + " ...";
}

/// "Missing: a.csv, b.csv and 3 more."
std::string ExamplesText(const char* heading, const std::vector<RunCounts::Run>& runs, std::int64_t total,
                         bool with_reason) {
  constexpr std::size_t kNamed = 3;
  if (runs.empty()) return "";
  std::string text;
  const std::size_t named = std::min(runs.size(), with_reason ? std::size_t{1} : kNamed);
  for (std::size_t i = 0; i < named; ++i) {
    text += (i == 0 ? "" : ", ") + Printable(runs[i].id);
    if (with_reason) text += " (" + Beginning(runs[i].reason) + ")";
  }
  const std::int64_t more = total - static_cast<std::int64_t>(named);
  return std::string(heading) + ": " + text + (more > 0 ? " and " + std::to_string(more) + " more" : "") + ".";
}

std::string AllNames(std::vector<std::string> names) {
  for (std::string& name : names) name = Printable(name);
  return NameList(names);
}

/// "a.csv, b.csv and 3 more".
std::string FirstNames(std::vector<std::string> names) {
  constexpr std::size_t kNamed = 3;
  const std::size_t all = names.size();
  if (all <= kNamed) return AllNames(std::move(names));
  names.resize(kNamed - 1);
  names.push_back(std::to_string(all - names.size()) + " more");
  return AllNames(std::move(names));
}

/// `folding` 1: without the law and the parameters of the start; 2: also without examples of missing and refused files.
std::string SummaryText(const StoreSummary& summary, const std::string& store, int folding) {
  const RunCounts& runs = summary.headline;
  const Grouping& grouping = summary.grouping;
  const std::string groups = Printable(grouping.text) + (grouping.otherwise.empty() ? "" : " " + grouping.otherwise);
  std::string text = Heading(Printable(store)) + Prose(runs.text + ".") + Prose(groups);
  const std::string missing = ExamplesText("Missing", runs.missing_runs, runs.missing, false);
  const std::string refused = ExamplesText("Refused", runs.refused_runs, runs.refused, true);
  const std::string stale = ExamplesText("With a former result only", runs.stale_runs, runs.stale, true);
  for (const std::string& line :
       {stale, Printable(summary.disagreement), grouping.is_compared ? VerdictText(summary) : std::string(),
        folding < 2 ? missing : "", folding < 2 ? refused : "", folding < 1 ? LawText(summary) : ""}) {
    if (!line.empty()) text += Prose(line);
  }
  text += ParametersText(summary, folding > 0);
  const std::string name = ShellWord(store);
  return text + Prose("More: status --details --store " + name +
                      " (fits and failures), report --out page.html "
                      "(plots), sqlite3 " +
                      name + " 'select file, inertia from results'.");
}

constexpr std::chrono::milliseconds kRedraw{200};

}  // namespace

std::string SummaryText(const StoreSummary& summary, const std::string& store) {
  constexpr int kMaxFolding = 2;
  std::string text = SummaryText(summary, store, 0);
  for (int folding = 1; folding <= kMaxFolding && LineCount(text) > kSummaryLines; ++folding) {
    text = SummaryText(summary, store, folding);
  }
  return text;
}

std::string QuietText(const StoreSummary& summary) {
  constexpr int kDigits = 10;
  std::string text;
  for (const QuantitySummary& quantity : summary.quantities) {
    if (!summary.IsMainParameter(quantity)) continue;
    const Distribution& values = quantity.distribution;
    text += quantity.name + " " + NumberText(values.median, kDigits) + " " +
            (quantity.runs > 1 ? NumberText(values.std_dev, kDigits) : "-") + " " + quantity.unit + "\n";
  }
  return text;
}

Result<std::string> StatusText(Store& store) {
  ASSIGN_OR_RETURN(const auto counts, store.Count());
  std::string text = Heading("Runs") + Row("in the store", counts.runs) + Row("not refitted yet", counts.pending) +
                     Row("recording missing", counts.missing) + Row("refused", counts.unfitted - counts.missing);
  if (counts.stale > 0) text += Row("with a former result only", counts.stale);
  if (counts.earlier > 0) text += Row("not in the last manifest", counts.earlier);
  if (counts.former_fits > 0) text += Row("fits of models not asked for", counts.former_fits);
  ASSIGN_OR_RETURN(const auto meta, store.Meta());
  if (meta.is_interrupted()) text += Prose(Capitalized(std::string(kNotComplete)) + ".");
  if (counts.fits == 0) return text;
  ASSIGN_OR_RETURN(const auto overview, Overview(store));
  return text + LawsText(overview.laws) + RecommendationsText(overview.recommendations) +
         FailuresText(overview.failures);
}

std::string LeftOutText(const std::map<std::string, std::int64_t>& left_out) {
  std::int64_t files = 0;
  std::vector<std::string> kinds;
  for (const auto& [pattern, count] : left_out) {
    files += count;
    kinds.push_back(std::to_string(count) + " " + Printable(pattern));
  }
  return std::to_string(files) + (files == 1 ? " file is" : " files are") + " left out because of the name (" +
         NameList(kinds) + "); a pattern such as 'folder/**/*.json' takes recordings among them";
}

std::string ListsText(const std::vector<std::string>& lists) {
  return std::to_string(lists.size()) + (lists.size() == 1 ? " file is" : " files are") +
         " left out because of the column path, which manifests and exports of " + std::string(kRefitToolName) +
         " have (" + FirstNames(lists) + ")";
}

std::string KeptText(std::int64_t stale) {
  return stale == 0 ? "" : "; " + std::to_string(stale) + (stale == 1 ? " keeps" : " keep") + " a former result";
}

std::string RefitText(const RefitCounts& counts) {
  const std::int64_t current = counts.current - counts.stale_before;
  std::string text = std::to_string(counts.refitted) + (counts.refitted == 1 ? " run" : " runs") + " tried, " +
                     std::to_string(current) + (current == 1 ? " was" : " were") + " current";
  if (counts.unfitted > 0) text += "; " + std::to_string(counts.unfitted) + " could not be fitted";
  if (counts.renamed > 0) {
    text +=
        "; " + std::to_string(counts.renamed) + (counts.renamed == 1 ? " has" : " have") + " another name than before";
  }
  if (counts.changed > 0) {
    text += "; the rig or calibration of " + std::to_string(counts.changed) + (counts.changed == 1 ? " run" : " runs") +
            " changed meanwhile: give the same command again";
  }
  return text + KeptText(counts.stale) + (counts.stale > 0 ? " (--replace_by_failures replaces it)" : "");
}

std::string WithoutResultText(const StoreCounts& counts) {
  std::string text;
  if (counts.without_file > 0) {
    text = "; the recording, rig or calibration of " + std::to_string(counts.without_file) +
           (counts.without_file == 1 ? " run" : " runs") + " is missing";
  }
  return text + (counts.runs > counts.earlier && counts.fitted == 0 ? "; no run has a current result" : "");
}

std::string PruneText(const Prunable& prunable, bool dry_run) {
  std::int64_t fits = 0;
  std::vector<std::string> models;
  for (const auto& [model, count] : prunable.models) {
    fits += count;
    models.push_back(model);
  }
  std::string text;
  const auto add = [&](std::int64_t count, const std::string& what, const std::vector<std::string>& names) {
    if (count > 0)
      text += Prose(std::to_string(count) + " " + what + ": " + (dry_run ? AllNames(names) : FirstNames(names)));
  };
  const auto runs = [](const std::vector<std::string>& ids) { return ids.size() == 1 ? "run " : "runs "; };
  add(fits, std::string(fits == 1 ? "fit of a model" : "fits of models") + " that the last refit did not ask for",
      models);
  add(std::ssize(prunable.stale_runs), std::string(runs(prunable.stale_runs)) + "with a former result only",
      prunable.stale_runs);
  add(std::ssize(prunable.unlisted_runs),
      std::string(runs(prunable.unlisted_runs)) + "not among the recordings of the last refit", prunable.unlisted_runs);
  if (text.empty()) return "Nothing to remove.\n";
  return Heading(dry_run ? "Would be removed" : "Removed") + text;
}

std::string ComparisonText(const StoreComparison& comparison, const std::string& before, const std::string& after) {
  std::string text =
      Heading("Fits") + Row("in both", comparison.fits) + Row("in " + before + " only", comparison.only_before) +
      Row("in " + after + " only", comparison.only_after) +
      (comparison.stale_before > 0 ? Row("left out as stale in " + before, comparison.stale_before) : "") +
      (comparison.stale_after > 0 ? Row("left out as stale in " + after, comparison.stale_after) : "") +
      Row("ended with another status", comparison.changed_status) + Row("runs with other data", comparison.other_data) +
      (comparison.renamed > 0 ? Row("runs with another name", comparison.renamed) : "");
  text += Heading("Parameters") + Row("identical", comparison.identical) +
          Row("moved by less than 1e-9 errors", comparison.rounding) +
          Row("moved by less than an error", comparison.within_errors) + Row("moved by more", comparison.moved) +
          Row("changed, without a standard error", comparison.without_error);
  if (comparison.cpus_before != comparison.cpus_after) {
    text += Heading("Types of CPU") + Prose(before + ": " + NameList(comparison.cpus_before)) +
            Prose(after + ": " + NameList(comparison.cpus_after));
  }
  return text + MovedText(comparison) + ChangedText(comparison) + RemovedFitsText(comparison);
}

std::string ProgressText(const RefitCounts& counts, double seconds) {
  constexpr int kDigits = 3;
  const auto done = static_cast<double>(counts.done());
  const double share = counts.runs > 0 ? done / static_cast<double>(counts.runs) : 1;
  std::string text = std::to_string(counts.done()) + " of " + std::to_string(counts.runs) + " runs (" +
                     std::to_string(static_cast<int>(100 * share)) + " %)";
  if (seconds > 0 && done > 0) {
    const double rate = done / seconds;
    text += ", " + NumberText(rate, kDigits) + " a second, " +
            DurationText(static_cast<double>(counts.runs - counts.done()) / rate) + " left";
  }
  if (counts.unfitted > 0) text += ", " + std::to_string(counts.unfitted) + " could not be fitted";
  return text;
}

RefitProgress::RefitProgress(std::string name, int descriptor, std::chrono::milliseconds between)
    : name_(std::move(name)),
      descriptor_(descriptor),
      is_terminal_(::isatty(descriptor) == 1),
      between_(is_terminal_ ? kRedraw : between) {}

void RefitProgress::Show(const RefitCounts& counts, Clock::time_point now) {
  if (now - last_ < between_) return;
  last_ = now;
  const std::string text = ProgressText(counts, std::chrono::duration<double>(now - begin_).count());
  if (!is_terminal_) {
    WriteAll(descriptor_, name_ + ": " + text + "\n");
    return;
  }
  constexpr int kWidth = 20;
  const auto full = static_cast<std::size_t>(counts.runs > 0 ? kWidth * counts.done() / counts.runs : kWidth);
  WriteAll(descriptor_, "\r[" + std::string(full, '#') + std::string(kWidth - full, '.') + "] " + text + "\x1b[K");
  has_drawn_ = true;
}

void RefitProgress::Finish() {
  if (std::exchange(has_drawn_, false)) WriteAll(descriptor_, "\r\x1b[K");
}

}  // namespace pendulum
