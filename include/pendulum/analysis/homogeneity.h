// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/analysis/constancy.h"
#include "pendulum/analysis/random_effects.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// One of several recordings of a rig, fitted alone.
struct RunAlone {
  std::string label;  ///< For sentences: "recording 2 (b.csv)".
  const Recording& used;
  const FitReport& fit;
  const FitOptions& options;   ///< Those of the fit.
  const Constancy* constancy;  ///< Of the fit; nullptr: unknown.
};

/// A shared parameter as one recording alone has it, not cut off at a bound.
struct RunEstimate {
  std::optional<double> value, std_error;  ///< In the parameter's unit; absent where the recording tells none.
  std::optional<double> z;                 ///< Distance from the mean of the others over its standard deviation.
};

/// One shared parameter over K recordings.
struct SharedParameter {
  std::string name, unit;
  std::vector<RunEstimate> runs;  ///< K
  double mean = 0;                ///< Weighted with 1 / std_error², as if they agreed.
  double std_error = 0;           ///< Of that mean.
  double statistic = 0;  ///< Σ ((value - mean) / std_error)², χ² of `dof` where they agree (W. G. Cochran 1954)
  int dof = 0;
  double p = 1;
  RandomEffects scatter;
};

/// Whether differences between recordings are those of their amplitudes: value = a + slope · amplitude², the same
/// within recordings and between them.
struct AmplitudeDependence {
  std::string name, unit;  ///< Of the parameter.
  double slope = 0;        ///< unit per rad²
  double slope_std_error = 0;
  double p = 1;       ///< That no slope explains as much, by the F test against what is left.
  double span = 0;    ///< slope · (largest - smallest amplitude² of a recording) over the mean.
  double rest_p = 1;  ///< Of what still differs between recordings beside the slope, by χ².

  bool explains() const;
};

/// Whether K recordings are of one rig, as far as their fits alone tell.
struct Homogeneity {
  double statistic = 0;  ///< χ² of all shared parameters together (MODEL.md eq. (58)).
  int dof = 0;
  std::optional<double> p;                  ///< Absent where there is no test; `reason` says why.
  std::vector<SharedParameter> parameters;  ///< Those that are not fixed.
  std::vector<double> amplitudes;           ///< K, rad: rms over the motion.
  std::vector<AmplitudeDependence> amplitude_dependence;
  std::vector<int> disagreeing;  ///< 0-based; those that disagree with a majority or its scatter. Often empty.
  std::string reason;            ///< Why there is no test; empty when there is.
  std::string verdict;           ///< Sentences.

  bool agrees() const { return p.value_or(1) >= kDisagree; }

  /// Whether each parameter that differs does so with amplitude, and in nothing else.
  bool is_amplitude() const;

  static constexpr double kDisagree = 0.01;  ///< So often recordings of one rig are said to disagree.
};

/// Compares what each recording alone says of the shared parameters, priors taken out and systematic errors of what
/// is not common to all (clocks, calibrations) added: joint test of all, which recording disagrees, what
/// amplitude explains, and the scatter between recordings.
Homogeneity TestHomogeneity(const std::vector<RunAlone>& runs, const std::vector<std::string>& shared);

}  // namespace pendulum
