// SPDX-License-Identifier: Apache-2.0
// The objects of a MAT-file of version 5, and their table alone.
#include <cstddef>
#include <cstdint>

#include "recording/readers/mat/mat_timeseries.h"
#include "tests/fuzz/recording.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = pendulum::TextOf(data, size);
  pendulum::MatTable table;
  pendulum::AddTimeseries(pendulum::SubsystemOf(text), table);
  std::size_t rows = 0;
  for (const pendulum::MatColumn& column : table.columns) {
    const bool is_time = column.name.written == column.name.run + ".Time";
    if (is_time) rows = column.values.size();
    pendulum::Require(!column.name.run.empty() && rows > 0 && column.values.size() == rows);
  }
  const auto objects = pendulum::Mcos::Read(text, size);
  for (std::size_t object = 0; objects && object < objects->objects(); ++object) {
    const std::string name = objects->ClassName(objects->ClassOf(object));
    pendulum::Require(object == 0 || !name.empty());
    const pendulum::McosProperty* const property = objects->Find(object, "Data_");
    const bool is_cell = property != nullptr && property->kind == pendulum::McosProperty::Kind::kCell;
    pendulum::Require(!is_cell || property->value < size);
  }
  return 0;
}
