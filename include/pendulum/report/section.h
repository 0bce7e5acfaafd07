// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "pendulum/report/layout.h"

namespace pendulum {

/// How much a reader is to be stopped: by "differs", by "did not converge".
enum class Emphasis { kNone, kCaution, kAlarm };

/// Sentences. A no-break space (U+00A0) is shown as a blank at which no line is broken.
struct Words {
  std::string text;
  Emphasis emphasis = Emphasis::kNone;
};

/// A name and what is said of it, in a few words or a sentence.
struct Fact {
  std::string name, text;
  Emphasis emphasis = Emphasis::kNone;
};
using Facts = std::vector<Fact>;

/// Rows below headers; each has one cell per column. Columns without any text are not shown.
struct Table {
  std::vector<Column> columns;
  std::vector<std::vector<std::string>> rows = {};
  std::string caution = {};     ///< The text of cells that are to stop a reader; empty: none.
  std::size_t rows_before = 0;  ///< `left_out` stands behind so many rows.
  std::string left_out = {};    ///< "... 12 more": what the table does not list; empty: nothing.
};

struct Formula {
  std::string text;
};

struct Items {
  std::vector<std::string> texts;
  Emphasis emphasis = Emphasis::kNone;
};

using Block = std::variant<Words, Facts, Table, Formula, Items>;

/// A part of the report for people, whatever form it is given.
struct Section {
  std::string title;
  std::string remark = {};  ///< On the whole section, in a few words; often empty.
  std::vector<Block> blocks = {};

  Section& Add(Block block) {
    blocks.push_back(std::move(block));
    return *this;
  }
  /// Sentences; nothing when the text is empty.
  Section& Say(std::string text, Emphasis emphasis = Emphasis::kNone) {
    if (!text.empty()) blocks.emplace_back(Words{std::move(text), emphasis});
    return *this;
  }
};

using Sections = std::vector<Section>;

}  // namespace pendulum
