// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/readers/columns/column.h"
#include "recording/readers/columns/table.h"

/// A file of Sensor Logger, an app that writes one file for each sensor of a phone: `time,seconds_elapsed,z,y,x`. The
/// units are not in the header; the name of the file names the sensor.
namespace pendulum::csv {

/// What the columns of a file of this name mean, after the name of their axis: "gyroscope (rad/s)"; empty: not to be
/// read; std::nullopt: the name says nothing. Uncalibrated accelerations are in g on some phones.
inline std::optional<std::string_view> MeaningOfPhoneFile(std::string_view file) {
  struct Sensor {
    std::string_view word, meaning;
  };
  constexpr std::array kSensors = {Sensor{"uncalibrated", ""},
                                   Sensor{"magnet", ""},
                                   Sensor{"gravity", ""},
                                   Sensor{"gyro", "gyroscope (rad/s)"},
                                   Sensor{"totalaccel", "acceleration (m/s^2)"},
                                   Sensor{"accel", "linear acceleration (m/s^2)"}};
  const std::string plain = PlainName(file.substr(file.find_last_of("/\\:") + 1));
  for (const Sensor& sensor : kSensors) {
    if (plain.find(sensor.word) != std::string::npos) return sensor.meaning;
  }
  return std::nullopt;
}

/// Whether a file has this name because a phone's app wrote the rates of its gyro into it.
inline bool IsGyroFile(std::string_view file) { return MeaningOfPhoneFile(file).value_or("").starts_with("gyro"); }

/// Gives the columns of such a file their meaning. `file` is its name, perhaps after that of its archive and a colon.
inline void NamePhoneSensor(std::string_view file, std::vector<TableColumn>& columns) {
  const auto is_of_log = [](const TableColumn& column) {
    constexpr std::array<std::string_view, 5> kNames = {"time", "seconds_elapsed", "z", "y", "x"};
    return std::ranges::find(kNames, column.written) != kNames.end();
  };
  if (columns.size() != 5 || !std::ranges::all_of(columns, is_of_log)) return;
  const auto sensor = MeaningOfPhoneFile(file);
  for (TableColumn& column : columns) {
    if (column.written == "time") column.meaning.clear();
    if (column.written == "seconds_elapsed") column.meaning = "time_s";
    if (column.written.size() > 1 || !sensor) continue;
    column.meaning = sensor->empty() ? "" : column.written + " " + std::string(*sensor);
  }
}

}  // namespace pendulum::csv
