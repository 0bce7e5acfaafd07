// SPDX-License-Identifier: Apache-2.0
#include "pendulum/acquisition/device_clock.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::device_clock_test {
namespace {

using Random = std::mt19937_64;
using Delay = std::function<double(Random&)>;  // s, at least 0

constexpr double kTrueScale = 0.997009;  // a resonator that is 3000 ppm too fast
constexpr double kFrames = 25;           // per second

double Exponential(Random& random, double mean) { return std::exponential_distribution<double>(1 / mean)(random); }

double Uniform(Random& random, double most) { return std::uniform_real_distribution<double>(0, most)(random); }

/// A program that waits for bytes and wakes up within some hundred microseconds.
double Wakeup(Random& random) { return 50e-6 + Exponential(random, 200e-6); }

/// USB polls every millisecond, and a latency timer adds up to 16 ms (FTDI's default).
double UsbBridge(Random& random) { return 1e-3 + Uniform(random, 16e-3); }

/// A busy computer: a tenth of the frames wait for tens of milliseconds.
double Busy(Random& random) { return Wakeup(random) + (Uniform(random, 1) < 0.1 ? Exponential(random, 40e-3) : 0); }

std::vector<Arrival> Arrivals(double seconds, const Delay& delay, Random& random) {
  std::vector<Arrival> arrivals;
  double latest = 0;
  for (double device = 0; device < seconds; device += 1 / kFrames) {
    latest = std::max(latest, 1000 + kTrueScale * device + delay(random));  // frames stay in order
    arrivals.push_back({device, latest});
  }
  return arrivals;
}

/// Over many runs: the share of runs whose scale is within 1.96 standard errors of the truth, and the rms of scale
/// error / standard error.
struct Coverage {
  double share = 0, rms = 0;
};

Coverage CoverageOf(double seconds, const Delay& delay) {
  constexpr int kRuns = 200;
  Coverage coverage;
  for (int i = 0; i < kRuns; ++i) {
    Random random(static_cast<std::uint64_t>(i) + 1);
    const DeviceClock clock = FitDeviceClock(Arrivals(seconds, delay, random), 0, 0);
    const double z = (clock.scale - kTrueScale) / clock.std_dev;
    coverage.share += std::abs(z) < 1.96 ? 1.0 / kRuns : 0;
    coverage.rms += z * z / kRuns;
  }
  coverage.rms = std::sqrt(coverage.rms);
  return coverage;
}

TEST(FitDeviceClock, IsExactWithoutDelays) {
  Random random(1);
  const std::vector<Arrival> arrivals = Arrivals(
      60, [](Random&) { return 0.004; }, random);
  const DeviceClock clock = FitDeviceClock(arrivals, 0, 1e-6);
  EXPECT_TRUE(clock.is_measured);
  EXPECT_NEAR(clock.scale, kTrueScale, 1e-10);
  EXPECT_NEAR(clock.std_dev, 1e-6, 1e-8);  // the host's standard deviation
}

/// The stated error agrees with the true one, over two hundred seeded runs for each kind of delay.
TEST(FitDeviceClock, HasTheRightError) {
  const std::vector<std::pair<std::string, Delay>> delays = {{"wakeup", Wakeup}, {"usb", UsbBridge}, {"busy", Busy}};
  for (const auto& [name, delay] : delays) {
    for (const double seconds : {20.0, 60.0, 600.0}) {
      const Coverage coverage = CoverageOf(seconds, delay);
      // Student's t with some 20 degrees of freedom has 94 % within 1.96; the binomial standard deviation of 200 runs
      // is 1.7 %.
      EXPECT_GT(coverage.share, 0.91) << name << ' ' << seconds;
      EXPECT_LT(coverage.rms, 1.3) << name << ' ' << seconds;
      EXPECT_GT(coverage.rms, 0.6) << name << ' ' << seconds;
    }
  }
}

/// USB polls on a grid of the host's clock. If the run is too short for the frames to drift across the grid, the fitted
/// clock has a systematic error.
TEST(FitDeviceClock, HasTheRightErrorOnAGrid) {
  constexpr int kRuns = 200;
  for (const double seconds : {10.0, 30.0, 60.0}) {
    int covered = 0;
    for (int i = 0; i < kRuns; ++i) {
      Random random(static_cast<std::uint64_t>(i) + 1);
      const double scale = 1 + std::normal_distribution<double>(0, 500e-6)(random),
                   phase = Uniform(random, kUsbPolling);
      std::vector<Arrival> arrivals;
      for (double device = 0; device < seconds; device += 1 / kFrames) {
        const double grid = std::ceil((scale * device + phase) / kUsbPolling) * kUsbPolling;
        arrivals.push_back({device, 1000 + grid});
      }
      const DeviceClock clock = FitDeviceClock(arrivals, kUsbPolling, 0);
      covered += std::abs(clock.scale - scale) < 1.96 * clock.std_dev ? 1 : 0;
    }
    EXPECT_GT(covered, 0.93 * kRuns) << seconds;
  }
}

/// In the second half of the minute all arrivals are some milliseconds late: the host's clock jumped ahead, or a USB
/// bridge became slower.
TEST(FitDeviceClock, HasALargerErrorAfterAStep) {
  for (const double step : {1e-3, 5e-3, 20e-3}) {
    Random random(7);
    std::vector<Arrival> arrivals = Arrivals(60, Wakeup, random);
    for (Arrival& each : arrivals) each.host_time += each.device_time > 30 ? step : 0;
    const DeviceClock clock = FitDeviceClock(arrivals, kUsbPolling, 0);
    EXPECT_LT(std::abs(clock.scale - kTrueScale), 4 * clock.std_dev) << step;
  }
}

TEST(FitDeviceClock, IsBetterThanALineThroughAllArrivals) {
  Random random(3);
  const std::vector<Arrival> arrivals = Arrivals(60, UsbBridge, random);
  const DeviceClock clock = FitDeviceClock(arrivals, 0, 0);
  // Least squares through N delays of standard deviation 16 ms / √12 has the error σ √12 / (T √N).
  const double straight = 16e-3 / (60 * std::sqrt(60 * kFrames));
  EXPECT_LT(clock.std_dev, straight / 2);
}

/// The port is not read for four seconds, so all frames of more than one part of the run are late.
TEST(FitDeviceClock, IgnoresAStall) {
  Random random(4);
  std::vector<Arrival> arrivals = Arrivals(60, Wakeup, random);
  for (Arrival& each : arrivals) {
    if (each.device_time > 20 && each.device_time < 24)
      each.host_time = std::max(each.host_time, 1000 + 24 * kTrueScale);
  }
  const DeviceClock clock = FitDeviceClock(arrivals, 0, 0);
  EXPECT_LT(std::abs(clock.scale - kTrueScale), 4 * clock.std_dev);
  EXPECT_LT(clock.std_dev, 5e-6);
}

TEST(FitDeviceClock, MeasuresNothingFromShortOrJitteredArrivals) {
  Random random(5);
  for (const double seconds : {0.0, 1.0, 4.0}) {
    const DeviceClock clock = FitDeviceClock(Arrivals(seconds, Wakeup, random), 0, 0);
    EXPECT_FALSE(clock.is_measured);
    EXPECT_EQ(clock.scale, 1);
    EXPECT_EQ(clock.std_dev, kResonatorStdDev);
  }
  // Half a second of jitter gives less certainty than the resonator's specification.
  const Delay jitter = [](Random& any) { return Uniform(any, 0.5); };
  EXPECT_FALSE(FitDeviceClock(Arrivals(6, jitter, random), 0, 0).is_measured);
}

TEST(FitDeviceClock, RefusesAnImplausibleClock) {
  Random random(6);
  std::vector<Arrival> arrivals = Arrivals(60, Wakeup, random);
  for (Arrival& each : arrivals) each.host_time /= 20;  // as if replayed twenty times as fast
  const DeviceClock clock = FitDeviceClock(arrivals, 0, 0);
  EXPECT_TRUE(clock.is_implausible);
  EXPECT_FALSE(clock.is_measured);
  EXPECT_EQ(clock.scale, 1);
}

TEST(FitDeviceClock, AcceptsArrivalsAtOneInstant) {
  std::vector<Arrival> arrivals;
  for (int i = 0; i < 1000; ++i) arrivals.push_back({0.04 * i, 5.0});  // all read at the same time at the end
  EXPECT_FALSE(FitDeviceClock(arrivals, 0, 0).is_measured);
}

TEST(HostClockStdDev, IsAtMostTheStandardDeviationOfAQuartzClock) {
  EXPECT_GT(HostClockStdDev(), 0);
  EXPECT_LE(HostClockStdDev(), 30e-6);
}

}  // namespace
}  // namespace pendulum::device_clock_test
