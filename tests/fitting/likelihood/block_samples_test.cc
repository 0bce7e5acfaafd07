// SPDX-License-Identifier: Apache-2.0
#include "fitting/likelihood/block_samples.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::block_samples_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAreArray;
using testing::Pointwise;

using Samples = BlockSamples<double, false, 1, double>;

/// The readings of the blocks in sample order, and their sums in the order of addition.
struct Collected {
  std::vector<double> readings;
  std::vector<double> sums;
  bool is_complete = false;
};

/// Passes segments of the line 3 t + 1 that begin at multiples of `length`, up to `end`.
Collected PassLine(Samples& samples, const std::vector<double>& time, int threads, double length, double end) {
  Collected collected;
  collected.readings.resize(time.size());
  samples.Restart(time, threads);
  const auto work = [&](SampleBlock<1>& block, std::size_t first, int count, double& sum) {
    sum = 0;
    for (int i = 0; i < count; ++i) sum += collected.readings[first + i] = block.row[0][i];
  };
  const auto add = [&](double sum) { collected.sums.push_back(sum); };
  for (double start = 0; start < end; start += length) {
    Segment<double> segment;
    segment.start = start;
    segment.end = start + length;
    segment.order = 1;
    segment.angle[0] = 3 * start + 1;
    segment.angle[1] = 3;
    samples.AddSegment(segment, work, add);
  }
  collected.is_complete = samples.is_complete();
  return collected;
}

std::vector<double> Times(std::size_t count) {
  std::vector<double> time(count);
  for (std::size_t i = 0; i < count; ++i) time[i] = 0.01 * static_cast<double>(i);
  return time;
}

std::vector<double> Line(const std::vector<double>& time) {
  std::vector<double> line;
  for (const double t : time) line.push_back(3 * t + 1);
  return line;
}

TEST(BlockSamples, EvaluatesEachSampleWithItsOwnSegment) {
  for (const std::size_t count : {1UL, 255UL, 256UL, 257UL, 1000UL}) {
    const std::vector<double> time = Times(count);
    for (const double length : {0.003, 0.01, 0.37, 2.56, 100.0}) {
      Samples samples;
      const Collected collected = PassLine(samples, time, 1, length, time.back() + 1e-9);
      EXPECT_TRUE(collected.is_complete);
      EXPECT_THAT(collected.readings, Pointwise(DoubleNear(1e-12), Line(time))) << count << ", " << length;
    }
  }
}

// There are more segments than are stored before evaluation, and more blocks than one thread takes.
TEST(BlockSamples, SumsInTheSameOrderOnAnyNumberOfThreads) {
  const std::vector<double> time = Times(150'000);
  for (const double length : {0.013, 7.7}) {
    Samples alone;
    const Collected one = PassLine(alone, time, 1, length, 1e4);
    EXPECT_THAT(one.readings, Pointwise(DoubleNear(1e-9), Line(time)));
    Samples shared;
    const Collected three = PassLine(shared, time, 3, length, 1e4);
    EXPECT_THAT(three.readings, ElementsAreArray(one.readings));
    EXPECT_THAT(three.sums, ElementsAreArray(one.sums));
  }
}

TEST(BlockSamples, RestartsAfterAnAbandonedTrace) {
  for (const std::size_t count : {1'000UL, 150'000UL}) {  // the second is shared among threads
    const std::vector<double> time = Times(count);
    Samples samples;
    EXPECT_FALSE(PassLine(samples, time, 3, 0.37, 0.4 * time.back()).is_complete);
    const Collected again = PassLine(samples, time, 3, 0.37, 2 * time.back());
    EXPECT_TRUE(again.is_complete);
    EXPECT_THAT(again.readings, Pointwise(DoubleNear(1e-9), Line(time))) << count;
  }
}

}  // namespace
}  // namespace pendulum::block_samples_test
