// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pendulum {

/// Writes a table as CSV text, which ReadRows then reads. Line N is row N, so that messages name rows of the table.
/// Cells are separated by semicolons, because numbers stored as text may have decimal commas. A number is written in
/// its shortest exact form.
class CsvText {
 public:
  /// The text is limited to `max_bytes` and `max_rows`: see is_full.
  explicit CsvText(std::size_t max_bytes, std::size_t max_rows = static_cast<std::size_t>(-1))
      : max_bytes_(max_bytes), max_rows_(max_rows) {}

  /// Adds a cell. `row` and `column` begin at 0. A cell before the last one, or beyond the limits, is left out.
  void AddNumber(std::size_t row, std::size_t column, double number);
  void AddText(std::size_t row, std::size_t column, std::string_view text);

  /// True if cells were left out because the text became too long or too wide.
  bool is_full() const { return is_full_; }

  /// True if a cell was left out because it came before the last one.
  bool is_disordered() const { return is_disordered_; }

  /// The text; all rows have the same number of cells. A comment (a row of one cell that begins with #) keeps its form.
  std::string Finish();

 private:
  struct Row {
    std::uint32_t cells = 0;
    bool is_comment = false;
  };

  bool BeginCell(std::size_t row, std::size_t column);
  bool HasRoom(std::size_t bytes);
  void QuoteComment();
  std::string Padded(std::size_t width) const;

  std::size_t max_bytes_, max_rows_;
  std::string text_;
  std::vector<Row> rows_;
  bool is_full_ = false, is_disordered_ = false;
};

/// A cell of a CSV text, in quotes if needed. Line ends become blanks.
std::string CsvCell(std::string_view text);

}  // namespace pendulum
