// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/clock_change.h"

#include <cmath>
#include <cstdint>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"

namespace pendulum::clock_change_test {
namespace {

using testing::HasSubstr;

/// Held for 2 s, then free: 20 s at 100 Hz.
Recording Recorded(std::uint64_t seed) {
  SyntheticOptions options = NoisyRun("coulomb", seed);
  options.duration = 20;
  return Must(SimulateRecording(options));
}

/// From sample `row` on, the clock is faster by `factor`.
Recording WithFasterClock(Recording recording, Eigen::Index row, double factor) {
  const double change = recording.time[row];
  for (Eigen::Index i = row; i < recording.size(); ++i) {
    recording.time[i] = change + factor * (recording.time[i] - change);
  }
  return recording;
}

/// From sample `row` on, every second sample is left out: the sampling is slower, and the clock is right.
Recording WithSlowerSampling(const Recording& recording, Eigen::Index row) {
  Recording slower = recording;
  Eigen::Index count = row;
  for (Eigen::Index i = row; i < recording.size(); i += 2, ++count) {
    slower.time[count] = recording.time[i];
    slower.value[count] = recording.value[i];
  }
  slower.time.conservativeResize(count);
  slower.value.conservativeResize(count);
  return slower;
}

TEST(CheckClock, RefusesAClockThatChangesItsRate) {
  for (const double factor : {1e-3, 0.5, 0.9, 0.97, 1.03, 1.1, 2.0, 1e3}) {
    for (const Eigen::Index row : {450, 1000, 1700}) {
      if (row != 1000 && std::abs(factor - 1) < 0.05) continue;  // too small for the few half swings beside it
      const Result<void> checked = CheckClock(WithFasterClock(Recorded(1), row, factor));
      ASSERT_FALSE(checked) << factor << ", " << row;
      EXPECT_EQ(checked.error().code, StatusCode::kDataLoss);
      EXPECT_THAT(checked.error().message, HasSubstr("a swing takes as many rows as before: the clock changed"));
    }
  }
  EXPECT_THAT(CheckClock(WithFasterClock(Recorded(1), 1000, 1.1)).error().message,
              testing::AllOf(testing::StartsWith("the times change their rate at 10 s, from 10 ms to 11 ms"),
                             testing::EndsWith("with --to 10 or --from 10")));
}

TEST(CheckClock, AcceptsSamplingThatChangesItsRate) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Recording recording = Recorded(seed);
    for (const Eigen::Index row : {450, 1000, 1700}) {
      const Result<void> checked = CheckClock(WithSlowerSampling(recording, row));
      EXPECT_TRUE(checked.has_value()) << checked.error().message;
    }
  }
}

/// As of a log with gaps, of a jittering host and of one that rounds to whole milliseconds.
TEST(CheckClock, AcceptsUnevenTimes) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Recording uneven = Recorded(seed);
    for (Eigen::Index i = 0; i < uneven.size(); ++i) {
      uneven.time[i] += 0.004 * std::sin(0.7 * static_cast<double>(i * i));
      uneven.time[i] += i > 700 ? 1.3 : 0;
      uneven.time[i] = 1e-3 * std::round(1e3 * uneven.time[i]);
    }
    const Result<void> checked = CheckClock(uneven);
    EXPECT_TRUE(checked.has_value()) << checked.error().message;
  }
}

}  // namespace
}  // namespace pendulum::clock_change_test
