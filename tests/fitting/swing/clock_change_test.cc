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
      const auto checked = CheckClock(WithFasterClock(Recorded(1), row, factor));
      ASSERT_FALSE(checked) << factor << ", " << row;
      EXPECT_EQ(checked.error().code, StatusCode::kDataLoss);
      EXPECT_THAT(checked.error().message(), HasSubstr("a swing takes as many rows as before: the clock changed"));
    }
  }
  EXPECT_THAT(CheckClock(WithFasterClock(Recorded(1), 1000, 1.1)).error().message(),
              testing::AllOf(testing::StartsWith("the times change their rate at 10 s, from 10 ms to 11 ms"),
                             testing::EndsWith("with --to 10 or --from 10")));
}

TEST(CheckClock, ReturnsAChangeWithinTheHold) {
  for (const double factor : {0.97, 1.03, 2.0}) {
    for (const Eigen::Index row : {25, 150}) {
      const auto checked = CheckClock(WithFasterClock(Recorded(1), row, factor));
      ASSERT_TRUE(checked) << checked.error().message();
      ASSERT_TRUE(*checked) << factor;
      EXPECT_DOUBLE_EQ((*checked)->time, 0.01 * static_cast<double>(row));
      EXPECT_NEAR((*checked)->before, 0.01, 1e-9);
      EXPECT_NEAR((*checked)->after, 0.01 * factor, 1e-9);
    }
  }
  Recording rounded = WithFasterClock(Recorded(1), 150, 0.97);  // steps of 9 and 10 ms
  for (double& time : rounded.time) time = std::floor(1e3 * time) / 1e3;
  const auto checked = CheckClock(rounded);
  ASSERT_TRUE(checked && *checked);
  EXPECT_NEAR((*checked)->time, 1.5, 0.1);
  EXPECT_NEAR((*checked)->after, 0.0097, 2e-6);
  EXPECT_THAT(MessageText((StepChange{1, 0.01, 0.02}).ToWarning()),
              testing::AllOf(testing::StartsWith("the times change their rate at 1 s, from 10 ms to 20 ms between"),
                             testing::EndsWith("with --to 1 or --from 1")));
}

TEST(CheckClock, AcceptsSamplingThatChangesItsRate) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Recording recording = Recorded(seed);
    for (const Eigen::Index row : {450, 1000, 1700}) {
      const auto checked = CheckClock(WithSlowerSampling(recording, row));
      ASSERT_TRUE(checked) << checked.error().message();
      EXPECT_FALSE(*checked) << row;
    }
  }
}

/// The sampling becomes slower by `factor`: the readings between the samples, which lie on a parabola.
Recording Resampled(const Recording& recording, Eigen::Index row, double factor) {
  Recording slower = recording;
  Eigen::Index count = row;
  for (double at = static_cast<double>(row); at < static_cast<double>(recording.size() - 2); at += factor, ++count) {
    const auto i = static_cast<Eigen::Index>(at);
    const double w = at - static_cast<double>(i);
    slower.time[count] = recording.time[i] + w * (recording.time[i + 1] - recording.time[i]);
    const double a = recording.value[i - 1], b = recording.value[i], c = recording.value[i + 1];
    slower.value[count] = b + 0.5 * w * (c - a) + 0.5 * w * w * (a - 2 * b + c);
  }
  slower.time.conservativeResize(count);
  slower.value.conservativeResize(count);
  return slower;
}

/// A torsion pendulum's period does not depend on the amplitude, here 0.8 to 0.4 rad.
TEST(CheckClock, KnowsTorsionPendulums) {
  Recording torsion;
  torsion.time = Eigen::VectorXd::LinSpaced(2300, 0, 22.99);
  torsion.value = torsion.time.unaryExpr([](double t) { return 0.8 * std::exp(-0.03 * t) * std::cos(5 * t); });
  for (const bool is_spring : {false, true}) {
    for (const double factor : {1.01, 1.015, 1.02, 1.1}) {
      const auto checked = CheckClock(Resampled(torsion, 1000, factor), is_spring);
      EXPECT_TRUE(checked.has_value()) << factor << ", " << checked.error().message();
    }
  }
  EXPECT_FALSE(CheckClock(WithFasterClock(torsion, 1000, 1.1), true).has_value());
}

/// As of a log with gaps, of a jittering host and of one that rounds to whole milliseconds.
Recording Uneven(Recording recording, Eigen::Index from, double jitter) {
  for (Eigen::Index i = from; i < recording.size(); ++i) {
    recording.time[i] += jitter * std::sin(0.7 * static_cast<double>(i * i));
    recording.time[i] += i > 700 ? 1.3 : 0;
    recording.time[i] = 1e-3 * std::round(1e3 * recording.time[i]);
  }
  return recording;
}

/// From sample `row` on, packets of four rows arrive together, and a hundredth of the rows is lost.
Recording InPackets(const Recording& recording, Eigen::Index row) {
  Recording packets = recording;
  Eigen::Index count = row;
  for (Eigen::Index i = row; i < recording.size(); ++i) {
    if (i % 100 == 37) continue;
    packets.time[count] =
        recording.time[std::min(i / 4 * 4 + 3, recording.size() - 1)] + 1e-4 * static_cast<double>(i % 4);
    packets.value[count++] = recording.value[i];
  }
  packets.time.conservativeResize(count);
  packets.value.conservativeResize(count);
  return packets;
}

TEST(CheckClock, AcceptsTimesThatAreOrBecomeUneven) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Recording run = Recorded(seed);
    for (const Recording& uneven : {Uneven(run, 0, 0.004), Uneven(run, 1000, 0.004), InPackets(run, 1000)}) {
      const auto checked = CheckClock(uneven);
      EXPECT_TRUE(checked.has_value()) << seed << ", " << checked.error().message();
    }
  }
}

TEST(CheckClock, GivesTimesThatDistinguishSamples) {
  Recording recording = WithFasterClock(Recorded(1), 1000, 1.1);
  recording.time.array() += 1700000000;
  EXPECT_THAT(CheckClock(recording).error().message(), testing::EndsWith("with --to 1700000010 or --from 1700000010"));
}

}  // namespace
}  // namespace pendulum::clock_change_test
