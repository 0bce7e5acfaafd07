// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/readers/read_recording.h"

/// Small files for tests of the reader, and the expected results.
namespace pendulum {

inline constexpr double kDegree = 0.017453292519943295;  // rad, NIST SP 811, table 6

/// Eight rows; `{t}` is replaced by 0, 10, ..., 70 and `{v}` by 100, 101, ..., 107.
inline std::string Rows(const std::string& pattern, int count = 8) {
  std::string rows;
  for (int i = 0; i < count; ++i) {
    std::string row = pattern + "\n";
    for (const auto& [mark, number] : {std::pair{"{t}", 10 * i}, {"{v}", 100 + i}}) {
      for (std::size_t at = 0; (at = row.find(mark)) != std::string::npos;) row.replace(at, 3, std::to_string(number));
    }
    rows += row;
  }
  return rows;
}

inline Recording RecordingOf(const std::string& text, const ReadOptions& options = {}) {
  const Result<Recording> recording = ParseRecording(text, "run.csv", options);
  EXPECT_TRUE(recording.has_value()) << text << (recording ? "" : recording.error().message());
  return recording.value_or(Recording());
}

/// Expects the times 0, 0.01, ..., 0.07 s and the values 100, 101, ..., 107 times `unit`.
inline void ExpectTheRows(const Recording& recording, double unit = 1) {
  ASSERT_EQ(recording.size(), 8);
  for (int i = 0; i < 8; ++i) {
    EXPECT_DOUBLE_EQ(recording.time[i], i / 100.0);
    EXPECT_DOUBLE_EQ(recording.value[i], (100 + i) * unit);
  }
}

inline std::string FaultOf(const std::string& text, const ReadOptions& options = {},
                           StatusCode code = StatusCode::kDataLoss) {
  const Result<Recording> recording = ParseRecording(text, "run.csv", options);
  EXPECT_FALSE(recording.has_value()) << text;
  if (recording) return "";
  EXPECT_EQ(recording.error().code, code) << recording.error().message();
  return recording.error().message();
}

inline std::string WrongFlag(const std::string& text, const ReadOptions& options) {
  return FaultOf(text, options, StatusCode::kInvalidArgument);
}

inline ReadOptions TimeAndValue(const std::string& time, const std::string& value, const std::string& unit = "") {
  ReadOptions options;
  options.time_column = time;
  options.value_column = value;
  options.unit = unit;
  return options;
}

inline ReadOptions Unit(const std::string& unit, double sample_rate_hz = 0) {
  ReadOptions options;
  options.unit = unit;
  options.sample_rate_hz = sample_rate_hz;
  return options;
}

}  // namespace pendulum
