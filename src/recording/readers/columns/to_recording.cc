// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/to_recording.h"

#include <cmath>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/recording/sensor_statement.h"
#include "recording/readers/columns/to_angle.h"
#include "recording/time_grid.h"

namespace pendulum::csv {
namespace {

double RateOf(const ReadColumns& columns, const ReadOptions& options) {
  return options.sample_rate_hz > 0 ? options.sample_rate_hz : columns.metadata.sample_rate_hz;
}

/// `columns`: before the times are changed.
TimeSource TimeSourceOf(const ReadColumns& columns) {
  if (columns.metadata.Has("clock_scale") || columns.metadata.Has("clock_scale_std_dev")) return TimeSource::kMeasured;
  const Layout& layout = columns.layout;
  if (!layout.time) return columns.is_host_time ? TimeSource::kComputer : TimeSource::kRate;
  if (layout.is_clock || layout.is_from_first) return TimeSource::kComputer;
  if (AreOnGrid(columns.samples.time)) return TimeSource::kGrid;
  const bool is_counter = layout.time->unit->suffix == "ms" || layout.time->unit->suffix == "us";
  return is_counter ? TimeSource::kDevice : TimeSource::kSeconds;
}

void WarnOfClock(ReadColumns& columns, const ReadOptions& options) {
  const auto warn = [&](Warning warning) {
    warning.about.file = columns.samples.name;
    columns.samples.warnings.push_back(std::move(warning));
  };
  const Layout& layout = columns.layout;
  const std::string& lost = columns.metadata.lost_samples;
  if (columns.is_host_time) {
    warn({.code = "host_time",
          .finding = "the times are those at which the host received each line",
          .advice = "if there is a column of the device's own times, name it with --time_column",
          .flags = {"time_column"},
          .assumed = "times of arrival at the computer (--time_column)"});
  }
  if (!layout.time && RateOf(columns, options) > 0 && lost.find_first_of("123456789") != std::string::npos) {
    warn({.code = "lost_samples",
          .finding = "the file says that " + lost +
                     " samples were lost, so times computed from the sample rate are too early after each loss"});
  }
}

void WarnOfSensor(ReadColumns& columns) {
  const std::string& unknown = columns.metadata.unknown_sensor;
  if (unknown.empty() || columns.metadata.sensor) return;
  columns.samples.warnings.push_back(
      {.code = "sensor_unknown",
       .finding =
           "the line # sensor: " + unknown + " names no kind of sensor, so its errors are assumed from the readings",
       .explanation = "a kind is one of " + NameList(SensorKinds()),
       .about = {.file = columns.samples.name}});
}

/// Converts times to seconds and repairs the clock.
Result<void> SetTimes(ReadColumns& columns, const ReadOptions& options) {
  const Layout& layout = columns.layout;
  RawSamples& samples = columns.samples;
  if (!layout.time && RateOf(columns, options) > 0) {
    for (Eigen::Index i = 0; i < samples.time.size(); ++i) {
      samples.time[i] = static_cast<double>(i) / RateOf(columns, options);
    }
    return {};
  }
  const Unit& unit = layout.time ? *layout.time->unit : *UnitOfSuffix("s");
  if (layout.is_from_first) samples.time.array() -= double{samples.time[0]};
  const bool is_usual = unit.suffix == "s" || unit.suffix == "ms" || unit.suffix == "us";
  if (!is_usual) {  // RepairClock knows s, ms and us.
    for (double& time : samples.time) time = unit.ToSi(time);
    samples.time_unit = "s";
  }
  ASSIGN_OR_RETURN(RawSamples repaired, RepairClock(std::move(samples), options.window));
  samples = std::move(repaired);
  if (is_usual && unit.divisor != 1) {
    for (double& time : samples.time) time = unit.ToSi(time);
  }
  return {};
}

/// Moves the time stamps to the middle of the averaging window, for which the rows stand to first order.
void MoveToMiddle(Recording& recording) {
  auto& window = recording.oversampling.window;
  if (!window) return;
  const double middle = window->middle();
  if (middle != 0) recording.time.array() += middle;
  *window = {window->from - middle, window->to - middle};
}

}  // namespace

Warning EmptyCells(const std::string& file, std::size_t rows, const std::string& column) {
  const std::string count = rows == 1 ? "1 row was" : std::to_string(rows) + " rows were";
  return {.code = "empty_cells",
          .finding = count + " left out, with no number in column " + column + " or in its time",
          .about = {.file = file}};
}

Result<Recording> ToRecording(ReadColumns columns, const ReadOptions& options) {
  WarnOfClock(columns, options);
  WarnOfSensor(columns);
  const TimeSource time_source = TimeSourceOf(columns);
  RETURN_IF_ERROR(SetTimes(columns, options));
  RawSamples& samples = columns.samples;
  const Metadata& metadata = columns.metadata;
  Recording recording;
  recording.path = samples.name;
  recording.time = std::move(samples.time);
  recording.value = std::move(samples.value);
  recording.warnings = std::move(samples.warnings);
  recording.clock_scale = metadata.clock_scale;
  recording.clock_scale_std_dev =
      std::hypot(metadata.clock_scale_std_dev, metadata.clock_scale * samples.clock_std_dev);
  recording.rig_json = metadata.rig_json;
  recording.time_source = time_source;
  recording.stated_sensor = metadata.sensor;
  SetValues(columns.layout, options, metadata, recording);
  MoveToMiddle(recording);
  recording.is_unit_assumed = columns.layout.is_unit_assumed;
  if (columns.layout.second) {
    RETURN_IF_ERROR(TurnIntoAngles(*columns.layout.second, samples.second, recording));
  }
  recording.sha256 = std::move(columns.sha256);
  return MakeRecording(std::move(recording));
}

}  // namespace pendulum::csv
