// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/clock.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::clock_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Rows with these stamps, starting on line 2. Each value is its row number unless values are given.
RawSamples Rows(const std::vector<double>& time, const std::string& unit = "s", std::vector<double> value = {}) {
  RawSamples samples;
  samples.name = "run.csv";
  samples.time_unit = unit;
  const auto size = static_cast<Eigen::Index>(time.size());
  samples.time = Eigen::Map<const Eigen::VectorXd>(time.data(), size);
  samples.value = Eigen::VectorXd::LinSpaced(size, 0, static_cast<double>(size - 1));
  if (!value.empty()) samples.value = Eigen::Map<const Eigen::VectorXd>(value.data(), size);
  for (Eigen::Index i = 0; i < size; ++i) samples.lines.Add(i + 2);
  return samples;
}

std::vector<double> Stamps(int count, const std::function<double(int)>& stamp) {
  std::vector<double> time;
  for (int i = 0; i < count; ++i) time.push_back(stamp(i));
  return time;
}

/// i-th stamp at 100 Hz, with the digits a file would have.
double Hundredth(int i) { return i / 100.0; }

RawSamples Repaired(const RawSamples& samples) {
  const Result<RawSamples> repaired = RepairClock(samples);
  EXPECT_TRUE(repaired.has_value()) << (repaired ? "" : repaired.error().message());
  return repaired.value_or(RawSamples());
}

/// The only warning, as "code: message".
std::string WarningOf(const RawSamples& repaired) {
  EXPECT_EQ(repaired.warnings.size(), 1);
  return repaired.warnings.empty()
             ? ""
             : std::string(repaired.warnings[0].code.text()) + ": " + MessageText(repaired.warnings[0]);
}

std::string FaultOf(const RawSamples& samples) {
  const Result<RawSamples> repaired = RepairClock(samples);
  EXPECT_FALSE(repaired.has_value());
  if (repaired) return "";
  EXPECT_EQ(repaired.error().code, StatusCode::kDataLoss);
  return repaired.error().message();
}

void ExpectUntouched(const RawSamples& samples) {
  const RawSamples repaired = Repaired(samples);
  EXPECT_EQ(repaired.time, samples.time);
  EXPECT_EQ(repaired.value, samples.value);
  EXPECT_THAT(repaired.warnings, IsEmpty());
}

std::vector<double> ValuesOf(const RawSamples& samples) { return {samples.value.begin(), samples.value.end()}; }

TEST(LineNumbers, GivesTheLineOfEachRow) {
  LineNumbers lines;
  for (const std::size_t line : {2, 3, 4, 7, 8, 20}) lines.Add(line);
  EXPECT_EQ(lines.size(), 6);
  for (const auto& [row, line] : {std::pair{0, 2}, {2, 4}, {3, 7}, {4, 8}, {5, 20}}) EXPECT_EQ(lines.LineOf(row), line);
}

// ---- Nothing to repair -------------------------------------------------------------------------------------------

TEST(RepairClock, KeepsUniformStamps) {
  ExpectUntouched(Rows(Stamps(2000, Hundredth)));
  ExpectUntouched(Rows(Stamps(600, [](int i) { return std::round(i * 100.0 / 3); }), "ms"));  // 33, 67, 100
}

TEST(RepairClock, KeepsGaps) {
  ExpectUntouched(Rows(Stamps(2000, [](int i) { return Hundredth(i + (i > 700 ? 250 : 0) + (i > 701 ? 1 : 0)); })));
}

TEST(RepairClock, KeepsEventDrivenSampling) {
  std::mt19937 random(7);
  double time = 4;
  ExpectUntouched(Rows(Stamps(3000, [&](int) {
    // From 0.1 ms to 1.3 s, to a microsecond, logarithmically uniform.
    time += 1e-4 * std::exp(std::log(13000.0) * static_cast<double>(random()) / 4294967296.0);
    return std::round(time * 1e6) / 1e6;
  })));
}

// ---- Counters ----------------------------------------------------------------------------------------------------

TEST(RepairClock, UnwrapsA32BitCounter) {
  for (const char* const unit : {"us", "ms"}) {
    const double start = 4294967296.0 - 995;  // 2^32
    const RawSamples repaired =
        Repaired(Rows(Stamps(200, [&](int i) { return std::fmod(start + 10 * i, 4294967296.0); }), unit));
    for (int i = 0; i < 200; ++i) EXPECT_EQ(repaired.time[i], start + 10 * i);
    EXPECT_EQ(WarningOf(repaired), "time_wrapped: run.csv:102: the times restart from 0 after 2^32 " +
                                       std::string(unit) +
                                       ", 1 time in all, because the counter overflows; later times were corrected");
  }
}

TEST(RepairClock, UnwrapsACounterAfterAPauseOfMoreThanHalfItsRange) {
  // 100 s, a pause of 40 min, and 100 s with an overflow after 50 s.
  const auto stamp = [](int i) { return 1744967296 + 10000.0 * i + (i < 10000 ? 0 : 2.4e9); };
  const RawSamples repaired =
      Repaired(Rows(Stamps(20000, [&](int i) { return std::fmod(stamp(i), 4294967296.0); }), "us"));
  for (int i = 0; i < 20000; ++i) ASSERT_EQ(repaired.time[i], stamp(i));
}

TEST(RepairClock, UnwrapsACounterRepeatedly) {
  const double step = 1e9;
  const RawSamples repaired =
      Repaired(Rows(Stamps(20, [&](int i) { return std::fmod(step * i, 4294967296.0); }), "us"));
  for (int i = 0; i < 20; ++i) EXPECT_EQ(repaired.time[i], step * i);
  EXPECT_THAT(WarningOf(repaired), testing::HasSubstr("run.csv:7: "));
  EXPECT_THAT(WarningOf(repaired), testing::HasSubstr("4 times in all"));  // 19e9 / 2^32 = 4.4
}

TEST(RepairClock, DoesNotUnwrapIfTheStepDiffers) {
  // The logger was restarted: a wrap would mean 2^32 us between two steps of 10 ms.
  EXPECT_EQ(
      FaultOf(Rows(Stamps(200, [](int i) { return i < 100 ? 3e9 + 1e4 * i : 1e4 * i; }), "us")),
      "run.csv:102: time 1000000 us follows 3000990000 us, so the clock was set back: these are two recordings in "
      "one file; split it before this line");
}

TEST(RepairClock, UnwrapsA16BitCounter) {
  struct Case {
    const char* unit;
    double first;  // First of the counter's 65536 values.
    double step;
    int wraps;  // In 20000 steps: floor(20000 step / 65536), as the count starts at `first`.
  };
  for (const Case& each : {Case{"ms", 0, 10, 3}, Case{"us", 0, 10000, 3051}, Case{"ms", -32768, 10, 3}}) {
    const auto stamp = [&](int i) { return each.first + std::fmod(each.step * i, 65536.0); };
    const RawSamples repaired = Repaired(Rows(Stamps(20001, stamp), each.unit));
    for (int i = 0; i <= 20000; ++i) ASSERT_EQ(repaired.time[i], each.first + each.step * i);
    EXPECT_THAT(WarningOf(repaired),
                testing::HasSubstr("the times restart from " + std::to_string(static_cast<int>(each.first)) +
                                   " after 2^16 " + each.unit + ", " + std::to_string(each.wraps) + " times in all"));
  }
}

TEST(RepairClock, DoesNotUnwrapA16BitCounterWithUnequalSteps) {
  // Set back after 61 s, 4.5 s before the counter's end; then set back after a value above 16 bits.
  EXPECT_THAT(FaultOf(Rows(Stamps(12000, [](int i) { return 10.0 * (i % 6100); }), "ms")),
              testing::HasSubstr("so the clock was set back"));
  EXPECT_THAT(FaultOf(Rows(Stamps(12000, [](int i) { return 10.0 * (i % 6554) + 6; }), "ms")),
              testing::HasSubstr("65536 ms, so the clock was set back"));
  // Six rows of 10 ms are lost, so 70 ms appear as 4.464 ms.
  EXPECT_THAT(FaultOf(Rows(Stamps(200, [](int i) { return std::fmod(1e4 * (i < 50 ? i : i + 6), 65536.0); }), "us")),
              testing::HasSubstr("so the clock was set back"));
}

// ---- Coarse stamps -----------------------------------------------------------------------------------------------

struct Rounding {
  double grid;
  double rate_hz;
  double start;
  double freedom = 0.1;  // Largest error that the stamps permit, in grid steps.
};

/// Rounds the stamps of a true clock and expects that RepairClock recovers the clock, except for a constant shift,
/// which rounding hides.
void ExpectTheTrueClock(const Rounding& rounding, const std::function<double(double)>& round) {
  const auto truth = [&](int i) { return rounding.start + i / rounding.rate_hz; };
  const auto stamp = [&](int i) { return std::round(round(truth(i) / rounding.grid) * rounding.grid * 1e9) / 1e9; };
  const RawSamples repaired = Repaired(Rows(Stamps(900, stamp)));
  ASSERT_EQ(repaired.time.size(), 900);
  const double shift = repaired.time[0] - truth(0);
  EXPECT_LE(std::abs(shift), rounding.grid);
  const Eigen::VectorXd true_time = Eigen::VectorXd::LinSpaced(900, truth(0), truth(899)).array() + shift;
  EXPECT_LE((repaired.time - true_time).cwiseAbs().maxCoeff(), rounding.freedom * rounding.grid)
      << rounding.grid << " s at " << rounding.rate_hz << " Hz";
  EXPECT_EQ(repaired.warnings.at(0).code, "time_rounded");
}

TEST(RepairClock, FindsTheUniformClockOfCoarseStamps) {
  // At 29.97 Hz three successive rows share a stamp of 0.1 s, except for one slip in 1000 rows.
  for (const Rounding& rounding : {Rounding{0.1, 30, 0.013}, Rounding{1, 30, 0.4}, Rounding{0.1, 29.97, 100, 0.34},
                                   Rounding{0.01, 30, 3.3}, Rounding{0.1, 12, 0}, Rounding{0.01, 83.1, 0}}) {
    ExpectTheTrueClock(rounding, [](double x) { return std::round(x); });
    ExpectTheTrueClock(rounding, [](double x) { return std::floor(x); });
  }
}

// As of a logger that loses a row when it empties its buffer.
TEST(RepairClock, KeepsTheTimesOfRowsThatAreLostAtEqualDistances) {
  for (const double interval : {0.02, 0.005, 0.05, 20.0}) {
    for (const int distance : {20, 50, 128}) {
      const RawSamples samples =
          Rows(Stamps(900, [&](int i) { return std::round(1e6 * interval * (i + i / (distance - 1))) / 1e6; }));
      EXPECT_EQ(Repaired(samples).time, samples.time) << interval << ", " << distance;
    }
  }
}

/// Stamps at 100 Hz, rounded to the grid by `round`.
RawSamples Coarse(int seconds, double grid, double start, const std::function<double(double)>& round) {
  // Whole hundredths are divided, so a stamp halfway between two steps stays halfway: 0.5 s = 50 counts of 0.01 s.
  const double counts = std::round(100 * grid);
  return Rows(Stamps(100 * seconds + 1, [&](int i) { return round((100 * start + i) / counts) * grid; }));
}

TEST(RepairClock, GivesTheUncertaintyOfTheRate) {
  for (const int seconds : {20, 30}) {
    for (const double grid : {0.1, 0.5, 1.0}) {
      for (const double start : {0.0, 0.03, 0.27, 17.48}) {
        for (const bool is_truncated : {false, true}) {
          const auto round = [&](double x) { return is_truncated ? std::floor(x) : std::round(x); };
          const RawSamples samples = Coarse(seconds, grid, start, round);
          const RawSamples repaired = Repaired(samples);
          const std::string name = std::to_string(seconds) + " s, " + std::to_string(grid) + " s from " +
                                   std::to_string(start) + (is_truncated ? ", truncated" : "");
          ASSERT_EQ(repaired.warnings.at(0).code, "time_rounded") << name;
          EXPECT_LE((repaired.time - samples.time).cwiseAbs().maxCoeff(), (0.5 + 1e-6) * grid) << name;
          const double step = (repaired.time[100 * seconds] - repaired.time[0]) / (100 * seconds);
          const double half_width = std::sqrt(3.0) * repaired.clock_std_dev;  // For a uniform distribution.
          EXPECT_LE(std::abs(0.01 / step - 1), half_width) << name;
          // The bound uses only the first and the last grid step, whose positions are each known to within one row.
          EXPECT_LE(half_width, 0.01 / (seconds - 2 * grid)) << name;
        }
      }
    }
  }
}

/// At both limits of the slope, the band that contains the stamps is one step wide. The width is convex in the slope,
/// so the band is wider beyond the limits.
TEST(RepairClock, AllowsExactlyTheSlopesThatFitAllStamps) {
  std::mt19937 random(19);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  for (int trial = 0; trial < 300; ++trial) {
    const int size = 40 + static_cast<int>(random() % 100);
    const double slope = 0.15 + uniform(), start = uniform();
    const std::vector<double> stamps = Stamps(size, [&](int i) { return std::round(start + slope * i); });
    const RawSamples repaired = Repaired(Rows(stamps));
    if (repaired.clock_std_dev == 0) continue;
    const double middle = (repaired.time[size - 1] - repaired.time[0]) / (size - 1);
    const double half_width = std::sqrt(3.0) * repaired.clock_std_dev * middle;
    const auto width = [&](double each) {  // Width of the band for a slope.
      double low = stamps[0], high = stamps[0];
      for (int i = 0; i < size; ++i) {
        low = std::min(low, stamps[i] - each * i);
        high = std::max(high, stamps[i] - each * i);
      }
      return high - low;
    };
    EXPECT_LE(std::abs(slope - middle), half_width * (1 + 1e-9)) << trial;
    for (const double end : {middle - half_width, middle + half_width}) EXPECT_NEAR(width(end), 1, 1e-5) << trial;
  }
}

TEST(RepairClock, ReportsTheRepairOfCoarseStamps) {
  // Rounding moves rows 2 and 898 towards each other, and rows 1 and 899 away from each other, by a third of a step
  // each. A sixth of a step, half a row, remains at each end. So the sampling interval is too long by at most
  // 1 / 896 or too short by at most 1 / 898.
  EXPECT_EQ(WarningOf(Repaired(Rows(Stamps(901, [](int i) { return std::round(i / 3.0) / 10; })))),
            "time_rounded: run.csv:2: the times are rounded to 0.1 s, which is coarse compared with the sampling "
            "interval; they were replaced by a uniform clock of 30 Hz, which assumes uniform sampling; clocks within "
            "+- 0.033 Hz agree with all times: an error of 0.11 % in times and 0.22 % in inertia; if the times were "
            "truncated instead of rounded, the new times and release_time are 0.05 s too early");
}

TEST(RepairClock, KeepsIncreasingCoarseStampsOfUnevenSampling) {
  std::mt19937 random(3);
  double time = 0;
  const RawSamples samples =
      Rows(Stamps(500, [&](int) { return time += static_cast<double>(1 + random() % 5); }), "ms");
  const RawSamples repaired = Repaired(samples);
  EXPECT_EQ(repaired.time, samples.time);
  EXPECT_EQ(
      WarningOf(repaired),
      "time_rounded: run.csv:2: the times are rounded to 1 ms, which is coarse compared with the sampling interval; no "
      "uniform clock agrees with them, so they were not changed; rounding gives them an error of 0.29 ms");  // 1 / √12
}

TEST(RepairClock, RefusesCoarseStampsWithLostRows) {
  const auto stamp = [](int i) { return std::round((i < 300 ? i : i + 40) / 3.0) / 10; };
  EXPECT_EQ(
      FaultOf(Rows(Stamps(600, stamp), "s", Stamps(600, [](int i) { return std::cos(0.1 * i); }))),
      "run.csv:3: time 0 s is also on line 2, and 598 of 600 rows share a time with another row; no uniform clock "
      "agrees with all times, so rows are missing or the rate changes, most clearly between lines 300 and 323. "
      "Give "
      "a part without this with --from and --to, or record the times with a finer step");
}

// ---- Few significant digits --------------------------------------------------------------------------------------

/// Uniform random numbers from 0 to 1 and derived ones, which are the same with every standard library.
class Randomness {
 public:
  explicit Randomness(unsigned int seed) : engine_(seed) {}

  double Uniform() { return (static_cast<double>(engine_()) + 0.5) / 4294967296.0; }
  double Exponential() { return -std::log(Uniform()); }
  double Normal() { return std::sqrt(-2 * std::log(Uniform())) * std::cos(6.283185307179586 * Uniform()); }

 private:
  std::mt19937 engine_;
};

/// A number as a file shows it with this many significant digits.
double Printed(double number, int digits) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*e", digits - 1, number);
  return std::strtod(text.data(), nullptr);
}

struct Digits {
  int digits;
  double rate_hz;
  double duration;
};

TEST(RepairClock, FindsTheClockOfTimesWithFewSignificantDigits) {
  for (const Digits& each : {Digits{3, 30, 30}, Digits{4, 240, 30}, Digits{4, 100, 120}, Digits{5, 2000, 15}}) {
    int agree = 0;
    for (unsigned int seed = 1; seed <= 200; ++seed) {
      Randomness random(seed);
      const double rate = each.rate_hz * (1 + 0.02 * (random.Uniform() - 0.5));
      const double start = seed % 2 == 0 ? 0 : random.Uniform() / rate;
      const RawSamples repaired = Repaired(Rows(Stamps(static_cast<int>(rate * each.duration),
                                                       [&](int i) { return Printed(start + i / rate, each.digits); })));
      ASSERT_EQ(repaired.warnings.at(0).code, "time_rounded") << each.digits << " digits, seed " << seed;
      const Eigen::Index last = repaired.time.size() - 1;
      const double found = static_cast<double>(last) / (repaired.time[last] - repaired.time[0]);
      if (std::abs(found / rate - 1) <= std::sqrt(3.0) * repaired.clock_std_dev) ++agree;
      EXPECT_LE(repaired.clock_std_dev, 0.001);
      EXPECT_LE(std::abs(repaired.time[0] - start), 0.1 / rate);
    }
    EXPECT_EQ(agree, 200) << each.digits << " digits";  // the true clock agrees with all stamps
  }
}

TEST(RepairClock, ReportsTimesWithFewSignificantDigits) {
  const std::string warning = WarningOf(Repaired(Rows(Stamps(900, [](int i) { return Printed(i / 30.0, 3); }))));
  EXPECT_THAT(warning, testing::StartsWith(
                           "time_rounded: run.csv:2: the times are rounded to 3 significant digits, so their steps "
                           "grow to 0.1 s, which is coarse compared with the sampling interval; they were replaced by "
                           "a uniform clock of 30 Hz, which assumes uniform sampling; clocks within +- "));
}

TEST(RepairClock, RefusesTimesWithFewDigitsAndLostRows) {
  const std::vector<double> values = Stamps(900, [](int i) { return std::cos(0.1 * i); });
  const auto stamp = [](int i) { return Printed((i < 500 ? i : i + 40) / 30.0, 3); };
  EXPECT_THAT(FaultOf(Rows(Stamps(900, stamp), "s", values)),
              testing::HasSubstr("so rows are missing or the rate changes"));
}

// ---- Packets -----------------------------------------------------------------------------------------------------

/// How a host receives and stamps the rows of a device. Times in s.
struct Transfer {
  std::string name;
  double rate_hz = 260;
  double duration = 20;
  int rows = 16;               ///< In a packet.
  bool varies = false;         ///< A packet has from 1 to twice as many rows.
  double latency = 0.002;      ///< Mean, exponential.
  double latency_std_dev = 0;  ///< Of a normal latency with a mean of 3 standard deviations, in addition.
  double poll = 0;             ///< Interval at which the host looks for packets; 0: it waits for them.
  double grid = 0.001;         ///< Stamps are truncated to this.
  double inner_step = 0;       ///< Between the stamps of a packet.
  double noise_deg = 0.1;
  double lost_rows = 0;             ///< Probability that the device skips a row.
  double lost_packets = 0;          ///< Probability that a packet is lost.
  int lost_packet_each = 0;         ///< Every so many packets, one is lost.
  int lost_together = 0;            ///< Number of successive rows that are skipped once.
  bool skips_after_packet = false;  ///< One row is skipped after each packet.
  int missed = 0;                   ///< Of 200 recordings, so many may be read in spite of lost rows.
};

/// A decaying swing that was sampled at `rate_hz`, packed, and stamped by the host.
RawSamples Transferred(const Transfer& transfer, double rate_hz, Randomness& random) {
  struct Row {
    double time, value;
  };
  std::vector<Row> rows;
  const double phase = 6 * random.Uniform(), gap = transfer.duration * (0.2 + 0.6 * random.Uniform());
  for (int i = 0; i < rate_hz * transfer.duration; ++i) {
    const double time = i / rate_hz;
    const double deg = 25 * std::exp(-time / 15) * std::cos(4.9 * time + phase) + transfer.noise_deg * random.Normal();
    const bool is_skipped = random.Uniform() < transfer.lost_rows ||
                            (transfer.skips_after_packet && i % (transfer.rows + 1) == 0) ||
                            (time > gap && time < gap + transfer.lost_together / rate_hz);
    if (!is_skipped) rows.push_back({time, std::round(100 * deg) / 100});
  }
  std::vector<double> stamps, values;
  double arrival = 0;
  const double start = 2000 * random.Uniform(), poll_phase = random.Uniform();
  int packet = 0;
  for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end, ++packet) {
    const int size = transfer.varies ? 1 + static_cast<int>(2 * transfer.rows * random.Uniform()) : transfer.rows;
    end = std::min(begin + static_cast<std::size_t>(size), rows.size());
    double received = rows[end - 1].time + transfer.latency * random.Exponential() +
                      std::max(0.0, transfer.latency_std_dev * (3 + random.Normal()));
    if (transfer.poll > 0) received = (std::ceil(received / transfer.poll + poll_phase)) * transfer.poll;
    arrival = std::max(arrival, start + received);
    const bool is_lost = random.Uniform() < transfer.lost_packets ||
                         (transfer.lost_packet_each > 0 && packet % transfer.lost_packet_each == 1);
    for (std::size_t i = begin; i < end && !is_lost; ++i) {
      stamps.push_back(std::floor(arrival / transfer.grid) * transfer.grid);
      values.push_back(rows[i].value);
      arrival += transfer.inner_step;
    }
  }
  return Rows(stamps, "s", values);
}

double FoundRateHz(const RawSamples& repaired) {
  const Eigen::Index last = repaired.time.size() - 1;
  return static_cast<double>(last) / (repaired.time[last] - repaired.time[0]);
}

TEST(RepairClock, FindsTheRateOfPacketsWithinItsError) {
  const std::vector<Transfer> transfers = {
      {.name = "packets of one size"},
      {.name = "packets of many sizes", .varies = true},
      {.name = "long latencies", .latency = 0.01},
      {.name = "normal latencies", .latency = 0, .latency_std_dev = 0.005},
      {.name = "a host that polls", .latency = 0, .poll = 0.02},
      {.name = "stamps that increase in packets", .grid = 1e-6, .inner_step = 12e-6},
      {.name = "small packets", .rate_hz = 1000, .rows = 2, .latency = 0.0005, .grid = 1e-4},
      {.name = "few packets", .rate_hz = 50, .rows = 25},
      {.name = "coarse stamps", .grid = 0.01},
      {.name = "noise", .noise_deg = 1}};
  for (const Transfer& transfer : transfers) {
    int found = 0, agree = 0;
    double largest_std_dev = 0;
    for (unsigned int seed = 1; seed <= 200; ++seed) {
      Randomness random(seed);
      const double rate_hz = transfer.rate_hz * (1 + 0.01 * (random.Uniform() - 0.5));
      const Result<RawSamples> repaired = RepairClock(Transferred(transfer, rate_hz, random));
      if (!repaired || repaired->warnings.empty() || repaired->warnings[0].code != "time_bursts") continue;
      ++found;
      if (std::abs(FoundRateHz(*repaired) / rate_hz - 1) <= 2 * repaired->clock_std_dev) ++agree;
      largest_std_dev = std::max(largest_std_dev, repaired->clock_std_dev);
    }
    EXPECT_GE(found, 198) << transfer.name;
    EXPECT_GE(agree, 0.95 * found) << transfer.name;
    EXPECT_LE(largest_std_dev, 0.002) << transfer.name;
  }
}

/// Where stamps increase within packets, no two rows share one, so the rows are read with a warning.
TEST(RepairClock, RefusesPacketsWithLostRowsOrWarns) {
  const std::vector<Transfer> transfers = {
      {.name = "5 % of the rows", .lost_rows = 0.05},
      {.name = "5 % of the rows, long latencies", .latency = 0.01, .lost_rows = 0.05},
      {.name = "5 % of the rows, stamps that increase in packets",
       .grid = 1e-6,
       .inner_step = 12e-6,
       .lost_rows = 0.05,
       .missed = 2},
      {.name = "1 % of the rows", .lost_rows = 0.01, .missed = 4},
      {.name = "5 % of the packets", .lost_packets = 0.05},
      {.name = "5 % of the packets of many sizes", .varies = true, .lost_packets = 0.05},
      {.name = "every twentieth packet", .lost_packet_each = 20},
      {.name = "a row after each packet", .skips_after_packet = true},
      {.name = "one packet", .lost_together = 16},
      {.name = "a second", .lost_together = 260}};
  for (const Transfer& transfer : transfers) {
    int missed = 0;
    for (unsigned int seed = 1; seed <= 200; ++seed) {
      Randomness random(seed);
      const Result<RawSamples> repaired = RepairClock(Transferred(transfer, transfer.rate_hz, random));
      if (!repaired) {
        EXPECT_THAT(repaired.error().message(), testing::HasSubstr("so rows are missing or the rate changes"));
        EXPECT_THAT(repaired.error().message(), testing::Not(testing::HasSubstr("--sample_rate_hz")));
        EXPECT_THAT(repaired.error().try_flags, IsEmpty());
        continue;
      }
      const auto is_warned = [](const Warning& warning) {
        return warning.code == "time_bursts" &&
               MessageText(warning).ends_with("; give a part without gaps with --from and --to");
      };
      missed += std::ranges::any_of(repaired->warnings, is_warned) ? 0 : 1;
    }
    EXPECT_LE(missed, transfer.missed) << transfer.name;
  }
}

TEST(RepairClock, ReportsPackets) {
  Randomness random(1);
  const std::string warning = WarningOf(Repaired(Transferred({}, 260, random)));
  EXPECT_THAT(warning,
              testing::MatchesRegex(
                  "time_bursts: run.csv:2: the rows come in 32. packets of about 16 rows, and each packet has "
                  "the time at which it was received; the times were replaced by a uniform clock of "
                  "(259.9|260)[0-9.]* Hz .- 0.0[0-9]* Hz, which assumes that no rows are missing: an error of "
                  "0.0[0-9]* % in times and 0.0[0-9]* % in inertia; the shortest delay of the packets remains in "
                  "release_time; if you know the sampling rate, give --sample_rate_hz with --time_column none"));
}

/// A device that samples fast, then pauses: the stamps increase within groups of rows and are right.
TEST(RepairClock, KeepsStampsOfADeviceThatPauses) {
  const auto stamp = [](int i) { return std::round((i / 16) * 62000 + (i % 16) * 200) / 1e6; };
  std::vector<double> values = Stamps(1600, [&](int i) { return 25 * std::cos(4.9 * stamp(i)); });
  ExpectUntouched(Rows(Stamps(1600, stamp), "s", values));
}

/// A row for each change of a count. Rows are dense where the pendulum is fast, so they seem to come in packets.
TEST(RepairClock, KeepsStampsOfAnEncoder) {
  for (const double decay : {0.0, 0.002, 0.02}) {
    for (const int levels : {3, 7, 20, 60}) {
      std::vector<double> time, value;
      double count = 0;
      for (int k = 0; k < 2'000'000; ++k) {  // every 20 us
        const double now = 2e-5 * k;
        const double angle = levels * std::exp(-decay * now) * std::cos(4.9 * now);
        if (std::abs(angle - count) < 1) continue;  // hysteresis of half a count
        count += angle > count ? 1 : -1;
        time.push_back(now);
        value.push_back(count);
      }
      ExpectUntouched(Rows(time, "s", value));
    }
  }
}

TEST(RepairClock, SuggestsTheRateOfFewPackets) {
  const auto stamp = [](int i) { return 3.0 * (i / 300); };  // five packets of 300 rows
  const Result<RawSamples> repaired =
      RepairClock(Rows(Stamps(1500, stamp), "s", Stamps(1500, [](int i) { return std::cos(0.05 * i); })));
  ASSERT_FALSE(repaired.has_value());
  EXPECT_THAT(repaired.error().message(),
              testing::HasSubstr("; the times suggest 100 Hz, but too few of them differ to prove that the sampling is "
                                 "uniform. If it is, give --sample_rate_hz 100 with --time_column none"));
  EXPECT_THAT(repaired.error().try_flags, ElementsAre("--sample_rate_hz 100", "--time_column none"));
}

// ---- Ends that repeat, and windows -------------------------------------------------------------------------------

TEST(RepairClock, RemovesRowsThatRepeatTheFirstOrTheLast) {
  std::vector<double> time = Stamps(300, Hundredth), value = Stamps(300, [](int i) { return i; });
  time.insert(time.end(), 700, time.back());
  value.insert(value.end(), 700, value.back());
  time.insert(time.begin(), 5, time.front());
  value.insert(value.begin(), 5, value.front());
  const RawSamples repaired = Repaired(Rows(time, "s", value));
  EXPECT_EQ(ValuesOf(repaired), Stamps(300, [](int i) { return i; }));
  EXPECT_EQ(repaired.lines.LineOf(1), 8);
  ASSERT_EQ(repaired.warnings.size(), 2);
  EXPECT_EQ(repaired.warnings[0].code, "rows_repeated");
  EXPECT_EQ(MessageText(repaired.warnings[0]),
            "run.csv:307: lines 307 to 1006 repeat line 306, time and value, and were left out");
  EXPECT_EQ(MessageText(repaired.warnings[1]),
            "run.csv:3: lines 3 to 7 repeat line 2, time and value, and were left out");
}

TEST(RepairClock, KeepsOneOfEachPairOfEqualRows) {
  std::vector<double> time, value;
  for (int i = 0; i < 200; ++i) {
    time.insert(time.end(), 2, Hundredth(i));
    value.insert(value.end(), 2, std::sin(0.05 * i));
  }
  const RawSamples repaired = Repaired(Rows(time, "s", value));
  EXPECT_EQ(repaired.time.size(), 200);
  EXPECT_EQ(repaired.warnings.at(0).code, "time_repeated");
}

TEST(RepairClock, JudgesTheWindowIfTheWholeFileCannotBeRepaired) {
  const RawSamples samples = Rows(Stamps(900, [](int i) { return i < 600 ? 10 * i : 10 * (i - 600); }), "ms");
  EXPECT_FALSE(RepairClock(samples).has_value());
  const Result<RawSamples> repaired = RepairClock(samples, {1, 4.5});
  ASSERT_TRUE(repaired.has_value());
  EXPECT_EQ(repaired->time.size(), 351);  // 1 s to 4.5 s
  EXPECT_EQ(repaired->time[0], 1000);
  EXPECT_EQ(repaired->lines.LineOf(0), 102);
  EXPECT_EQ(WarningOf(*repaired),
            "time_outside_window: run.csv: the times outside the window of --from and --to cannot be repaired, so only "
            "351 of "
            "900 rows were read; run.csv:602: time 0 ms follows 5990 ms, so the clock was set back: these are two "
            "recordings in "
            "one file; split it before this line");
  EXPECT_EQ(RepairClock(samples, {1, 20}).error().message(), RepairClock(samples).error().message());
}

// ---- Stamps that repeat ------------------------------------------------------------------------------------------

TEST(RepairClock, RemovesRowsThatShareAStamp) {
  std::vector<double> time = Stamps(100, Hundredth);
  time[50] = time[49];
  const RawSamples repaired = Repaired(Rows(time));
  EXPECT_EQ(repaired.time.size(), 98);
  EXPECT_EQ(repaired.value[48], 48);
  EXPECT_EQ(repaired.value[49], 51);
  EXPECT_EQ(repaired.lines.LineOf(49), 53);
  EXPECT_EQ(WarningOf(repaired),
            "time_repeated: run.csv:52: 2 of 100 rows were left out because they share their time with another row, "
            "first 0.49 s; of rows with equal times and values, one was kept");
}

TEST(RepairClock, KeepsOneOfSeveralEqualRows) {
  EXPECT_THAT(ValuesOf(Repaired(Rows({0, 1, 2, 2, 3, 4, 5, 6, 7, 8}, "s", {0, 1, 5, 5, 3, 4, 5, 6, 7, 8}))),
              ElementsAre(0, 1, 5, 3, 4, 5, 6, 7, 8));
}

TEST(RepairClock, RemovesRowsOfAStoppedClock) {
  std::vector<double> time = Stamps(100, Hundredth);
  for (int i = 61; i < 66; ++i) time[i] = time[60];
  const RawSamples repaired = Repaired(Rows(time));
  EXPECT_EQ(repaired.time.size(), 94);
  EXPECT_EQ(repaired.value[60], 66);
  EXPECT_EQ(repaired.warnings.at(0).code, "time_repeated");
}

TEST(RepairClock, RefusesMoreThanAFifthOfSharedStamps) {
  std::mt19937 random(5);
  double time = 0;
  const std::vector<double> stamps = Stamps(100, [&](int i) {
    if (i % 8 != 1) time += 1e-3 * static_cast<double>(1 + random() % 1000);
    return time;
  });
  EXPECT_THAT(FaultOf(Rows(stamps)),
              testing::HasSubstr(", and 26 of 100 rows share a time with another row; "));  // 1, 9, .., 97
}

// ---- Stamps that go back -----------------------------------------------------------------------------------------

TEST(RepairClock, RemovesTheFewestRowsIfStampsGoBack) {
  std::vector<double> time = Stamps(100, Hundredth);
  time[40] = 0.375;  // Between rows 37 and 38: without row 40 the times increase.
  time[80] = 0.835;  // Late, between rows 83 and 84.
  const RawSamples repaired = Repaired(Rows(time));
  EXPECT_EQ(repaired.time.size(), 98);
  EXPECT_EQ(repaired.value[39], 39);
  EXPECT_EQ(repaired.value[40], 41);
  EXPECT_EQ(repaired.value[78], 79);
  EXPECT_EQ(repaired.value[79], 81);
  EXPECT_EQ(
      WarningOf(repaired),
      "time_not_increasing: run.csv:42: time 0.375 s does not follow 0.39 s of line 41; the fewest rows were left "
      "out to make times increase, 2 of 100 rows");
}

TEST(RepairClock, LeavesOutStampsFarFromThoseAroundThem) {
  for (const double wrong : {0.04, 40.4, -1e6}) {  // of 0.4 s: a lost digit, a doubled one, anything
    std::vector<double> time = Stamps(100, Hundredth);
    time[40] = wrong;
    const RawSamples repaired = Repaired(Rows(time));
    EXPECT_EQ(repaired.time.size(), 99) << wrong;
    EXPECT_EQ(repaired.value[40], 41) << wrong;
    EXPECT_THAT(WarningOf(repaired), testing::AllOf(testing::StartsWith("time_not_increasing: run.csv:42: time "),
                                                    testing::EndsWith(" s is far from 0.39 s of line 41; 1 row with "
                                                                      "such a time was left out")));
  }
  // Where the clock was set back, the rows around are not as far apart as their number says.
  std::vector<double> set_back = Stamps(100, Hundredth);
  for (int i = 50; i < 100; ++i) set_back[static_cast<std::size_t>(i)] -= 0.2;
  EXPECT_THAT(FaultOf(Rows(set_back)), testing::HasSubstr("so the clock was set back"));
}

/// The counter does not overflow where a stamp of 4.28e9 us loses a digit.
TEST(RepairClock, TakesNoLostDigitForAnOverflow) {
  std::vector<double> time = Stamps(1000, [](int i) { return 4280000000.0 + 10000.0 * i; });
  time[300] = 428300000;
  const RawSamples repaired = Repaired(Rows(time, "us"));
  EXPECT_EQ(repaired.time.size(), 999);
  EXPECT_EQ(repaired.time[998], time[999]);
  EXPECT_THAT(WarningOf(repaired), testing::StartsWith("time_not_increasing: "));
}

TEST(RepairClock, DetectsNonAdjacentUnorderedStamps) {
  std::vector<double> time = Stamps(100, [](int i) { return i; });
  for (const auto& [row, stamp] : {std::pair{11, 13.0}, {12, 12.0}, {13, 14.0}, {14, 12.5}}) time[row] = stamp;
  // 10 13 12 14 12.5 15: both 10 12 12.5 15 and 10 13 14 15 leave out two rows; leaving out one is not enough.
  EXPECT_EQ(Repaired(Rows(time)).time.size(), 98);
}

// The motion in between would be computed for so long: 1e80 s at 1 Hz take for ever.
TEST(RepairClock, RefusesRowsThatAreFarFromAllOthers) {
  for (const int size : {8, 400}) {
    for (const std::vector<double>& wrong : {std::vector<double>{-1e308},
                                             {-1e80, -0.9e80},
                                             {-1e5},
                                             {1e5, 1.001e5},
                                             {1e80},
                                             {1e308, 0.9e308},
                                             {-1e80, 1e80},
                                             {1e80, 1.1e80, 1.2e80, 1.3e80}}) {
      std::vector<double> times = Stamps(size, Hundredth);
      times.insert(times.end(), wrong.begin(), wrong.end());
      std::ranges::sort(times);
      const auto repaired = RepairClock(Rows(times));
      ASSERT_FALSE(repaired) << wrong[0] << ", " << size;
      EXPECT_THAT(repaired.error().message(), testing::HasSubstr("rows are 0.01 s apart; correct or remove this row"));
    }
  }
}

TEST(RepairClock, KeepsRowsAfterAPause) {
  const auto kept = [](int rows_before, double pause) {
    return RepairClock(Rows(Stamps(1000, [&](int i) { return 0.02 * i + (i < rows_before ? 0 : pause); }))).has_value();
  };
  EXPECT_TRUE(kept(1, 250));    // a log of changes whose pendulum was at rest first
  EXPECT_TRUE(kept(3, 86400));  // two recordings in one file
  EXPECT_TRUE(kept(500, 86400));
  EXPECT_FALSE(kept(500, 1e8));
  EXPECT_FALSE(kept(1, 86400));
}

TEST(RepairClock, RefusesAClockThatWasSetBack) {
  EXPECT_EQ(FaultOf(Rows(Stamps(400, [](int i) { return Hundredth(i % 200); }))),
            "run.csv:202: time 0 s follows 1.99 s, so the clock was set back: these are two recordings in one file; "
            "split it before this line");
}

TEST(RepairClock, RefusesMoreThanATwentiethOfBackwardRows) {
  std::vector<double> time = Stamps(100, Hundredth);
  for (int i = 4; i < 100; i += 15) time[i] -= 0.015;
  EXPECT_EQ(FaultOf(Rows(time)),
            "run.csv:6: time 0.025 s does not follow 0.03 s of line 5, and 7 of 100 rows would have to be left out to "
            "make times increase; correct or sort the rows");
}

TEST(RepairClock, RepairsOneFaultAfterAnother) {
  std::vector<double> time = Stamps(200, Hundredth);
  time[50] = time[49];
  time[120] = 1.175;
  const RawSamples repaired = Repaired(Rows(time));
  ASSERT_EQ(repaired.warnings.size(), 2);
  EXPECT_EQ(MessageText(repaired.warnings[1]),
            "run.csv:122: time 1.175 s does not follow 1.19 s of line 121; the fewest rows were left out to make times "
            "increase, 1 of 198 rows");
  EXPECT_EQ(repaired.time.size(), 197);
}

TEST(RepairClock, MakesAnyStampsIncreaseOrRefusesThem) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<double> time = Stamps(20 + static_cast<int>(random() % 80), Hundredth);
    for (auto edits = random() % 4; edits > 0; --edits) {
      time[random() % time.size()] += 0.005 * (static_cast<double>(random() % 17) - 8);
    }
    const Result<RawSamples> repaired = RepairClock(Rows(time));
    if (!repaired) continue;
    for (Eigen::Index i = 1; i < repaired->time.size(); ++i) {
      ASSERT_GT(repaired->time[i], repaired->time[i - 1]) << "trial " << trial << ", row " << i;
    }
    EXPECT_EQ(repaired->lines.size(), repaired->time.size());
  }
}

}  // namespace
}  // namespace pendulum::clock_test
