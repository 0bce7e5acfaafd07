// SPDX-License-Identifier: Apache-2.0
#include "pendulum/acquisition/received_run.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include <gtest/gtest.h>

namespace pendulum::received_run_test {
namespace {

namespace wire = pendulum_logger;

constexpr SamplingRate kRate{10000, 1};  // a sample every 10 000 ticks of 0.5 us, 5 ms

wire::Data Frame(int sequence, std::uint32_t tick, std::initializer_list<int> sums) {
  wire::Data frame{};
  frame.sequence = static_cast<std::uint16_t>(sequence);
  frame.tick = tick;
  for (const int sum : sums) frame.sums[frame.count++] = static_cast<std::uint16_t>(sum);
  return frame;
}

std::vector<double> TimesOf(const ReceivedRun& run) {
  std::vector<double> times;
  for (std::size_t i = 0; i < run.size(); ++i) times.push_back(run.Time(i));
  return times;
}

std::vector<double> CountsOf(const ReceivedRun& run) {
  std::vector<double> counts;
  for (std::size_t i = 0; i < run.size(); ++i) counts.push_back(run.Counts(i));
  return counts;
}

using Numbers = std::vector<double>;

// ---- NearestRate -------------------------------------------------------------------------------------------------

TEST(NearestRate, IsExactIfThePeriodIsAWholeNumberOfTicks) {
  const auto rate = NearestRate(200, 1);
  ASSERT_TRUE(rate);
  EXPECT_EQ(rate->period, 10000);
  EXPECT_EQ(rate->oversample, 1);
  EXPECT_EQ(rate->Ticks(), 10000);
  EXPECT_EQ(rate->Hz(), 200);
}

TEST(NearestRate, RoundsThePeriod) {
  const auto rate = NearestRate(60, 1);  // 33 333.3 ticks
  ASSERT_TRUE(rate);
  EXPECT_EQ(rate->period, 33333);
  EXPECT_DOUBLE_EQ(rate->Hz(), 2e6 / 33333);
  EXPECT_EQ(NearestRate(300, 1)->period, 6667);  // 6666.7
}

TEST(NearestRate, CountsConversionsWithTheSamples) {
  const auto rate = NearestRate(100, 16);
  ASSERT_TRUE(rate);
  EXPECT_EQ(rate->period, 1250);
  EXPECT_EQ(rate->oversample, 16);
  EXPECT_EQ(rate->Ticks(), 20000);
  EXPECT_EQ(rate->Hz(), 100);
}

// 250 to 62 500 ticks between conversions mean 8000 to 32 conversions per second.
TEST(NearestRate, CoversExactlyThePossibleRates) {
  EXPECT_EQ(NearestRate(8000, 1)->period, 250);
  EXPECT_EQ(NearestRate(32, 1)->period, 62500);
  EXPECT_EQ(NearestRate(125, 64)->period, 250);
  EXPECT_EQ(NearestRate(0.5, 64)->period, 62500);
  EXPECT_FALSE(NearestRate(8100, 1));
  EXPECT_FALSE(NearestRate(31.9, 1));
  EXPECT_FALSE(NearestRate(127, 64));
  EXPECT_FALSE(NearestRate(0.49, 64));
}

TEST(NearestRate, RefusesAnInvalidRate) {
  EXPECT_FALSE(NearestRate(200, 0));
  EXPECT_FALSE(NearestRate(200, -1));
  EXPECT_FALSE(NearestRate(100, 65));
  EXPECT_FALSE(NearestRate(0, 1));
  EXPECT_FALSE(NearestRate(-200, 1));
  EXPECT_FALSE(NearestRate(std::nan(""), 1));
  EXPECT_FALSE(NearestRate(1e300 * 1e300, 1));
}

// ---- Samples -----------------------------------------------------------------------------------------------------

TEST(ReceivedRun, IsEmptyAtFirst) {
  const ReceivedRun run(kRate);
  EXPECT_EQ(run.size(), 0);
  EXPECT_TRUE(run.arrivals().empty());
  EXPECT_EQ(run.Losses().samples, 0);
  EXPECT_FALSE(run.Losses().is_end_known);
}

TEST(ReceivedRun, MeasuresTimeFromTheFirstSample) {
  ReceivedRun run(kRate);
  EXPECT_TRUE(run.AddFrame(Frame(0, 123456, {500, 501, 1023}), 10));
  EXPECT_TRUE(run.AddFrame(Frame(1, 153456, {0, 512}), 10.02));
  EXPECT_EQ(TimesOf(run), Numbers({0, 0.005, 0.010, 0.015, 0.020}));
  EXPECT_EQ(CountsOf(run), Numbers({500, 501, 1023, 0, 512}));
  EXPECT_EQ(run.Losses().samples, 0);
}

TEST(ReceivedRun, ReportsTheArrivalTimesOfFrames) {
  ReceivedRun run(kRate);
  run.AddFrame(Frame(0, 0, {1, 2, 3}), 7.25);
  run.AddFrame(Frame(1, 30000, {4}), 7.5);
  ASSERT_EQ(run.arrivals().size(), 2);
  EXPECT_DOUBLE_EQ(run.arrivals()[0].device_time, 0.010);  // the time of its last sample
  EXPECT_EQ(run.arrivals()[0].host_time, 7.25);
  EXPECT_DOUBLE_EQ(run.arrivals()[1].device_time, 0.015);
  EXPECT_EQ(run.arrivals()[1].host_time, 7.5);
}

// 2^32 ticks are 2147.483648 s.
TEST(ReceivedRun, ContinuesAcrossTheTickOverflow) {
  for (const std::uint32_t before : {5000U, 10000U, 20000U, 25000U}) {
    ReceivedRun run(kRate);
    const std::uint32_t first = 0U - before;
    EXPECT_TRUE(run.AddFrame(Frame(0, first, {1, 2, 3}), 0)) << before;
    EXPECT_TRUE(run.AddFrame(Frame(1, first + 30000U, {4, 5}), 0)) << before;
    EXPECT_EQ(TimesOf(run), Numbers({0, 0.005, 0.010, 0.015, 0.020})) << before;
    EXPECT_EQ(run.Losses().samples, 0);
  }
}

// Three wraps of the counter with frames 1000 s apart. The samples in between are missing and the time continues.
TEST(ReceivedRun, ContinuesAcrossSeveralTickOverflows) {
  ReceivedRun run(kRate);
  std::uint32_t tick = 77;
  for (int i = 0; i <= 7; ++i, tick += 2000000000U) ASSERT_TRUE(run.AddFrame(Frame(i, tick, {i}), 1000 * i));
  EXPECT_EQ(run.Time(7), 7000);
  EXPECT_EQ(run.Losses().samples, 7 * 199999);
}

TEST(ReceivedRun, AveragesConversions) {
  ReceivedRun run({1250, 16});
  run.AddFrame(Frame(0, 0, {16 * 512, 16 * 512 + 1, 16 * 1023, 8}), 0);
  EXPECT_EQ(CountsOf(run), Numbers({512, 512.0625, 1023, 0.5}));
  EXPECT_EQ(TimesOf(run), Numbers({0, 0.010, 0.020, 0.030}));
}

TEST(ReceivedRun, ReportsSaturation) {
  ReceivedRun run(kRate);
  run.AddFrame(Frame(0, 0, {0, 1, 1022, 1023}), 0);
  EXPECT_TRUE(run.IsSaturated(0));
  EXPECT_FALSE(run.IsSaturated(1));
  EXPECT_FALSE(run.IsSaturated(2));
  EXPECT_TRUE(run.IsSaturated(3));
}

// If four conversions of at most 1023 counts add up to 4091, three are 1023 and one is 1022. If they add up to 1, three
// are 0.
TEST(ReceivedRun, ReportsSaturationOfSomeConversions) {
  ReceivedRun run({2500, 4});
  run.AddFrame(Frame(0, 0, {4 * 1023, 4 * 1023 - 1, 4 * 512, 1, 0}), 0);
  EXPECT_TRUE(run.IsSaturated(0));
  EXPECT_TRUE(run.IsSaturated(1));
  EXPECT_FALSE(run.IsSaturated(2));
  EXPECT_TRUE(run.IsSaturated(3));
  EXPECT_TRUE(run.IsSaturated(4));
}

// ---- Losses ------------------------------------------------------------------------------------------------------

TEST(ReceivedRun, LeavesAGapForLostSamples) {
  ReceivedRun run(kRate);
  run.AddFrame(Frame(0, 0, {1, 2}), 0);
  EXPECT_TRUE(run.AddFrame(Frame(1, 50000, {6}), 0));  // samples 3, 4 and 5 are missing
  EXPECT_EQ(TimesOf(run), Numbers({0, 0.005, 0.025}));
  const RunLosses losses = run.Losses();
  EXPECT_EQ(losses.samples, 3);
  EXPECT_EQ(losses.on_line, 0);  // no frame number is missing, so the logger did not send them
  EXPECT_EQ(losses.dropped, 0);
  EXPECT_FALSE(losses.is_end_known);
}

TEST(ReceivedRun, SeparatesLossesOfTheLoggerAndTheLine) {
  ReceivedRun run(kRate);
  run.AddFrame(Frame(0, 0, {1, 2}), 0);
  wire::Data late = Frame(2, 70000, {8});  // five are missing: three dropped, two in a damaged frame
  late.dropped = 3;
  late.late = 1;
  run.AddFrame(late, 0);
  EXPECT_EQ(run.Losses().dropped, 3);
  EXPECT_EQ(run.Losses().on_line, 2);
  EXPECT_EQ(run.Losses().late, 1);
  run.SetEnd({5, 3, 1});
  const RunLosses losses = run.Losses();
  EXPECT_TRUE(losses.is_end_known);
  EXPECT_EQ(losses.samples, 5);
  EXPECT_EQ(losses.dropped, 3);
  EXPECT_EQ(losses.on_line, 2);
  EXPECT_EQ(losses.late, 1);
}

// At 200 Hz a frame has 8 samples, so there are 25 frames per second.
TEST(ReceivedRun, FindsMissingSamplesAtBothEnds) {
  ReceivedRun run(kRate);
  run.AddFrame(Frame(2, 40000, {5, 6}), 0);
  EXPECT_EQ(run.Losses().samples, 16);  // frames 0 and 1
  EXPECT_EQ(run.Losses().on_line, 16);
  run.SetEnd({22, 0, 0});  // and four samples after the frame
  EXPECT_EQ(run.Losses().samples, 20);
  EXPECT_EQ(run.Losses().on_line, 20);
}

// Each frame reports how many samples were dropped before it was sent. Here two were dropped after the samples of frame
// 0, which still had room. Then frame 1 with its eight samples is lost on the line.
TEST(ReceivedRun, DoesNotCountReportedDropsAsLostOnTheLine) {
  ReceivedRun run(kRate);
  wire::Data first = Frame(0, 0, {1, 2}), third = Frame(2, 120000, {13});
  first.dropped = third.dropped = 2;
  run.AddFrame(first, 0);
  run.AddFrame(third, 0);
  const RunLosses losses = run.Losses();
  EXPECT_EQ(losses.samples, 10);
  EXPECT_EQ(losses.on_line, 8);
  EXPECT_EQ(losses.dropped, 2);
}

TEST(ReceivedRun, CountsNoLossWhenTheFrameNumberOverflows) {
  ReceivedRun run(kRate);
  std::uint32_t tick = 0;
  for (int i = 0; i < 65540; ++i, tick += 10000) ASSERT_TRUE(run.AddFrame(Frame(i, tick, {i % 1000}), 0));
  EXPECT_EQ(run.Losses().samples, 0);
  EXPECT_EQ(run.Losses().on_line, 0);
}

TEST(ReceivedRun, ReportsNoLossesOfACompleteRun) {
  ReceivedRun run(kRate);
  run.AddFrame(Frame(0, 40000, {5, 6}), 0);
  run.SetEnd({2, 0, 0});
  const RunLosses losses = run.Losses();
  EXPECT_EQ(losses.samples, 0);
  EXPECT_EQ(losses.on_line, 0);
  EXPECT_TRUE(losses.is_end_known);
}

// The counters in a frame stop at 65 535; the counters in End do not.
TEST(ReceivedRun, UsesTheCountersOfEndIfFrameCountersSaturate) {
  ReceivedRun run(kRate);
  wire::Data full = Frame(0, 0, {1});
  full.dropped = full.late = 65535;
  run.AddFrame(full, 0);
  EXPECT_EQ(run.Losses().late, 65535);
  run.SetEnd({1, 1000000, 70000});
  EXPECT_EQ(run.Losses().dropped, 1000000);
  EXPECT_EQ(run.Losses().late, 70000);
  EXPECT_EQ(run.Losses().samples, 1000000);
}

// The logger has already dropped two samples when it sends the first frame. The next frame shows their position.
TEST(ReceivedRun, CountsLoggerDropsOnce) {
  ReceivedRun run(kRate);
  wire::Data first = Frame(0, 0, {1, 2}), second = Frame(1, 40000, {5});
  first.dropped = second.dropped = 2;
  for (const wire::Data& frame : {first, second}) {
    run.AddFrame(frame, 0);
    EXPECT_EQ(run.Losses().samples, 2);
    EXPECT_EQ(run.Losses().dropped, 2);
    EXPECT_EQ(run.Losses().on_line, 0);
  }
}

// A late conversion spoils its sample. The next sample starts at the next conversion, so the gap is not a whole number
// of samples.
TEST(ReceivedRun, AcceptsAGapThatIsNotAWholeNumberOfSamples) {
  ReceivedRun run({2500, 4});
  EXPECT_TRUE(run.AddFrame(Frame(0, 0, {100}), 0));
  EXPECT_TRUE(run.AddFrame(Frame(1, 17500, {104}), 0));  // 7 conversions: 4 of the first sample, 3 of a spoiled one
  EXPECT_EQ(TimesOf(run), Numbers({0, 0.00875}));
  EXPECT_EQ(run.Losses().samples, 1);
  EXPECT_TRUE(run.AddFrame(Frame(2, 30000, {104}), 0));  // 5 conversions: one was spoiled, which is less than a sample
  EXPECT_EQ(run.Losses().samples, 1);
}

// ---- KeepFirst ---------------------------------------------------------------------------------------------------

/// Samples 0, 1, 2, a gap of one sample, 4, a gap of two samples in the lost frame, 7, 8.
ReceivedRun RunWithGaps() {
  ReceivedRun run(kRate);
  wire::Data second = Frame(1, 40000, {4}), fourth = Frame(3, 70000, {7, 8});
  second.dropped = fourth.dropped = 1;
  run.AddFrame(Frame(0, 0, {0, 1, 2}), 0);
  run.AddFrame(second, 0);
  run.AddFrame(fourth, 0);
  return run;
}

TEST(ReceivedRun, KeepsTheFirstSamplesAndTheirLosses) {
  ReceivedRun run = RunWithGaps();
  EXPECT_EQ(run.Losses().samples, 3);
  run.SetEnd({100, 1, 0});
  run.KeepFirst(4);
  EXPECT_EQ(CountsOf(run), Numbers({0, 1, 2, 4}));
  const RunLosses losses = run.Losses();
  EXPECT_EQ(losses.samples, 1);
  EXPECT_EQ(losses.dropped, 1);
  EXPECT_EQ(losses.on_line, 0);
  EXPECT_TRUE(losses.is_end_known);
  run.KeepFirst(3);
  EXPECT_EQ(run.Losses().samples, 0);
  EXPECT_EQ(run.Losses().dropped, 0);
}

TEST(ReceivedRun, KeepsAGapBeforeTheLastKeptSample) {
  ReceivedRun run = RunWithGaps();
  run.KeepFirst(5);
  EXPECT_EQ(TimesOf(run), Numbers({0, 0.005, 0.010, 0.020, 0.035}));
  EXPECT_EQ(run.Losses().samples, 3);
  EXPECT_EQ(run.Losses().on_line, 2);
  EXPECT_EQ(run.Losses().dropped, 1);
}

TEST(ReceivedRun, KeepsAllSamplesIfAsManyAreRequested) {
  ReceivedRun run = RunWithGaps();
  run.SetEnd({10, 1, 0});  // 6 samples arrived, so 4 were lost on the line
  for (const std::size_t samples : {std::size_t{1000}, run.size()}) {
    run.KeepFirst(samples);
    EXPECT_EQ(run.size(), 6);
    EXPECT_EQ(run.Losses().samples, 5);
  }
}

// ---- Contradictions ----------------------------------------------------------------------------------------------

void ExpectContradicts(ReceivedRun& run, const wire::Data& frame) {
  const std::size_t size = run.size(), arrivals = run.arrivals().size();
  const int before = run.Losses().contradicting_frames;
  EXPECT_FALSE(run.AddFrame(frame, 1)) << frame.tick;
  EXPECT_EQ(run.size(), size);
  EXPECT_EQ(run.arrivals().size(), arrivals);
  EXPECT_EQ(run.Losses().contradicting_frames, before + 1);
}

TEST(ReceivedRun, IgnoresAFrameThatIsNotAfterThePreviousOne) {
  ReceivedRun run(kRate);
  run.AddFrame(Frame(0, 100000, {1, 2, 3}), 0);
  ExpectContradicts(run, Frame(1, 100000, {1, 2, 3}));  // the same frame twice
  ExpectContradicts(run, Frame(1, 90000, {1}));
  ExpectContradicts(run, Frame(1, 110000, {1}));
  ExpectContradicts(run, Frame(1, 120000, {1}));
  EXPECT_TRUE(run.AddFrame(Frame(1, 130000, {4}), 1));
  EXPECT_EQ(run.Losses().samples, 0);
}

TEST(ReceivedRun, IgnoresAFrameOffTheGrid) {
  ReceivedRun run(kRate);
  run.AddFrame(Frame(0, 0, {1}), 0);
  ExpectContradicts(run, Frame(1, 10001, {2}));
  ExpectContradicts(run, Frame(1, 9999, {2}));
  ExpectContradicts(run, Frame(1, 25000, {2}));
  EXPECT_TRUE(run.AddFrame(Frame(1, 10000, {2}), 1));
}

TEST(ReceivedRun, IgnoresASampleThatOverlapsThePreviousSample) {
  ReceivedRun run({2500, 4});
  run.AddFrame(Frame(0, 0, {1}), 0);
  ExpectContradicts(run, Frame(1, 7500, {2}));
  EXPECT_TRUE(run.AddFrame(Frame(1, 10000, {2}), 1));
}

TEST(ReceivedRun, IgnoresSumsBeyondTheConverter) {
  ReceivedRun run(kRate);
  ExpectContradicts(run, Frame(0, 0, {1, 1024}));
  EXPECT_TRUE(run.AddFrame(Frame(0, 0, {1, 1023}), 0));
  ExpectContradicts(run, Frame(1, 20000, {}));
  ReceivedRun of_means({250, 64});
  ExpectContradicts(of_means, Frame(0, 0, {64 * 1023 + 1}));
  EXPECT_TRUE(of_means.AddFrame(Frame(0, 0, {64 * 1023}), 0));
}

// A frame that is half the counter's range later might equally be earlier.
TEST(ReceivedRun, RejectsAGapOfEighteenMinutes) {
  ReceivedRun run({250, 1});
  run.AddFrame(Frame(0, 0, {1}), 0);
  ExpectContradicts(run, Frame(1, 2147483750U, {2}));  // a multiple of 250, beyond 2^31
  EXPECT_TRUE(run.AddFrame(Frame(1, 2147483500U, {2}), 1074));
  EXPECT_EQ(run.Time(1), 1073.74175);
}

TEST(ReceivedRun, CountsIgnoredFramesAsLost) {
  ReceivedRun run(kRate);
  run.AddFrame(Frame(0, 0, {1}), 0);
  ExpectContradicts(run, Frame(1, 10000, {2000}));
  run.AddFrame(Frame(2, 20000, {3}), 0);
  run.SetEnd({3, 0, 0});
  EXPECT_EQ(run.Losses().samples, 1);
  EXPECT_EQ(run.Losses().contradicting_frames, 1);
}

}  // namespace
}  // namespace pendulum::received_run_test
