// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/joint_table.h"

#include <algorithm>

#include "pendulum/base/format.h"
#include "recording/readers/columns/several_quantities.h"

namespace pendulum::csv {
namespace {

bool IsMoving(const JointRows& rows) {
  const auto [low, high] = std::ranges::minmax(rows.value);
  return low < high;
}

std::vector<std::string> NamesOf(const std::vector<JointRows*>& joints, const std::string& column) {
  std::vector<std::string> names;
  names.reserve(joints.size());
  for (const JointRows* rows : joints)
    names.push_back(Quoted(column.empty() ? rows->joint : rows->joint + "/" + column));
  return names;
}

}  // namespace

JointChoice ChoiceOf(const std::vector<TableColumn>& columns, const std::string& value_column) {
  if (value_column.empty() || IndexOf(columns, value_column) < columns.size()) return {"", value_column};
  const std::size_t slash = value_column.rfind('/');
  if (slash != std::string::npos && slash > 0) {
    const std::string column = value_column.substr(slash + 1);
    if (IndexOf(columns, column) < columns.size()) return {value_column.substr(0, slash), column};
  }
  return {value_column, ""};
}

bool JointTable::Add(std::string_view joint, double time, double value, std::size_t line) {
  if (joints_.empty() || joints_[last_].joint != joint) {
    last_ = std::ranges::find(joints_, joint, &JointRows::joint) - joints_.begin();
    if (last_ == kMaxJoints) {
      last_ = 0;
      return false;
    }
    if (last_ == joints_.size()) joints_.push_back({std::string(joint), {}, {}, {}});
  }
  JointRows& rows = joints_[last_];
  rows.time.push_back(time);
  rows.value.push_back(value);
  rows.lines.Add(line);
  return true;
}

Result<JointRows*> JointTable::Choose(const Line& line, const std::string& joint, const std::string& column) {
  std::vector<JointRows*> all, moving;
  for (JointRows& rows : joints_) {
    if (rows.joint == joint) return &rows;
    all.push_back(&rows);
    if (IsMoving(rows)) moving.push_back(&rows);
  }
  if (all.empty()) return nullptr;
  if (!joint.empty()) {
    return line.Fault(line.text.data(),
                      "--value_column is " + Quoted(joint) + ", which is neither a column nor one of " +
                          ListWithAnd(NamesOf(all, "")) + "; give one of these",
                      StatusCode::kInvalidArgument);
  }
  if (all.size() == 1) return all.front();
  if (moving.size() == 1) return moving.front();
  const std::vector<JointRows*>& several = moving.empty() ? all : moving;
  return line.Fault(line.text.data(), SeveralQuantities(NamesOf(several, column)));
}

}  // namespace pendulum::csv
