// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/sections_json.h"

#include <string>
#include <variant>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/report/json_parts.h"
#include "pendulum/report/text.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

std::string Shown(const std::string& text) { return WithBlanks(Printable(text)); }

Json ShownTexts(const std::vector<std::string>& texts) { return ArrayOf(texts, Shown); }

std::string EmphasisName(Emphasis emphasis) {
  return emphasis == Emphasis::kNone ? "none" : emphasis == Emphasis::kCaution ? "caution" : "alarm";
}

struct BlockToJson {
  Json operator()(const Words& words) const {
    return {{"kind", "words"}, {"text", Shown(words.text)}, {"emphasis", EmphasisName(words.emphasis)}};
  }
  Json operator()(const Facts& facts) const {
    const auto row = [](const Fact& fact) -> Json {
      return {{"name", fact.name}, {"text", Shown(fact.text)}, {"emphasis", EmphasisName(fact.emphasis)}};
    };
    return {{"kind", "facts"}, {"rows", ArrayOf(facts, row)}};
  }
  Json operator()(const Table& table) const {
    const auto column = [](const Column& one) -> Json {
      return {{"header", Shown(one.header)}, {"is_number", one.right_aligned}, {"joins", one.gap == 1}};
    };
    return {{"kind", "table"},
            {"columns", ArrayOf(table.columns, column)},
            {"rows", ArrayOf(table.rows, ShownTexts)},
            {"caution", TextOrNull(table.caution)},
            {"rows_before", table.rows_before},
            {"left_out", TextOrNull(table.left_out)}};
  }
  Json operator()(const Formula& formula) const { return {{"kind", "formula"}, {"text", Shown(formula.text)}}; }
  Json operator()(const Items& items) const {
    return {{"kind", "items"}, {"texts", ShownTexts(items.texts)}, {"emphasis", EmphasisName(items.emphasis)}};
  }
};

/// "Do the recordings agree?": "do-the-recordings-agree".
std::string IdOf(const std::string& title) {
  std::string id;
  for (const char c : title) {
    const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const bool is_kept = (lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9');
    if (is_kept) id += lower;
    if (!is_kept && !id.empty() && !id.ends_with('-')) id += '-';
  }
  if (id.ends_with('-')) id.pop_back();
  return id;
}

Json SectionJson(const Section& section) {
  const auto block = [](const Block& one) { return std::visit(BlockToJson(), one); };
  return {{"id", IdOf(section.title)},
          {"title", section.title},
          {"law", TextOrNull(section.law)},
          {"recording", section.recording == 0 ? Json(nullptr) : Json(section.recording)},
          {"remark", TextOrNull(section.remark)},
          {"blocks", ArrayOf(section.blocks, block)}};
}

}  // namespace

nlohmann::ordered_json SectionsJson(const Sections& sections) { return ArrayOf(sections, SectionJson); }

nlohmann::ordered_json SectionsJson(const Identification& identification) {
  return SectionsJson(ReportSections(identification, FitsInFull::kAll));
}

std::string ToSectionsJsonText(const Identification& identification) {
  return JsonText(SectionsJson(identification)) + "\n";
}

}  // namespace pendulum
