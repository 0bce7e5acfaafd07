// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pendulum/recording/calibration/calibration_table.h"

/// Tables for tests of calibrations.
namespace pendulum {

/// The published table of the reference rig: 10-bit counts of a potentiometer at angles set by hand.
inline constexpr const char* kReferenceTable =
    "counts,angle_deg\n19,-45\n97,-30\n177,-15\n261,0\n324,15\n396,30\n475,45\n";

inline CalibrationTable TableOf(const std::string& text) {
  const Result<CalibrationTable> table = ParseCalibrationTable(text, "table.csv");
  EXPECT_TRUE(table.has_value()) << text << (table ? "" : table.error().message());
  return table.value_or(CalibrationTable());
}

/// A table from numbers, unchecked.
inline CalibrationTable TableOf(const std::string& input, const std::string& angle_unit,
                                const std::vector<double>& reading, const std::vector<double>& angle) {
  CalibrationTable table{"table.csv",
                         input,
                         angle_unit,
                         Eigen::VectorXd(reading.size()),
                         Eigen::VectorXd(angle.size()),
                         std::vector<std::size_t>(reading.size())};
  for (std::size_t i = 0; i < reading.size(); ++i) {
    table.reading[static_cast<Eigen::Index>(i)] = reading[i];
    table.angle[static_cast<Eigen::Index>(i)] = angle[i];
    table.line[i] = i + 2;
  }
  return table;
}

}  // namespace pendulum
