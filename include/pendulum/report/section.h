// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "pendulum/report/layout.h"

namespace pendulum {

/// Strength of a highlight: kCaution for "differs", kAlarm for "did not converge".
enum class Emphasis { kNone, kCaution, kAlarm };

/// Sentences. A no-break space (U+00A0) is shown as a blank without a line break.
struct Words {
  std::string text;
  Emphasis emphasis = Emphasis::kNone;
};

/// A name and its description, in a few words or a sentence.
struct Fact {
  std::string name, text;
  Emphasis emphasis = Emphasis::kNone;
};
using Facts = std::vector<Fact>;

/// Rows below headers; each has one cell per column. Columns without text are not shown.
struct Table {
  std::vector<Column> columns;
  std::vector<std::vector<std::string>> rows = {};
  std::string caution = {};     ///< The text of cells to be highlighted; empty: none.
  std::size_t rows_before = 0;  ///< `left_out` is shown after this many rows.
  std::string left_out = {};    ///< "... 12 more": describes omitted rows; empty: none are omitted.
};

struct Formula {
  std::string text;
};

struct Items {
  std::vector<std::string> texts;
  Emphasis emphasis = Emphasis::kNone;
};

using Block = std::variant<Words, Facts, Table, Formula, Items>;

/// A part of the report as text, independent of its format.
struct Section {
  std::string title;
  std::string remark = {};  ///< A short remark on the whole section; often empty.
  std::vector<Block> blocks = {};
  std::string law = {};  ///< The law that it is about; empty: all, or the only one that is shown in full.
  int recording = 0;     ///< The number (from 1) of the recording that it is about; 0: all, or the only one.

  /// Adds one of the kinds of Block.
  template <typename Kind>
  Section& Add(Kind block) {
    blocks.emplace_back(std::move(block));
    return *this;
  }
  /// Adds sentences; an empty text adds nothing.
  Section& AddText(std::string text, Emphasis emphasis = Emphasis::kNone) {
    if (!text.empty()) blocks.emplace_back(Words{std::move(text), emphasis});
    return *this;
  }
};

using Sections = std::vector<Section>;

/// Which fits of a comparison are shown in full.
enum class FitsInFull { kMain, kAll };

/// "Closed forms against the fit of drag: recording 2".
std::string FullTitle(const Section& section);

}  // namespace pendulum
