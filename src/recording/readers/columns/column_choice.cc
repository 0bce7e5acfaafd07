// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/column_choice.h"

#include "recording/readers/columns/choice.h"
#include "recording/readers/columns/time_choice.h"
#include "recording/readers/columns/value_choice.h"

namespace pendulum::csv {

Result<void> ChooseColumns(const TableView& table, const ReadOptions& options, Layout& layout,
                           std::vector<Warning>& warnings) {
  Choice choice{.table = table, .options = options, .layout = layout, .warnings = warnings};
  if (Result<void> found = FindNamedTime(choice); !found) return found;
  if (Result<void> chosen = ChooseValue(choice); !chosen) return chosen;
  if (Result<void> chosen = ChooseTime(choice); !chosen) return chosen;
  if (choice.value && choice.value == choice.time) {
    return choice.WrongFlag(*choice.value,
                            "column " + choice.NameOf(*choice.value) +
                                " cannot be both the time and the quantity; choose another with --value_column");
  }
  if (Result<void> set = SetValue(choice); !set) return set;
  return choice.Answer(choice.value.value_or(0));
}

}  // namespace pendulum::csv
