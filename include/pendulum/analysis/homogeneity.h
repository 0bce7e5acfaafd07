// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/analysis/agreement.h"
#include "pendulum/analysis/constancy.h"
#include "pendulum/analysis/random_effects.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// One of several recordings of a rig, fitted alone.
struct RunAlone {
  std::string label;  ///< Name in sentences: "recording 2 (b.csv)".
  const Recording& used;
  const FitReport& fit;
  const FitOptions& options;   ///< Options of the fit.
  const Constancy* constancy;  ///< Constancy of the fit; nullptr: unknown.
};

/// A shared parameter estimated from one recording alone, without bounds.
struct RunEstimate {
  std::optional<double> value, std_error;  ///< Estimate, parameter's unit; absent: not determined.
  std::optional<double> z;  ///< (value - mean of the other recordings) / standard deviation of this difference.
};

/// One shared parameter over K recordings.
struct SharedParameter {
  std::string name, unit;
  std::vector<RunEstimate> runs;  ///< K
  double mean = 0;                ///< Weighted with 1 / std_error², assuming that the recordings agree.
  double std_error = 0;           ///< Standard error of that mean.
  double statistic = 0;  ///< Σ ((value - mean) / std_error)², χ² with `dof` degrees of freedom if they agree (W. G.
                         ///< Cochran 1954)
  int dof = 0;
  double p = 1;
  RandomEffects scatter;

  bool agrees() const { return p >= Agreement::kDisagree; }
};

/// Whether recordings differ because their amplitudes differ: value = a + slope · amplitude², with the same slope
/// within recordings and between them.
struct AmplitudeDependence {
  std::string name, unit;  ///< Name and unit of the parameter.
  double slope = 0;        ///< unit per rad²
  double slope_std_error = 0;
  double p = 1;       ///< Probability that a slope explains as much by chance (F test against the remaining scatter).
  double span = 0;    ///< slope · (largest - smallest amplitude² of a recording) / mean.
  double rest_p = 1;  ///< p of the differences that the slope does not explain, by χ².

  bool explains() const;
};

/// Whether K recordings come from one rig, judged by their separate fits.
struct Homogeneity {
  double statistic = 0;  ///< χ² of all shared parameters together (MODEL.md eq. (10.3)).
  int dof = 0;
  std::optional<double> p;                  ///< Absent if there is no test; `reason` gives the cause.
  std::vector<SharedParameter> parameters;  ///< Without fixed parameters.
  std::vector<double> amplitudes;           ///< K, rad: rms over the motion.
  std::vector<AmplitudeDependence> amplitude_dependence;
  /// 0-based indices of recordings that disagree with a majority, or are far outside the scatter of the others; often
  /// empty.
  std::vector<int> disagreeing;
  std::string reason;   ///< Why there is no test; empty if there is one.
  std::string verdict;  ///< Sentences.

  /// Whether a recording or the rig is another one, or the recordings disagree by more than the joint fit's errors from
  /// other sources. FitTogether sets it.
  bool matters = false;

  bool agrees() const { return p.value_or(1) >= kDisagree; }

  /// Whether the estimates belong to no pendulum: a recording disagrees with the others, or inertia differs too much.
  bool has_different_rigs() const { return !disagreeing.empty() || ScatterOfRigs() > 0; }

  /// Relative standard deviation of inertia between recordings if it is too large for one rig; otherwise 0.
  double ScatterOfRigs() const;

  /// Whether some parameters differ, and all of these only through their dependence on amplitude.
  bool is_amplitude() const;

  static constexpr double kDisagree = Agreement::kDisagree;
};

/// Compares the estimates of the shared parameters from each recording alone. Priors are removed. Systematic errors
/// that differ between recordings are added: clocks and calibrations if they differ. Changes within recordings are not,
/// because amplitude_dependence judges them. Gives the joint test, the recordings that disagree, the differences
/// explained by amplitude, and the scatter between recordings.
Homogeneity TestHomogeneity(const std::vector<RunAlone>& runs, const std::vector<std::string>& shared);

}  // namespace pendulum
