// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/column_choice.h"

#include "pendulum/base/try.h"
#include "recording/readers/columns/choice.h"
#include "recording/readers/columns/passages.h"
#include "recording/readers/columns/time_choice.h"
#include "recording/readers/columns/value_choice.h"

namespace pendulum::csv {
namespace {

std::optional<TablePreview::Column> Previewed(const std::optional<std::size_t>& index, const Unit* unit) {
  if (!index) return std::nullopt;
  return TablePreview::Column{*index, unit == nullptr ? "" : std::string(unit->suffix)};
}

/// Fills the parts of a preview that the choosers of columns know.
void FillPreview(const Choice& choice, TablePreview& preview) {
  preview.names.clear();
  for (std::size_t i = 0; i < choice.layout.width; ++i) preview.names.push_back(choice.FlagValueOf(i));
  preview.rows = choice.table.first_rows();
  preview.time = Previewed(choice.time, choice.layout.time ? choice.layout.time->unit : nullptr);
  preview.value = Previewed(choice.value, choice.layout.value.unit);
  preview.assumptions = choice.warnings;
  preview.questions = choice.questions;
}

Result<void> Choose(Choice& choice) {
  RETURN_IF_ERROR(RefusePassages(choice));
  RETURN_IF_ERROR(FindNamedTime(choice));
  RETURN_IF_ERROR(ChooseValue(choice));
  RETURN_IF_ERROR(ChooseTime(choice));
  if (choice.value && choice.value == choice.time) {
    return choice.WrongFlag(*choice.value,
                            "column " + choice.NameOf(*choice.value) +
                                " cannot be both the time and the quantity; choose another with --value_column");
  }
  RETURN_IF_ERROR(SetValue(choice));
  return choice.Answer(choice.value.value_or(0));
}

}  // namespace

Result<void> ChooseColumns(const TableView& table, const ReadOptions& options, Layout& layout,
                           std::vector<Warning>& warnings) {
  Choice choice{.table = table, .options = options, .layout = layout, .warnings = warnings};
  Result<void> chosen = Choose(choice);
  if (options.preview != nullptr) FillPreview(choice, *options.preview);
  return chosen;
}

}  // namespace pendulum::csv
