// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "pendulum/recording/readers/read_recording.h"
#include "tests/fuzz/require.h"

/// Any bytes give a recording that satisfies its invariant, or an error sentence.
namespace pendulum {

inline Calibration CountsToDegrees() {
  Calibration calibration;
  calibration.input = "counts";
  calibration.angle_unit = "deg";
  calibration.coefficients = {-49.6077, 0.1985};
  calibration.input_range = SensorRange{0, 1023};
  return calibration;
}

/// Options that a user may give with the file; `choice`, the last byte of the input, selects them.
inline ReadOptions Options(std::uint8_t choice) {
  const std::array<ReadOptions, 8> options = {
      ReadOptions(),
      ReadOptions{"", "", "deg", 100, {}, 0.5, {}, 0, {}},
      ReadOptions{"1", "2", "counts", 0, CountsToDegrees(), {}, {}, 4, AveragingWindow{-0.001, 0.001}},
      ReadOptions{"1:ms", "", "rad", 0, {}, 0.0, SensorRange{-1, 1}, 1, {}},
      ReadOptions{"none", "", "", 50, {}, {}, {}, 0, {}},
      ReadOptions{"", "2", "", 0, CountsToDegrees(), 1.0, SensorRange{0, 1023}, 16, {}},
      ReadOptions{"time_s", "angle_deg", "", 0, {}, {}, {}, 0, {}},
      ReadOptions{"", "1", "volts", 0, {}, {}, SensorRange{0, 5}, 0, {}},
  };
  return options.at(choice % options.size());
}

inline void CheckResult(const Result<Recording>& recording) {
  if (recording) {
    Require(MakeRecording(*recording).has_value());
    Require(recording->sha256.size() == 64 && recording->resolution >= 0);
    Require(!recording->range || recording->range->low < recording->range->high);
  } else {
    Require(recording.error().code != StatusCode::kNotFound && recording.error().code != StatusCode::kInternal);
    RequireSentence(recording.error().message(), "a.csv");
  }
}

inline void CheckRecording(std::string_view text) {
  CheckResult(ParseRecording(text, "a.csv", Options(text.empty() ? 0 : text.back())));
}

}  // namespace pendulum
