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

/// Whether a parameter is a zero's drift, zero_drift or bias_drift.
bool IsDrift(std::string_view name);

/// The probability of a standard normal variable farther from 0, to either side.
double TwoSidedP(double z);

/// The next instant that is none of a part ending at `time`.
double After(double time);

/// What each of N readings says of its modelled value m [rad or rad/s] under a noise, l being its log-likelihood.
struct ReadingTerms {
  Eigen::VectorXd score;        ///< N, ∂l/∂m, 1 / unit of m
  Eigen::VectorXd information;  ///< N, -∂²l/∂m², 1 / unit of m²; of a robust family their mean
};

/// Of N values as measured and N as modelled, rad or rad/s.
ReadingTerms TermsOf(const NoiseModel& noise, const Eigen::VectorXd& value, const Eigen::VectorXd& readings);

/// The covariance of W'score for residuals of that noise and memory (MODEL.md eq. (29)). time N, weights N x K.
Eigen::MatrixXd ScoreCovariance(const NoiseModel& noise, const Autocorrelation& memory, const ReadingTerms& terms,
                                const Eigen::VectorXd& time, const Eigen::MatrixXd& weights);

/// The memory of N residuals; time in true s, jacobian N x K by all that was fitted to them. As
/// EstimateAutocorrelation.
Autocorrelation MemoryOf(const Eigen::VectorXd& time, const Eigen::VectorXd& value, const NoiseModel& noise,
                         const Eigen::VectorXd& readings, const Eigen::MatrixXd& jacobian,
                         const std::stop_token& stop = {});

/// What a variance by N residuals is short of, `lost` of N variances having gone into the free parameters.
double Inflation(const NoiseModel& noise, Eigen::Index samples, Eigen::Index free, double lost);

/// A fit as a linear function of the readings' scores about its solution, over F parameters.
struct LinearFit {
  std::vector<Eigen::Index> free;  ///< F, neither held nor, `with_bounds`, at a bound.
  Eigen::MatrixXd jacobian;        ///< N x P, readings by the report's parameters.
  Eigen::MatrixXd inverse;         ///< F x F, of the information: products of the report's units.
  Eigen::MatrixXd influence;       ///< N x F: estimates [report's units] move by its transpose times the scores.
};

/// Nothing where the motion cannot be traced or the readings do not tell the F parameters, or once a stop is requested.
std::optional<LinearFit> Linearize(const Recording& recording, const FitReport& fit, const std::optional<Rig>& rig,
                                   const ReadingTerms& terms, const ParameterPriors& priors, bool with_bounds,
                                   const std::stop_token& stop = {});

/// The noise of a fit, with the sensor's range.
NoiseModel NoiseOfFit(const Recording& used, const FitReport& fit, const FitOptions& options);

/// Inertia and friction as the readings alone would have them, whatever bounds they have: K that are free, in the
/// report's units.
struct UnboundedEstimate {
  std::vector<std::string_view> names;  ///< K
  Eigen::VectorXd value;                ///< K
  Eigen::MatrixXd covariance;           ///< K x K
};

/// A step from the fit to where the likelihood would be greatest without bounds. Nothing as Linearize.
std::optional<UnboundedEstimate> EstimateUnbounded(const Recording& part, const FitReport& fit, const NoiseModel& noise,
                                                   const std::optional<Rig>& rig, const std::stop_token& stop = {});

/// dᵀ C⁻¹ d, with C scaled to unit diagonal; NaN unless C is positive.
double SquaredLength(const Eigen::VectorXd& difference, const Eigen::MatrixXd& covariance);

/// A part of the recording, fitted once more.
struct PartFit {
  Recording part;
  Eigen::Index first = 0;  ///< Its first sample, of those used.
  FitReport fit;
  std::string reason;  ///< Why the fit is none; empty when it converged.

  bool converged() const { return reason.empty(); }
};

/// Parts of a fitted recording, each fitted with a start of its own from where the whole fit sees it. Keeps references.
class Parts {
 public:
  Parts(const Recording& used, const FitReport& fit, const FitOptions& options);

  /// Samples from <= time <= to [s, file's clock], with these parameters held at the whole fit's estimates.
  PartFit Fit(double from, double to, const std::vector<std::string_view>& held) const;

  NoiseModel NoiseOf(const FitReport& fit) const;

  /// rad: of the swing that passes through the whole fit's motion at a time [s, file's clock]; 0 without a motion.
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

/// Cuts half swings into parts of equal ∫ amplitude^(2/3) dt (MODEL.md eq. (54)), whose inertia and friction have about
/// equal errors, for their variances go as 1 / (amplitude² duration³): indices into `ends` [s, file's clock], which has
/// at least parts · kFewestHalfSwings + 1. No part has fewer than kFewestHalfSwings, three periods.
std::vector<std::size_t> CutEvenly(const std::vector<double>& ends, std::size_t parts, const Parts& fits);

/// "7 half swings are too few for ...".
std::string TooShort(const std::vector<double>& ends, const std::string& what, std::size_t needed);

}  // namespace pendulum
