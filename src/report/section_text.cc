// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/section_text.h"

#include <algorithm>
#include <string_view>

#include "pendulum/report/layout.h"

namespace pendulum {
namespace {

constexpr std::string_view kBold = "\x1B[1m";
constexpr std::string_view kYellow = "\x1B[33m";
constexpr std::string_view kRed = "\x1B[1;31m";
constexpr std::string_view kPlain = "\x1B[0m";

std::string IndentOf(int count) {
  std::string blanks;
  blanks.resize(static_cast<std::size_t>(std::max(count, 0)), ' ');
  return blanks;
}

/// Renders the blocks of a section as text.
class TextRenderer {
 public:
  explicit TextRenderer(TextStyle style) : style_(style) {}

  std::string Title(const Section& section) const {
    const std::string title = Painted("[[" + FullTitle(section) + "]]", kBold);
    return title + (section.remark.empty() ? "" : " (" + section.remark + ")") + "\n";
  }

  std::string operator()(const Words& words) const { return Filled(words.text, IndentOf(kTextIndent), words.emphasis); }

  std::string operator()(const Facts& facts) const {
    int longest = 0;
    for (const Fact& fact : facts) longest = std::max(longest, DisplayWidth(fact.name));
    std::string text;
    for (const Fact& fact : facts) {
      const std::string name = IndentOf(kTextIndent) + fact.name + IndentOf(longest - DisplayWidth(fact.name) + 2);
      text += Filled(fact.text, name, fact.emphasis);
    }
    return text;
  }

  std::string operator()(const Table& table) const {
    std::vector<std::vector<std::string>> rows = table.rows;
    for (auto& row : rows) {
      for (std::string& cell : row) {
        if (!table.caution.empty() && cell == table.caution) cell = Painted(cell, kYellow);
      }
    }
    if (table.left_out.empty()) return TableWithin(table.columns, rows, kTextIndent, style_.width);
    const std::string text = AlignedTable(table.columns, rows, kTextIndent);
    return WithLineAfter(1 + table.rows_before, IndentOf(kTextIndent) + table.left_out + "\n", text);
  }

  std::string operator()(const Formula& formula) const {
    return Filled(formula.text, IndentOf(kTextIndent), Emphasis::kNone);
  }

  std::string operator()(const Items& items) const {
    std::string text;
    for (const std::string& item : items.texts) text += Filled(item, "  - ", items.emphasis);
    return text;
  }

 private:
  std::string Painted(const std::string& text, std::string_view colour) const {
    return style_.colour ? std::string(colour) + text + std::string(kPlain) : text;
  }

  std::string Emphasized(const std::string& line, Emphasis emphasis) const {
    if (emphasis == Emphasis::kNone) return line;
    return Painted(line, emphasis == Emphasis::kAlarm ? kRed : kYellow);
  }

  /// Words after `first`, wrapped to lines; only the text is coloured. A text that fits on a line stays unchanged.
  std::string Filled(const std::string& text, const std::string& first, Emphasis emphasis) const {
    const int indent = DisplayWidth(first);
    const bool fits = indent + DisplayWidth(text) <= style_.width;
    const std::string lines = fits ? IndentOf(indent) + text + "\n" : Paragraph(text, IndentOf(indent), style_.width);
    std::string filled;
    for (std::size_t begin = 0; begin < lines.size();) {
      const std::size_t end = lines.find('\n', begin);
      const std::string line = lines.substr(begin + static_cast<std::size_t>(indent), end - begin - indent);
      filled += (begin == 0 ? first : IndentOf(indent)) + Emphasized(WithBlanks(line), emphasis) + "\n";
      begin = end + 1;
    }
    return filled;
  }

  static std::string WithLineAfter(std::size_t lines, const std::string& line, std::string text) {
    std::size_t at = 0;
    for (; lines > 0; --lines) at = text.find('\n', at) + 1;
    return text.insert(at, line);
  }

  TextStyle style_;
};

}  // namespace

std::string ToText(const Sections& sections, TextStyle style) {
  const TextRenderer renderer(style);
  std::string text;
  for (const Section& section : sections) {
    text += renderer.Title(section);
    for (const Block& block : section.blocks) text += std::visit(renderer, block);
  }
  return text;
}

}  // namespace pendulum
