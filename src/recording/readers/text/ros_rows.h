// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/readers/columns/joint_table.h"
#include "recording/readers/text/cell.h"
#include "recording/readers/text/ros.h"

namespace pendulum::csv {

/// Reads the rows of a ROS table.
class RosRows {
 public:
  /// `columns` and `layout` must outlive this object; `layout` may be completed later.
  RosRows(const RosTable& table, const std::vector<TableColumn>& columns, const Layout& layout)
      : table_(table), columns_(columns), layout_(layout), stamps_(table.is_nanoseconds) {}

  bool has_joints() const { return table_.joint != kNoColumn; }

  /// Stores the joint that the user requests. Returns the options without it.
  ReadOptions SplitOffJoint(const ReadOptions& options);

  /// kDataLoss: a table with one joint per row has both coordinates of a point.
  Result<void> CheckSecond(const Line& line) const;

  struct Sample {
    double time = 0, value = 0, second = 0;
  };

  /// The sample of a row; std::nullopt if it has a gap or was stored with its joint.
  Result<std::optional<Sample>> Read(const Line& line, Cells& cells);

  /// The rows of the chosen joint. `line` is the header.
  Result<JointRows*> ChooseJoint(const Line& line);
  std::string NameOf(const JointRows& rows) const;

 private:
  Result<void> ReadStamp(const Line& line, Cells& cells, double& time);

  RosTable table_;
  const std::vector<TableColumn>& columns_;
  const Layout& layout_;
  StampClock stamps_;
  std::string joint_;  // The requested joint; empty: none.
  JointTable joints_;
  std::vector<std::string_view> fields_;  // Fields of the current row.
};

}  // namespace pendulum::csv
