// SPDX-License-Identifier: Apache-2.0
#include "tools/refit_text.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <unistd.h>

#include "pendulum/base/format.h"
#include "pendulum/base/staged_file.h"
#include "pendulum/batch/overview.h"
#include "pendulum/report/layout.h"
#include "pendulum/report/text_parts.h"
#include "tools/progress_line.h"

namespace pendulum {
namespace {

using Cells = std::vector<std::string>;

std::string ModelsText(const nlohmann::ordered_json& models) {
  const std::vector<Column> columns = {
      {"model"},       {"fits", true}, {"converged", true}, {"not converged", true}, {"not identifiable", true},
      {"failed", true}};
  std::vector<Cells> rows;
  for (const auto& model : models) {
    rows.push_back({model["model"].get<std::string>()});
    for (const char* key : {"fits", "converged", "not_converged", "not_identifiable", "failed"}) {
      rows.back().push_back(model[key].dump());
    }
  }
  return Heading("Fits") + AlignedTable(columns, rows, kTextIndent);
}

std::string RecommendationsText(const nlohmann::ordered_json& recommendations) {
  if (recommendations.empty()) return "";
  std::vector<Cells> rows;
  for (const auto& row : recommendations) {
    rows.push_back({row["model"].is_null() ? "none" : row["model"].get<std::string>(), row["runs"].dump()});
  }
  return Heading("Recommended") + AlignedTable({{"model"}, {"runs", true}}, rows, kTextIndent);
}

std::string FailuresText(const nlohmann::ordered_json& failures) {
  if (failures.empty()) return "";
  std::string text = Heading("Not converged");
  for (const auto& failure : failures) {
    const std::string first = "    " + failure["fits"].dump() + " x " + failure["status"].get<std::string>() + ": ";
    text += Paragraph(Printable(failure["reason"].get<std::string>()) + " (" +
                          Printable(failure["examples"][0].get<std::string>()) + ")",
                      first, kTextWidth);
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
  return Heading("Missing in the second store") + AlignedTable({{"run"}, {"model"}}, rows, kTextIndent);
}

constexpr std::chrono::milliseconds kRedraw{200};

}  // namespace

Result<std::string> StatusText(Store& store) {
  const auto counts = store.Count();
  if (!counts) return tl::unexpected(counts.error());
  std::string text = Heading("Runs") + Row("in the store", counts->runs) + Row("not refitted yet", counts->pending) +
                     Row("could not be fitted", counts->unfitted);
  if (counts->earlier > 0) text += Row("not in the last manifest", counts->earlier);
  if (counts->fits == 0) return text;
  const auto overview = Overview(store);
  if (!overview) return tl::unexpected(overview.error());
  return text + ModelsText((*overview)["models"]) + RecommendationsText((*overview)["recommendations"]) +
         FailuresText((*overview)["failures"]);
}

std::string ComparisonText(const StoreComparison& comparison, const std::string& before, const std::string& after) {
  std::string text =
      Heading("Fits") + Row("in both", comparison.fits) + Row("in " + before + " only", comparison.only_before) +
      Row("in " + after + " only", comparison.only_after) +
      Row("ended with another status", comparison.changed_status) + Row("runs with other data", comparison.other_data);
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
