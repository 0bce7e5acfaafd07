// SPDX-License-Identifier: Apache-2.0
#include "fitting/likelihood/averaged_counts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pendulum {
namespace {

constexpr double kSqrtHalf = 0.70710678118654752440;
constexpr double kPerRootTwoPi = 0.39894228040143267794;
constexpr double kVarianceOfRounding = 1.0 / 12;  // counts²

/// A function of x and λ with the derivatives that a likelihood needs, in this order: f; f_x, f_xx; f_λ, f_λλ, f_xλ.
/// The first kTerms of them are computed: 1, 3 or 6.
template <int kTerms>
using Terms = std::array<double, kTerms>;

template <int kTerms>
Terms<kTerms> Product(const Terms<kTerms>& a, const Terms<kTerms>& b) {
  Terms<kTerms> c;
  c[0] = a[0] * b[0];
  if constexpr (kTerms >= 3) {
    c[1] = a[0] * b[1] + a[1] * b[0];
    c[2] = a[0] * b[2] + 2 * a[1] * b[1] + a[2] * b[0];
  }
  if constexpr (kTerms == 6) {
    c[3] = a[0] * b[3] + a[3] * b[0];
    c[4] = a[0] * b[4] + 2 * a[3] * b[3] + a[4] * b[0];
    c[5] = a[0] * b[5] + a[1] * b[3] + a[3] * b[1] + a[5] * b[0];
  }
  return c;
}

/// The probability that a reading is above the edge at distance u · σ above its value, as a function of value and λ.
template <int kTerms>
Terms<kTerms> AboveEdge(double u, double sigma) {
  Terms<kTerms> above;
  above[0] = 0.5 * std::erfc(kSqrtHalf * u);
  if constexpr (kTerms >= 3) {
    const double density = kPerRootTwoPi * std::exp(-0.5 * u * u);
    above[1] = density / sigma;
    above[2] = density * u / (sigma * sigma);
    if constexpr (kTerms == 6) {
      above[3] = density * u;
      above[4] = density * u * (u * u - 1);
      above[5] = density * (u * u - 1) / sigma;
    }
  }
  return above;
}

constexpr double kFarEdge = 7.2;  // in σ: a reading is beyond it with a probability of 3e-13, which is neglected
constexpr int kMostLevels = 14;   // for σ up to 0.75: 2 · kFarEdge · σ + 1 edges, and one level more

/// The levels that one reading may show and their probabilities, the lowest level first.
template <int kTerms>
struct ReadingLevels {
  double lowest = 0;
  int count = 1;
  std::array<Terms<kTerms>, kMostLevels> probability;
};

/// Sets the levels of a reading at the value z [counts].
template <int kTerms>
void SetLevels(const CountSum& sum, double z, double sigma, ReadingLevels<kTerms>& levels) {
  const double reach = kFarEdge * sigma;
  // The lowest level is the one whose upper edge is the first above z - reach; likewise the highest.
  const double lowest = std::clamp(std::ceil(z - reach - 0.5), sum.low, sum.high);
  const double highest = std::clamp(std::floor(z + reach + 0.5), lowest, sum.high);
  levels.lowest = lowest;
  levels.count = static_cast<int>(std::min(highest - lowest, kMostLevels - 1.0)) + 1;
  Terms<kTerms> rest{};  // the probability of this level and those above it, or below an edge near the top
  rest[0] = 1;
  bool from_below = true;  // `rest` is 1 minus a small number while the edges are below the value
  for (int k = 0; k + 1 < levels.count; ++k) {
    const double u = (lowest + k + 0.5 - z) / sigma;
    Terms<kTerms>& here = levels.probability[k];
    const Terms<kTerms> above = AboveEdge<kTerms>(u, sigma);
    if (u < 0) {
      // Both edges are below the value: the difference of the probabilities below them keeps its digits.
      Terms<kTerms> below = AboveEdge<kTerms>(-u, sigma);
      for (int t = 1; t < kTerms; ++t) below[t] = -above[t];
      for (int t = 0; t < kTerms; ++t) here[t] = k == 0 ? below[t] : below[t] - rest[t];
      rest = below;
      continue;
    }
    if (from_below && k > 0) {
      for (int t = 0; t < kTerms; ++t) rest[t] = (t == 0 ? 1.0 : 0.0) - rest[t];
    }
    from_below = false;
    for (int t = 0; t < kTerms; ++t) here[t] = rest[t] - above[t];
    rest = above;
  }
  Terms<kTerms>& last = levels.probability[levels.count - 1];
  last = rest;
  if (from_below && levels.count > 1) {
    for (int t = 0; t < kTerms; ++t) last[t] = (t == 0 ? 1.0 : 0.0) - rest[t];
  }
}

/// Adds the readings of a sum one by one and keeps the distribution of their sum so far. Reuses its memory.
template <int kTerms>
class SumDistribution {
 public:
  void Set(const CountSum& sum, double x, double sigma) {
    const auto n = static_cast<std::size_t>(sum.readings);
    is_still_ = sum.motion.slope == 0 && sum.motion.bend == 0;
    if (levels_.size() < n) levels_.resize(n);
    readings_ = n;
    lowest_ = 0;
    span_ = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double s = (static_cast<double>(i) + 0.5) / sum.readings - 0.5;
      if (i == 0 || !is_still_) SetLevels(sum, x + s * (sum.motion.slope + s * sum.motion.bend), sigma, levels_[i]);
      lowest_ += LevelsOf(i).lowest;
      span_ += LevelsOf(i).count - 1;
    }
    target_ = sum.sum - lowest_;
  }

  /// The probability of the sum; 0 if it is out of reach.
  Terms<kTerms> OfSum() {
    if (!(target_ >= 0 && target_ <= span_)) return {};
    const int target = static_cast<int>(target_);
    Convolve(target, target);
    return target >= bottom_ && target <= top_ ? values_[static_cast<std::size_t>(target)] : Terms<kTerms>{};
  }

  /// The probabilities of less than the sum, and of at most the sum.
  NoiseModel::Distribution UpToSum() {
    if (target_ < 0) return {0, 0};
    if (target_ > span_) return {1, 1};
    const int target = static_cast<int>(target_);
    Convolve(0, target);
    double below = 0;
    for (int k = 0; k < target; ++k) below += values_[static_cast<std::size_t>(k)][0];
    return {std::min(below, 1.0), std::min(below + values_[static_cast<std::size_t>(target)][0], 1.0)};
  }

 private:
  const ReadingLevels<kTerms>& LevelsOf(std::size_t i) const { return levels_[is_still_ ? 0 : i]; }

  /// Computes the probabilities of sums up to `most`, counted from the lowest; those below `least` only as far as they
  /// are needed.
  void Convolve(int least, int most) {
    values_.assign(static_cast<std::size_t>(most) + 1, Terms<kTerms>{});
    values_[0][0] = 1;
    bottom_ = top_ = 0;
    int remaining = span_;
    for (std::size_t i = 0; i < readings_; ++i) {
      const ReadingLevels<kTerms>& levels = LevelsOf(i);
      if (levels.count == 1) continue;
      remaining -= levels.count - 1;
      Add(levels, std::max(bottom_, least - remaining), std::min(top_ + levels.count - 1, most));
    }
  }

  /// Adds a reading. The sums from `bottom` to `top` are computed, from the top down, so that the sums without the
  /// reading are still there.
  void Add(const ReadingLevels<kTerms>& levels, int bottom, int top) {
    for (int k = top; k >= bottom; --k) {
      Terms<kTerms> sum{};
      const int last = std::min(levels.count - 1, k - bottom_);
      for (int j = std::max(0, k - top_); j <= last; ++j) {
        const Terms<kTerms> product =
            Product<kTerms>(values_[static_cast<std::size_t>(k - j)], levels.probability[static_cast<std::size_t>(j)]);
        for (int t = 0; t < kTerms; ++t) sum[static_cast<std::size_t>(t)] += product[static_cast<std::size_t>(t)];
      }
      values_[static_cast<std::size_t>(k)] = sum;
    }
    bottom_ = bottom;
    top_ = top;
    Trim();
  }

  /// Leaves out sums whose probability is negligible.
  void Trim() {
    constexpr double kNegligible = 1e-18;
    while (bottom_ < top_ && values_[static_cast<std::size_t>(bottom_)][0] < kNegligible)
      values_[static_cast<std::size_t>(bottom_++)] = {};
    while (bottom_ < top_ && values_[static_cast<std::size_t>(top_)][0] < kNegligible)
      values_[static_cast<std::size_t>(top_--)] = {};
  }

  std::vector<ReadingLevels<kTerms>> levels_;  // the first readings_ are in use, or one if the value stands still
  std::size_t readings_ = 0;
  bool is_still_ = false;
  std::vector<Terms<kTerms>> values_;
  double lowest_ = 0;
  double target_ = 0;
  int span_ = 0;
  int bottom_ = 0;  // sums below it and above top_ are impossible so far
  int top_ = 0;
};

template <int kTerms>
SumDistribution<kTerms>& DistributionOf(const CountSum& sum, double x, double sigma) {
  thread_local SumDistribution<kTerms> distribution;
  distribution.Set(sum, x, sigma);
  return distribution;
}

/// The expectation of the value over the window minus that at its middle: bend · mean of s².
double MeanBend(const CountSum& sum) {
  const double n = sum.readings;
  return sum.motion.bend * (1 - 1 / (n * n)) / 12;
}

/// Derivatives of log P from those of P.
template <int kTerms>
NoiseLikelihood LogOf(const Terms<kTerms>& p) {
  NoiseLikelihood l;
  l.log = std::log(p[0]);
  if constexpr (kTerms >= 3) {
    l.score = p[1] / p[0];
    l.information = l.score * l.score - p[2] / p[0];
  }
  if constexpr (kTerms == 6) {
    l.sigma_score = p[3] / p[0];
    l.sigma_information = l.sigma_score * l.sigma_score - p[4] / p[0];
    l.mixed = l.score * l.sigma_score - p[5] / p[0];
  }
  return l;
}

/// f(a) and its derivatives, from those of f at a[0].
template <int kTerms>
Terms<kTerms> Composed(const Terms<kTerms>& a, double f, double first, double second) {
  Terms<kTerms> c;
  c[0] = f;
  if constexpr (kTerms >= 3) {
    c[1] = first * a[1];
    c[2] = first * a[2] + second * a[1] * a[1];
  }
  if constexpr (kTerms == 6) {
    c[3] = first * a[3];
    c[4] = first * a[4] + second * a[3] * a[3];
    c[5] = first * a[5] + second * a[1] * a[3];
  }
  return c;
}

/// Σ of the expectations and of the variances of the readings of a mean.
template <int kTerms>
struct Moments {
  Terms<kTerms> expectation{};
  Terms<kTerms> variance{};
};

/// MODEL.md eq. (7.10). With g = exp(-2π²σ²), a rounded reading at z has the expectation z - g sin(2πz) / π and the
/// variance σ² + 1/12 - g (4σ² + 1/π²) cos(2πz) - g² sin²(2πz) / π², but for terms of g⁴ (B. Widrow and I. Kollár,
/// Quantization Noise, 2008, section 4).
template <int kTerms>
Moments<kTerms> MomentsOf(const CountSum& sum, double x, double sigma) {
  constexpr double kPi = 3.14159265358979323846;
  const double square = sigma * sigma;
  const double slope = -4 * kPi * kPi * square;  // d ln g / dλ
  const double g = sigma < kContinuousSigma ? std::exp(-2 * kPi * kPi * square) : 0;
  const double b = 4 * square + 1 / (kPi * kPi);
  const Terms<6> wave = {g, 0, 0, g * slope, g * slope * (slope + 2), 0};
  const Terms<6> factor = {b, 0, 0, 8 * square, 16 * square, 0};
  Terms<6> expectation{};
  Terms<6> variance{};
  const bool is_still = sum.motion.slope == 0 && sum.motion.bend == 0;
  const int places = g == 0 ? 0 : is_still ? 1 : sum.readings;
  const double weight = is_still ? sum.readings : 1;
  for (int i = 0; i < places; ++i) {
    const double s = is_still ? 0.0 : (i + 0.5) / sum.readings - 0.5;
    const double angle = 2 * kPi * (x + s * (sum.motion.slope + s * sum.motion.bend));
    const double sine = std::sin(angle);
    const double cosine = std::cos(angle);
    const Terms<6> sines = {sine, 2 * kPi * cosine, -4 * kPi * kPi * sine, 0, 0, 0};
    const Terms<6> cosines = {cosine, -2 * kPi * sine, -4 * kPi * kPi * cosine, 0, 0, 0};
    const Terms<6> shift = Product<6>(wave, sines);
    const Terms<6> less = Product<6>(Product<6>(wave, factor), cosines);
    const Terms<6> shift_squared = Product<6>(shift, shift);
    for (std::size_t t = 0; t < 6; ++t) {
      expectation[t] -= weight * shift[t] / kPi;
      variance[t] -= weight * (less[t] + shift_squared[t] / (kPi * kPi));
    }
  }
  const double n = sum.readings;
  expectation[0] += n * (x + MeanBend(sum));
  expectation[1] += n;
  variance[0] += n * (square + kVarianceOfRounding);
  variance[3] += 2 * n * square;
  variance[4] += 4 * n * square;
  Moments<kTerms> moments;
  std::copy_n(expectation.begin(), kTerms, moments.expectation.begin());
  std::copy_n(variance.begin(), kTerms, moments.variance.begin());
  return moments;
}

/// The sum as a normal variable with the expectation and the variance of the sum of rounded readings.
template <int kTerms>
NoiseLikelihood NormalSum(const CountSum& sum, double x, double sigma) {
  const Moments<kTerms> moments = MomentsOf<kTerms>(sum, x, sigma);
  Terms<kTerms> off = moments.expectation;
  off[0] -= sum.sum;
  const double v = moments.variance[0];
  const Terms<kTerms> inverse = Composed<kTerms>(moments.variance, 1 / v, -1 / (v * v), 2 / (v * v * v));
  const Terms<kTerms> log = Composed<kTerms>(moments.variance, std::log(v), 1 / v, -1 / (v * v));
  const Terms<kTerms> ratio = Product<kTerms>(Product<kTerms>(off, off), inverse);
  Terms<kTerms> l;
  for (std::size_t t = 0; t < kTerms; ++t) l[t] = -0.5 * (ratio[t] + log[t]);
  NoiseLikelihood likelihood;
  likelihood.log = l[0] + std::log(kPerRootTwoPi);
  if constexpr (kTerms >= 3) likelihood.score = l[1], likelihood.information = -l[2];
  if constexpr (kTerms == 6) {
    likelihood.sigma_score = l[3];
    likelihood.sigma_information = -l[4];
    likelihood.mixed = -l[5];
  }
  return likelihood;
}

/// Whether the sum is taken for a normal variable. With few readings the exact sum is quick; at an end of the range it
/// is needed.
bool IsNormal(const CountSum& sum, double sigma) {
  constexpr double kNearEnd = 2;       // counts
  constexpr double kMostSigma = 0.75;  // counts, for which kMostLevels are enough
  const double mean = sum.sum / sum.readings;
  if (sigma < kMostSigma && (mean < sum.low + kNearEnd || mean > sum.high - kNearEnd)) return false;
  return sigma >= (sum.readings >= 32 ? 0.3 : sum.readings >= 8 ? 0.4 : kContinuousSigma);
}

template <int kTerms>
NoiseLikelihood ExactSum(const CountSum& sum, double x, double sigma) {
  constexpr double kOutlier = 1e-13;  // probability
  constexpr double kBell = 0.3;       // counts
  constexpr double kImpossible = 1e-250;
  const double off = sum.sum / sum.readings - x - MeanBend(sum);
  Terms<kTerms> p = DistributionOf<kTerms>(sum, x, sigma).OfSum();
  const double outlier = kOutlier * std::exp(-0.5 * off * off / (kBell * kBell));
  if (!(p[0] + outlier > kImpossible)) {
    NoiseLikelihood l;
    l.log = std::log(kOutlier) - 0.5 * off * off / (kBell * kBell);
    l.score = off / (kBell * kBell);
    l.information = 1 / (kBell * kBell);
    return l;
  }
  p[0] = std::max(p[0], 0.0) + outlier;
  if constexpr (kTerms >= 3) {
    p[1] += outlier * off / (kBell * kBell);
    p[2] += outlier * (off * off / (kBell * kBell) - 1) / (kBell * kBell);
  }
  return LogOf<kTerms>(p);
}

}  // namespace

CountSum CountSumOf(const NoiseModel& noise, double y) {
  const Averaging& averaging = noise.averaging;
  const double per_count = 1 / averaging.count;
  CountSum sum;
  sum.readings = averaging.readings;
  sum.sum = std::round((y - averaging.level) * per_count * averaging.readings);
  sum.motion = {averaging.motion.slope * per_count, averaging.motion.bend * per_count};
  // The limits of censoring lie half a step of the means within the range.
  if (noise.low > -kInfinity) sum.low = std::floor((noise.low - averaging.level) * per_count);
  if (noise.high < kInfinity) sum.high = std::ceil((noise.high - averaging.level) * per_count);
  return sum;
}

NoiseLikelihood CountSumLikelihood(const CountSum& sum, double x, double sigma) {
  return IsNormal(sum, sigma) ? NormalSum<6>(sum, x, sigma) : ExactSum<6>(sum, x, sigma);
}

NoiseLikelihood CountSumSlope(const CountSum& sum, double x, double sigma) {
  return IsNormal(sum, sigma) ? NormalSum<3>(sum, x, sigma) : ExactSum<3>(sum, x, sigma);
}

double CountSumLog(const CountSum& sum, double x, double sigma) {
  return IsNormal(sum, sigma) ? NormalSum<1>(sum, x, sigma).log : ExactSum<1>(sum, x, sigma).log;
}

NoiseModel::Distribution CountSumDistribution(const CountSum& sum, double x, double sigma) {
  if (!IsNormal(sum, sigma)) return DistributionOf<1>(sum, x, sigma).UpToSum();
  const Moments<1> moments = MomentsOf<1>(sum, x, sigma);
  const double scale = kSqrtHalf / std::sqrt(moments.variance[0]);
  const auto below = [&](double edge) { return 0.5 * std::erfc((moments.expectation[0] - edge) * scale); };
  return {below(sum.sum - 0.5), below(sum.sum + 0.5)};
}

double CountSumMargin(const CountSum& sum, double x) {
  double total = 0;
  double margin = kInfinity;
  for (int i = 0; i < sum.readings; ++i) {
    const double s = (i + 0.5) / sum.readings - 0.5;
    const double z = x + s * (sum.motion.slope + s * sum.motion.bend);
    const double level = std::clamp(std::round(z), sum.low, sum.high);
    total += level;
    if (level < sum.high) margin = std::min(margin, level + 0.5 - z);
    if (level > sum.low) margin = std::min(margin, z - level + 0.5);
  }
  return total == sum.sum ? std::max(margin, 0.0) : 0.0;
}

}  // namespace pendulum
