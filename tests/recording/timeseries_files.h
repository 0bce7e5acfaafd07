// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/recording/mat_objects.h"

/// Objects of class timeseries for tests. They have the properties that MATLAB saves from R2010b on, including those of
/// tsdata.timemetadata and tsdata.datametadata.
namespace pendulum::objects {

/// Eight samples. The times 0, 0.01, ..., 0.07 s are uniform unless `times` lists them.
struct Series {
  std::vector<std::size_t> sizes = {8, 1};
  std::vector<double> data = {100, 101, 102, 103, 104, 105, 106, 107};
  std::vector<double> times;
  double start = 0, increment = 0.01, length = 8;
  std::string time_unit, data_unit, name;  // Empty: default.
  bool is_unit_emptied = false;            // The unit of time is stored as an empty text.
  Array storage = Nothing();
};

/// The classes that a timeseries needs in a file.
struct Classes {
  explicit Classes(File& file)
      : time(file.AddClass("tsdata", "timemetadata",
                           {{"Units", Letters("seconds")}, {"Start_", Number(0)}, {"Time_", Nothing()}})),
        data(file.AddClass("tsdata", "datametadata", {{"Units", Letters("")}})),
        series(
            file.AddClass("", "timeseries", {{"Name", Letters("")}, {"Storage_", Nothing()}, {"Time_", Nothing()}})) {}

  std::size_t time, data, series;
};

/// Returns the number of the object.
inline std::size_t AddSeries(File& file, const Classes& classes, const Series& series) {
  const bool is_listed = !series.times.empty();
  Fields time = {{"Length", Number(series.length)}, {"Format", Letters("")}};
  if (is_listed) time.emplace_back("Time_", Numbers({series.times.size(), 1}, series.times));
  if (!is_listed && series.start != 0) time.emplace_back("Start_", Number(series.start));
  time.emplace_back("Increment_", is_listed ? Nothing() : Number(series.increment));
  if (!series.time_unit.empty() || series.is_unit_emptied) time.emplace_back("Units", Letters(series.time_unit));
  Fields data;
  if (!series.data_unit.empty()) data.emplace_back("Units", Letters(series.data_unit));
  const std::size_t time_info = file.AddObject(classes.time, time), data_info = file.AddObject(classes.data, data);
  Fields all = {{"Events", Cells({})},
                {"DataInfo", file.Reference({data_info})},
                {"TimeInfo", file.Reference({time_info})},
                {"Data_", Numbers(series.sizes, series.data)},
                {"Version", Number(10.1)}};
  if (!series.name.empty()) all.emplace_back("Name", Letters(series.name));
  if (series.storage.kind != "double" || !series.storage.numbers.empty()) all.emplace_back("Storage_", series.storage);
  return file.AddObject(classes.series, all, false, {{"TreatNaNasMissing", 1}, {"BeingBuilt", 0}});
}

/// A file with one timeseries in a variable.
inline File FileOf(const Series& series, const std::string& variable = "ts", int version = 4) {
  File file(version);
  const Classes classes(file);
  file.AddVariable(variable, file.Reference({AddSeries(file, classes, series)}, true));
  return file;
}

}  // namespace pendulum::objects
