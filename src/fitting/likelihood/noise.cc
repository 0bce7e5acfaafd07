// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/likelihood/noise.h"

#include <algorithm>
#include <cmath>

#include "fitting/likelihood/averaged_counts.h"
#include "fitting/likelihood/level_likelihoods.h"
#include "pendulum/base/distributions.h"
#include "pendulum/base/physics.h"

namespace pendulum {
namespace {

constexpr double kRootHalf = 0.70710678118654752440;
constexpr double kRootTwoPi = 2.50662827463100050242;
constexpr double kLogRootTwoPi = 0.91893853320467274178;

double Density(double x) { return std::exp(-0.5 * x * x) / kRootTwoPi; }

/// Mills' ratio (1 - Φ(x)) / φ(x) for x >= 0; for large x by the asymptotic series (Abramowitz & Stegun 26.2.12).
double MillsRatio(double x) {
  constexpr double kFarOut = 20;
  if (x < kFarOut) return 0.5 * std::erfc(kRootHalf * x) * kRootTwoPi * std::exp(0.5 * x * x);
  const double inverse_square = 1 / (x * x);
  double term = 1;
  double sum = 1;
  for (int k = 1; k <= 8; ++k) {
    term *= -(2 * k - 1) * inverse_square;
    sum += term;
  }
  return sum / x;
}

/// For 0 <= a < b.
IntervalProbability UpperTail(double a, double b) {
  const double ratio = MillsRatio(a);
  const double density = std::isinf(b) ? 0 : std::exp(-0.5 * (b - a) * (b + a));  // φ(b) / φ(a)
  const double rest = density > 0 ? density * MillsRatio(b) / ratio : 0;          // Q(b) / Q(a)
  IntervalProbability interval;
  interval.log = -0.5 * a * a - kLogRootTwoPi + std::log(ratio) + std::log1p(-rest);
  interval.lower = 1 / (ratio * (1 - rest));
  interval.upper = interval.lower * density;
  return interval;
}

/// For a < 0 < b.
IntervalProbability AroundZero(double a, double b) {
  // Computes the smaller of the probabilities outside and inside, to keep its digits.
  const double outside = 0.5 * (std::erfc(-kRootHalf * a) + std::erfc(kRootHalf * b));
  const double inside = outside < 0.5 ? 1 - outside : 0.5 * (std::erf(kRootHalf * b) - std::erf(kRootHalf * a));
  return {outside < 0.5 ? std::log1p(-outside) : std::log(inside), Density(a) / inside, Density(b) / inside};
}

/// Limit for a short interval: log φ changes by less than this over the interval, and the length of the interval is
/// less than a tenth of this. The probability is then density times length, with an error of fourth order in both.
constexpr double kShort = 4e-3;

IntervalProbability ShortInterval(double a, double b) {
  const double length = b - a;
  const double middle = 0.5 * (a + b);
  const double curvature = (middle * middle - 1) * length * length / 24;
  const double tilt = 0.5 * middle * length;  // of log φ, to each end
  const double sag = 0.125 * length * length + curvature;
  IntervalProbability interval;
  interval.log = -0.5 * middle * middle - kLogRootTwoPi + std::log(length) + curvature;
  interval.lower = std::exp(tilt - sag) / length;
  interval.upper = std::exp(-tilt - sag) / length;
  return interval;
}

double LogStudentConstant(double freedom) {
  return std::lgamma(0.5 * (freedom + 1)) - std::lgamma(0.5 * freedom) - 0.5 * std::log(freedom * kPi);
}

/// Integral of exp(-ρ(z)) for Huber's ρ.
double HuberConstant(double width) {
  return kRootTwoPi * std::erf(kRootHalf * width) + 2 / width * std::exp(-0.5 * width * width);
}

}  // namespace

IntervalProbability GaussianInterval(double a, double b) {
  if (a < 0 && b <= 0) {
    const IntervalProbability mirrored = GaussianInterval(-b, -a);
    return {mirrored.log, mirrored.upper, mirrored.lower};
  }
  if ((b - a) * std::max(a, 10.0) < kShort) return ShortInterval(a, b);
  return a >= 0 ? UpperTail(a, b) : AroundZero(a, b);
}

std::string_view NoiseFamilyName(NoiseFamily family) {
  switch (family) {
    case NoiseFamily::kGaussian: return "gaussian";
    case NoiseFamily::kQuantized: return "quantized";
    case NoiseFamily::kHuber: return "huber";
    case NoiseFamily::kStudent: return "student";
    case NoiseFamily::kEdges: return "edges";
    case NoiseFamily::kAveraged: return "averaged";
  }
  return "gaussian";
}

namespace {

/// The values that a reading allows: an interval, or from == to.
struct Interval {
  double from;
  double to;
};

Interval IntervalOf(const NoiseModel& noise, double y) {
  if (y <= noise.low) return {-kInfinity, noise.low};
  if (y >= noise.high) return {noise.high, kInfinity};
  const double half = 0.5 * noise.resolution + noise.lag;
  return {y - half, y + half};
}

/// b · density, or 0 if b is infinite.
double ProductOrZero(double b, double density) { return std::isinf(b) ? 0 : b * density; }

/// Log-probability of an interval and its derivatives (MODEL.md eq. (7.2)).
NoiseLikelihood IntervalLikelihood(const Interval& interval, double m, double sigma) {
  const double a = (interval.from - m) / sigma;
  const double b = (interval.to - m) / sigma;
  const IntervalProbability p = GaussianInterval(a, b);
  const double first = ProductOrZero(a, p.lower) - ProductOrZero(b, p.upper);
  const double second = ProductOrZero(a * a, p.lower) - ProductOrZero(b * b, p.upper);
  const double third = ProductOrZero(a * a * a, p.lower) - ProductOrZero(b * b * b, p.upper);
  NoiseLikelihood l;
  l.log = p.log;
  const double slope = p.lower - p.upper;  // σ ∂l/∂m
  l.score = slope / sigma;
  l.information = std::max(slope * slope - first, 0.0) / (sigma * sigma);
  l.sigma_score = first;
  l.sigma_information = first * first + first - third;
  l.mixed = (slope * first + slope - second) / sigma;
  return l;
}

NoiseLikelihood GaussianLikelihood(double residual, double sigma) {
  const double z = residual / sigma;
  NoiseLikelihood l;
  l.log = -0.5 * z * z - kLogRootTwoPi - std::log(sigma);
  l.score = z / sigma;
  l.information = 1 / (sigma * sigma);
  l.sigma_score = z * z - 1;
  l.sigma_information = 2 * z * z;
  l.mixed = 2 * z / sigma;
  return l;
}

NoiseLikelihood StudentLikelihood(double residual, double sigma) {
  constexpr double kFreedom = NoiseModel::kStudentFreedom;
  static const double constant = LogStudentConstant(kFreedom);
  const double z = residual / sigma;
  const double spread = kFreedom + z * z;
  NoiseLikelihood l;
  l.log = constant - std::log(sigma) - 0.5 * (kFreedom + 1) * std::log1p(z * z / kFreedom);
  l.score = (kFreedom + 1) * z / spread / sigma;
  l.information = (kFreedom + 1) * (kFreedom - z * z) / (spread * spread) / (sigma * sigma);
  l.sigma_score = (kFreedom + 1) * z * z / spread - 1;
  l.mixed = 2 * kFreedom * (kFreedom + 1) * z / (spread * spread) / sigma;
  l.sigma_information = z * sigma * l.mixed;
  return l;
}

NoiseLikelihood HuberLikelihood(double residual, double sigma) {
  constexpr double kWidth = NoiseModel::kHuberWidth;
  static const double log_constant = std::log(HuberConstant(kWidth));
  const double z = residual / sigma;
  const bool inside = std::abs(z) <= kWidth;
  const double psi = std::clamp(z, -kWidth, kWidth);
  NoiseLikelihood l;
  l.log = -(inside ? 0.5 * z * z : kWidth * std::abs(z) - 0.5 * kWidth * kWidth) - log_constant - std::log(sigma);
  l.score = psi / sigma;
  l.information = inside ? 1 / (sigma * sigma) : 0;
  l.sigma_score = psi * z - 1;
  l.mixed = (inside ? 2 * z : psi) / sigma;
  l.sigma_information = z * sigma * l.mixed;
  return l;
}

}  // namespace

namespace {

/// Lower tail of a standardized robust distribution at u: probability, density, and the density's derivative.
struct Tail {
  double probability;
  double density;
  double slope;
};

Tail StudentBelow(double u) {
  constexpr double kFreedom = NoiseModel::kStudentFreedom;
  const double density = StudentDensity(u, kFreedom);
  return {StudentProbability(u, kFreedom), density, -(kFreedom + 1) * u / (kFreedom + u * u) * density};
}

Tail HuberBelow(double u) {
  constexpr double kWidth = NoiseModel::kHuberWidth;
  static const double constant = HuberConstant(kWidth);
  const double psi = std::clamp(u, -kWidth, kWidth);
  const double density = std::exp(-psi * (u - 0.5 * psi)) / constant;
  if (std::abs(u) > kWidth) return {u < 0 ? density / kWidth : 1 - density / kWidth, density, -psi * density};
  const double corner = std::exp(-0.5 * kWidth * kWidth) / constant / kWidth;
  const double inside = std::erf(kRootHalf * u) + std::erf(kRootHalf * kWidth);
  return {corner + 0.5 * kRootTwoPi / constant * inside, density, -u * density};
}

Tail RobustBelow(NoiseFamily family, double u) {
  return family == NoiseFamily::kHuber ? HuberBelow(u) : StudentBelow(u);
}

/// A reading at an end of the range: the value is at that end or beyond it.
NoiseLikelihood RobustEndLikelihood(const NoiseModel& noise, double y, double m) {
  const double side = y >= noise.high ? 1 : -1;
  const double u = side * (m - (side > 0 ? noise.high : noise.low)) / noise.sigma;
  const Tail tail = RobustBelow(noise.family, u);
  const double hazard = tail.density / tail.probability;
  const double bend = hazard * hazard - tail.slope / tail.probability;
  NoiseLikelihood l;
  l.log = std::log(tail.probability);
  l.score = side * hazard / noise.sigma;
  l.information = bend / (noise.sigma * noise.sigma);
  l.sigma_score = -u * hazard;
  l.sigma_information = -u * hazard + u * u * bend;
  l.mixed = side * (hazard - u * bend) / noise.sigma;
  return l;
}

/// Whether the likelihood is that of a sum of rounded readings. A single reading, or its end of the range, is an
/// interval.
bool IsSum(const NoiseModel& noise) { return noise.family == NoiseFamily::kAveraged && noise.averaging.readings > 1; }

/// Converts the likelihood from counts to the unit of the reading.
NoiseLikelihood FromCounts(NoiseLikelihood l, double per_count) {
  l.score *= per_count;
  l.information *= per_count * per_count;
  l.mixed *= per_count;
  return l;
}

/// The likelihood of a mean is nearly concave. Where it is not, its weight is a part of the squared score, so that the
/// gradient of a sample is never lost.
SampleLikelihood DevianceOfMean(const NoiseModel& noise, double y, double m) {
  constexpr double kLeast = 0.1;
  const double per_count = 1 / noise.averaging.count;
  const NoiseLikelihood l =
      FromCounts(CountSumSlope(CountSumOf(noise, y), InCounts(noise, m), noise.sigma * per_count), per_count);
  return {std::max(-2 * l.log, 0.0), l.score, std::max(l.information, kLeast * l.score * l.score)};
}

}  // namespace

NoiseLikelihood NoiseModel::LikelihoodAt(double y, double m) const {
  if (IsSum(*this)) {
    const double per_count = 1 / averaging.count;
    return FromCounts(CountSumLikelihood(CountSumOf(*this, y), InCounts(*this, m), sigma * per_count), per_count);
  }
  if (IsRobust()) {
    if (IsCensored(y)) return RobustEndLikelihood(*this, y, m);
    return family == NoiseFamily::kHuber ? HuberLikelihood(y - m, sigma) : StudentLikelihood(y - m, sigma);
  }
  if (IsInterval(y)) return IntervalLikelihood(IntervalOf(*this, y), m, sigma);
  return GaussianLikelihood(y - m, sigma);
}

SampleLikelihood NoiseModel::DevianceAt(double y, double m) const {
  if (IsSum(*this)) return DevianceOfMean(*this, y, m);
  if (!IsRobust() && !IsInterval(y)) {
    const double z = (y - m) / sigma;
    return {z * z, z / sigma, 1 / (sigma * sigma)};
  }
  if (IsRobust() && IsCensored(y)) {
    const NoiseLikelihood l = RobustEndLikelihood(*this, y, m);
    return {-2 * l.log, l.score, l.information > 0 ? l.information : l.score * l.score};
  }
  if (IsRobust()) {
    const NoiseLikelihood l = LikelihoodAt(y, m);
    const double best = LikelihoodAt(y, y).log;
    const bool at_top = l.score == 0 || y == m;
    return {2 * (best - l.log), l.score, at_top ? LikelihoodAt(y, y).information : l.score / (y - m)};
  }
  const Interval interval = IntervalOf(*this, y);
  constexpr double kCertain = 8.5;  // in σ from both edges: the probability is 1 to rounding
  if (interval.from + kCertain * sigma < m && m < interval.to - kCertain * sigma) return {};
  const double a = (interval.from - m) / sigma;
  const double b = (interval.to - m) / sigma;
  const IntervalProbability p = GaussianInterval(a, b);
  const double best = std::log(std::erf(0.5 * kRootHalf * (b - a)));  // 0 if censored
  const double slope = p.lower - p.upper;
  const double first = ProductOrZero(a, p.lower) - ProductOrZero(b, p.upper);
  return {std::max(2 * (best - p.log), 0.0), slope / sigma, std::max(slope * slope - first, 0.0) / (sigma * sigma)};
}

NoiseModel::Distribution NoiseModel::DistributionAt(double y, double m) const {
  if (IsSum(*this)) return CountSumDistribution(CountSumOf(*this, y), InCounts(*this, m), sigma / averaging.count);
  const auto below = [&](double x) {
    const double u = (x - m) / sigma;
    return IsRobust() ? RobustBelow(family, u).probability : 0.5 * std::erfc(-kRootHalf * u);
  };
  if (IsCensored(y)) return y >= high ? Distribution{below(high), 1} : Distribution{0, below(low)};
  if (!IsInterval(y)) return {below(y), below(y)};
  const Interval interval = IntervalOf(*this, y);
  return {below(interval.from), below(interval.to)};
}

double LogLikelihood(const NoiseModel& noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                     const Eigen::Ref<const Eigen::VectorXd>& readings) {
  const LevelLikelihoods likelihoods(noise, value.size());
  double sum = 0;
  for (Eigen::Index i = 0; i < value.size(); ++i) sum += likelihoods.At(value[i], readings[i], i).log;
  return sum;
}

namespace {

/// Σ ∂l/∂λ and Σ -∂²l/∂λ² over the samples.
struct SigmaSums {
  double score = 0;
  double information = 0;
  double square = 0;  // of the scores
};

SigmaSums SumsOver(const NoiseModel& noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                   const Eigen::Ref<const Eigen::VectorXd>& readings) {
  SigmaSums sums;
  // Huber's Proposal 2: σ is chosen so that the mean of ψ² equals its mean under normal noise.
  constexpr double kWidth = NoiseModel::kHuberWidth;
  static const double normal =
      std::erf(kRootHalf * kWidth) - 2 * kWidth * Density(kWidth) + kWidth * kWidth * std::erfc(kRootHalf * kWidth);
  const LevelLikelihoods likelihoods(noise, value.size());
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    const NoiseLikelihood l = likelihoods.At(value[i], readings[i], i);
    const bool huber = noise.family == NoiseFamily::kHuber;
    if (huber && noise.IsCensored(value[i])) continue;
    const double psi = noise.sigma * l.score;
    const double score = huber ? psi * psi - normal : l.sigma_score;
    sums.score += score;
    sums.square += score * score;
    sums.information += !huber ? l.sigma_information : l.information > 0 ? 2 * psi * psi : 0.0;
  }
  return sums;
}

}  // namespace

double MostLikelySigma(NoiseModel noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                       const Eigen::Ref<const Eigen::VectorXd>& readings, double smallest) {
  constexpr int kMaxSteps = 60;
  constexpr double kLongestStep = 1;   // in λ
  constexpr double kConverged = 0.01;  // the error after a step is of the order of its square
  double below = std::log(smallest);
  double above = std::log(1e6 * noise.sigma);
  double lambda = std::max(std::log(noise.sigma), below);
  for (int step = 0; step < kMaxSteps; ++step) {
    noise.sigma = std::exp(lambda);
    const SigmaSums sums = SumsOver(noise, value, readings);
    (sums.score > 0 ? below : above) = lambda;
    double change = sums.information > 0 ? sums.score / sums.information : std::copysign(kLongestStep, sums.score);
    change = std::clamp(change, -kLongestStep, kLongestStep);
    double next = lambda + change;
    if (next >= above) next = 0.5 * (lambda + above);
    if (next <= below) next = std::max(0.5 * (lambda + below), std::log(smallest));
    const double made = std::abs(next - lambda);
    lambda = next;
    if (made < kConverged) break;
  }
  return std::exp(lambda);
}

double RobustSigmaError(const NoiseModel& noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                        const Eigen::Ref<const Eigen::VectorXd>& readings) {
  const SigmaSums sums = SumsOver(noise, value, readings);
  return noise.sigma * std::sqrt(sums.square) / sums.information;
}

}  // namespace pendulum
