// SPDX-License-Identifier: Apache-2.0
#include "pendulum/trajectory/encoder.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"

namespace pendulum::encoder_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;

/// 0.3 cos 5t rad without friction, with counts of 10 mrad.
SyntheticOptions Undamped() {
  SyntheticOptions options;
  options.model = {"linear", "viscous", Gravity::kLinear};
  options.parameters = {0.04, 0.0};
  options.start = StartKind::kMoving;
  options.initial_angle = 0.3;
  options.duration = 4;
  options.resolution = 0.01;
  options.rows = RowTiming::kEvents;
  return options;
}

Recording Simulated(const SyntheticOptions& options) {
  const Result<Recording> recording = SimulateRecording(options);
  EXPECT_TRUE(recording) << recording.error().message();
  return *recording;
}

TEST(SimulateRecording, HasEventsWhereTheCosineCrossesEdges) {
  const Recording recording = Simulated(Undamped());
  // The count goes from 30 to -30 or back in each of six half periods of π/5 s, then from 30 down to 13.6, which is
  // 0.3 cos 19.95 rad.
  EXPECT_EQ(recording.size(), 1 + 6 * 60 + 16);
  for (Eigen::Index i = 1; i < recording.size(); ++i) {
    const double step = recording.value[i] - recording.value[i - 1];
    EXPECT_THAT(std::abs(step), DoubleNear(0.01, 1e-12));
    const double edge = recording.value[i] - 0.5 * step;
    EXPECT_THAT(0.3 * std::cos(5 * recording.time[i]), DoubleNear(edge, 1e-9)) << recording.time[i];
  }
}

TEST(SimulateRecording, ScattersEdgesAndStampsAsGiven) {
  SyntheticOptions options = Undamped();
  options.duration = 60;
  options.noise = 5e-4;
  double edges = 0;
  Recording recording = Simulated(options);
  const auto deviation = [&](Eigen::Index i) {
    const double edge = 0.5 * (recording.value[i] + recording.value[i - 1]);
    return 0.3 * std::cos(5 * recording.time[i]) - edge;
  };
  for (Eigen::Index i = 1; i < recording.size(); ++i) edges += std::pow(deviation(i), 2);
  const auto count = static_cast<double>(recording.size() - 1);
  // The relative standard error of a standard deviation from n draws is 1/sqrt(2 n); the limit is five of these.
  EXPECT_THAT(std::sqrt(edges / count) / 5e-4, DoubleNear(1, 5 / std::sqrt(2 * count)));

  options.noise = 0;
  options.time_noise = 1e-4;
  recording = Simulated(options);
  double stamps = 0;
  for (Eigen::Index i = 1; i < recording.size(); ++i) {
    const double rate = 1.5 * std::sin(5 * recording.time[i]);
    if (std::abs(rate) > 0.5) stamps += std::pow(deviation(i) / rate, 2) / count;
  }
  EXPECT_GT(std::sqrt(stamps), 0.8e-4);
  EXPECT_LT(std::sqrt(stamps), 1.0e-4);
}

TEST(SimulateRecording, SamplesTheSameEncoderAtEqualIntervals) {
  SyntheticOptions options = Undamped();
  options.noise = 5e-4;
  options.sample_rate = 1000;
  const Recording events = Simulated(options);
  options.rows = RowTiming::kEvenFromEncoder;
  const Recording even = Simulated(options);
  ASSERT_EQ(even.size(), 4000);
  Eigen::Index event = 0;
  for (Eigen::Index i = 0; i < even.size(); ++i) {
    while (event + 1 < events.size() && events.time[event + 1] <= even.time[i]) ++event;
    EXPECT_EQ(even.value[i], events.value[event]) << even.time[i];
  }
}

TEST(SimulateRecording, RefusesEventsWithoutAnEncoder) {
  const auto refused = [](void (*change)(SyntheticOptions&)) {
    SyntheticOptions options = Undamped();
    change(options);
    const Result<Recording> recording = SimulateRecording(options);
    EXPECT_FALSE(recording);
    return recording ? std::string() : recording.error().message();
  };
  EXPECT_EQ(refused([](SyntheticOptions& o) { o.resolution = 0; }),
            "resolution is 0; it must be at least 1e-05 rad where rows are events");
  EXPECT_EQ(refused([](SyntheticOptions& o) { o.noise = 0.005; }),
            "noise is 0.005; it must be at most a fifth of the resolution where rows are events");
  EXPECT_THAT(refused([](SyntheticOptions& o) { o.jitter = 0.001; }), HasSubstr("rows of events come from an encoder"));
  EXPECT_EQ(refused([](SyntheticOptions& o) {
              o.rows = RowTiming::kEven;
              o.time_noise = 0.001;
            }),
            "time_noise is 0.001; it must be 0 unless rows are events");
}

}  // namespace
}  // namespace pendulum::encoder_test
