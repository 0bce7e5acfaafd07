// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/recording/clock.h"
#include "recording/readers/columns/table.h"

/// Tables in which each row belongs to one joint.
namespace pendulum::csv {

/// The meaning of --value_column for such a table: JOINT, COLUMN or JOINT/COLUMN. Missing parts are empty.
struct JointChoice {
  std::string joint, column;
};

JointChoice ChoiceOf(const std::vector<TableColumn>& columns, const std::string& value_column);

/// The rows of one joint.
struct JointRows {
  std::string joint;
  std::vector<double> time, value;
  LineNumbers lines;
};

class JointTable {
 public:
  static constexpr std::size_t kMaxJoints = 1000;

  /// Adds a row. Returns false if the row would begin joint number kMaxJoints + 1.
  bool Add(std::string_view joint, double time, double value, std::size_t line);

  /// The requested joint, or the only joint, or the only joint that moves; nullptr if there are no rows. `line` is the
  /// header, `column` the name of the value column. kDataLoss: several joints are possible. kInvalidArgument: there is
  /// no such joint.
  Result<JointRows*> Choose(const Line& line, const std::string& joint, const std::string& column);

 private:
  std::vector<JointRows> joints_;
  std::size_t last_ = 0;  // Joint of the previous row.
};

}  // namespace pendulum::csv
