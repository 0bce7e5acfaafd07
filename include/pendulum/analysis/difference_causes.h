// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/analysis/fitted_motion.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Applies K formulas to a recording and returns K values, in their own units. std::nullopt: a formula cannot be
/// applied.
using FormulaValues = std::function<std::optional<Eigen::VectorXd>(const Recording&, Gravity gravity)>;

/// Results (K values each) of K formulas on a fitted motion; each stage adds one property of the recording (MODEL.md
/// eq. (6.12)).
struct FormulaStages {
  Eigen::VectorXd small_angles;  ///< Linear gravity, no drift of the zero, 200 samples per period, no noise.
  Eigen::VectorXd drifting;      ///< Adds the fitted drift.
  Eigen::VectorXd own_gravity;   ///< Uses the model's gravity.
  Eigen::VectorXd own_instants;  ///< Takes samples at the recording's time stamps.
  Eigen::VectorXd own_levels;    ///< Rounds to the sensor's levels, within its range.
};

/// Returns std::nullopt if the trajectory cannot be computed or the formulas cannot be applied to it.
std::optional<FormulaStages> ApplyInStages(const FittedMotion& motion, const Recording& used, Gravity gravity,
                                           const FormulaValues& formulas);

/// The causes of DifferenceCauses.
enum class DifferenceCause { kFormula, kDrift, kAmplitude, kSampling, kResolution, kRecording };

/// Difference between a formula and the fit, split by cause.
struct DifferenceCauses {
  double formula = 0;     ///< The difference at small angles: the formula assumes other friction than the model.
  double drift = 0;       ///< The zero drifts.
  double amplitude = 0;   ///< The angles are not small.
  double sampling = 0;    ///< Samples are missing near the turning points.
  double resolution = 0;  ///< Readings are rounded to levels.
  double recording = 0;   ///< The readings differ from the model: noise, or another law.

  /// The largest part.
  DifferenceCause Largest() const;

  double total() const { return formula + drift + amplitude + sampling + resolution + recording; }
};

/// Splits the difference (closed_form - fit) of formula `k`. closed_form: the formula's value for the recording; fit:
/// the fit's value, in the same unit. `scale` converts the values in `stages` to this unit.
DifferenceCauses SplitDifference(const FormulaStages& stages, Eigen::Index k, double scale, double closed_form,
                                 double fit);

/// Names of the causes that depend on the formula and the recording.
struct CauseNames {
  std::string formula;
  std::string amplitude;
  std::string misfit;  ///< For the part of the recording if it exceeds 3 standard deviations of noise; else "noise".
};

/// Lists the parts that are at least a fifth of the difference, the largest first. std_dev: standard deviation of the
/// difference that noise alone causes, in `unit`.
std::string DescribeCauses(const DifferenceCauses& causes, double std_dev, const std::string& unit,
                           const CauseNames& names);

}  // namespace pendulum
