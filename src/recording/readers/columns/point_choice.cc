// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/columns/point_choice.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include <Eigen/QR>

#include "pendulum/recording/arc.h"
#include "recording/swing_signature.h"

namespace pendulum::csv {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// The words of a column's name without its unit, each between blanks.
std::string WordsOf(const NameMeaning& meaning) {
  std::string words = " " + meaning.stem + " ";
  std::ranges::replace_if(
      words, [](char c) { return c == '_' || c == '.' || c == '-'; }, ' ');
  return words;
}

/// The rows in which both columns have numbers, at most some thousand of them.
std::pair<VectorXd, VectorXd> RowsOfBoth(const VectorXd& first, const VectorXd& second) {
  constexpr Index kMost = 4096;
  const Index step = first.size() / kMost + 1;
  VectorXd x(first.size() / step + 1), y(x.size());
  Index count = 0;
  for (Index i = 0; i < first.size(); i += step) {
    if (!std::isfinite(first[i]) || !std::isfinite(second[i])) continue;
    x[count] = first[i];
    y[count++] = second[i];
  }
  return {x.head(count), y.head(count)};
}

/// Whether the height follows the square of the horizontal distance from the pivot, at twice the frequency of the
/// swing. A drift that only looks like an arc does not.
bool FollowsBend(const VectorXd& x, const VectorXd& y, double pivot_x, double rows_per_period) {
  constexpr double kLeastShare = 0.2;  // of the variance; the rest is noise
  const Eigen::MatrixXd covariance = SwingCovariance({(x.array() - pivot_x).square(), y}, rows_per_period / 2);
  return covariance(0, 1) * covariance(0, 1) > kLeastShare * covariance(0, 0) * covariance(1, 1);
}

/// How much better the circle describes the points than a parabola, in -2 ln L. Another quantity that follows the
/// square of the angle, such as the tension of the string, lies on a parabola as well.
double GainOverParabola(const VectorXd& x, const VectorXd& y, const Arc& arc) {
  const VectorXd distance = (x.array() - arc.x) / arc.radius;
  Eigen::MatrixXd powers(x.size(), 3);
  powers << VectorXd::Ones(x.size()), distance, distance.cwiseAbs2();
  const Eigen::Vector3d coefficients = powers.colPivHouseholderQr().solve(y);
  const VectorXd slope = (coefficients[1] + 2 * coefficients[2] * distance.array()) / arc.radius;
  const VectorXd radial = (y - powers * coefficients).array() / (1 + slope.array().square()).sqrt();
  const auto count = static_cast<double>(x.size());
  return count * std::log(radial.squaredNorm() / (count * arc.std_dev * arc.std_dev));
}

/// The point with these coordinates if they lie on an arc.
std::optional<Point> OnArc(const VectorXd& x, const VectorXd& y, double rows_per_period) {
  constexpr double kLeastAngle = 0.05, kClearAngle = 0.15;  // rad; a shorter arc may be any curve
  constexpr double kSeen = 2.5, kClear = 10;  // height of the arc, in standard deviations of the points about it
  constexpr double kClearGain = 5;            // over a parabola
  // The centripetal part of accelerations bends their arc as the swing decays, and moves its centre.
  constexpr double kExact = 50, kAtOrigin = 0.05;  // of the radius
  const auto [some_x, some_y] = RowsOfBoth(x, y);
  const Result<Arc> arc = FitArc(some_x, some_y);
  if (!arc) return std::nullopt;
  double low = 0, high = 0;
  for (Index i = 0; i < some_x.size(); ++i) {
    const double angle = arc->Angle(some_x[i], some_y[i]);
    low = std::min(low, angle);
    high = std::max(high, angle);
  }
  const double half = (high - low) / 2, height = arc->radius * (1 - std::cos(half));
  Point point;
  if (half < kLeastAngle || height < kSeen * arc->std_dev) return std::nullopt;
  const bool is_long = half > kClearAngle && height > kClear * arc->std_dev;
  const double gain = GainOverParabola(some_x, some_y, *arc);
  if (gain < -kClearGain) return std::nullopt;
  point.is_clear = is_long && gain > kClearGain;
  if (!is_long && !FollowsBend(x, y, arc->x, rows_per_period)) return std::nullopt;
  point.is_exact = height > kExact * arc->std_dev;
  point.is_about_origin = std::hypot(arc->x, arc->y) < kAtOrigin * arc->radius;
  return point;
}

/// The unit of both coordinates, or nullptr.
const Unit* UnitOf(const Choice& choice, std::size_t index) {
  return choice.options.unit.empty() ? choice.Meaning(index).unit : UnitOfText(choice.options.unit);
}

}  // namespace

std::optional<Point> FindNamedPoint(const Choice& choice) {
  const std::string& flag = choice.options.value_column;
  if (std::ranges::find(choice.names, flag, &Name::written) != choice.names.end()) return std::nullopt;
  for (std::size_t at = flag.find(','); at != std::string::npos; at = flag.find(',', at + 1)) {
    const auto x = choice.FindColumn("--value_column", Trim(std::string_view(flag).substr(0, at)));
    const auto y = choice.FindColumn("--value_column", Trim(std::string_view(flag).substr(at + 1)));
    if (x && y && *x != *y) return Point{*x, *y, true};
  }
  return std::nullopt;
}

std::optional<std::size_t> FindVertical(const Choice& choice, std::size_t horizontal) {
  const NameMeaning& x = choice.Meaning(horizontal);
  if (x.kind != Kind::kLength || x.unit == nullptr || !x.Has("x")) return std::nullopt;
  std::string wanted = WordsOf(x);
  const std::size_t at = wanted.rfind(" x ");
  if (at == std::string::npos) return std::nullopt;
  wanted.replace(at + 1, 1, "y");
  for (std::size_t i = 0; i < choice.names.size(); ++i) {
    const NameMeaning& y = choice.Meaning(i);
    const bool may_be_point = y.kind == Kind::kLength && y.unit == x.unit && y.stem.size() == x.stem.size();
    if (may_be_point && !choice.names[i].is_hidden && WordsOf(y) == wanted) return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> FindPoint(const Choice& choice, const Columns& candidates) {
  Columns points;
  std::ranges::copy_if(candidates, std::back_inserter(points),
                       [&](std::size_t i) { return FindVertical(choice, i).has_value(); });
  return points.size() == 1 ? std::optional(points.front()) : std::nullopt;
}

std::optional<Point> FindPointOnArc(const Choice& choice, const Columns& two, double rows_per_period) {
  if (two.size() != 2) return std::nullopt;
  // The arc is above or below its centre, so only the right order determines the downward direction.
  for (const auto& [x, y] : {std::pair(two[0], two[1]), std::pair(two[1], two[0])}) {
    std::optional<Point> point = OnArc(choice.NumbersOf(x), choice.NumbersOf(y), rows_per_period);
    if (!point) continue;
    point->horizontal = x;
    point->vertical = y;
    return point;
  }
  return std::nullopt;
}

Result<void> CheckCoordinates(const Choice& choice) {
  const std::size_t index = *choice.value;
  if (choice.vertical) {
    for (const std::size_t i : {index, *choice.vertical}) {
      const Unit* unit = UnitOf(choice, i);
      const bool may_be_length =
          choice.Meaning(i).kind.value_or(Kind::kLength) == Kind::kLength || IsShortAcceleration(choice.Meaning(i));
      const bool is_length =
          unit == nullptr ? may_be_length : unit->kind == Kind::kLength && unit == UnitOf(choice, index);
      if (is_length) continue;
      return choice.WrongFlag(i, "columns " + choice.NameOf(index) + " and " + choice.NameOf(*choice.vertical) +
                                     " were chosen as the coordinates of a point, but column " + choice.NameOf(i) +
                                     (unit == nullptr ? " is no length" : " is in " + std::string(unit->Written())) +
                                     "; both must be lengths in one unit (px, m, cm or mm), or choose one column with "
                                     "--value_column");
    }
    return {};
  }
  const NameMeaning& meaning = choice.Meaning(index);
  if (meaning.kind != Kind::kLength || meaning.unit == nullptr || !meaning.Has("y")) return {};
  const bool asked = !choice.options.value_column.empty();
  return choice.table.line.Fault(
      choice.PlaceOf(index),
      "column " + choice.NameOf(index) +
          " is the height of the point, which is the same on both sides; choose the horizontal "
          "coordinate with --value_column, or leave the flag out to use both",
      asked ? StatusCode::kInvalidArgument : StatusCode::kDataLoss);
}

}  // namespace pendulum::csv
