// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/clock.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "pendulum/base/format.h"
#include "pendulum/base/median.h"
#include "pendulum/base/try.h"
#include "recording/packet_clock.h"
#include "recording/significant_digits.h"
#include "recording/stamp_order.h"
#include "recording/uniform_clock.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Check = Result<void>;

/// Digits of a time in a message: all that a double keeps, so that a counter is shown without an exponent.
constexpr int kDigits = 15;

std::string Count(Index count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

std::string PacketsText(const Packets& packets) {
  return "the rows come in " + std::to_string(packets.count) + " packets of about " + NumberText(packets.rows) +
         " rows";
}

/// A relative error of the times in a message.
std::string ErrorText(double share) {
  const auto percent = [](double each) { return NumberText(100 * each, 2) + " %"; };
  return "an error of " + percent(share) + " in times and " + percent(2 * share) + " in inertia";
}

/// A counter has whole numbers and drops by nearly its whole range when it wraps around.
struct Counter {
  const char* range_text;
  double range;
  double first;
};

constexpr std::array kCounters = {Counter{"2^32", 4294967296.0, 0}, Counter{"2^16", 65536.0, 0},
                                  Counter{"2^16", 65536.0, -32768.0}};

double PerSecond(const std::string& time_unit) { return time_unit == "s" ? 1 : time_unit == "ms" ? 1e3 : 1e6; }

/// Rows begin <= i < end.
struct RowRange {
  Index begin, end;

  Index size() const { return end - begin; }
};

/// The first rows in succession that are in the window.
RowRange RowsInWindow(const RawSamples& samples, const ClockWindow& window) {
  const double per_second = PerSecond(samples.time_unit);
  const Eigen::VectorXd& time = samples.time;
  Index begin = 0;
  while (begin < time.size() && time[begin] < window.from * per_second) ++begin;
  Index end = begin;
  while (end < time.size() && !(time[end] > window.to * per_second)) ++end;
  return {begin, end};
}

/// Median of the forward steps; 0 if there is none.
double MedianForwardStep(const Eigen::VectorXd& time) {
  std::vector<double> steps;
  for (Index i = 1; i < time.size(); ++i) {
    if (time[i] > time[i - 1]) steps.push_back(time[i] - time[i - 1]);
  }
  return steps.empty() ? 0 : Median(std::move(steps));
}

/// Repairs the time stamps of one file.
class ClockRepair {
 public:
  explicit ClockRepair(RawSamples samples) : samples_(std::move(samples)) {}

  Result<RawSamples> Repair();
  void KeepOnly(const RowRange& rows);

 private:
  const Eigen::VectorXd& time() const { return samples_.time; }
  Index size() const { return samples_.time.size(); }

  std::string TimeText(double time) const { return NumberText(time, kDigits) + " " + samples_.time_unit; }
  std::string LineText(Index row) const { return samples_.name + ":" + std::to_string(samples_.lines.LineOf(row)); }
  tl::unexpected<Status> Fault(Index row, const std::string& sentence) const {
    return pendulum::Fault(LineText(row), sentence);
  }
  void Warn(Index row, Warning warning) {
    warning.about.file = samples_.name;
    warning.about.line = samples_.lines.LineOf(row);
    samples_.warnings.push_back(std::move(warning));
  }

  bool IsUniform() const;
  bool Increases() const;
  double MedianStep() const;
  std::vector<Index> Wraps(const Counter& counter) const;
  bool IsLikely(const Counter& counter, const std::vector<Index>& wraps) const;
  void Unwrap();
  std::optional<double> Grid() const;
  bool IsNotDecreasing() const;
  Index CountUnusualSteps(double grid) const;
  Index FirstSharedRow() const;
  Index CountSharedRows(std::vector<bool>& keep) const;
  bool IsOwnGrid(double grid) const;
  bool MakeUniform(double grid);
  bool MakeUniformFromDigits();
  bool IsEventDriven() const;
  Result<bool> MakeUniformFromPackets();
  double RateHz(double interval) const;
  std::string EvenText(double interval, const std::string& why) const;
  std::string ReplacementText(double interval, double tolerance) const;
  void UseClock(double start, double interval, double std_dev);
  std::string UnevenText(const PacketClockSearch& found) const;
  void WarnOfPackets(const Packets& packets, const PacketClockSearch& found);
  tl::unexpected<Status> SharedStampsFault(const PacketClockSearch& found) const;
  void RemoveRepeatedEnds();
  bool SharedRowsAreEqual() const;
  bool IsSameRow(Index a, Index b) const {
    return time()[a] == time()[b] && samples_.value[a] == samples_.value[b] &&
           (samples_.second.size() == 0 || samples_.second[a] == samples_.second[b]);
  }
  Check RemoveRowsWithSharedStamps();
  void RemoveStrayStamps();
  Check RemoveBackwardRows();
  void KeepRows(const std::vector<bool>& keep);
  void WarnOfScatter();

  RawSamples samples_;
};

/// True if all steps agree within 9 % of their mean. Then nothing has to be repaired, whatever the grid.
bool ClockRepair::IsUniform() const {
  const Index steps = size() - 1;
  if (steps < 1) return true;
  double least = time()[1] - time()[0], largest = least;
  for (Index i = 1; i < steps; ++i) {
    const double step = time()[i + 1] - time()[i];
    least = std::min(least, step);
    largest = std::max(largest, step);
  }
  const double mean = (time()[steps] - time()[0]) / static_cast<double>(steps);
  return least > 0 && largest - least < 0.09 * mean;
}

bool ClockRepair::Increases() const {
  for (Index i = 1; i < size(); ++i) {
    if (time()[i] <= time()[i - 1]) return false;
  }
  return true;
}

bool ClockRepair::IsNotDecreasing() const { return std::is_sorted(time().begin(), time().end()); }

double ClockRepair::MedianStep() const { return MedianForwardStep(time()); }

// ---- Counters that wrap around -----------------------------------------------------------------------------------

/// The rows where the counter wraps around; empty if the times cannot come from this counter.
std::vector<Index> ClockRepair::Wraps(const Counter& counter) const {
  std::vector<Index> wraps;
  for (Index i = 0; i < size(); ++i) {
    const double count = time()[i] - counter.first;
    if (count != std::floor(count) || count < 0 || count >= counter.range) return {};
    if (i > 0 && time()[i] - time()[i - 1] < -counter.range / 2) wraps.push_back(i);
  }
  return wraps;
}

/// Whether the steps across the wraps are like the other steps. A range of 16 bits is so short that a clock set back,
/// or a long gap, could look like a wrap. All steps of a 16-bit counter must therefore be alike, except short gaps.
bool ClockRepair::IsLikely(const Counter& counter, const std::vector<Index>& wraps) const {
  constexpr double kUsualSteps = 10, kAlike = 2, kShortGap = 1.0 / 64;
  const double usual = MedianStep();
  const bool is_short = counter.range < kCounters.front().range;
  double largest = 0;
  for (Index i = 1; i < size(); ++i) largest = std::max(largest, time()[i] - time()[i - 1]);
  const double limit = is_short ? kAlike * usual + 1 : std::max(largest, kUsualSteps * usual);
  for (const Index i : wraps) {
    if (time()[i] + counter.range - time()[i - 1] > limit) return false;
    for (Index k = i + 1; k < std::min(i + kMaxStepsBack, size()); ++k) {
      if (time()[k] - time()[k - 1] > counter.range / 2) return false;  // the return from a stamp that lost a digit
    }
  }
  if (!is_short) return true;
  const double longest = std::max(limit, kShortGap * counter.range);
  for (Index i = 1; i < size(); ++i) {
    double step = time()[i] - time()[i - 1];
    if (step < -counter.range / 2) step += counter.range;
    if (step < usual / kAlike - 1 || step > longest) return false;
  }
  return true;
}

void ClockRepair::Unwrap() {
  if (samples_.time_unit == "s") return;
  for (const Counter& counter : kCounters) {
    const std::vector<Index> wraps = Wraps(counter);
    if (wraps.empty() || !IsLikely(counter, wraps)) continue;
    Warn(wraps.front(),
         {.code = "time_wrapped",
          .finding = "the times restart from " + NumberText(counter.first, kDigits) + " after " + counter.range_text +
                     " " + samples_.time_unit + ", " + Count(static_cast<Index>(wraps.size()), "time") +
                     " in all, because the counter overflows",
          .explanation = "later times were corrected"});
    double add = 0;
    std::size_t next = 0;
    for (Index i = wraps.front(); i < size(); ++i) {
      if (next < wraps.size() && wraps[next] == i) {
        add += counter.range;
        ++next;
      }
      samples_.time[i] += add;
    }
    return;
  }
}

// ---- Coarse stamps -----------------------------------------------------------------------------------------------

bool IsMultiple(double number, double grid) {
  const double steps = number / grid;
  return std::abs(steps - std::round(steps)) < 1e-4;
}

/// The coarsest grid on which all stamps lie, counted from the first: 1, 2 or 5 times a power of ten. It must be at
/// least a tenth of the mean sampling interval.
std::optional<double> ClockRepair::Grid() const {
  constexpr std::array kMantissas = {5.0, 2.0, 1.0};
  constexpr int kMaxDecades = 12;
  const double span = time().maxCoeff() - time().minCoeff();
  const double mean = span / static_cast<double>(size() - 1);
  if (!(mean > 0) || !std::isfinite(span)) return std::nullopt;
  int exponent = static_cast<int>(std::floor(std::log10(span)));
  for (int decade = 0; decade < kMaxDecades; ++decade, --exponent) {
    for (const double mantissa : kMantissas) {
      const double grid = exponent < 0 ? mantissa / std::pow(10, -exponent) : mantissa * std::pow(10, exponent);
      if (grid < 0.1 * mean) return std::nullopt;
      const auto is_off_grid = [&](double each) { return !IsMultiple(each - time()[0], grid); };
      if (std::none_of(time().begin(), time().end(), is_off_grid)) return grid;
    }
  }
  return std::nullopt;
}

/// The number of steps that differ from the median step by at least one step of the grid.
Index ClockRepair::CountUnusualSteps(double grid) const {
  std::vector<double> steps;
  for (Index i = 1; i < size(); ++i) steps.push_back(std::round((time()[i] - time()[i - 1]) / grid));
  const double usual = Median(steps);
  return std::ranges::count_if(steps, [usual](double step) { return step != usual; });
}

/// Whether the grid is the sampling interval itself and rows are missing, even if at equal distances: most steps are
/// one of the grid, and none is shorter. Printed stamps are rounded to a power of ten, so that such a grid shows
/// nothing.
bool ClockRepair::IsOwnGrid(double grid) const {
  const double decade = std::log10(grid);
  if (std::abs(decade - std::round(decade)) < 1e-6) return false;
  double shortest = std::numeric_limits<double>::infinity();
  for (Index i = 1; i < size(); ++i) shortest = std::min(shortest, time()[i] - time()[i - 1]);
  return shortest > 0.5 * grid && MedianStep() < 1.5 * grid;
}

/// Replaces the stamps by the middle of the uniform clocks that agree with all of them to half a grid step. Returns
/// false if there is no such clock.
bool ClockRepair::MakeUniform(double grid) {
  if (IsOwnGrid(grid)) return false;
  const double first = time()[0];
  const auto in_steps = [&](double each) { return std::round((each - first) / grid); };
  const std::optional<UniformClock> clock = FindUniformClock(IntervalsOfWholeSteps(time().unaryExpr(in_steps)));
  if (!clock) return false;
  Warn(0, {.code = "time_rounded",
           .finding =
               "the times are rounded to " + TimeText(grid) + ", which is coarse compared with the sampling interval",
           .explanation = ReplacementText(clock->slope * grid, clock->slope_tolerance / clock->slope) +
                          "; if the times were truncated instead of rounded, the new times and release_time are " +
                          TimeText(grid / 2) + " too early",
           .assumed = EvenText(clock->slope * grid, "the times are rounded")});
  UseClock(first + clock->start * grid, clock->slope * grid, clock->slope_tolerance / clock->slope / std::sqrt(3.0));
  return true;
}

/// As MakeUniform, for times with so few significant digits that their steps become coarse.
bool ClockRepair::MakeUniformFromDigits() {
  constexpr double kCoarse = 0.1;
  const std::optional<int> digits = SignificantDigits(time());
  if (!digits || size() < 2) return false;
  const double unit = LastUnit(std::max(std::abs(time()[0]), std::abs(time()[size() - 1])), *digits);
  const std::optional<double> grid = Grid();
  if (grid && *grid > 0.99 * unit) return false;  // no stamp has smaller steps than the largest
  if (unit < kCoarse * (time()[size() - 1] - time()[0]) / static_cast<double>(size() - 1)) return false;
  const auto clock_of = [&](DigitsRule rule) { return FindUniformClock(IntervalsOfDigits(time(), *digits, rule)); };
  std::string rounded = "rounded";
  std::optional<UniformClock> clock = clock_of(DigitsRule::kRounded);
  if (!clock) {
    rounded = "truncated";
    clock = clock_of(DigitsRule::kTruncated);
  }
  if (!clock) return false;
  Warn(0, {.code = "time_rounded",
           .finding = "the times are " + rounded + " to " + std::to_string(*digits) +
                      " significant digits, so their steps grow to " + TimeText(unit) +
                      ", which is coarse compared with the sampling interval",
           .explanation = ReplacementText(clock->slope, clock->slope_tolerance / clock->slope),
           .assumed = EvenText(clock->slope, "the times are rounded")});
  UseClock(clock->start, clock->slope, clock->slope_tolerance / clock->slope / std::sqrt(3.0));
  return true;
}

double ClockRepair::RateHz(double interval) const { return PerSecond(samples_.time_unit) / interval; }

std::string ClockRepair::ReplacementText(double interval, double tolerance) const {
  return "they were replaced by a uniform clock of " + NumberText(RateHz(interval), 6) +
         " Hz, which assumes uniform sampling; clocks within +- " + NumberText(tolerance * RateHz(interval), 2) +
         " Hz agree with all times: " + ErrorText(tolerance);
}

std::string ClockRepair::EvenText(double interval, const std::string& why) const {
  return "even sampling at " + NumberText(RateHz(interval), 6) + " Hz, as " + why +
         " (--time_column none --sample_rate_hz)";
}

void ClockRepair::UseClock(double start, double interval, double std_dev) {
  samples_.clock_std_dev = std_dev;
  samples_.time = Eigen::VectorXd::LinSpaced(size(), start, start + interval * static_cast<double>(size() - 1));
}

// ---- Packets -----------------------------------------------------------------------------------------------------

/// Whether nearly all rows are changes of a count by one step. Such rows are dense where the motion is fast.
bool ClockRepair::IsEventDriven() const {
  constexpr double kShare = 0.85;
  std::vector<double> changes;
  for (Index i = 1; i < size(); ++i) changes.push_back(std::abs(samples_.value[i] - samples_.value[i - 1]));
  const double usual = Median(changes);
  const auto equal = std::ranges::count_if(changes, [&](double each) { return std::abs(each - usual) < 1e-6 * usual; });
  return static_cast<double>(equal) > kShare * static_cast<double>(changes.size());
}

/// Replaces the stamps of packets of rows by the clock of the device, if they show a uniform one. If they do not and
/// rows share stamps, the error says why.
Result<bool> ClockRepair::MakeUniformFromPackets() {
  constexpr double kMinRows = 2;
  const Packets packets = FindPackets(time());
  if (packets.count == 0) return false;
  std::vector<bool> keep;
  const bool is_shared = 5 * CountSharedRows(keep) > size() && !SharedRowsAreEqual();
  if (IsEventDriven() || (!is_shared && packets.rows < kMinRows)) return false;
  const PacketClockSearch found = FindPacketClock({time(), samples_.value, Grid().value_or(0)});
  const PacketClock& clock = found.clock;
  if (found.verdict != PacketClockVerdict::kFound) {
    if (is_shared) return SharedStampsFault(found);
    if (found.verdict == PacketClockVerdict::kUneven && packets.has_inner_steps) WarnOfPackets(packets, found);
    return false;
  }
  Warn(0, {.code = "time_bursts",
           .finding = PacketsText(packets) + ", and each packet has the time at which it was received",
           .explanation = "the times were replaced by a uniform clock of " + NumberText(RateHz(clock.interval), 6) +
                          " Hz +- " + NumberText(clock.std_dev * RateHz(clock.interval), 2) +
                          " Hz, which assumes that no rows are missing: " + ErrorText(clock.std_dev) +
                          "; the shortest delay of the packets remains in release_time",
           .advice = "if you know the sampling rate, give --sample_rate_hz with --time_column none",
           .flags = {"sample_rate_hz", "time_column"},
           .assumed = EvenText(clock.interval, "the rows come in packets")});
  UseClock(clock.start, clock.interval, clock.std_dev);
  return true;
}

/// The lines between which rows are missing or the rate changes most; empty if not known.
std::string ClockRepair::UnevenText(const PacketClockSearch& found) const {
  if (found.uneven_to <= found.uneven_from) return "";
  return ", most clearly between lines " + std::to_string(samples_.lines.LineOf(found.uneven_from)) + " and " +
         std::to_string(samples_.lines.LineOf(found.uneven_to));
}

/// Warns of stamps of packets that are wrong, because the values show that the rows are sampled uniformly, and that no
/// uniform clock can replace.
void ClockRepair::WarnOfPackets(const Packets& packets, const PacketClockSearch& found) {
  Warn(0, {.code = "time_bursts",
           .finding = PacketsText(packets) + ", and the times are those at which the packets were received",
           .explanation = "no uniform clock agrees with them, so rows are missing or the rate changes" +
                          UnevenText(found) + ", and the times were not changed",
           .advice = "give a part without gaps with --from and --to",
           .flags = {"from", "to"}});
}

/// The error for rows of which too many share a stamp.
tl::unexpected<Status> ClockRepair::SharedStampsFault(const PacketClockSearch& found) const {
  const Index first = FirstSharedRow();
  std::vector<bool> keep;
  const std::string sentence = "time " + TimeText(time()[first]) + " is also on line " +
                               std::to_string(samples_.lines.LineOf(first)) + ", and " +
                               std::to_string(CountSharedRows(keep)) + " of " + std::to_string(size()) +
                               " rows share a time with another row; ";
  if (found.verdict == PacketClockVerdict::kTooFewPackets) {
    const std::string rate = NumberText(RateHz(found.clock.interval), 6);
    return WithTry(Fault(first + 1, sentence + "the times suggest " + rate +
                                        " Hz, but too few of them differ to prove that the sampling is uniform. If it "
                                        "is, give --sample_rate_hz " +
                                        rate + " with --time_column none"),
                   {"--sample_rate_hz " + rate, "--time_column none"});
  }
  return Fault(first + 1, sentence + "no uniform clock agrees with all times, so rows are missing or the rate changes" +
                              UnevenText(found) +
                              ". Give a part without this with --from and --to, or record the times with a finer step");
}

/// Warns of coarse stamps that increase but fit no uniform clock. There is no warning if nearly all steps are equal,
/// because then the sampling is regular with some gaps.
void ClockRepair::WarnOfScatter() {
  constexpr double kMinUnusualShare = 0.1;
  const std::optional<double> grid = Grid();
  if (!grid || static_cast<double>(CountUnusualSteps(*grid)) <= kMinUnusualShare * static_cast<double>(size())) return;
  Warn(0, {.code = "time_rounded",
           .finding =
               "the times are rounded to " + TimeText(*grid) + ", which is coarse compared with the sampling interval",
           .explanation = "no uniform clock agrees with them, so they were not changed; rounding gives them an error "
                          "of " +
                          NumberText(*grid / std::sqrt(12.0), 2) + " " + samples_.time_unit});
}

// ---- Repeated stamps ---------------------------------------------------------------------------------------------

/// The first row whose stamp the next row repeats, or the number of rows.
Index ClockRepair::FirstSharedRow() const {
  Index row = 0;
  while (row + 1 < size() && time()[row + 1] != time()[row]) ++row;
  return row + 1 < size() ? row : size();
}

/// The number of rows to leave out. Of successive rows with the same stamp, one is kept if their values are equal, and
/// none otherwise.
Index ClockRepair::CountSharedRows(std::vector<bool>& keep) const {
  keep.assign(static_cast<std::size_t>(size()), true);
  Index removed = 0;
  for (Index begin = 0, end = 0; begin < size(); begin = end) {
    bool is_equal = true;
    for (end = begin + 1; end < size() && time()[end] == time()[begin]; ++end) {
      is_equal = is_equal && samples_.value[end] == samples_.value[begin] &&
                 (samples_.second.size() == 0 || samples_.second[end] == samples_.second[begin]);
    }
    if (end - begin == 1) continue;
    std::fill(keep.begin() + begin + (is_equal ? 1 : 0), keep.begin() + end, false);
    removed += end - begin - (is_equal ? 1 : 0);
  }
  return removed;
}

/// Whether all rows that share a stamp also have the same values, so that nothing is lost without the repetitions.
bool ClockRepair::SharedRowsAreEqual() const {
  for (Index i = 1; i < size(); ++i) {
    if (time()[i] == time()[i - 1] && !IsSameRow(i, i - 1)) return false;
  }
  return true;
}

Check ClockRepair::RemoveRowsWithSharedStamps() {
  constexpr double kMaxShare = 0.2;
  const Index first = FirstSharedRow();
  if (first == size()) return {};
  std::vector<bool> keep;
  const Index removed = CountSharedRows(keep);
  const std::string many = std::to_string(removed) + " of " + std::to_string(size()) + " rows";
  if (static_cast<double>(removed) > kMaxShare * static_cast<double>(size()) && !SharedRowsAreEqual()) {
    return SharedStampsFault({});
  }
  Warn(first + 1, {.code = "time_repeated",
                   .finding = many + " were left out because they share their time with another row, first " +
                              TimeText(time()[first]),
                   .explanation = "of rows with equal times and values, one was kept"});
  KeepRows(keep);
  return {};
}

void ClockRepair::KeepRows(const std::vector<bool>& keep) {
  LineNumbers lines;
  Index kept = 0;
  for (Index i = 0; i < size(); ++i) {
    if (!keep[i]) continue;
    samples_.time[kept] = samples_.time[i];
    samples_.value[kept] = samples_.value[i];
    if (samples_.second.size() > 0) samples_.second[kept] = samples_.second[i];
    lines.Add(samples_.lines.LineOf(i));
    ++kept;
  }
  samples_.time.conservativeResize(kept);
  samples_.value.conservativeResize(kept);
  if (samples_.second.size() > 0) samples_.second.conservativeResize(kept);
  samples_.lines = std::move(lines);
}

// ---- Ends that repeat --------------------------------------------------------------------------------------------

/// Leaves out rows at the start or the end that repeat one row, time and value, as a logger writes that hangs. The
/// usual number of rows that share a stamp is no repetition.
void ClockRepair::RemoveRepeatedEnds() {
  constexpr Index kMinRepeats = 3;
  Index begin = 0, end = size() - 1;  // the rows to keep
  while (begin < end && IsSameRow(begin, begin + 1)) ++begin;
  if (begin == end) return;
  while (IsSameRow(end, end - 1)) --end;
  Index usual = 1;
  for (Index i = begin + 1, shared = 1; i <= end; ++i) {
    shared = time()[i] == time()[i - 1] ? shared + 1 : 1;
    usual = std::max(usual, shared);
  }
  const Index at_start = begin, at_end = size() - 1 - end, least = std::max(kMinRepeats, 2 * usual);
  const auto line = [&](Index row) { return std::to_string(samples_.lines.LineOf(row)); };
  std::vector<bool> keep(static_cast<std::size_t>(size()), true);
  if (at_end >= least) {
    Warn(end + 1, {"rows_repeated", "lines " + line(end + 1) + " to " + line(size() - 1) + " repeat line " + line(end) +
                                        ", time and value, and were left out"});
    std::fill(keep.begin() + end + 1, keep.end(), false);
  }
  if (at_start >= least) {
    Warn(1, {"rows_repeated", "lines " + line(1) + " to " + line(begin) + " repeat line " + line(0) +
                                  ", time and value, and were left out"});
    std::fill(keep.begin() + 1, keep.begin() + begin + 1, false);
  }
  if (std::ranges::find(keep, false) != keep.end()) KeepRows(keep);
}

// ---- Stamps that go back -----------------------------------------------------------------------------------------

/// Leaves out single rows, or a few in succession, whose stamps are far from those of the rows around them, as after a
/// lost or doubled digit. The rows around them are as far apart as the number of rows between them says, so the clock
/// was not set back.
void ClockRepair::RemoveStrayStamps() {
  constexpr double kMaxShare = 0.05, kAlike = 1.5;
  if (IsNotDecreasing()) return;
  const double step = MedianStep();
  std::vector<bool> keep(size(), true), all(size(), true);
  Index removed = 0, first = 0;
  for (const UnorderedRows& rows : FindUnorderedRows(time())) DropOutOfOrderRows(time(), rows, keep);
  for (Index begin = 1, end = 1; begin + 1 < size(); begin = std::max(begin + 1, end)) {
    for (end = begin; end + 1 < size() && !keep[end]; ++end) {
    }
    const Index count = end - begin;
    if (count == 0 || count > kMaxStepsBack || !keep[begin - 1] || !keep[end]) continue;
    const double expected = step * static_cast<double>(count + 1), across = time()[end] - time()[begin - 1];
    const auto is_far = [&](Index row) {
      return std::max(time()[begin - 1] - time()[row], time()[row] - time()[end]) > kMaxStepsBack * step;
    };
    if (across > kAlike * expected || kAlike * across < expected || !is_far(begin) || !is_far(end - 1)) continue;
    std::fill(all.begin() + begin, all.begin() + end, false);
    if (removed == 0) first = begin;
    removed += count;
  }
  if (removed == 0 || static_cast<double>(removed) > kMaxShare * static_cast<double>(size())) return;
  Warn(first, {.code = "time_not_increasing",
               .finding = "time " + TimeText(time()[first]) + " is far from " + TimeText(time()[first - 1]) +
                          " of line " + std::to_string(samples_.lines.LineOf(first - 1)),
               .explanation = Count(removed, "row") +
                              (removed == 1 ? " with such a time was" : " with such times were") + " left out"});
  KeepRows(all);
}

Check ClockRepair::RemoveBackwardRows() {
  constexpr double kMaxShare = 0.05;
  const double reach = kMaxStepsBack * MedianStep();
  std::vector<bool> keep(size(), true);
  Index removed = 0, first = 0;
  double latest = time()[0];
  for (Index i = 1; i < size(); ++i) {
    if (latest - time()[i] > reach) {
      return Fault(i,
                   "time " + TimeText(time()[i]) + " follows " + TimeText(latest) +
                       ", so the clock was set back: these are two recordings in one file; split it before this line");
    }
    if (first == 0 && time()[i] <= latest) first = i;
    latest = std::max(latest, time()[i]);
  }
  for (const UnorderedRows& rows : FindUnorderedRows(time())) removed += DropOutOfOrderRows(time(), rows, keep);
  if (removed == 0) return {};
  const std::string sentence = "time " + TimeText(time()[first]) + " does not follow " + TimeText(time()[first - 1]) +
                               " of line " + std::to_string(samples_.lines.LineOf(first - 1));
  const std::string many = std::to_string(removed) + " of " + std::to_string(size()) + " rows";
  if (static_cast<double>(removed) > kMaxShare * static_cast<double>(size())) {
    return Fault(first, sentence + ", and " + many +
                            " would have to be left out to make times increase; correct or sort the rows");
  }
  Warn(first, {.code = "time_not_increasing",
               .finding = sentence,
               .explanation = "the fewest rows were left out to make times increase, " + many});
  KeepRows(keep);
  return {};
}

void ClockRepair::KeepOnly(const RowRange& rows) {
  std::vector<bool> keep(static_cast<std::size_t>(size()), false);
  std::fill(keep.begin() + rows.begin, keep.begin() + rows.end, true);
  KeepRows(keep);
}

Result<RawSamples> ClockRepair::Repair() {
  if (IsUniform()) return std::move(samples_);
  RemoveRepeatedEnds();
  if (IsUniform()) return std::move(samples_);
  RemoveStrayStamps();
  if (IsUniform()) return std::move(samples_);
  Unwrap();
  if (IsUniform()) return std::move(samples_);
  if (SharedRowsAreEqual()) {  // otherwise a clock with two rows in each interval would fit rows that are there twice
    RETURN_IF_ERROR(RemoveRowsWithSharedStamps());
    if (IsUniform()) return std::move(samples_);
  }
  // A uniform clock fits stamps with lost rows only if the losses are spread evenly. The probability that 8 losses fall
  // into 8 different eighths of the recording is 8!/8^8 = 0.2 %.
  constexpr Index kMinUnusualSteps = 8;
  const bool has_true_gaps = samples_.left_out > 0 && Increases();
  if (IsNotDecreasing() && !has_true_gaps) {
    const std::optional<double> grid = Grid();
    std::vector<bool> keep;
    const bool suggests_uniform_clock =
        grid && (CountUnusualSteps(*grid) >= kMinUnusualSteps || 5 * CountSharedRows(keep) > size());
    if (suggests_uniform_clock && MakeUniform(*grid)) return std::move(samples_);
    if (MakeUniformFromDigits()) return std::move(samples_);
    ASSIGN_OR_RETURN(const bool made, MakeUniformFromPackets());
    if (made) return std::move(samples_);
  }
  if (Increases()) {
    if (!has_true_gaps) WarnOfScatter();
    return std::move(samples_);
  }
  RETURN_IF_ERROR(RemoveRowsWithSharedStamps());
  RETURN_IF_ERROR(RemoveBackwardRows());
  return std::move(samples_);
}

// ---- Rows far from all others ------------------------------------------------------------------------------------

/// Refuses rows that are so far from the others that their time is wrong: one or two at an end, or beyond any pause.
/// The motion between them would have to be computed for as long as they are apart.
Check RefuseDistantRows(const RawSamples& samples) {
  constexpr Index kMostAtAnEnd = 2;
  constexpr double kFar = 10;                         // times the time of the rows between the ends
  constexpr double kManySteps = 1e6, kEndless = 1e9;  // sampling intervals: hours, and months
  const Eigen::VectorXd& time = samples.time;
  const Index last = time.size() - 1;
  if (last < 2 * kMostAtAnEnd + 1) return {};
  const Eigen::VectorXd steps = time.tail(last) - time.head(last);
  if (!(steps.maxCoeff() > kManySteps * steps.minCoeff())) return {};  // spares most files the median
  const double inner = time[last - kMostAtAnEnd] - time[kMostAtAnEnd];
  const double step = MedianForwardStep(time), mean_step = inner / static_cast<double>(last - 2 * kMostAtAnEnd);
  for (Index i = 0; i < last; ++i) {
    const double gap = steps[i];
    const bool is_early = i < kMostAtAnEnd, is_late = i >= last - kMostAtAnEnd;
    const bool is_wrong = (is_early || is_late) && gap > kFar * inner && gap > kManySteps * mean_step;
    if (!is_wrong && !(gap > kEndless * step)) continue;
    const Index row = is_early ? i : i + 1;
    return Fault(samples.name + ":" + std::to_string(samples.lines.LineOf(row)),
                 "the time " + NumberText(time[row], kDigits) + " " + samples.time_unit + " is " + NumberText(gap, 3) +
                     " " + samples.time_unit + " from that of the row " + (is_early ? "after" : "before") +
                     " it, and rows are " + NumberText(step, 3) + " " + samples.time_unit +
                     " apart; correct or remove this row");
  }
  return {};
}

Result<RawSamples> RepairRows(ClockRepair repair) {
  Result<RawSamples> repaired = repair.Repair();
  if (!repaired) return repaired;
  RETURN_IF_ERROR(RefuseDistantRows(*repaired));
  return repaired;
}

}  // namespace

std::size_t LineNumbers::LineOf(Index row) const {
  const auto next = std::ranges::upper_bound(jumps_, row, {}, &std::pair<Index, std::size_t>::first);
  const auto& [first_row, first_line] = *std::prev(next);
  return first_line + static_cast<std::size_t>(row - first_row);
}

Result<RawSamples> RepairClock(RawSamples samples, const ClockWindow& window) {
  if (window.IsOpen()) return RepairRows(ClockRepair(std::move(samples)));
  Result<RawSamples> repaired = RepairRows(ClockRepair(samples));
  if (repaired) return repaired;
  const auto rows = RowsInWindow(samples, window);
  constexpr Index kMinRows = 3;
  if (rows.size() < kMinRows) return repaired;
  const Index all = samples.time.size();
  if (rows.size() == all) return repaired;
  ClockRepair part(std::move(samples));
  part.KeepOnly(rows);
  Result<RawSamples> repaired_part = RepairRows(std::move(part));
  if (!repaired_part) return repaired_part;
  repaired_part->warnings.push_back({.code = "time_outside_window",
                                     .finding = "the times outside the window of --from and --to cannot be repaired, "
                                                "so only " +
                                                std::to_string(rows.size()) + " of " + std::to_string(all) +
                                                " rows were read",
                                     .explanation = repaired.error().message(),
                                     .flags = {"from", "to"},
                                     .about = {.file = repaired_part->name}});
  return repaired_part;
}

}  // namespace pendulum
