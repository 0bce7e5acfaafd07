// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/unit_guess.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/median.h"
#include "pendulum/base/physics.h"
#include "recording/swing_signature.h"

namespace pendulum::csv {
namespace {

using Eigen::Index;

constexpr double kShortestPeriod = 0.1, kLongestPeriod = 20;  // s
constexpr double kLargestSwing = 3.3;  // rad; a pendulum that does not turn over stays within pi.
constexpr double kLeastSwing = 0.02;   // rad
/// rad; from here on the period shows the amplitude (MODEL.md section 3: 2.3 % at 0.6 rad).
constexpr double kTellingSwing = 0.6;

/// A unit of acceleration, and what gravity is in it.
struct GravityUnit {
  std::string_view unit;
  double gravity;
};

constexpr std::array kGravityUnits = {GravityUnit{"g", 1}, GravityUnit{"m_s2", kStandardGravity},
                                      GravityUnit{"mg", 1e3}};

/// The median length of the vector with these components.
double UsualLength(const std::vector<Eigen::VectorXd>& axes) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(axes.front().size());
  for (const Eigen::VectorXd& axis : axes) squares += axis.cwiseAbs2();
  return std::sqrt(MedianOf(squares));
}

/// Whether the period of the swing depends on the amplitude as for a pendulum with this amplitude [rad].
enum class Evidence { kNone, kPendulum, kLinear };

Evidence EvidenceOf(const SwingSignature& swing, double rad_per_unit) {
  constexpr double kLeastExcess = 0.02;  // Smaller differences of the period are not measured well enough.
  constexpr double kNear = 0.4;
  const double large = PendulumPeriodRatio(swing.first_amplitude * rad_per_unit);
  const double expected = large / PendulumPeriodRatio(swing.last_amplitude * rad_per_unit) - 1;
  const double seen = swing.period_ratio - 1;
  if (expected < kLeastExcess) return Evidence::kNone;
  if (std::abs(seen - expected) < kNear * expected) return Evidence::kPendulum;
  return std::abs(seen) < kNear * expected ? Evidence::kLinear : Evidence::kNone;
}

/// Degrees or radians, for a swing of this amplitude in the file's unit. `rad_per_unit` converts the amplitude of the
/// readings to that of the angle.
UnitGuess GuessAngleUnit(const std::optional<SwingSignature>& swing, double amplitude, double rad_per_unit,
                         std::string_view rad, std::string_view deg) {
  const double angle = amplitude * rad_per_unit;
  const std::string reached = " (the swing reaches " + NumberText(angle, 3);
  if (angle > kLargestSwing) return {deg, reached + ", too much for radians)", ""};
  if (angle < kLeastSwing) {
    return {"", ", and a swing of " + NumberText(angle, 2) + " may be radians or degrees", std::string(rad)};
  }
  if (angle < kTellingSwing || !swing) return {rad, reached + ", too little for degrees)", ""};
  switch (EvidenceOf(*swing, rad_per_unit)) {
    case Evidence::kPendulum: return {rad, reached + ", and its period depends on the amplitude as in radians)", ""};
    case Evidence::kLinear:
      return {"",
              ", and its period does not depend on the amplitude: a small swing in degrees, or a torsion spring in "
              "radians",
              std::string(deg)};
    case Evidence::kNone: break;
  }
  return {rad, reached + ")", ""};
}

/// Whether times are numbers of days from 1900, as a spreadsheet writes dates: of the years 1954 to 2119, with steps
/// below 2 s. As seconds they would be sampled at more than 40 kHz, hours after the start.
bool AreDaysOfSpreadsheet(double first, double step) {
  constexpr double kFirst = 2e4, kLast = 8e4, kLongestStep = 2.4e-5;  // days
  return first > kFirst && first < kLast && step > 0 && step < kLongestStep;
}

UnitGuess GuessUnnamed(const Eigen::VectorXd& values, const std::optional<SwingSignature>& swing, double amplitude) {
  const bool is_whole = AreWhole(values);
  // NaN, where a cell has no number, is not larger.
  const bool is_large = std::ranges::any_of(values, [](double value) { return std::abs(value) > kMostDegrees; });
  if (is_whole && is_large) return {"counts", " (whole numbers)", ""};
  if (amplitude > kMostDegrees) return {"", "", "counts"};
  if (amplitude > kLargestSwing && !is_whole) {
    return {"deg", " (the swing reaches " + NumberText(amplitude, 3) + ")", ""};
  }
  if (swing && amplitude > kTellingSwing && amplitude < kLargestSwing && EvidenceOf(*swing, 1) == Evidence::kPendulum) {
    return {"rad", " (its period depends on the amplitude as in radians)", ""};
  }
  return {"", ", and its name does not say whether it is an angle, a voltage or a length", is_whole ? "counts" : "rad"};
}

/// Whether times may be seconds of a slow torsion pendulum, which is read every 10 s, or milliseconds of a fast
/// pendulum. period: if the times are seconds.
bool IsSlowOrInMs(double period) {
  constexpr double kLongestSlowPeriod = 620;  // s
  return period > kLongestPeriod && period < kLongestSlowPeriod;
}

}  // namespace

double MedianOf(const Eigen::VectorXd& values) {
  std::vector<double> numbers;
  std::ranges::copy_if(values, std::back_inserter(numbers), [](double value) { return std::isfinite(value); });
  return numbers.empty() ? 0 : Median(std::move(numbers));
}

double HalfRange(const Eigen::VectorXd& values) {
  double low = INFINITY, high = -INFINITY;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return high > low ? (high - low) / 2 : 0;
}

bool AreWhole(const Eigen::VectorXd& values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return !std::isfinite(value) || value == std::floor(value); });
}

double MedianStep(const Eigen::VectorXd& numbers) {
  std::vector<double> steps;
  std::optional<Index> last;  // Row of the last finite number.
  double advance = 0, rows = 0;
  for (Index i = 0; i < numbers.size(); ++i) {
    if (!std::isfinite(numbers[i])) continue;
    const double step = last ? numbers[i] - numbers[*last] : 0;
    const auto distance = static_cast<double>(i - last.value_or(i));
    last = i;
    if (step < 0) continue;  // A counter that overflows.
    advance += step;
    rows += distance;
    if (step > 0) steps.push_back(step / distance);
  }
  if (steps.empty()) return 0;
  // Coarse stamps repeat; the mean step is the sampling interval then.
  return std::min(advance / rows, Median(std::move(steps)));
}

bool MaySecondsCount(const Eigen::VectorXd& values) {
  constexpr double kFewRows = 30;  // a period; a logger reads more
  const auto swing = FindSwingSignature(values);
  return swing && swing->rows_per_period < kFewRows;
}

TimeGuess GuessTimeUnit(const Eigen::VectorXd& times, const Eigen::VectorXd& values) {
  struct Scale {
    std::string_view unit;
    double seconds;
  };
  constexpr std::array kScales = {Scale{"s", 1}, Scale{"ms", 1e-3}, Scale{"us", 1e-6}, Scale{"ns", 1e-9}};
  constexpr double kEpochFirst = 5e8, kEpochLast = 5e9;  // s: the years 1985 to 2128.
  constexpr double kLongestStep = 0.5;                   // s
  const double step = MedianStep(times);
  const auto first_time = std::find_if(times.begin(), times.end(), [](double time) { return std::isfinite(time); });
  const double begin = first_time == times.end() ? 0 : *first_time;
  for (const Scale& scale : kScales) {
    const double first = begin * scale.seconds;
    const bool is_usual_step = step * scale.seconds <= kLongestStep;
    if (first > kEpochFirst && first < kEpochLast && is_usual_step) return {scale.unit, " (it counts from 1970)", true};
  }
  if (AreDaysOfSpreadsheet(begin, step)) {
    return {"days", " (it counts days from 1900, as spreadsheets do)", true};
  }
  const auto swing = FindSwingSignature(values);
  if (swing) {
    if (const double period = swing->rows_per_period * step; IsSlowOrInMs(period)) {
      return {"", "the period is " + NumberText(period, 3) + " s if the times are in s, and " +
                      NumberText(period / 1e3, 3) + " s if they are in ms"};
    }
    for (const Scale& scale : kScales) {
      const double period = swing->rows_per_period * step * scale.seconds;
      if (period < kShortestPeriod || period > kLongestPeriod) continue;
      return {scale.unit, " (the period is then " + NumberText(period, 3) + " s)"};
    }
  }
  constexpr Index kEnoughRows = 20, kMostByHand = 200;          // fewer show no swing
  constexpr double kShortestReading = 2, kLongestReading = 60;  // s between readings by hand
  const bool is_usual_by_hand = step >= kShortestReading && step <= kLongestReading && AreWhole(times);
  if (!swing && values.size() >= kEnoughRows && values.size() <= kMostByHand && is_usual_by_hand) {
    return {"", "the rows are " + NumberText(step, 3) + " s apart if the times are in s, and " + NumberText(step, 3) +
                    " ms if they are in ms"};
  }
  for (const Scale& scale : kScales) {
    if (step * scale.seconds <= kLongestStep) {
      return {scale.unit, " (the rows are then " + NumberText(step * scale.seconds, 3) + " s apart)"};
    }
  }
  return {"s", ""};
}

std::string_view UnitOfGravity(const std::vector<Eigen::VectorXd>& axes) {
  constexpr double kNear = 0.2;
  constexpr double kLeastSteady = 0.5;  // the part along the rod, which keeps its sign
  const double length = UsualLength(axes);
  double steady = 0;
  for (const Eigen::VectorXd& axis : axes) steady = std::hypot(steady, MedianOf(axis));
  const auto* const found = std::ranges::find_if(kGravityUnits, [&](const GravityUnit& each) {
    return std::abs(length / each.gravity - 1) < kNear && steady > kLeastSteady * each.gravity;
  });
  return found == kGravityUnits.end() ? std::string_view() : found->unit;
}

std::string_view UnitOfMovingGravity(const std::vector<Eigen::VectorXd>& axes) {
  constexpr double kLeastMotion = 0.02;  // of gravity: along the rod, the motion of a swing of 0.2 rad
  const double length = UsualLength(axes);
  const auto moves = [&](const Eigen::VectorXd& axis) { return HalfRange(axis) > kLeastMotion * length; };
  return std::ranges::count_if(axes, moves) < 2 ? std::string_view() : UnitOfGravity(axes);
}

namespace {

/// The unit of an acceleration that is one of these axes.
UnitGuess GuessAccelerationUnit(double amplitude, const std::vector<Eigen::VectorXd>& axes) {
  constexpr double kMostInG = 2, kMostInSi = 100, kMostInMg = 4e3;
  const double usual = UsualLength(axes);
  const std::string_view unit = UnitOfGravity(axes);
  const std::string at_rest = " (it is about " + NumberText(usual, 2) + " at rest)";
  if (unit == "mg" || unit == "m_s2" || (unit == "g" && amplitude < kMostInG)) return {unit, at_rest, ""};
  if (amplitude > kMostInG && amplitude < kMostInSi) return {"m_s2", "", ""};
  if (amplitude <= kMostInG) return {"", ", which may be m/s^2 or g", "m_s2"};
  if (std::max(amplitude, usual) < kMostInMg) return {"", ", which may be mg (thousandths of g)", "mg"};
  return {"", ", and is too large for m/s^2, g and mg: divide it by what it is at rest along the rod, then it is in g",
          ""};
}

}  // namespace

UnitGuess GuessValueUnit(std::optional<Kind> kind, const Eigen::VectorXd& values, double seconds,
                         const std::vector<Eigen::VectorXd>& axes) {
  const auto swing = FindSwingSignature(values);
  const double amplitude = swing ? swing->amplitude : HalfRange(values);
  if (!kind) return GuessUnnamed(values, swing, amplitude);
  switch (*kind) {
    case Kind::kAngle: {
      if (amplitude > kMostDegrees && AreWhole(values)) return {"counts", " (whole numbers)", ""};
      return GuessAngleUnit(swing, amplitude, 1, "rad", "deg");
    }
    case Kind::kRate: {
      if (!swing || seconds <= 0) return {"", ", which may be rad/s or deg/s", "rad_s"};
      const double per_rate = swing->rows_per_period * seconds / (2 * kPi);
      return GuessAngleUnit(swing, amplitude, per_rate, "rad_s", "deg_s");
    }
    case Kind::kRaw: return {AreWhole(values) ? "counts" : "volts", "", ""};
    case Kind::kAcceleration: return GuessAccelerationUnit(amplitude, axes);
    case Kind::kLength: return {"px", ", a length of unknown scale", ""};
    case Kind::kTime: break;
  }
  return {"", "", "deg"};
}

}  // namespace pendulum::csv
