// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/profile.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pendulum/fitting/uncertainty/standard_errors.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// The profile likelihood of one parameter. The interval ends where the deviance, with the other parameters solved
/// again, has risen by Student's t² times a factor, as in MINOS. The factor is the variance of ComputeErrors divided by
/// the variance of the likelihood at fixed σ. It accounts for the estimate of σ and for autocorrelated residuals.
class Profile {
 public:
  Profile(const SolvedFit& fit, Optimum optimum, int k) : fit_(fit), optimum_(std::move(optimum)), k_(k) {
    if (std::ranges::find(optimum_.free, k) == optimum_.free.end()) {
      optimum_.free.push_back(k);
      optimum_.inverse = InvertInformation(optimum_.information, optimum_.free);
    }
    if (!optimum_.inverse.identifiable) return;
    const Index row = std::ranges::find(optimum_.free, k) - optimum_.free.begin();
    const Errors errors = ComputeErrors(fit_, optimum_);
    const double naive = optimum_.inverse.matrix(row, row);
    length_ = errors.t95[row] * std::sqrt(errors.covariance(row, row));
    last_trace_ = fit_.cost.traces() + Budget();
    threshold_ = length_ * length_ / naive;
    t95_ = errors.t95[row];
    points_.push_back({At(), 0});
    direction_ = optimum_.inverse.matrix.col(row) / naive;
  }

  bool is_defined() const { return threshold_ > 0 && std::isfinite(threshold_); }

  /// Distance to the end of the interval on a side (-1 or 1). Returns std::nullopt if there is no end.
  std::optional<double> FindReach(double side) {
    const auto index = static_cast<std::size_t>(k_);
    const double bound = side < 0 ? fit_.solve.lower[index] : fit_.solve.upper[index];
    const double farthest = std::min(std::abs(bound - At()), kFarthest * length_);
    if (farthest == 0) return 0;
    return Find(side, farthest);
  }

  /// Whether the budget of trajectories is used up, so the ends are unknown.
  bool is_exhausted() const { return fit_.cost.traces() >= last_trace_; }

  /// Whether the profile fell below the optimum: it then belongs to another local minimum.
  bool found_lower() const { return found_lower_; }

  /// The points of the profile, with points added until they are evenly spread between the ends. The distances of the
  /// ends from the estimate are `down` and `up`. Points of the search far beyond the ends are removed.
  std::vector<ProfilePoint> SpreadPoints(double down, double up) {
    constexpr double kFarBeyond = 4;  // in thresholds
    last_trace_ = fit_.cost.traces() + Budget();
    SpreadOver(-down);
    SpreadOver(up);
    std::erase_if(points_, [&](const ProfilePoint& p) { return p.statistic > kFarBeyond * threshold(); });
    std::ranges::sort(points_, {}, &ProfilePoint::value);
    return points_;
  }

  /// The largest distance that the search on a side reached.
  double SearchedDistance(double side) const {
    double farthest = 0;
    for (const ProfilePoint& point : points_) farthest = std::max(farthest, side * (point.value - At()));
    return farthest;
  }

  double threshold() const { return t95_ * t95_; }

  double At() const { return fit_.solution.parameters[static_cast<std::size_t>(k_)]; }

 private:
  static constexpr double kFarthest = 100;  // in units of length_
  static constexpr double kNegligible = 0.05;

  /// Budget of trajectories for one parameter. A well-behaved profile needs some tens for each recording.
  int Budget() const {
    constexpr double kSamples = 2e6;
    const double runs = fit_.cost.runs();
    return static_cast<int>(runs * std::clamp(kSamples * runs / fit_.samples(), 100.0, 400.0));
  }

  /// Square root of the rise relative to the threshold. It is 1 at the end of the interval and grows with the distance.
  double SquareRootOfRiseAt(double distance, double side) {
    SolveOptions options = fit_.solve;
    options.fixed[static_cast<std::size_t>(k_)] = true;
    options.max_traces = last_trace_;
    std::vector<double> start = fit_.solution.parameters;
    for (std::size_t j = 0; j < optimum_.free.size(); ++j) {
      const auto i = static_cast<std::size_t>(optimum_.free[j]);
      const double moved = start[i] + side * distance * direction_[static_cast<Index>(j)];
      start[i] = std::clamp(moved, options.lower[i], options.upper[i]);
    }
    start[static_cast<std::size_t>(k_)] = At() + side * distance;
    const Solution other = Solve(fit_.cost, start, options);
    if (!other.usable) return kUnbounded;
    found_lower_ = found_lower_ || other.sum < fit_.solution.sum - kNegligible * threshold_;
    const double root = std::sqrt(std::max(other.sum - fit_.solution.sum, 0.0) / threshold_);
    points_.push_back({start[static_cast<std::size_t>(k_)], root * root * threshold()});
    return root;
  }

  /// Adds points on one side up to a signed distance from the estimate, except near existing points.
  void SpreadOver(double farthest) {
    constexpr int kParts = 4;
    constexpr double kNear = 0.25;  // in parts
    if (farthest == 0) return;
    const double part = farthest / kParts;
    for (int i = 1; i <= kParts; ++i) {
      const double value = At() + i * part;
      const auto is_near = [&](const ProfilePoint& p) { return std::abs(p.value - value) < kNear * std::abs(part); };
      if (std::ranges::none_of(points_, is_near)) SquareRootOfRiseAt(std::abs(i * part), farthest < 0 ? -1 : 1);
    }
  }

  /// Finds the distance where SquareRootOfRiseAt is 1, by regula falsi between points on both sides. Returns
  /// std::nullopt if it stays below 1.
  std::optional<double> Find(double side, double farthest) {
    constexpr int kMaxSolves = 25;
    constexpr double kAccuracy = 0.01;
    constexpr double kLongestStretch = 4;
    double inside = 0;
    double root_inside = 0;
    double outside = kUnbounded;
    double root_outside = kUnbounded;
    double distance = std::min(length_, farthest);
    for (int solve = 0; solve < kMaxSolves && !is_exhausted(); ++solve) {
      const double root = SquareRootOfRiseAt(distance, side);
      if (std::abs(root - 1) < kAccuracy) return distance;
      if (root < 1) {
        if (distance == farthest) return std::nullopt;
        inside = distance;
        root_inside = root;
      } else {
        outside = distance;
        root_outside = root;
      }
      distance = Next(inside, root_inside, outside, root_outside, kLongestStretch);
      distance = std::min(distance, farthest);
    }
    return distance;
  }

  static double Next(double inside, double root_inside, double outside, double root_outside, double longest_stretch) {
    if (!std::isfinite(outside)) return inside * std::min(1 / std::max(root_inside, 1e-3), longest_stretch);
    if (!std::isfinite(root_outside)) return 0.5 * (inside + outside);
    const double share = (1 - root_inside) / (root_outside - root_inside);
    return inside + std::clamp(share, 0.05, 0.95) * (outside - inside);
  }

  const SolvedFit& fit_;
  Optimum optimum_;
  int k_;
  bool found_lower_ = false;
  int last_trace_ = 0;
  double length_ = 0;     // of half the interval, if the likelihood were a parabola
  double threshold_ = 0;  // of the rise of the deviance
  double t95_ = 0;
  std::vector<ProfilePoint> points_;
  Eigen::VectorXd direction_;  // change of the free parameters along the profile
};

}  // namespace

ProfileInterval ProfileParameter(const SolvedFit& fit, const Optimum& optimum, int k) {
  const auto index = static_cast<std::size_t>(k);
  Profile profile(fit, optimum, k);
  ProfileInterval interval;
  if (!profile.is_defined()) {
    interval.open = OpenInterval::kNotDetermined;
    return interval;
  }
  const double lower = fit.solve.lower[index];
  const double upper = fit.solve.upper[index];
  const std::optional<double> down = profile.FindReach(-1);
  const std::optional<double> up = profile.FindReach(1);
  if (down || std::isfinite(lower)) interval.lower = down ? profile.At() - *down : lower;
  if (up || std::isfinite(upper)) interval.upper = up ? profile.At() + *up : upper;
  if (!interval.lower || !interval.upper) {
    interval.open = OpenInterval::kFlatLikelihood;
  }
  if (profile.is_exhausted()) {
    interval.lower = interval.upper = std::nullopt;
    interval.open = OpenInterval::kNotFollowed;
  }
  if (profile.found_lower()) {
    interval.lower = interval.upper = std::nullopt;
    interval.open = OpenInterval::kBetterMinimum;
  }
  if (profile.is_exhausted() || profile.found_lower()) return interval;
  interval.points =
      profile.SpreadPoints(down.value_or(profile.SearchedDistance(-1)), up.value_or(profile.SearchedDistance(1)));
  // The curve is then incomplete, but the ends are valid.
  if (profile.is_exhausted() || profile.found_lower()) interval.points.clear();
  interval.threshold = profile.threshold();
  return interval;
}

}  // namespace pendulum
