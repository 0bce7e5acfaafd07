// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "recording/readers/columns/column.h"

/// The columns of a table that are read.
namespace pendulum::csv {

struct Column {
  std::size_t index = 0;
  std::string name;  // As messages show it.
  const Unit* unit = nullptr;
  bool is_gyro = false;             // According to its name.
  bool is_without_gravity = false;  // According to its name: a linear acceleration.
};

struct Layout {
  char separator = ',';
  std::size_t width = 0;
  bool has_header = false;
  std::optional<Column> time;  // std::nullopt: times come from a sample rate or from the host.
  bool is_clock = false;       // The times are times of day: 16:04:31.273.
  bool is_from_first = false;  // Times count from the first row, because they began at midnight or in 1970.
  Column value;
  bool is_unit_assumed = false;  // The unit of the value is a guess from its numbers.
  std::optional<Column> second;  // The vertical coordinate of a point whose horizontal one is `value`.
  /// Other axes of a gyro whose first one is `value`, and the direction of the rotation in them, a unit vector of
  /// 1 + axes.size() components; empty if `value` alone is read.
  std::vector<Column> axes;
  Eigen::VectorXd direction;
};

}  // namespace pendulum::csv
