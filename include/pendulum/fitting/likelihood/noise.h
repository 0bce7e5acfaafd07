// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace pendulum {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Probability that a standard normal variable lies in [a, b], and its derivatives. `log` is log(Φ(b) - Φ(a)); `lower`
/// and `upper` are φ(a) / (Φ(b) - Φ(a)) and φ(b) / (Φ(b) - Φ(a)).
struct IntervalProbability {
  double log = 0;
  double lower = 0;
  double upper = 0;
};

/// Requires a < b; each may be infinite. Error of `log` below 1e-13 (absolute or relative), of `lower` and `upper`
/// 1e-11 (relative).
IntervalProbability GaussianInterval(double a, double b);

/// How samples scatter about the trajectory.
enum class NoiseFamily {
  kGaussian,
  kQuantized,  ///< Normal, then rounded to levels: a reading stands for an interval of one resolution around it.
  kHuber,      ///< Normal within 1.345 σ, two-sided exponential beyond (P. J. Huber, Ann. Math. Stat. 35:73, 1964).
  kStudent,    ///< Student's t with 4 degrees of freedom (Lange, Little & Taylor, JASA 84:881, 1989).
  kEdges,      ///< For events: normal about the edge between two levels; a silence is an interval, as for kQuantized.
  kAveraged,   ///< The mean of several readings, each normal, then rounded to levels (Averaging).
};

/// Whether outliers have bounded influence: kHuber and kStudent.
inline bool IsRobust(std::optional<NoiseFamily> family) {
  return family == NoiseFamily::kHuber || family == NoiseFamily::kStudent;
}

/// "gaussian", "quantized", "huber", "student", "edges", "averaged".
std::string_view NoiseFamilyName(NoiseFamily family);

/// How the value moves while the readings of one mean are taken, in the unit of the reading. At the part s of the
/// averaging window, from -1/2 to 1/2, it differs by slope · s + bend · s² from the value at its middle.
struct WindowMotion {
  double slope = 0;
  double bend = 0;
};

/// How a sample is the mean of rounded readings (MODEL.md eq. (7.9)).
struct Averaging {
  int readings = 1;  ///< n, taken at the middles of n equal parts of the averaging window.
  double count = 0;  ///< Spacing q of the levels of one reading, in the unit of the reading. Means are q / n apart.
  double level = 0;  ///< One of the levels, same unit.
  /// N; null: the value stands still while a mean is taken.
  std::shared_ptr<const std::vector<WindowMotion>> motions = nullptr;
  WindowMotion motion;  ///< Of one sample: NoiseModel::ForSample.
};

/// Log-likelihood l of one sample as a function of the modelled reading m.
struct SampleLikelihood {
  double deviance = 0;  ///< 2 (max l - l) >= 0 at the given σ: the square of the deviance residual.
  double score = 0;     ///< ∂l/∂m
  /// -∂²l/∂m² >= 0. For robust families score / (y - m): the parabola in m that touches l at the current m and has this
  /// curvature is nowhere above l.
  double weight = 0;
};

/// The same log-likelihood as a function of m and of λ = ln σ.
struct NoiseLikelihood {
  double log = 0;                     ///< l: log-probability if quantized or censored, otherwise log-density.
  double score = 0, information = 0;  ///< ∂l/∂m and -∂²l/∂m²
  double sigma_score = 0, sigma_information = 0;  ///< ∂l/∂λ and -∂²l/∂λ²
  double mixed = 0;                               ///< -∂²l/∂m∂λ
};

/// The noise of the samples of one recording (MODEL.md eq. (7.1) to (7.3), (7.5)). A reading at an end of the sensor's
/// range is censored: the true value is at that end or beyond it.
struct NoiseModel {
  static constexpr double kHuberWidth = 1.345;  ///< In σ.
  static constexpr double kStudentFreedom = 4;

  NoiseFamily family = NoiseFamily::kGaussian;
  double sigma = 1;       ///< rad or rad/s: standard deviation, or the scale of the robust families.
  double resolution = 0;  ///< q, same unit; used for kQuantized and kEdges.
  double low = -kInfinity, high = kInfinity;  ///< Same unit; readings at or beyond these limits are censored.
  std::optional<double> edge = std::nullopt;  ///< Same unit; for events, one of the edges, as in Recording::edge.
  double stamp_ratio = 0;                     ///< Standard deviation of a time stamp divided by σ [s/rad]; for kEdges.
  double lag = 0;                             ///< Same unit, for kEdges: extends a silence's interval at both ends.
  /// N, for kEdges: the standard deviation of sample i is σ · spread[i], including the error of its time stamp. If
  /// null, every sample has σ.
  std::shared_ptr<const std::vector<double>> spread = nullptr;
  Averaging averaging = {};  ///< For kAveraged; σ is that of one reading. `resolution` is the spacing of the means.

  bool IsCensored(double reading) const { return reading <= low || reading >= high; }
  /// Whether least squares is the exact likelihood: normal noise, and no reading at an end of the range.
  bool IsUncensoredGaussian() const {
    return family == NoiseFamily::kGaussian && low == -kInfinity && high == kInfinity;
  }

  /// For events: whether a reading only states that the value lies within its level.
  bool IsSilence(double reading) const {
    if (!edge) return false;
    const double levels = (reading - *edge) / resolution;
    return std::abs(levels - std::round(levels)) > 0.25;
  }
  /// Whether a reading is an interval, not a number.
  bool IsInterval(double reading) const {
    return family == NoiseFamily::kQuantized || family == NoiseFamily::kAveraged || IsCensored(reading) ||
           (family == NoiseFamily::kEdges && IsSilence(reading));
  }

  /// The noise of sample i: σ includes its spread, and `spread` is null; likewise the motion of the averaging.
  NoiseModel ForSample(Eigen::Index i) const {
    if (!spread && !averaging.motions) return *this;
    const auto at = static_cast<std::size_t>(i);
    const double own = spread ? sigma * (*spread)[at] : sigma;
    const WindowMotion motion = averaging.motions ? (*averaging.motions)[at] : averaging.motion;
    const Averaging here = {averaging.readings, averaging.count, averaging.level, nullptr, motion};
    return {family, own, resolution, low, high, edge, stamp_ratio, lag, nullptr, here};
  }
  /// The noise of the samples from index `first` on.
  NoiseModel From(Eigen::Index first) const {
    NoiseModel remaining = *this;
    if (spread) remaining.spread = std::make_shared<const std::vector<double>>(spread->begin() + first, spread->end());
    if (const auto& all = averaging.motions)
      remaining.averaging.motions = std::make_shared<const std::vector<WindowMotion>>(all->begin() + first, all->end());
    return remaining;
  }
  /// Standard deviation of each of the N samples; for kAveraged of a mean, in which rounding is noise.
  Eigen::VectorXd Deviations(Eigen::Index samples) const {
    if (family == NoiseFamily::kAveraged) return Eigen::VectorXd::Constant(samples, MeanDeviation());
    if (!spread) return Eigen::VectorXd::Constant(samples, sigma);
    return sigma * Eigen::Map<const Eigen::VectorXd>(spread->data(), samples);
  }

  bool IsRobust() const { return pendulum::IsRobust(family); }

  /// For kAveraged: standard deviation of a mean if rounding were noise of q / sqrt(12).
  double MeanDeviation() const {
    const double rounding = averaging.count * averaging.count / 12;
    return std::sqrt((sigma * sigma + rounding) / averaging.readings);
  }

  /// Deviance of a reading y for the modelled reading m, as the solver needs it. If the noise has a spread, call this
  /// and the next two functions on ForSample(i).
  SampleLikelihood DevianceAt(double y, double m) const;
  /// Log-likelihood of a reading y for the modelled reading m, with the derivatives with respect to m and ln σ.
  NoiseLikelihood LikelihoodAt(double y, double m) const;

  /// Distribution function just below the reading y and at y. The two are equal if the noise has a density at y.
  struct Distribution {
    double below;
    double at;
  };
  Distribution DistributionAt(double y, double m) const;
};

/// Σ l over the N samples.
double LogLikelihood(const NoiseModel& noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                     const Eigen::Ref<const Eigen::VectorXd>& readings);

/// The σ that maximizes the likelihood of N samples (Huber's "proposal 2" for kHuber), at most 1e6 times noise.sigma.
/// It is at least `smallest`, which is returned when the quantization explains every sample.
double MostLikelySigma(NoiseModel noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                       const Eigen::Ref<const Eigen::VectorXd>& readings, double smallest);

/// Standard error of a robust family's σ, from the scatter of the samples' scores.
double RobustSigmaError(const NoiseModel& noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                        const Eigen::Ref<const Eigen::VectorXd>& readings);

}  // namespace pendulum
