// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/start/scan_starts.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"

namespace pendulum::scan_starts_test {
namespace {

constexpr double kFrequency = 4.8;  // rad/s; 12.5 readings/s are 16 in a period
constexpr FrequencyRange kRange = {3, 8};

/// A linear oscillation of the readings with this frequency.
Recording Oscillating(Quantity quantity, const std::string& unit) {
  Recording recording;
  recording.time = Eigen::VectorXd::LinSpaced(100, 0, 8);
  recording.value = 0.3 * (-0.1 * recording.time.array()).exp() * (kFrequency * recording.time.array() - 0.9).cos();
  recording.quantity = quantity;
  recording.unit = unit;
  return Must(MakeRecording(recording));
}

/// The natural frequencies of the starts: sqrt(G/I), with G = 1.
std::vector<double> FrequenciesOf(const std::vector<StartValues>& starts) {
  std::vector<double> frequencies;
  for (const StartValues& start : starts) frequencies.push_back(1 / std::sqrt(start.parameters.at(0)));
  return frequencies;
}

TEST(ScanStarts, FindsTheFrequencyOfEachSensor) {
  const MotionModel model = Must(FindMotionModel("linear"));
  for (const auto& [quantity, unit] : {std::pair{Quantity::kAngle, "rad"},
                                       {Quantity::kRate, "rad/s"},
                                       {Quantity::kAngle, "volts"},
                                       {Quantity::kRate, "volts"},
                                       {Quantity::kPosition, "px"}}) {
    const auto starts = Must(ScanStarts(Oscillating(quantity, unit), model, kRange, FitOptions{}));
    ASSERT_FALSE(starts.empty()) << unit;
    EXPECT_THAT(FrequenciesOf(starts), testing::Contains(testing::DoubleNear(kFrequency, 0.1))) << unit;
  }
}

TEST(ScanStarts, GivesNoneAfterAStopRequest) {
  std::stop_source source;
  source.request_stop();
  FitOptions options;
  options.stop = source.get_token();
  const MotionModel model = Must(FindMotionModel("linear"));
  EXPECT_THAT(Must(ScanStarts(Oscillating(Quantity::kAngle, "rad"), model, kRange, options)), testing::IsEmpty());
}

}  // namespace
}  // namespace pendulum::scan_starts_test
