// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/markdown.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include "pendulum/report/fit_sections.h"
#include "pendulum/report/summary_text.h"
#include "pendulum/report/text.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

bool IsWordCharacter(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || (c & '\x80') != 0; }

/// Whether Markdown would interpret the character at i.
bool IsMarkup(std::string_view text, std::size_t i) {
  const char before = i > 0 ? text[i - 1] : ' ';
  const char after = i + 1 < text.size() ? text[i + 1] : ' ';
  switch (text[i]) {
    case '_': return !IsWordCharacter(before) || !IsWordCharacter(after);  // within a word it is an ordinary character
    case ']': return after == '(' || after == '[' || after == ':';         // elsewhere brackets do not make a link
    default: return std::string_view("\\`*<|&~$").find(text[i]) != std::string_view::npos;
  }
}

/// Whether a text would begin a heading, a list, a quotation or a rule.
bool BeginsWithMarkup(std::string_view text) {
  if (text.empty()) return false;
  const std::size_t digits = text.find_first_not_of("0123456789");
  const bool is_number =
      digits != 0 && digits != std::string_view::npos && (text[digits] == '.' || text[digits] == ')');
  return std::string_view("#>-+=").find(text[0]) != std::string_view::npos ||
         (is_number && (digits + 1 == text.size() || text[digits + 1] == ' '));
}

/// A paragraph or an item; its beginning is escaped, too.
std::string LineText(std::string_view text) {
  std::string escaped = MarkdownText(text);
  if (!BeginsWithMarkup(escaped)) return escaped;
  const std::size_t digits = std::min(escaped.find_first_not_of("0123456789"), escaped.size());
  return escaped.substr(0, digits) + "\\" + escaped.substr(digits);
}

std::string Emphasized(const std::string& text, Emphasis emphasis) {
  return emphasis == Emphasis::kNone || text.empty() ? text : "**" + text + "**";
}

// --- tables ----------------------------------------------------------------------------------------------------------

/// Columns and rows of a Markdown table, with escaped texts.
struct PipeTable {
  std::vector<Column> columns;
  std::vector<std::vector<std::string>> rows;
};

bool IsEmptyColumn(const Table& table, std::size_t i) {
  return std::ranges::all_of(table.rows, [&](const auto& row) { return row[i].empty(); });
}

/// The table without empty columns, and with each error in the column of its value.
PipeTable Joined(const Table& table) {
  PipeTable joined;
  joined.rows.resize(table.rows.size());
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (IsEmptyColumn(table, i)) continue;
    const bool joins = table.columns[i].gap == 1 && !joined.columns.empty();
    if (joins) {
      if (!table.columns[i].header.empty()) joined.columns.back().header += " " + MarkdownText(table.columns[i].header);
    } else {
      joined.columns.push_back({MarkdownText(table.columns[i].header), table.columns[i].right_aligned});
    }
    for (std::size_t k = 0; k < table.rows.size(); ++k) {
      const std::string cell = MarkdownText(table.rows[k][i]);
      const bool stops = !table.caution.empty() && table.rows[k][i] == table.caution;
      const std::string shown = Emphasized(cell, stops ? Emphasis::kCaution : Emphasis::kNone);
      if (!joins) {
        joined.rows[k].push_back(shown);
      } else if (!shown.empty()) {
        joined.rows[k].back() += " " + shown;
      }
    }
  }
  return joined;
}

std::string PipeRow(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) row += (cell.empty() ? "" : " " + cell) + " |";
  return row + "\n";
}

std::string TableText(const Table& table) {
  PipeTable pipes = Joined(table);
  if (pipes.columns.empty()) return "";
  std::vector<std::string> headers;
  std::string rule = "|";
  for (const Column& column : pipes.columns) {
    headers.push_back(column.header);
    rule += column.right_aligned ? " --: |" : " --- |";
  }
  std::string text = PipeRow(headers) + rule + "\n";
  for (std::size_t k = 0; k < pipes.rows.size(); ++k) {
    if (!table.left_out.empty() && k == table.rows_before) text += PipeRow({MarkdownText(table.left_out)});
    text += PipeRow(pipes.rows[k]);
  }
  return text + "\n";
}

// --- blocks ----------------------------------------------------------------------------------------------------------

struct MarkdownRenderer {
  std::string operator()(const Words& words) const { return Emphasized(LineText(words.text), words.emphasis) + "\n\n"; }
  std::string operator()(const Facts& facts) const {
    std::string text = "| | |\n| --- | --- |\n";
    for (const Fact& fact : facts) {
      text += PipeRow({MarkdownText(fact.name), Emphasized(MarkdownText(WithBlanks(fact.text)), fact.emphasis)});
    }
    return text + "\n";
  }
  std::string operator()(const Table& table) const { return TableText(table); }
  std::string operator()(const Formula& formula) const { return "```text\n" + WithBlanks(formula.text) + "\n```\n\n"; }
  std::string operator()(const Items& items) const {
    std::string text;
    for (const std::string& item : items.texts) text += "- " + LineText(item) + "\n";
    return text + "\n";
  }
};

}  // namespace

std::string MarkdownText(std::string_view text) {
  const std::string printable = Printable(text);
  std::string escaped;
  for (std::size_t i = 0; i < printable.size(); ++i) {
    if (IsMarkup(printable, i)) escaped += '\\';
    escaped += printable[i];
  }
  return escaped;
}

std::string ToMarkdown(const Sections& sections) {
  std::string text;
  for (const Section& section : sections) {
    text += "## " + MarkdownText(FullTitle(section)) + "\n\n";
    if (!section.remark.empty()) text += "(" + MarkdownText(section.remark) + ")\n\n";
    for (const Block& block : section.blocks) text += std::visit(MarkdownRenderer(), block);
  }
  if (text.ends_with("\n\n")) text.pop_back();
  return text;
}

std::string ToMarkdown(const Identification& identification) {
  ResultSummary summary = SummarizeResult(identification);
  summary.title = "Summary";
  summary.fit.warnings.clear();  // the next section has them in full
  Sections sections = {SummarySection(summary)};
  const Sections all = ReportSections(identification);
  const auto is_warning = [](const Section& section) { return section.title == "Warnings"; };
  std::ranges::copy_if(all, std::back_inserter(sections), is_warning);
  std::ranges::copy_if(all, std::back_inserter(sections), std::not_fn(is_warning));
  return "# Pendulum: " + MarkdownText(TitleOf(identification, "a recording")) + "\n\n" + ToMarkdown(sections);
}

}  // namespace pendulum
