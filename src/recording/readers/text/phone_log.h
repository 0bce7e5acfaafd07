// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "recording/readers/columns/column.h"
#include "recording/readers/columns/table.h"

/// A file of Sensor Logger, an app that writes one file for each sensor of a phone: `time,seconds_elapsed,z,y,x`. The
/// units are not in the header; the name of the file names the sensor.
namespace pendulum::csv {

/// What the columns of a file of this name mean, after the name of their axis: "gyroscope (rad/s)"; empty: the name
/// does not say. Uncalibrated accelerations are in g on some phones.
inline std::string_view MeaningOfPhoneFile(std::string_view file) {
  const std::string plain = PlainName(file.substr(file.find_last_of("/\\:") + 1));
  const auto has = [&](std::string_view word) { return plain.find(word) != std::string::npos; };
  if (has("gyro")) return "gyroscope (rad/s)";
  if (has("totalaccel")) return "acceleration (m/s^2)";
  return has("accel") && !has("uncalibrated") ? "linear acceleration (m/s^2)" : "";
}

/// Whether a file with these names of readings holds the calibrated rates of a phone's gyro.
inline bool IsPhoneGyro(std::string_view file, const std::vector<std::string>& readings) {
  const auto is_axis = [](const std::string& name) { return name == "x" || name == "y" || name == "z"; };
  return std::ranges::all_of(readings, is_axis) && MeaningOfPhoneFile(file).starts_with("gyro") &&
         PlainName(file).find("uncalibrated") == std::string::npos;
}

/// Gives the columns of such a file their meaning. `file` is its name, perhaps after that of its archive and a colon.
inline void NamePhoneSensor(std::string_view file, std::vector<TableColumn>& columns) {
  const auto is_of_log = [](const TableColumn& column) {
    constexpr std::array<std::string_view, 5> kNames = {"time", "seconds_elapsed", "z", "y", "x"};
    return std::ranges::find(kNames, column.written) != kNames.end();
  };
  if (columns.size() != 5 || !std::ranges::all_of(columns, is_of_log)) return;
  const std::string_view sensor = MeaningOfPhoneFile(file);
  for (TableColumn& column : columns) {
    if (column.written == "time") column.meaning.clear();
    if (column.written == "seconds_elapsed") column.meaning = "time_s";
    if (column.written.size() == 1 && !sensor.empty()) column.meaning = column.written + " " + std::string(sensor);
  }
}

}  // namespace pendulum::csv
