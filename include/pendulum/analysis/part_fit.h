// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "pendulum/analysis/fitted_motion.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/likelihood/noise.h"
#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// Whether a parameter is a drift of the zero: zero_drift or bias_drift.
bool IsDrift(std::string_view name);

/// Probability that a standard normal variable has a larger magnitude than z.
double TwoSidedP(double z);

/// The smallest double above `time`; a part that ends at `time` does not contain it.
double After(double time);

/// Derivatives of each of N readings' log-likelihood l by its modelled value m [rad or rad/s].
struct ReadingTerms {
  Eigen::VectorXd score;        ///< N, ∂l/∂m, 1 / unit of m
  Eigen::VectorXd information;  ///< N, -∂²l/∂m², 1 / unit of m²; for a robust family the mean
};

/// Terms of N measured values and N modelled readings, rad or rad/s.
ReadingTerms TermsOf(const NoiseModel& noise, const Eigen::VectorXd& value, const Eigen::VectorXd& readings);

/// The covariance of W'score for residuals with this noise and autocorrelation (MODEL.md eq. (29)). time N, weights N x
/// K.
Eigen::MatrixXd ScoreCovariance(const NoiseModel& noise, const Autocorrelation& memory, const ReadingTerms& terms,
                                const Eigen::VectorXd& time, const Eigen::MatrixXd& weights);

/// The autocorrelation of N residuals. time: true s; jacobian: N x K, by all parameters fitted to them. As
/// EstimateAutocorrelation.
Autocorrelation MemoryOf(const Eigen::VectorXd& time, const Eigen::VectorXd& value, const NoiseModel& noise,
                         const Eigen::VectorXd& readings, const Eigen::MatrixXd& jacobian,
                         const std::stop_token& stop = {});

/// Correction factor for a variance from N residuals; the free parameters took `lost` of N variances.
double Inflation(const NoiseModel& noise, Eigen::Index samples, Eigen::Index free, double lost);

/// A fit as a linear function of the readings' scores about its solution, over F parameters.
struct LinearFit {
  std::vector<Eigen::Index> free;  ///< F, neither fixed nor, if `with_bounds`, at a bound.
  Eigen::MatrixXd jacobian;        ///< N x P, readings by the report's parameters.
  Eigen::MatrixXd inverse;         ///< F x F, inverse of the information: products of the report's units.
  Eigen::MatrixXd influence;       ///< N x F: its transpose times the scores is the change of the estimates [report's
                                   ///< units].
};

/// std::nullopt: the trajectory cannot be computed, the readings do not determine the F parameters, or a stop was
/// requested.
std::optional<LinearFit> Linearize(const Recording& recording, const FitReport& fit, const std::optional<Rig>& rig,
                                   const ReadingTerms& terms, const ParameterPriors& priors, bool with_bounds,
                                   const std::stop_token& stop = {});

/// The noise of a fit, with the sensor's range.
NoiseModel NoiseOfFit(const Recording& used, const FitReport& fit, const FitOptions& options);

/// Inertia and friction estimated from the readings without bounds: K free parameters, in the report's units.
struct UnboundedEstimate {
  std::vector<std::string_view> names;  ///< K
  Eigen::VectorXd value;                ///< K
  Eigen::MatrixXd covariance;           ///< K x K
};

/// One step from the fit to the maximum of the likelihood without bounds. std::nullopt as Linearize.
std::optional<UnboundedEstimate> EstimateUnbounded(const Recording& part, const FitReport& fit, const NoiseModel& noise,
                                                   const std::optional<Rig>& rig, const std::stop_token& stop = {});

/// dᵀ C⁻¹ d, with C scaled to unit diagonal; NaN unless C is positive definite.
double SquaredLength(const Eigen::VectorXd& difference, const Eigen::MatrixXd& covariance);

/// A second fit to a part of the recording.
struct PartFit {
  Recording part;
  Eigen::Index first = 0;  ///< Index of its first sample among those used.
  FitReport fit;
  std::string reason;  ///< Why there is no fit; empty if it converged.

  bool converged() const { return reason.empty(); }
};

/// Parts of a fitted recording. Each part is fitted with a separate start, which begins at the whole fit's motion.
/// Keeps references.
class Parts {
 public:
  Parts(const Recording& used, const FitReport& fit, const FitOptions& options);

  /// Fits samples from <= time <= to [s, file's clock], with the parameters `held` fixed at the whole fit's estimates.
  PartFit Fit(double from, double to, const std::vector<std::string_view>& held) const;

  NoiseModel NoiseOf(const FitReport& fit) const;

  /// Amplitude [rad] of the whole fit's swing at a time [s, file's clock]; 0 if the trajectory cannot be computed.
  double Amplitude(double time) const;

 private:
  double Instant(double time) const { return used_.clock_scale * (time - used_.time[0]); }

  const Recording& used_;
  const FitReport& fit_;
  FitOptions options_;
  std::optional<Trajectory> motion_;
  double inertia_ = 0;  // s²
  double low_ = -kInfinity, high_ = kInfinity;
};

inline constexpr std::size_t kFewestHalfSwings = 6;

/// Cuts half swings into parts of equal ∫ amplitude^(2/3) dt (MODEL.md eq. (54)). Inertia and friction then have about
/// equal errors in all parts, because their variances are proportional to 1 / (amplitude² duration³). Returns indices
/// into `ends` [s, file's clock], which has at least parts · kFewestHalfSwings + 1 elements. Every part has at least
/// kFewestHalfSwings half swings, three periods.
std::vector<std::size_t> CutEvenly(const std::vector<double>& ends, std::size_t parts, const Parts& fits);

/// "7 half swings are too few for ...".
std::string TooShort(const std::vector<double>& ends, const std::string& what, std::size_t needed);

}  // namespace pendulum
