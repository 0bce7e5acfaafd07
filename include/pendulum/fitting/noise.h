// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <string_view>

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
};

/// "gaussian", "quantized", "huber", "student".
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

/// The noise of the samples of one recording (MODEL.md eq. (26) to (28)). A reading at an end of the sensor's range is
/// censored: it says that the value is there or beyond.
struct NoiseModel {
  static constexpr double kHuberWidth = 1.345;  ///< In σ.
  static constexpr double kStudentFreedom = 4;

  NoiseFamily family = NoiseFamily::kGaussian;
  double sigma = 1;       ///< rad or rad/s: standard deviation, or the scale of the robust families.
  double resolution = 0;  ///< q, same unit; used when quantized.
  double low = -kInfinity, high = kInfinity;  ///< Same unit; readings at them or beyond are censored.

  bool IsCensored(double reading) const { return reading <= low || reading >= high; }
  /// Whether least squares say everything: normal, and no reading at an end of the range.
  bool IsPlain() const { return family == NoiseFamily::kGaussian && low == -kInfinity && high == kInfinity; }

  bool IsRobust() const { return family == NoiseFamily::kHuber || family == NoiseFamily::kStudent; }

  /// Of a reading y when the model says m.
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
