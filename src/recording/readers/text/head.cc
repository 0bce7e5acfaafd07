// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/text/head.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <ranges>
#include <utility>

#include "pendulum/base/utf8.h"
#include "recording/readers/text/sample_rate_text.h"
#include "recording/readers/text/tracker.h"
#include "recording/readers/text/vernier.h"

namespace pendulum::csv {
namespace {

// ---- Lines -------------------------------------------------------------------------------------------------------

/// The first lines of a text, without empty ones.
struct FirstLines {
  std::vector<TextLine> lines, comments;
  char separator = '\0';  // From the line `sep=`.
};

/// Calls take(text, number) for each line, also for a last one without a line end, until it returns false.
template <typename Take>
void ForEachTextLine(std::string_view text, std::size_t number, const Take& take) {
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = text.substr(begin, end - begin);
    while (line.ends_with('\r')) line.remove_suffix(1);
    if (!take(line, number)) return;
    begin = end + 1;
  }
}

/// Whether a field in quotes does not end. A quote elsewhere belongs to its text, as in 5" pipe.
bool HasOpenQuote(std::string_view text) {
  bool is_open = false;
  char before = ',';
  for (const char c : text) {
    const bool may_open = before == ',' || before == ';' || IsBlank(before);
    if (c == '"' && (is_open || may_open)) is_open = !is_open;
    before = c;
  }
  return is_open;
}

/// The row that begins with `line`, which is a part of `begin`, and its number of lines: a quoted name may contain line
/// breaks. A quote that few lines do not close is ignored.
std::pair<std::string_view, std::size_t> WholeRow(std::string_view begin, std::string_view line) {
  constexpr std::size_t kMostLines = 4;
  if (!HasOpenQuote(line)) return {line, 1};
  const auto at = static_cast<std::size_t>(line.data() - begin.data());
  std::size_t end = at + line.size();
  for (std::size_t lines = 2; lines <= kMostLines && end < begin.size(); ++lines) {
    end = std::min(begin.find('\n', begin.find('\n', end) + 1), begin.size());
    std::string_view row = begin.substr(at, end - at);
    while (row.ends_with('\r')) row.remove_suffix(1);
    if (!HasOpenQuote(row)) return {row, lines};
  }
  return {line, 1};
}

FirstLines SplitFirstLines(std::string_view begin) {
  constexpr std::size_t kMost = 400;
  FirstLines found;
  std::size_t next = 0;  // The line after a row of several lines.
  ForEachTextLine(begin, 1, [&](std::string_view text, std::size_t number) {
    if (number < next) return true;
    const auto [row, row_lines] = WholeRow(begin, text);
    text = row;
    next = number + row_lines;
    if (IsEmptyRow(text)) return true;
    if (Trim(text).front() == '#') {
      found.comments.push_back({text, number});
      return true;
    }
    const auto separator = found.lines.empty() ? SeparatorLine(text) : std::nullopt;
    if (separator) {
      found.separator = *separator;
      return true;
    }
    found.lines.push_back({text, number});
    return found.lines.size() < kMost;
  });
  return found;
}

bool HasHostStamps(const std::vector<TextLine>& lines) {
  constexpr std::size_t kEnough = 3;
  for (std::size_t i = 0; i < std::min(lines.size(), kEnough); ++i) {
    const auto stamp = FindHostStamp(lines[i].text);
    if (stamp && stamp->second_of_day) return true;
  }
  return false;
}

// ---- The rows ----------------------------------------------------------------------------------------------------

/// What each field of a line holds: kNumber (or a time of day), kText, kEmpty.
constexpr char kNumber = 'n', kText = 't', kEmpty = '-';

std::string MaskOf(std::string_view line, char separator) {
  Numbers numbers(separator != ',');
  std::string mask;
  for (FieldCutter fields(line, separator); !fields.done();) {
    const std::string_view text = Unquote(fields.Next());
    double number = 0;
    mask += IsMissing(text) ? kEmpty : numbers.Parse(text, number) || SecondOfDay(text) ? kNumber : kText;
  }
  return mask;
}

/// The most frequent width of the lines in the second half, and where most of them have numbers; the width 0 if they
/// have none.
std::string UsualMask(const std::vector<std::string>& masks) {
  std::map<std::size_t, std::size_t> widths;
  const std::size_t half = masks.size() / 2;
  for (std::size_t i = half; i < masks.size(); ++i) {
    if (masks[i].find(kNumber) != std::string::npos) ++widths[masks[i].size()];
  }
  if (widths.empty()) return "";
  const std::size_t width = std::ranges::max_element(widths, {}, [](const auto& entry) { return entry.second; })->first;
  std::string usual;
  for (std::size_t j = 0; j < width; ++j) {
    std::map<char, std::size_t> uses;
    for (std::size_t i = half; i < masks.size(); ++i) {
      if (masks[i].size() == width && masks[i].find(kNumber) != std::string::npos) ++uses[masks[i][j]];
    }
    usual += uses[kNumber] > uses[kText] ? kNumber : uses[kText] > 0 ? kText : kEmpty;
  }
  return usual;
}

/// Whether a line can be the first row: it has most of the numbers of the usual row, up to the last of them, and no
/// text where the usual row begins with empty fields.
bool IsFullRow(const std::string& mask, const std::string& usual) {
  const std::size_t last = usual.rfind(kNumber);
  if (last == std::string::npos || mask.size() <= last) return false;
  if (usual.front() == kEmpty && mask.front() == kText) return false;
  std::size_t wanted = 0, found = 0;
  for (std::size_t j = 0; j <= last; ++j) {
    if (usual[j] != kNumber) continue;
    if (mask[j] == kText) return false;
    ++wanted;
    found += mask[j] == kNumber ? 1 : 0;
  }
  return 2 * found >= wanted;
}

/// Whether a line has numbers, and no text where the usual row has numbers.
bool IsRow(const std::string& mask, const std::string& usual) {
  bool has_number = false;
  for (std::size_t j = 0; j < std::min(mask.size(), usual.size()); ++j) {
    if (usual[j] != kNumber) continue;
    if (mask[j] == kText) return false;
    has_number |= mask[j] == kNumber;
  }
  return has_number;
}

std::size_t CountFields(std::string_view line, char separator) {
  std::size_t count = 0;
  for (FieldCutter fields(line, separator); !fields.done(); ++count) fields.Next();
  return count;
}

/// A line of dashes below a header.
bool IsRule(std::string_view line) {
  constexpr std::string_view kMarks = "-=_+|*~ \t,;";
  return line.find_first_not_of(kMarks) == std::string_view::npos &&
         line.find_first_of("-=_*~") != std::string_view::npos;
}

bool SaysSomething(const std::vector<Name>& names) {
  return std::ranges::any_of(names, [](const Name& name) { return MeaningOf(name.text).kind.has_value(); });
}

/// The names in the header of a table of this width. Some programs separate them by another mark than the rows; then
/// the names must say something, because a remark may have as many words.
std::vector<Name> SplitNames(std::string_view line, char separator, std::size_t width) {
  std::vector<Name> names = SplitHeader(line, separator);
  const bool is_one = names.size() == 1;
  if (width < 2 || (!is_one && separator != ' ')) return names;
  for (const char other : {'\t', ';', ',', ' '}) {
    if (other == separator) continue;
    std::vector<Name> split = SplitHeader(is_one ? Unquote(line) : line, other);
    const bool are_names = std::ranges::all_of(split, [](const Name& name) { return IsName(name.text); });
    if (split.size() == width && are_names && SaysSomething(split)) return split;
  }
  return names;
}

/// Where the table is, for one separator.
struct Table {
  char separator = ',';
  std::size_t first_row = 0;  // Index of a line; the number of lines if there are no rows.
  std::size_t names = 0;      // Index of the line with the names, or first_row.
  std::size_t width = 0;      // Of the rows.
  double score = 0;
  bool begins_empty = false;  // The first field of all rows is empty.
};

/// The line of the names, which remarks may separate from the rows: a device that says that it calibrates.
template <typename AreNames>
std::size_t SkipRemarks(const std::vector<std::string_view>& lines, const Table& table, const AreNames& are_names) {
  constexpr std::size_t kMostRemarks = 5;
  // A remark may have as many words as there are columns, so names between the separators of the rows come first.
  for (std::size_t i = table.names; i + kMostRemarks > table.names; --i) {
    const std::vector<Name> names = SplitHeader(lines[i], table.separator);
    if (names.size() == table.width && SaysSomething(names) && are_names(i)) return i;
    if (i == 0 || names.size() == table.width) break;
  }
  for (std::size_t i = table.names; i + kMostRemarks > table.names; --i) {
    const std::vector<Name> names = SplitNames(lines[i], table.separator, table.width);
    if (SaysSomething(names)) return are_names(i) ? i : table.names;
    if (i == 0 || names.size() == table.width) break;
  }
  return table.names;
}

Table FindTable(const std::vector<std::string_view>& lines, char separator) {
  std::vector<std::string> masks;
  masks.reserve(lines.size());
  for (const std::string_view line : lines) masks.push_back(MaskOf(line, separator));
  const std::string usual = UsualMask(masks);
  Table table{separator, lines.size(), lines.size(), usual.size()};
  const auto is_row = [&](std::size_t i) { return i >= masks.size() || IsFullRow(masks[i], usual); };
  for (std::size_t i = 0; i < masks.size() && table.first_row == lines.size(); ++i) {
    if (is_row(i) && is_row(i + 1)) table.first_row = i;
  }
  table.names = table.first_row;
  if (table.first_row == lines.size()) return table;
  table.begins_empty = std::all_of(masks.begin() + static_cast<std::ptrdiff_t>(table.first_row), masks.end(),
                                   [](const std::string& mask) { return mask.starts_with(kEmpty); });
  const auto rows = std::ranges::count_if(masks, [&](const auto& mask) { return IsRow(mask, usual); });
  const auto numbers = static_cast<double>(std::ranges::count(usual, kNumber));
  const auto texts = static_cast<double>(std::ranges::count(usual, kText));
  table.score = static_cast<double>(rows) * std::max(numbers - texts, numbers / 8);
  if (table.first_row == 0) return table;
  table.names = table.first_row - 1;
  while (table.names > 0 && IsRule(lines[table.names])) --table.names;
  const auto are_names = [&](std::size_t i) {
    const std::vector<Name> above = SplitNames(lines[i], separator, table.width);
    return above.size() == table.width &&
           std::ranges::all_of(above, [](const Name& name) { return IsName(name.text); });
  };
  // A faulty row below the names.
  const auto is_faulty_row = [&](std::size_t i) {
    return masks[i].find(kNumber) != std::string::npos && (!IsText(lines[i]) || masks[i].size() == usual.size());
  };
  while (table.names > 0 && is_faulty_row(table.names) && are_names(table.names - 1)) table.first_row = table.names--;
  table.names = SkipRemarks(lines, table, are_names);
  constexpr double kSame = 1.5, kOther = 0.4;
  const std::vector<Name> names = SplitNames(lines[table.names], separator, table.width);
  const bool has_names = std::ranges::any_of(names, [](const Name& name) { return IsName(name.text); });
  if (has_names) table.score *= names.size() == table.width ? kSame : kOther;
  return table;
}

/// The separator that LabVIEW states above its table; NUL if there is none.
char LabViewSeparator(const std::vector<std::string_view>& lines) {
  if (lines.empty() || !lines.front().starts_with("LabVIEW Measurement")) return '\0';
  if (std::ranges::find(lines, "Separator\tTab") != lines.end()) return '\t';
  return std::ranges::find(lines, "Separator,Comma") != lines.end() ? ',' : '\0';
}

Table BestTable(const std::vector<std::string_view>& lines, char separator) {
  if (separator != '\0') return FindTable(lines, separator);
  Table best;
  for (const char each : {'\t', ';', ',', ' '}) {
    const bool is_used = each == ' ' || std::ranges::any_of(lines, [each](std::string_view line) {
                           return line.find(each) != std::string_view::npos;
                         });
    if (!is_used) continue;
    const Table table = FindTable(lines, each);
    if (best.score == 0 || table.score > best.score) best = table;
  }
  return best;
}

// ---- The header --------------------------------------------------------------------------------------------------

/// The names without what some programs write before them: `% t theta`, `DEF="Zeit" t / s`.
std::string_view NamesIn(std::string_view line, char separator) {
  for (const std::string_view mark : {"% ", "%\t", "//", ";", "DEF="}) {
    const bool is_mark = Trim(line).starts_with(mark) && mark.front() != separator;
    if (is_mark) return line.substr(line.find(mark) + mark.size());
  }
  return line;
}

std::string_view WithoutBrackets(std::string_view text) {
  const bool has_brackets = text.size() > 2 && (text.front() == '(' || text.front() == '[');
  return has_brackets ? text.substr(1, text.size() - 2) : text;
}

bool IsWord(std::string_view text) {
  constexpr std::size_t kLongerThanSymbols = 3;
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return text.size() >= kLongerThanSymbols && std::ranges::all_of(text, is_letter);
}

/// Whether each field is a unit, perhaps in brackets, or empty, below a name. Words for units such as
/// `millis` and `ADC` are names themselves if those above say nothing: `Hello, world`.
bool AreUnits(const std::vector<Name>& names, const std::vector<Name>& above) {
  bool has_unit = false;
  const bool may_be_words = SaysSomething(above);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string_view text = WithoutBrackets(names[i].text);
    if (text.empty() || text == "-") continue;
    if (i >= above.size()) return false;
    const NameMeaning meaning = MeaningOf(text);
    const Unit* unit = UnitOfText(text);
    const bool is_word = text == names[i].text && IsWord(text) && UnitOfSuffix(PlainName(text)) == nullptr;
    const bool is_unit = unit != nullptr || (meaning.has_other_unit && meaning.stem.size() < 2);
    if (!is_unit || (is_word && !may_be_words)) return false;
    has_unit = true;
  }
  return has_unit;
}

/// A name on one line.
std::string OnOneLine(std::string_view name) {
  std::string line(name);
  std::erase(line, '\r');
  std::ranges::replace(line, '\n', ' ');
  return line;
}

/// Names and, from the line below, their units.
std::vector<TableColumn> WithUnits(const std::vector<Name>& names, const std::vector<Name>& units) {
  std::vector<TableColumn> columns;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = OnOneLine(names[i].text);
    const std::string_view unit = i < units.size() ? WithoutBrackets(units[i].text) : std::string_view();
    const bool adds = UnitOfText(unit) != nullptr && MeaningOf(name).unit == nullptr;
    columns.push_back({name, adds ? name + " (" + std::string(unit) + ")" : name, "", names[i].at});
  }
  return columns;
}

/// The columns of an ordinary header, or of a header in the style of one of the known programs.
std::vector<TableColumn> ColumnsOf(const std::vector<Name>& names) {
  std::vector<TableColumn> columns;
  for (const Name& name : names) {
    const std::string written = OnOneLine(name.text);
    columns.push_back({written, written == "X_Value" ? "time" : written, "", name.at});  // LabVIEW's time
  }
  SplitRuns(columns);
  return columns;
}

/// The text without these blanks at its beginning.
std::string_view WithoutLeading(std::string_view blanks, std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(blanks), text.size()));
}

/// The header of numpy's savetxt: a comment above the first row with as many names as columns.
std::optional<TextLine> CommentWithNames(const FirstLines& first, const TextLine& row, std::size_t before,
                                         const Table& table) {
  for (const TextLine& comment : std::views::reverse(first.comments)) {
    if (comment.number >= row.number || comment.number <= before) continue;
    const std::string_view text = comment.text.substr(comment.text.find('#') + 1);
    // If tabs separate, empty names at the ends are columns too.
    const bool has_tabs = table.separator == '\t';
    for (const std::string_view blanks : {" ", " \t"}) {
      const std::string_view names = WithoutLeading(blanks, has_tabs ? text : Trim(text));
      const std::vector<Name> split = SplitNames(names, table.separator, table.width);
      if (split.size() == table.width && SaysSomething(split)) return TextLine{names, comment.number};
    }
    return std::nullopt;
  }
  return std::nullopt;
}

// ---- Lines above the table ---------------------------------------------------------------------------------------

/// What the lines above a table say about it: the sampling interval and the unit of the values.
void ReadPreamble(const std::vector<std::string_view>& lines, std::size_t end, Head& head) {
  constexpr std::array<std::string_view, 4> kUnitKeys = {"Y_Unit_Label", "Vertical Units", "Y Units", "VUnit"};
  constexpr std::array<std::string_view, 4> kStepKeys = {"Delta_X", "Sample Interval", "HResolution",
                                                         "Sampling Period"};
  for (std::size_t i = 0; i < end; ++i) {
    if (lines[i].starts_with("inDegrees=")) head.value_unit = lines[i].ends_with("yes") ? "deg" : "rad";
    const char separator = lines[i].find('\t') != std::string_view::npos ? '\t' : ',';
    std::string_view key;
    for (FieldCutter fields(lines[i], separator); !fields.done();) {
      const std::string_view field = Unquote(fields.Next());
      double number = 0;
      if (std::ranges::find(kStepKeys, key) != kStepKeys.end() && Numbers(separator == '\t').Parse(field, number) &&
          number > 0) {
        head.sample_rate_hz = 1 / number;
      }
      const Unit* unit = std::ranges::find(kUnitKeys, key) != kUnitKeys.end() ? UnitOfText(field) : nullptr;
      if (unit != nullptr && unit->kind != Kind::kTime) head.value_unit = unit->suffix;
      key = field;
    }
  }
}

/// Rigol's header: X,CH1,Start,Increment, and the numbers of the last two in the line below, beside the unit.
bool ReadRigolHeader(const std::vector<Name>& names, const std::vector<Name>& below, Head& head) {
  bool is_rigol = false;
  for (std::size_t i = 0; i < std::min(names.size(), below.size()); ++i) {
    double number = 0;
    if (names[i].text == "Increment" && ParseNumber(below[i].text, number) && number > 0) {
      head.sample_rate_hz = 1 / number;
      is_rigol = true;
    }
  }
  return is_rigol;
}

Head ParseVernierHead(const std::vector<TextLine>& lines, Layout& layout) {
  const std::size_t first = lines.front().number;
  Head head;
  std::string_view units;
  for (const TextLine& line : lines) {
    if (line.number == first + kVernierNames) head.names = line;
    if (line.number == first + kVernierUnits) units = line.text;
    if (line.number > first + kVernierUnits && head.first_row.number == 0) head.first_row = line;
  }
  layout.separator = '\t';
  layout.has_header = true;
  head.columns = VernierColumns(head.names.text, units);
  layout.width = head.columns.size();
  head.may_be_short = true;
  return head;
}

/// Examines the first lines of a text in steps, each of which needs the ones before.
class HeadParser {
 public:
  HeadParser(const FirstLines& first, Layout& layout) : first_(first), layout_(layout) {}

  Head Parse() {
    ChooseTable();
    FindNames();
    ReadPreamble(lines_, std::min(table_.first_row + 3, lines_.size()), head_);
    if (table_.first_row < lines_.size()) head_.first_row = LineOf(table_.first_row);
    FindRateLine();
    if (layout_.has_header) {
      head_.names = first_.lines[table_.names];
      MakeColumns();
    } else if (UseCommentAsHeader()) {
      MakeColumns();
    } else {
      head_.names = first_.lines[std::min(table_.first_row, lines_.size() - 1)];
      layout_.width = std::max<std::size_t>(table_.width, 1);
    }
    return std::move(head_);
  }

 private:
  TextLine LineOf(std::size_t i) const { return {lines_[i], first_.lines[i].number}; }
  std::string_view NamesTextOf(std::size_t i) const { return NamesIn(lines_[i], table_.separator); }
  std::vector<Name> NamesOf(std::size_t i) const { return SplitNames(NamesTextOf(i), table_.separator, table_.width); }

  static bool HasName(const std::vector<Name>& names) {
    return std::ranges::any_of(names, [](const Name& name) { return IsName(name.text); });
  }

  /// Finds a sampling rate in the lines and comments above the table, if no program's key gives it.
  void FindRateLine() {
    if (head_.sample_rate_hz > 0) return;
    std::vector<TextLine> above = first_.comments;
    for (std::size_t i = 0; i < std::min(table_.first_row, lines_.size()); ++i) above.push_back(LineOf(i));
    for (const TextLine& line : above) {
      std::string_view text = Trim(line.text);
      if (text.starts_with('#')) text.remove_prefix(1);
      const double rate = line.number < head_.first_row.number ? SampleRateIn(text) : 0;
      if (rate == 0) continue;
      head_.sample_rate_hz = rate;
      head_.rate_line = line;
    }
  }

  /// Whether the last field of the first row holds something.
  bool HasLastField() const {
    if (table_.first_row >= lines_.size()) return false;
    std::string_view field;
    for (FieldCutter fields(lines_[table_.first_row], table_.separator); !fields.done();) field = fields.Next();
    return !Unquote(field).empty();
  }

  void ChooseTable() {
    head_.has_host = HasHostStamps(first_.lines);
    for (const TextLine& line : first_.lines) lines_.push_back(DevicePart(line.text, head_.has_host));
    const char stated = first_.separator != '\0' ? first_.separator : LabViewSeparator(lines_);
    table_ = BestTable(lines_, stated);
    if (table_.score == 0) {  // Without rows of numbers, the first line is the header, so that messages name columns.
      const char separator = stated != '\0' ? stated : Separator(lines_[0]);
      table_ = {separator, std::min<std::size_t>(1, lines_.size()), 0};
    }
    layout_.separator = table_.separator;
  }

  /// Finds the names, perhaps above a line of units, and whether they are a header.
  void FindNames() {
    if (table_.names < table_.first_row) names_ = NamesOf(table_.names);
    if (table_.names > 0 && table_.names < table_.first_row) {
      std::vector<Name> above = NamesOf(table_.names - 1);
      if (HasName(above) && (AreUnits(names_, above) || ReadRigolHeader(above, names_, head_))) {
        units_ = std::exchange(names_, std::move(above));
        --table_.names;
      }
    }
    // R writes no name above the names of the rows.
    const bool has_row_names = names_.size() + 1 == table_.width && SaysSomething(names_) && HasLastField();
    if (has_row_names) names_.insert(names_.begin(), Name{"", names_.front().at});
    // Text above a table without a header says nothing.
    const bool is_text = table_.score > 0 && names_.size() != table_.width && !SaysSomething(names_);
    layout_.has_header = HasName(names_) && !is_text;
    const bool is_first_row_cut_off = !layout_.has_header && table_.first_row == 1 && table_.names == 0;
    if (is_first_row_cut_off && !names_.empty()) table_.first_row = 0;
  }

  /// Takes the names from a comment above the table. Returns false if there is none.
  bool UseCommentAsHeader() {
    const std::size_t before = table_.first_row > 0 ? first_.lines[table_.first_row - 1].number : 0;
    const auto comment = CommentWithNames(first_, head_.first_row, before, table_);
    if (!comment) return false;
    names_ = SplitNames(comment->text, table_.separator, table_.width);
    layout_.has_header = true;
    head_.names = *comment;
    return true;
  }

  void MakeColumns() {
    const bool is_comment = head_.names.number != first_.lines[table_.names].number;
    if (units_.empty() && table_.names > 0 && !is_comment) {
      head_.columns = LabelledColumns(lines_[table_.names - 1], names_, lines_[table_.first_row], table_.separator);
      head_.may_be_short = !head_.columns.empty();
    }
    if (head_.columns.empty() && table_.width == 1 && table_.separator == ' ' && names_.size() > 1) {
      // The name of a single column may contain blanks.
      names_ = {{Unquote(NamesTextOf(table_.names)), Trim(NamesTextOf(table_.names)).data()}};
    }
    if (head_.columns.empty()) head_.columns = units_.empty() ? ColumnsOf(names_) : WithUnits(names_, units_);
    // LabVIEW with `X_Columns No`: the times follow from the interval alone.
    if (table_.begins_empty && head_.sample_rate_hz > 0) head_.columns.front().meaning.clear();
    const auto times =
        std::ranges::count_if(head_.columns, [](const TableColumn& each) { return IsTime(each.meaning); });
    head_.may_be_short |= times > 1;
    layout_.width = head_.columns.size();
  }

  const FirstLines& first_;
  Layout& layout_;
  Head head_;
  Table table_;
  std::vector<std::string_view> lines_;  // What the device sent.
  std::vector<Name> names_, units_;
};

}  // namespace

std::optional<char> SeparatorLine(std::string_view line) {
  constexpr std::string_view kKey = "sep=";
  line = WithoutByteOrderMark(line);
  line.remove_prefix(line.starts_with('"') ? 1 : 0);
  if (line.size() <= kKey.size() || !line.starts_with(kKey)) return std::nullopt;
  return line[kKey.size()];
}

std::string_view RemarkPart(std::string_view line, const Head& head) {
  const auto after_time_of_day = [](std::string_view row) {
    const std::size_t end = std::min(row.find_first_not_of("0123456789:."), row.size());
    const std::string_view stamp = row.substr(0, end);
    const bool is_time = std::ranges::count(stamp, ':') == 2 && SecondOfDay(stamp);
    const std::size_t text = row.find_first_not_of(",; \t", end);
    return is_time && text != std::string_view::npos ? Trim(row.substr(text)) : std::string_view();
  };
  const std::string_view row = DevicePart(line, true);
  const std::string_view rest = after_time_of_day(row);
  const bool is_remark =
      !rest.empty() && IsText(rest) && after_time_of_day(DevicePart(head.first_row.text, head.has_host)).empty();
  return is_remark ? rest : row;
}

bool IsTextAmongRows(std::string_view line, const Head& head, char separator) {
  const std::string_view row = RemarkPart(line, head);
  if (!IsText(row) || IsMissing(Unquote(FieldCutter(row, separator).Next()))) return false;
  return head.fields_of_text == 0 || CountFields(row, separator) < head.fields_of_text;
}

bool IsHeaderAgain(std::string_view line, const Head& head, const Layout& layout) {
  const std::string_view names = head.names.text.substr(0, head.names.text.find_first_of("\r\n"));
  return layout.has_header && Trim(DevicePart(line, head.has_host)) == Trim(DevicePart(names, head.has_host));
}

Head ParseHead(std::string_view begin, Layout& layout) {
  const FirstLines first = SplitFirstLines(begin);
  if (first.lines.empty()) return {};
  if (IsVernier(first.lines.front().text)) return ParseVernierHead(first.lines, layout);
  Head head = HeadParser(first, layout).Parse();
  const std::string_view row = DevicePart(head.first_row.text, head.has_host);
  const std::size_t fields = CountFields(row, layout.separator);
  if (IsText(row) && fields >= layout.width) head.fields_of_text = fields;  // else it is no row
  return head;
}

TableNumbers ReadNumbers(std::string_view text, std::size_t number, const Head& head, const Layout& layout) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::vector<double>> columns(layout.width);
  std::size_t rows = 0;
  TableNumbers found;
  found.is_clock.resize(layout.width);
  std::vector<DayClock> clocks(layout.width);
  Numbers numbers(layout.separator != ',');
  ForEachTextLine(text, number, [&](std::string_view line, std::size_t at) {
    if (at < head.first_row.number || IsEmptyRow(line) || Trim(line).front() == '#') return true;
    if (IsHeaderAgain(line, head, layout)) return false;
    if (IsTextAmongRows(line, head, layout.separator)) return true;
    if (++rows * layout.width > kMostCells) return false;
    std::size_t index = 0;
    for (FieldCutter fields(DevicePart(line, head.has_host), layout.separator); !fields.done() && index < layout.width;
         ++index) {
      double value = kNone;
      if (!fields.NextNumber(numbers, value)) {
        const std::string_view field = Unquote(fields.Next());
        const auto time = numbers.Parse(field, value) ? std::nullopt : SecondOfDay(field);
        if (time) found.is_clock[index] = true;
        if (time) value = clocks[index].Continue(*time);
        if (!time && !numbers.Parse(field, value)) value = kNone;
      }
      columns[index].push_back(value);
    }
    for (; index < layout.width; ++index) columns[index].push_back(kNone);
    return true;
  });
  for (const std::vector<double>& column : columns) {
    found.columns.emplace_back(Eigen::VectorXd::Map(column.data(), static_cast<Eigen::Index>(column.size())));
  }
  return found;
}

std::vector<std::vector<std::string>> FirstRows(std::string_view text, std::size_t most, const Head& head,
                                                const Layout& layout) {
  std::vector<std::vector<std::string>> rows;
  if (head.first_row.number == 0) return rows;
  ForEachTextLine(text, 1, [&](std::string_view line, std::size_t at) {
    if (at < head.first_row.number || IsEmptyRow(line) || Trim(line).front() == '#') return true;
    if (rows.size() == most || IsHeaderAgain(line, head, layout)) return false;
    if (IsTextAmongRows(line, head, layout.separator)) return true;
    std::vector<std::string>& cells = rows.emplace_back();
    for (FieldCutter fields(DevicePart(line, head.has_host), layout.separator);
         !fields.done() && cells.size() < layout.width;) {
      cells.emplace_back(Unquote(fields.Next()));
    }
    return true;
  });
  return rows;
}

}  // namespace pendulum::csv
