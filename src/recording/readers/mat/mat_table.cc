// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_table.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

namespace pendulum {
namespace {

void PutSize(std::size_t size, std::string& bytes) {
  const std::uint64_t number = size;
  std::array<char, sizeof number> raw{};
  std::memcpy(raw.data(), &number, sizeof number);
  bytes.append(raw.data(), raw.size());
}

void PutText(const std::string& text, std::string& bytes) {
  PutSize(text.size(), bytes);
  bytes += text;
}

/// Removes values from the front of bytes; returns zeros after the end.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  std::string_view Raw(std::size_t size) {
    const std::string_view raw = bytes_.substr(0, size);
    bytes_.remove_prefix(raw.size());
    return raw;
  }

  std::size_t Size() {
    std::uint64_t number = 0;
    const std::string_view raw = Raw(sizeof number);
    if (!raw.empty()) std::memcpy(&number, raw.data(), raw.size());
    return number;
  }

  std::string Text() { return std::string(Raw(Size())); }

  std::vector<double> Numbers() {
    const std::string_view raw = Raw(Size());
    std::vector<double> values(raw.size() / sizeof(double));
    if (!values.empty()) std::memcpy(values.data(), raw.data(), values.size() * sizeof(double));
    return values;
  }

  bool IsEmpty() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
};

}  // namespace

std::string Pack(const MatTable& table) {
  std::string bytes;
  PutText(table.complaint, bytes);
  PutSize(table.skipped.size(), bytes);
  for (const SkippedVariable& variable : table.skipped) {
    PutText(variable.name, bytes);
    PutText(variable.kind, bytes);
    PutSize(variable.is_object ? 1 : 0, bytes);
  }
  for (const MatColumn& column : table.columns) {
    for (const std::string* text : {&column.name.written, &column.name.meaning, &column.name.run}) {
      PutText(*text, bytes);
    }
    PutSize(column.is_unit_known ? 1 : 0, bytes);
    const std::size_t size = column.values.size() * sizeof(double);
    PutSize(size, bytes);
    const std::size_t used = bytes.size();
    bytes.resize(used + size);
    if (size > 0) std::memcpy(bytes.data() + used, column.values.data(), size);
  }
  return bytes;
}

MatTable UnpackMatTable(std::string_view bytes) {
  MatTable table;
  ByteReader reader(bytes);
  table.complaint = reader.Text();
  for (std::size_t count = reader.Size(); count > 0 && !reader.IsEmpty(); --count) {
    SkippedVariable variable;
    variable.name = reader.Text();
    variable.kind = reader.Text();
    variable.is_object = reader.Size() != 0;
    table.skipped.push_back(std::move(variable));
  }
  while (!reader.IsEmpty()) {
    MatColumn column;
    column.name.written = reader.Text();
    column.name.meaning = reader.Text();
    column.name.run = reader.Text();
    column.is_unit_known = reader.Size() != 0;
    column.values = reader.Numbers();
    table.columns.push_back(std::move(column));
  }
  return table;
}

}  // namespace pendulum
