// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

namespace pendulum {

/// Detects when a pendulum that swung has come to rest. For kRestSeconds its readings must stay within the rounding and
/// noise about one angle, and the preceding turning points must lie alternately on both sides of that angle. A pendulum
/// held before its release has not swung, so it does not count as at rest. Designed for at least 32 samples per second
/// and noise of up to two counts.
class RestDetector {
 public:
  static constexpr double kRestSeconds = 5;

  /// Adds the next sample: time [s], increasing, and reading [counts].
  void AddSample(double time, double counts);

  bool IsAtRest() const;

  /// Whether there were as many turning points as a swing must have.
  bool HasSwung() const { return turns_.size() == kTurns; }

 private:
  /// Samples of at least a tenth of a second, which are averaged.
  struct Block {
    double time = 0;
    double sum = 0, squares = 0;
    double low = 0, high = 0;  // counts
    int count = 0;

    double Mean() const { return sum / count; }
    double Variance() const;  // of one sample, caused by noise
  };

  static constexpr std::size_t kTurns = 4;  // only the last ones are kept

  void Close();
  void TrackTurningPoints(double mean);

  Block open_;
  std::deque<Block> blocks_;  // of the last kRestSeconds
  std::deque<double> turns_;  // readings at the last turning points
  double extreme_ = 0;        // extreme reading since the last turning point
  int direction_ = 0;         // direction of the motion since the last turning point
  bool is_begun_ = false;
};

}  // namespace pendulum
