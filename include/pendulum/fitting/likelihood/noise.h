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

/// What a standard normal variable says by lying in [a, b]: log(Φ(b) - Φ(a)), and the densities at the ends over that
/// probability, φ(a) / (Φ(b) - Φ(a)) and φ(b) / (Φ(b) - Φ(a)).
struct IntervalProbability {
  double log = 0;
  double lower = 0;
  double upper = 0;
};

/// Error of log below 1e-13, absolute or relative, of the densities 1e-11, relative. a < b, each may be infinite.
IntervalProbability GaussianInterval(double a, double b);

/// How samples scatter about the trajectory.
enum class NoiseFamily {
  kGaussian,
  kQuantized,  ///< Normal, then rounded to levels: a reading is an interval of one resolution about it.
  kHuber,      ///< Normal within 1.345 σ, two-sided exponential beyond (P. J. Huber, Ann. Math. Stat. 35:73, 1964).
  kStudent,    ///< Student's t with 4 degrees of freedom (Lange, Little & Taylor, JASA 84:881, 1989).
  kEdges,      ///< Of events: normal about the edge between two levels; silences say no more than kQuantized readings.
};

/// Whether outliers have bounded influence: kHuber and kStudent.
inline bool IsRobust(std::optional<NoiseFamily> family) {
  return family == NoiseFamily::kHuber || family == NoiseFamily::kStudent;
}

/// "gaussian", "quantized", "huber", "student", "edges".
std::string_view NoiseFamilyName(NoiseFamily family);

/// What a sample's log-likelihood l says of the modelled reading m.
struct SampleLikelihood {
  double deviance = 0;  ///< 2 (max l - l) >= 0, at this σ: the square of the deviance residual.
  double score = 0;     ///< ∂l/∂m
  double weight = 0;    ///< -∂²l/∂m² >= 0; of the robust families score / (y - m), whose parabola lies below l.
};

/// What it says of σ too, by its logarithm λ.
struct NoiseLikelihood {
  double log = 0;                     ///< l: of a probability when quantized or censored, of a density otherwise.
  double score = 0, information = 0;  ///< ∂l/∂m and -∂²l/∂m²
  double sigma_score = 0, sigma_information = 0;  ///< ∂l/∂λ and -∂²l/∂λ²
  double mixed = 0;                               ///< -∂²l/∂m∂λ
};

/// The noise of the samples of one recording (MODEL.md eq. (26) to (28), (82)). A reading at an end of the sensor's
/// range is censored: it says that the value is there or beyond.
struct NoiseModel {
  static constexpr double kHuberWidth = 1.345;  ///< In σ.
  static constexpr double kStudentFreedom = 4;

  NoiseFamily family = NoiseFamily::kGaussian;
  double sigma = 1;       ///< rad or rad/s: standard deviation, or the scale of the robust families.
  double resolution = 0;  ///< q, same unit; used when quantized or of edges.
  double low = -kInfinity, high = kInfinity;  ///< Same unit; readings at them or beyond are censored.
  std::optional<double> edge = std::nullopt;  ///< Same unit; of events one of the edges, as Recording::edge.
  double stamp_ratio = 0;                     ///< Standard deviation of a stamp over σ [s/rad]; of edges.
  double lag = 0;                             ///< Same unit, of edges: a silence reaches so far beyond its count.
  /// N, of edges: sample i has the standard deviation σ · spread[i], its stamp's error included; none: all have σ.
  std::shared_ptr<const std::vector<double>> spread = nullptr;

  bool IsCensored(double reading) const { return reading <= low || reading >= high; }
  /// Whether least squares say everything: normal, and no reading at an end of the range.
  bool IsPlain() const { return family == NoiseFamily::kGaussian && low == -kInfinity && high == kInfinity; }

  /// Of events: whether a reading says no more than that the value lies within its level.
  bool IsSilence(double reading) const {
    if (!edge) return false;
    const double levels = (reading - *edge) / resolution;
    return std::abs(levels - std::round(levels)) > 0.25;
  }
  /// Whether a reading is an interval, not a number.
  bool IsInterval(double reading) const {
    return family == NoiseFamily::kQuantized || IsCensored(reading) ||
           (family == NoiseFamily::kEdges && IsSilence(reading));
  }

  /// The noise of sample i alone, which has no spread.
  NoiseModel ForSample(Eigen::Index i) const {
    if (!spread) return *this;
    const double own = sigma * (*spread)[static_cast<std::size_t>(i)];
    return {family, own, resolution, low, high, edge, stamp_ratio, lag, nullptr};
  }
  /// The noise of the samples from `first` on.
  NoiseModel From(Eigen::Index first) const {
    NoiseModel rest = *this;
    if (spread) rest.spread = std::make_shared<const std::vector<double>>(spread->begin() + first, spread->end());
    return rest;
  }
  /// Standard deviation of each of N samples.
  Eigen::VectorXd Deviations(Eigen::Index samples) const {
    if (!spread) return Eigen::VectorXd::Constant(samples, sigma);
    return sigma * Eigen::Map<const Eigen::VectorXd>(spread->data(), samples);
  }

  bool IsRobust() const { return pendulum::IsRobust(family); }

  /// Of a reading y when the model says m; of a sample that has a spread by its ForSample.
  SampleLikelihood At(double y, double m) const;
  NoiseLikelihood LikelihoodAt(double y, double m) const;

  /// Distribution function of the reading y just below it and at it: equal for a density.
  struct Distribution {
    double below;
    double at;
  };
  Distribution DistributionAt(double y, double m) const;
};

/// Σ l over N samples.
double LogLikelihood(const NoiseModel& noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                     const Eigen::Ref<const Eigen::VectorXd>& readings);

/// The σ at which N samples are likeliest (Huber's "proposal 2" for that family), up to 1e6 times noise.sigma; at least
/// `smallest`, which it is for levels that explain every sample.
double LikeliestSigma(NoiseModel noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                      const Eigen::Ref<const Eigen::VectorXd>& readings, double smallest);

/// The standard error of a robust family's σ, by the scatter of what each sample says of it.
double RobustSigmaError(const NoiseModel& noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                        const Eigen::Ref<const Eigen::VectorXd>& readings);

}  // namespace pendulum
