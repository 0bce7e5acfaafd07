// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

namespace pendulum {

/// Tells when a pendulum that swung has come to rest: for kRestSeconds its reading has stayed within what rounding and
/// noise make of one angle, and the turning points before lay on both sides of that angle. A pendulum that is held
/// before it is released has not swung, and is not at rest. Made for 32 samples a second and more, and noise of up to
/// two counts.
class RestDetector {
 public:
  static constexpr double kRestSeconds = 5;

  /// The next sample: time [s], rising, and reading [counts].
  void Take(double time, double counts);

  bool IsAtRest() const;

  /// Whether there were as many turning points as a swing has.
  bool HasSwung() const { return turns_.size() == kTurns; }

 private:
  /// Samples of a tenth of a second or a little more, of which the mean counts.
  struct Block {
    double time = 0;
    double sum = 0, squares = 0;
    double low = 0, high = 0;  // counts
    int count = 0;

    double Mean() const { return sum / count; }
    double Variance() const;  // of one sample, as noise makes it
  };

  static constexpr std::size_t kTurns = 4;  // the last ones are kept

  void Close();
  void FollowTurns(double mean);

  Block open_;
  std::deque<Block> blocks_;  // of the last kRestSeconds
  std::deque<double> turns_;  // readings at the last turning points
  double extreme_ = 0;        // since the last turning point
  int direction_ = 0;         // of the motion since then
  bool is_begun_ = false;
};

}  // namespace pendulum
