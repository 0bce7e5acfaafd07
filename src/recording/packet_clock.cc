// SPDX-License-Identifier: Apache-2.0
#include "recording/packet_clock.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pendulum/base/median.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Rows [first, last] that arrived together.
struct Packet {
  Index first, last;
  double stamp;  ///< Of the first row: later ones have waited for it.

  Index size() const { return last - first + 1; }
};

/// A step below this share of the mean step is within a packet.
constexpr double kInnerStep = 0.3;

std::vector<Packet> SplitIntoPackets(const Eigen::VectorXd& time) {
  const Index last = time.size() - 1;
  const double limit = kInnerStep * (time[last] - time[0]) / static_cast<double>(last);
  std::vector<Packet> packets = {{0, 0, time[0]}};
  for (Index i = 1; i <= last; ++i) {
    if (time[i] - time[i - 1] > limit) packets.push_back({i, i, time[i]});
    packets.back().last = i;
  }
  return packets;
}

double MedianRows(const std::vector<Packet>& packets) {
  std::vector<double> rows;
  for (const Packet& packet : packets) rows.push_back(static_cast<double>(packet.size()));
  return Median(std::move(rows));
}

/// The row of a packet whose true time its stamp follows.
enum class KeyRow { kLast, kFirst, kMiddle };

double RowOf(const Packet& packet, KeyRow key) {
  if (key == KeyRow::kMiddle) return 0.5 * static_cast<double>(packet.first + packet.last);
  return static_cast<double>(key == KeyRow::kLast ? packet.last : packet.first);
}

/// y over x.
struct ClockLine {
  double start = 0, slope = 0;

  double At(double x) const { return start + slope * x; }
};

struct RowStamp {
  double x, y;
};

ClockLine LeastSquaresLine(const std::vector<RowStamp>& points) {
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
  for (const auto& [x, y] : points) {
    mean_x += x / static_cast<double>(points.size());
    mean_y += y / static_cast<double>(points.size());
  }
  for (const auto& [x, y] : points) {
    xx += (x - mean_x) * (x - mean_x);
    xy += (x - mean_x) * (y - mean_y);
  }
  const double slope = xx > 0 ? xy / xx : 0;
  return {mean_y - slope * mean_x, slope};
}

/// The base line of the stamps: the line through one point for each of several blocks of packets.
struct BaseLine {
  ClockLine line;
  std::vector<RowStamp> base;  ///< Of each block: row, and deviation of its stamp from the line.
  double largest = 0;          ///< Largest of these deviations.
  double scatter = 0;          ///< Standard deviation of the base of a block, from its even and odd packets.
  double range = 0;            ///< Usual range of the deviations of all packets: 95 % are within it.

  /// Whether neighbouring blocks deviate alike, as after lost rows or with a drift (von Neumann's ratio, which is 2 for
  /// independent deviations). False for few blocks, which do not tell.
  bool HasTrend() const {
    constexpr std::size_t kMinBlocks = 8;
    constexpr double kLeastRatio = 1;
    double squares = 0, differences = 0;
    for (std::size_t i = 0; i < base.size(); ++i) {
      squares += base[i].y * base[i].y;
      if (i > 0) differences += (base[i].y - base[i - 1].y) * (base[i].y - base[i - 1].y);
    }
    return base.size() >= kMinBlocks && differences < kLeastRatio * squares;
  }
};

class BaseLineFit {
 public:
  BaseLineFit(const std::vector<Packet>& packets, KeyRow key) : takes_mean_(key == KeyRow::kMiddle) {
    for (const Packet& packet : packets) points_.push_back({RowOf(packet, key), packet.stamp});
    constexpr std::size_t kPacketsInBlock = 8, kMinBlocks = 4, kMaxBlocks = 24;
    blocks_ = std::clamp(points_.size() / kPacketsInBlock, kMinBlocks, kMaxBlocks);
  }

  BaseLine Fit() const {
    constexpr int kIterations = 6;
    BaseLine found;
    found.line = LeastSquaresLine(points_);
    for (int i = 0; i < kIterations; ++i) {
      const ClockLine correction = LeastSquaresLine(Base(found.line));
      found.line.start += correction.start;
      found.line.slope += correction.slope;
    }
    found.base = Base(found.line);
    for (const RowStamp& point : found.base) found.largest = std::max(found.largest, std::abs(point.y));
    found.scatter = Scatter(found.line);
    found.range = Range(found.line);
    return found;
  }

 private:
  std::size_t Begin(std::size_t block) const { return block * points_.size() / blocks_; }

  /// The base of the points begin, begin + step, ... before end, relative to the line.
  RowStamp BaseOf(const ClockLine& line, std::size_t begin, std::size_t end, std::size_t step) const {
    RowStamp base{0, std::numeric_limits<double>::infinity()};
    RowStamp sum{0, 0};
    double count = 0;
    for (std::size_t i = begin; i < end; i += step) {
      const RowStamp point{points_[i].x, points_[i].y - line.At(points_[i].x)};
      sum.x += point.x;
      sum.y += point.y;
      ++count;
      if (point.y < base.y) base = point;
    }
    return takes_mean_ ? RowStamp{sum.x / count, sum.y / count} : base;
  }

  std::vector<RowStamp> Base(const ClockLine& line) const {
    std::vector<RowStamp> base;
    for (std::size_t block = 0; block < blocks_; ++block) {
      base.push_back(BaseOf(line, Begin(block), Begin(block + 1), 1));
    }
    return base;
  }

  double Range(const ClockLine& line) const {
    std::vector<double> deviations;
    for (const RowStamp& point : points_) deviations.push_back(point.y - line.At(point.x));
    std::ranges::sort(deviations);
    const std::size_t end = deviations.size() / 40;
    return deviations[deviations.size() - 1 - end] - deviations[end];
  }

  double Scatter(const ClockLine& line) const {
    double sum = 0;
    for (std::size_t block = 0; block < blocks_; ++block) {
      const double difference =
          BaseOf(line, Begin(block), Begin(block + 1), 2).y - BaseOf(line, Begin(block) + 1, Begin(block + 1), 2).y;
      sum += difference * difference / 2;
    }
    return std::sqrt(sum / static_cast<double>(blocks_));
  }

  std::vector<RowStamp> points_;  ///< Row and stamp of each packet.
  std::size_t blocks_;
  bool takes_mean_;
};

/// The interval between rows of the packets that advance as most do, and its standard error.
struct Measured {
  double value, std_dev;
};

Measured CentralInterval(const std::vector<Packet>& packets, KeyRow key) {
  struct Step {
    double rows, time;
  };
  std::vector<Step> steps;
  for (std::size_t i = 1; i < packets.size(); ++i) {
    steps.push_back({RowOf(packets[i], key) - RowOf(packets[i - 1], key), packets[i].stamp - packets[i - 1].stamp});
  }
  std::ranges::sort(steps, {}, [](const Step& step) { return step.time / step.rows; });
  const std::size_t quarter = steps.size() / 4;
  Step sum{0, 0};
  for (std::size_t i = quarter; i < steps.size() - quarter; ++i) {
    sum.rows += steps[i].rows;
    sum.time += steps[i].time;
  }
  const auto at = [&](std::size_t i) { return steps[i].time / steps[i].rows; };
  const double spread = at(steps.size() - 1 - quarter) - at(quarter);
  return {sum.time / sum.rows, spread / std::sqrt(static_cast<double>(steps.size()))};
}

/// How the values change from one row to the next between packets, compared with the change within packets: 1 if the
/// rows are evenly sampled, 2 if a row is missing between packets. The change is measured in units of the mean change
/// over the rows around, so the result does not depend on the sampling.
class ContinuityOfValues {
 public:
  ContinuityOfValues(const Eigen::VectorXd& value, const std::vector<Packet>& packets)
      : value_(value), reach_(Reach()) {
    std::vector<bool> starts_packet(static_cast<std::size_t>(value.size()), false);
    for (const Packet& packet : packets) starts_packet[static_cast<std::size_t>(packet.first)] = true;
    for (Index i = reach_; i + 1 + reach_ < value.size(); ++i) {
      Add(starts_packet[static_cast<std::size_t>(i + 1)] ? between_ : within_, i);
    }
  }

  /// std_dev is infinite if the values do not tell.
  Measured Ratio() const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const Measured between = between_.Get(), within = within_.Get();
    if (std::isinf(within.std_dev) || std::isinf(between.std_dev)) return {1, kInfinity};
    if (within.value > 4 * within.std_dev) {
      const double ratio = between.value / within.value;
      return {ratio, std::hypot(between.std_dev, ratio * within.std_dev) / within.value};
    }
    // Only a lower limit of the ratio is known.
    const double most_within = std::max(within.value, 0.0) + 4 * within.std_dev;
    if (!(between.value - 4 * between.std_dev > 1.5 * most_within)) return {1, kInfinity};
    return {between.value / std::max(most_within, 0.01 * between.value), 0};
  }

 private:
  /// Sums for the regression of the change of the values on the mean change around.
  struct Sums {
    double xx = 0, xy = 0, yy = 0;
    Index count = 0;

    Measured Get() const {
      if (count < 8 || !(xx > 0)) return {0, std::numeric_limits<double>::infinity()};
      const double slope = xy / xx;
      const double residual = std::max(yy - slope * xy, 0.0) / static_cast<double>(count - 1);
      return {slope, std::sqrt(residual / xx)};
    }
  };

  /// The largest power of 2 with at most a sixth of a period on each side, so that the mean change around is nearly the
  /// slope.
  Index Reach() const {
    const double spread = std::sqrt((value_.array() - value_.mean()).square().mean());
    Index reach = 1;
    for (constexpr Index kMaxReach = 32; reach < kMaxReach && 8 * reach < value_.size(); reach *= 2) {
      const Index span = 4 * reach + 1;
      const Index count = value_.size() - span;
      const double change = std::sqrt((value_.tail(count) - value_.head(count)).array().square().mean());
      if (change > spread) break;
    }
    return reach;
  }

  void Add(Sums& sums, Index i) const {
    const double x = (value_[i + 1 + reach_] - value_[i - reach_]) / static_cast<double>(2 * reach_ + 1);
    const double y = value_[i + 1] - value_[i];
    sums.xx += x * x;
    sums.xy += x * y;
    sums.yy += y * y;
    ++sums.count;
  }

  const Eigen::VectorXd& value_;
  Index reach_;
  Sums within_, between_;
};

/// Rows between which the base line deviates most from the rate of most packets.
void LocateUnevenness(const BaseLine& base_line, double interval, PacketClockSearch& search) {
  double largest = -1;
  for (std::size_t i = 1; i < base_line.base.size(); ++i) {
    const RowStamp &before = base_line.base[i - 1], &after = base_line.base[i];
    const double excess = (base_line.line.slope - interval) * (after.x - before.x) + after.y - before.y;
    if (std::abs(excess) <= largest) continue;
    largest = std::abs(excess);
    search.uneven_from = static_cast<Index>(before.x);
    search.uneven_to = static_cast<Index>(after.x);
  }
}

/// The relative standard error of the interval. A lost row moves the base line by one interval. A single one changes
/// the slope of the line by at most three times the deviation that it causes; many that are lost at random by more,
/// because their deviations partly cancel.
double RelativeError(const BaseLine& base_line, double grid, double span) {
  const double interval = base_line.line.slope;
  const double few_blocks = 1 + 8 / static_cast<double>(base_line.base.size());
  const double scatter =
      std::max(2 * few_blocks * base_line.largest, 3 * base_line.largest * base_line.largest / interval);
  return std::hypot(scatter, grid / std::sqrt(3.0)) / span;
}

/// Whether nothing but latencies and rounding moves the stamps from the base line.
bool IsStraight(const BaseLine& base_line, const std::vector<Packet>& packets, KeyRow key, double grid) {
  constexpr double kScatters = 4, kStdDevs = 4, kMinShare = 0.005;
  const double interval = base_line.line.slope;
  const double explained = kScatters * base_line.scatter + grid;
  if (base_line.largest > std::max(explained, interval / 4)) return false;
  if (base_line.largest > interval / 4 + grid && base_line.HasTrend()) return false;
  // Packets that are lost regularly leave the base line straight, but then latencies seem as long as a packet.
  if (base_line.range < 0.6 * interval * MedianRows(packets)) return true;
  const Measured central = CentralInterval(packets, key);
  return std::abs(central.value - interval) <= kStdDevs * central.std_dev + kMinShare * interval;
}

/// The key row whose base line is straightest. Others than the last row must be much better, so that chance does not
/// select them.
PacketClockSearch SearchBaseLine(const std::vector<Packet>& packets, double grid) {
  constexpr double kMuchLess = 0.5, kLargestError = 0.003;
  const double span = packets.back().stamp - packets.front().stamp;
  PacketClockSearch search;
  double least_error = std::numeric_limits<double>::infinity();
  for (const KeyRow key : {KeyRow::kLast, KeyRow::kFirst, KeyRow::kMiddle}) {
    const BaseLine base_line = BaseLineFit(packets, key).Fit();
    const double error = RelativeError(base_line, grid, span);
    if (!(base_line.line.slope > 0) || error > kMuchLess * least_error) continue;
    least_error = error;
    search.clock = {base_line.line.start, base_line.line.slope, error};
    const bool is_found = error < kLargestError && IsStraight(base_line, packets, key, grid);
    search.verdict = is_found ? PacketClockVerdict::kFound : PacketClockVerdict::kUneven;
    LocateUnevenness(base_line, CentralInterval(packets, key).value, search);
  }
  return search;
}

/// A few packets are consistent with uniform sampling if all inner ones have the same number of rows and the same step.
PacketClockSearch SearchFewPackets(const std::vector<Packet>& packets) {
  constexpr std::size_t kMinPackets = 4;
  constexpr double kTolerance = 0.02;
  PacketClockSearch search;
  if (packets.size() < kMinPackets) return search;
  const Packet &first = packets.front(), &last = packets.back();
  search.clock.start = first.stamp;
  search.clock.interval = (last.stamp - first.stamp) / static_cast<double>(last.first - first.first);
  for (std::size_t i = 1; i < packets.size(); ++i) {
    const auto rows = static_cast<double>(packets[i].first - packets[i - 1].first);
    const double step = packets[i].stamp - packets[i - 1].stamp;
    if (std::abs(step - rows * search.clock.interval) > kTolerance * step) return search;
  }
  search.verdict = PacketClockVerdict::kTooFewPackets;
  return search;
}

bool HasInnerSteps(const std::vector<Packet>& packets, const Eigen::VectorXd& time) {
  return std::ranges::any_of(packets, [&](const Packet& packet) { return time[packet.last] > time[packet.first]; });
}

}  // namespace

Packets FindPackets(const Eigen::VectorXd& time) {
  const Index last = time.size() - 1;
  if (last < 1 || !(time[last] > time[0])) return {};
  const std::vector<Packet> packets = SplitIntoPackets(time);
  return {static_cast<Index>(packets.size()), MedianRows(packets), HasInnerSteps(packets, time)};
}

PacketClockSearch FindPacketClock(const StampedRows& rows) {
  constexpr std::size_t kMinPackets = 8;
  const std::vector<Packet> packets = SplitIntoPackets(rows.time);
  PacketClockSearch search =
      packets.size() < kMinPackets ? SearchFewPackets(packets) : SearchBaseLine(packets, rows.grid);
  constexpr double kStdDevs = 3, kTolerance = 0.25;
  const Measured continuity = ContinuityOfValues(rows.value, packets).Ratio();
  const double error = kStdDevs * continuity.std_dev;
  // If the stamps were right, the values would change by at least 1 / kInnerStep times more between packets.
  if (HasInnerSteps(packets, rows.time) && !(continuity.value + error < 2)) {
    search.verdict = PacketClockVerdict::kTrueStamps;
  } else if (std::abs(continuity.value - 1) > kTolerance + error) {
    search.verdict = PacketClockVerdict::kUneven;
  }
  return search;
}

}  // namespace pendulum
