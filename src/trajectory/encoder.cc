// SPDX-License-Identifier: Apache-2.0
#include "pendulum/trajectory/encoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>

#include <boost/math/tools/toms748_solve.hpp>
#include <boost/random/normal_distribution.hpp>

#include "pendulum/base/physics.h"

namespace pendulum {
namespace {

/// The point in [a, b] where f changes its sign.
template <typename Function>
double Root(const Function& f, double a, double b) {
  const double at_a = f(a);
  const double at_b = f(b);
  if (at_a == 0) return a;
  if (at_b == 0 || (at_a > 0) == (at_b > 0)) return b;
  std::uintmax_t most = 100;
  const auto near = boost::math::tools::eps_tolerance<double>(50);
  return boost::math::tools::toms748_solve(f, a, b, at_a, at_b, near, most).second;
}

/// Counts the edges that an angle, known at every time, crosses.
class Counter {
 public:
  Counter(const Trajectory& trajectory, const SyntheticOptions& options)
      : trajectory_(trajectory),
        options_(options),
        generator_(options.seed),
        count_(std::round(Position(options.start_time))) {
    DrawEdges();
  }

  std::vector<CountChange> Run(double end) {
    constexpr double kSteps = 2000;  // per small-angle period
    const double step = 2 * kPi * std::sqrt(options_.parameters.front()) / kSteps;
    for (double from = options_.start_time; from < end;) {
      const double to = std::min(from + step, end);
      const bool turns = trajectory_.Rate(from) * trajectory_.Rate(to) < 0;
      const double turn = turns ? Root([&](double t) { return trajectory_.Rate(t); }, from, to) : to;
      Move(from, turn);
      Move(turn, to);
      from = to;
    }
    return std::move(changes_);
  }

 private:
  double Position(double time) const { return (trajectory_.Angle(time) + options_.zero) / options_.resolution; }

  /// Draws errors for both edges of the new count.
  void DrawEdges() {
    boost::random::normal_distribution<double> draw(0, options_.noise / options_.resolution);
    for (double& edge : edges_) edge = draw(generator_);
    edges_[0] += count_ - 0.5;
    edges_[1] += count_ + 0.5;
  }

  /// Records the changes of an interval in which the direction of motion does not change.
  void Move(double from, double to) {
    if (!(from < to)) return;
    const double last = Position(to);
    const bool up = last > Position(from);
    const double direction = up ? 1 : -1;
    const double lag = direction * options_.hysteresis / options_.resolution;
    const double& ahead = up ? edges_[1] : edges_[0];
    while (direction * (last - ahead - lag) > 0) {
      const double edge = ahead + lag;
      const bool beyond = direction * (Position(from) - edge) >= 0;
      if (!beyond) from = Root([&](double t) { return Position(t) - edge; }, from, to);
      count_ += direction;
      changes_.push_back({from, count_});
      DrawEdges();
    }
  }

  const Trajectory& trajectory_;
  const SyntheticOptions& options_;
  std::mt19937_64 generator_;
  double count_;
  std::array<double, 2> edges_{};  // lower and upper edge, in counts
  std::vector<CountChange> changes_;
};

/// One row for each change, preceded by a first row.
void ReadEvents(const std::vector<CountChange>& changes, const SyntheticOptions& options, double first_count,
                Recording& recording) {
  std::mt19937_64 generator(~options.seed);  // independent of the draws for the edges
  boost::random::normal_distribution<double> draw(0, options.time_noise);
  const auto count = static_cast<Eigen::Index>(changes.size());
  recording.time.resize(count + 1);
  recording.value.resize(count + 1);
  recording.time[0] = options.start_time;
  recording.value[0] = first_count * options.resolution;
  for (Eigen::Index i = 0; i < count; ++i) {
    const CountChange& change = changes[static_cast<std::size_t>(i)];
    const double next = std::nextafter(recording.time[i], std::numeric_limits<double>::infinity());
    recording.time[i + 1] = std::max(change.time + draw(generator), next);
    recording.value[i + 1] = change.count * options.resolution;
  }
}

/// The current count at each instant.
void ReadEvenly(const std::vector<CountChange>& changes, const SyntheticOptions& options, double first_count,
                const Eigen::VectorXd& instants, Recording& recording) {
  recording.time = instants;
  recording.value.resize(instants.size());
  double count = first_count;
  std::size_t next = 0;
  for (Eigen::Index i = 0; i < instants.size(); ++i) {
    for (; next < changes.size() && changes[next].time <= instants[i]; ++next) count = changes[next].count;
    recording.value[i] = count * options.resolution;
  }
}

}  // namespace

std::vector<CountChange> CountChanges(const Trajectory& trajectory, const SyntheticOptions& options, double end) {
  return Counter(trajectory, options).Run(end);
}

void ReadEncoder(const Trajectory& trajectory, const SyntheticOptions& options, const Eigen::VectorXd& instants,
                 Recording& recording) {
  const std::vector<CountChange> changes = CountChanges(trajectory, options, instants[instants.size() - 1]);
  const double first = std::round((trajectory.Angle(options.start_time) + options.zero) / options.resolution);
  if (options.rows == RowTiming::kEvents) {
    ReadEvents(changes, options, first, recording);
  } else {
    ReadEvenly(changes, options, first, instants, recording);
  }
}

}  // namespace pendulum
