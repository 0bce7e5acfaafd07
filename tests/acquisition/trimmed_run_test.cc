// SPDX-License-Identifier: Apache-2.0
// Tests of runs that are cut at the planned end of the recording, and of runs with losses of several kinds.
#include <cstdint>

#include <gtest/gtest.h>

#include "pendulum/acquisition/received_run.h"

namespace pendulum::trimmed_run_test {
namespace {

constexpr SamplingRate kRate{10000, 1};  // 200 Hz
constexpr int kBlock = 8;                // samples in a frame: 25 frames per second

/// Frame `number` of a run without losses: samples 8 n to 8 n + 7, all 500.
pendulum_logger::Data Frame(int number) {
  pendulum_logger::Data frame{};
  frame.sequence = static_cast<std::uint16_t>(number);
  frame.tick = static_cast<std::uint32_t>(number * kBlock * kRate.Ticks());
  for (; frame.count < kBlock; ++frame.count) frame.sums[frame.count] = 500;
  return frame;
}

/// Frames 0 to `last`, without frames first_lost to last_lost.
ReceivedRun RunOf(int last, int first_lost, int last_lost) {
  ReceivedRun run(kRate);
  for (int i = 0; i <= last; ++i) {
    if (i < first_lost || i > last_lost) run.AddFrame(Frame(i), 0.04 * i);
  }
  return run;
}

TEST(KeepUntil, KeepsEarlierSamples) {
  ReceivedRun run = RunOf(60, 99, 99);
  run.KeepUntil(2);
  EXPECT_EQ(run.size(), 400U);
  EXPECT_DOUBLE_EQ(run.Time(399), 1.995);
  EXPECT_EQ(run.Losses().samples, 0);
}

TEST(KeepUntil, CountsALossAcrossTheEndUpToTheEnd) {
  ReceivedRun run = RunOf(60, 48, 51);  // samples 384 to 415 are lost; sample 400 is the first after the end
  run.KeepUntil(2);
  EXPECT_EQ(run.size(), 384U);
  EXPECT_EQ(run.Losses().samples, 16);
  EXPECT_EQ(run.Losses().on_line, 16);
}

TEST(KeepUntil, CountsALossJustBeforeTheEnd) {
  ReceivedRun run = RunOf(50, 49, 49);  // the last eight before the end; later frames show that they are missing
  run.KeepUntil(2);
  EXPECT_EQ(run.size(), 392U);
  EXPECT_EQ(run.Losses().samples, 8);
}

TEST(KeepUntil, IgnoresALossAfterTheEnd) {
  ReceivedRun run = RunOf(60, 50, 55);
  run.SetEnd({61 * kBlock, 0, 0});
  run.KeepUntil(2);
  EXPECT_EQ(run.size(), 400U);
  EXPECT_EQ(run.Losses().samples, 0);
  EXPECT_TRUE(run.Losses().is_end_known);
}

TEST(KeepUntil, KeepsAShorterRunUnchanged) {
  ReceivedRun run = RunOf(10, 99, 99);
  run.SetEnd({12 * kBlock, 0, 0});
  run.KeepUntil(2);
  EXPECT_EQ(run.size(), 88U);
  EXPECT_EQ(run.Losses().samples, 8);  // sent after the last frame that arrived
}

/// Three conversions were late, so their samples are missing. Then a whole frame is lost after the last one received.
TEST(Losses, AreSummedOverLateSamplesAndLostFrames) {
  ReceivedRun run(kRate);
  run.AddFrame(Frame(0), 0);
  pendulum_logger::Data late = Frame(1);
  late.tick += static_cast<std::uint32_t>(3 * kRate.Ticks());
  late.late = 3;
  run.AddFrame(late, 0);
  run.SetEnd({3 * kBlock, 0, 3});
  EXPECT_EQ(run.Losses().samples, 3 + 8);
  EXPECT_EQ(run.Losses().on_line, 8);
}

/// The logger dropped 200 000 samples, as its ticks show, but its counter stops at 65535.
TEST(Losses, AreNotCountedTwiceForASaturatedFrameCounter) {
  ReceivedRun run(kRate);
  run.AddFrame(Frame(0), 0);
  pendulum_logger::Data after = Frame(1);
  after.tick += static_cast<std::uint32_t>(200000 * kRate.Ticks());
  after.dropped = 65535;
  ASSERT_TRUE(run.AddFrame(after, 1000));
  run.SetEnd({2 * kBlock, 200000, 0});
  EXPECT_EQ(run.Losses().samples, 200000);
  EXPECT_EQ(run.Losses().on_line, 0);
}

/// The CRC of the frame is right by chance. The host's clock shows that so much time has not passed.
TEST(ReceivedRun, IgnoresAFrameFromTheFuture) {
  ReceivedRun run = RunOf(2, 99, 99);
  pendulum_logger::Data stray = Frame(3);
  stray.tick += static_cast<std::uint32_t>(20000 * kRate.Ticks());  // 100 s
  EXPECT_FALSE(run.AddFrame(stray, 0.2));
  EXPECT_TRUE(run.AddFrame(Frame(3), 0.2));
  EXPECT_EQ(run.Losses().samples, 0);
}

}  // namespace
}  // namespace pendulum::trimmed_run_test
