// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/text/ros_rows.h"

#include <algorithm>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"

namespace pendulum::csv {

ReadOptions RosRows::SplitOffJoint(const ReadOptions& options) {
  ReadOptions rest = options;
  if (!has_joints()) return rest;
  JointChoice choice = ChoiceOf(columns_, options.value_column);
  joint_ = std::move(choice.joint);
  rest.value_column = std::move(choice.column);
  return rest;
}

Result<void> RosRows::CheckSecond(const Line& line) const {
  if (!has_joints() || !layout_.second) return {};
  return line.Fault(columns_[layout_.second->index].at,
                    "columns " + layout_.value.name + " and " + layout_.second->name +
                        " are both coordinates of a point, but only one is read if each row belongs to one joint; "
                        "choose it with --value_column, or keep the rows of one joint and leave out column " +
                        Quoted(columns_[table_.joint].written));
}

Result<std::optional<RosRows::Sample>> RosRows::Read(const Line& line, Cells& cells) {
  fields_.clear();
  for (FieldCutter fields(line.text, layout_.separator); !fields.done();) fields_.push_back(Unquote(fields.Next()));
  fields_.resize(std::max(fields_.size(), layout_.width));
  Sample sample;
  if (layout_.time) {
    RETURN_IF_ERROR(ReadStamp(line, cells, sample.time));
  }
  const Column& column = layout_.value;
  RETURN_IF_ERROR(cells.Read(line, fields_[column.index], column, sample.value));
  if (layout_.second) {
    RETURN_IF_ERROR(cells.Read(line, fields_[layout_.second->index], *layout_.second, sample.second));
  }
  if (cells.is_gap) return std::nullopt;
  if (!has_joints()) return sample;
  if (joints_.Add(fields_[table_.joint], sample.time, sample.value, line.number)) return std::nullopt;
  return line.Fault(line.text.data(), "column " + Quoted(columns_[table_.joint].written) + " holds more than " +
                                          std::to_string(JointTable::kMaxJoints) +
                                          " names up to here; name one joint per row");
}

/// Reads the time of a row. If it is a stamp, the time is in seconds since the first stamp.
Result<void> RosRows::ReadStamp(const Line& line, Cells& cells, double& time) {
  const std::size_t index = layout_.time->index;
  const std::string_view field = fields_[index];
  if (index != table_.seconds || field.empty()) return cells.Read(line, field, *layout_.time, time);
  const std::string_view beyond = table_.nanoseconds == kNoColumn ? std::string_view() : fields_[table_.nanoseconds];
  if (stamps_.Read(field, beyond, time)) return {};
  return line.Fault(field.data(), "column " + layout_.time->name + " holds " + Quoted(field) +
                                      (beyond.empty() ? "" : " s and " + Quoted(beyond) + " ns") +
                                      ", which is not a time stamp of ROS; correct the field or delete the row");
}

Result<JointRows*> RosRows::ChooseJoint(const Line& line) {
  return joints_.Choose(line, joint_, columns_[layout_.value.index].written);
}

std::string RosRows::NameOf(const JointRows& rows) const {
  return Quoted(rows.joint + "/" + columns_[layout_.value.index].written);
}

}  // namespace pendulum::csv
