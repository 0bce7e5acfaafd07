// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/coverage_text.h"

#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/rounding.h"
#include "pendulum/report/layout.h"

namespace pendulum {
namespace {

using Cells = std::vector<std::string>;

constexpr int kCoverageDecimals = 3;
constexpr int kRatioDecimals = 2;
constexpr int kTableWidth = 120;

/// A table without layout.
struct CoverageTable {
  std::vector<Column> columns;
  std::vector<Cells> rows;  ///< One cell per column.
};

std::string RatioText(const std::optional<double>& ratio) { return ratio ? FixedText(*ratio, kRatioDecimals) : "-"; }

std::string ErrorText(const CoverageRow& row) {
  constexpr int kDigits = 3;
  return row.rms_error ? NumberText(*row.rms_error, kDigits) + " " + row.unit : "-";
}

std::string VerdictText(const CoverageRow& row) {
  if (row.passes()) return "pass";
  return row.precise ? "coverage" : row.covers ? "error" : "coverage, error";
}

std::string RangeText(double lower, double upper) {
  return "[" + FixedText(lower, kCoverageDecimals) + ", " + FixedText(upper, kCoverageDecimals) + "]";
}

CoverageTable ParameterTable(std::span<const CoverageStudy> studies) {
  CoverageTable table{{{"scenario"},
                       {"parameter"},
                       {"coverage", true},
                       {"[95 %]"},
                       {"rms error"},
                       {"error/bound", true},
                       {"std error/error", true},
                       {"no interval", true},
                       {"verdict"}},
                      {}};
  for (const CoverageStudy& study : studies) {
    for (const CoverageRow& row : study.rows) {
      table.rows.push_back({study.scenario.name, row.parameter, FixedText(row.coverage, kCoverageDecimals),
                            RangeText(row.coverage_lower, row.coverage_upper), ErrorText(row),
                            RatioText(row.error_over_bound), RatioText(row.std_error_over_error),
                            std::to_string(row.without_interval), VerdictText(row)});
    }
  }
  return table;
}

int Misses(const CoverageStudy& study) {
  int misses = 0;
  for (const CoverageRow& row : study.rows) misses += row.passes() ? 0 : 1;
  return misses;
}

/// Name of the counted objects.
std::string Counted(std::span<const CoverageStudy> studies) {
  const int runs = studies.empty() ? 1 : studies.front().runs;
  return runs > 1 ? "sets of " + std::to_string(runs) : "recordings";
}

CoverageTable ScenarioTable(std::span<const CoverageStudy> studies) {
  CoverageTable table{
      {{"scenario"}, {Counted(studies), true}, {"converged", true}, {"no fit", true}, {"misses", true}, {"what it is"}},
      {}};
  for (const CoverageStudy& study : studies) {
    table.rows.push_back({study.scenario.name, std::to_string(study.recordings), std::to_string(study.converged),
                          std::to_string(study.failed), std::to_string(Misses(study)), study.scenario.description});
  }
  return table;
}

std::string MarkdownLine(const Cells& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

std::string MarkdownTable(const CoverageTable& table) {
  Cells headers, rules;
  for (const Column& column : table.columns) {
    headers.push_back(column.header);
    rules.emplace_back(column.right_aligned ? "---:" : "---");
  }
  std::string text = MarkdownLine(headers) + MarkdownLine(rules);
  for (const Cells& row : table.rows) text += MarkdownLine(row);
  return text;
}

std::string RuleText(const CoverageRule& rule) {
  return "[" + FixedText(rule.lowest, kRatioDecimals) + ", " + FixedText(rule.highest, kRatioDecimals) + "]";
}

constexpr std::string_view kColumns =
    "Coverage is the share of recordings whose total 95 % interval contains the true value; [95 %] is the confidence "
    "interval of this share (Clopper and Pearson). A recording counts as not covered if the fit did not converge, or "
    "if it found the other kind of start and so lacks the parameter. `rms error` is the rms error of the estimates. "
    "`error/bound` is the rms of each error over the Cramér-Rao bound of its recording for the simulated noise. `std "
    "error/error` is the mean total standard error over the rms error. Where rig, clock and calibration have errors, "
    "their true values are drawn, and there is no bound. The zero angle varies between recordings within a "
    "count, and the release within a sampling interval.";

/// Explains the differences for sets of recordings.
std::string SetsText(std::span<const CoverageStudy> studies) {
  return "Here the fits are joint fits of " + Counted(studies) +
         " recordings of one rig, released from 0.7 to 1.3 times the scenario's angle. Only shared parameters are "
         "counted; their Cramér-Rao bound is computed from the readings of the whole set.";
}

/// Explains the rules, with the numbers used for the verdicts.
std::string Rules(std::span<const CoverageStudy> studies) {
  const CoverageRule usual;
  std::string text = "A line passes if the interval of its coverage overlaps " + RuleText(usual);
  for (const CoverageStudy& study : studies) {
    const CoverageRule& rule = study.scenario.rule;
    if (rule.lowest == usual.lowest && rule.highest == usual.highest) continue;
    text += ", " + RuleText(rule) + " in `" + study.scenario.name + "`";
  }
  text += ", " + RuleText(kAtBoundRule) + " where the truth is at the parameter's bound, and error/bound is at most " +
          FixedText(usual.largest_error, kRatioDecimals) + ".";
  return Paragraph(text, "", kTableWidth);
}

}  // namespace

std::string CoverageText(std::span<const CoverageStudy> studies) {
  const CoverageTable parameters = ParameterTable(studies);
  const CoverageTable scenarios = ScenarioTable(studies);
  return AlignedTable(parameters.columns, parameters.rows, 0) + "\n" +
         AlignedTable(scenarios.columns, scenarios.rows, 0);
}

std::string CoverageMarkdown(std::span<const CoverageStudy> studies, std::string_view command) {
  const bool sets = !studies.empty() && studies.front().runs > 1;
  return "# Do the 95 % intervals contain the truth 95 % of the time?\n\n" + Paragraph(kColumns, "", kTableWidth) +
         (sets ? "\n" + Paragraph(SetsText(studies), "", kTableWidth) : "") + "\n" + Rules(studies) + "\n```sh\n" +
         std::string(command) + "\n```\n\n" + MarkdownTable(ParameterTable(studies)) + "\n" +
         MarkdownTable(ScenarioTable(studies));
}

std::string CoverageScenarioList(std::span<const CoverageScenario> scenarios) {
  CoverageTable table{{{"scenario"}, {"what it is"}}, {}};
  for (const CoverageScenario& scenario : scenarios) table.rows.push_back({scenario.name, scenario.description});
  return AlignedTable(table.columns, table.rows, 0);
}

}  // namespace pendulum
