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

/// K formulas applied to a recording: their values, in their own units. Nothing where one cannot be.
using FormulaValues = std::function<std::optional<Eigen::VectorXd>(const Recording&, Gravity gravity)>;

/// K values: what K formulas make of a fitted motion as one thing after the other comes between (MODEL.md eq. (38)).
struct FormulaStages {
  Eigen::VectorXd small_angles;  ///< Linear gravity, no drift of the zero, 200 samples a period, no noise.
  Eigen::VectorXd drifting;      ///< The same with the fitted drift.
  Eigen::VectorXd own_gravity;   ///< The same with the model's gravity.
  Eigen::VectorXd own_instants;  ///< At the recording's instants.
  Eigen::VectorXd own_levels;    ///< On the sensor's levels, within its range.
};

/// Nothing where the motion cannot be traced, or the formulas cannot be applied to it.
std::optional<FormulaStages> ApplyInStages(const FittedMotion& motion, const Recording& used, Gravity gravity,
                                           const FormulaValues& formulas);

/// A difference between a formula and the fit, part by part.
struct DifferenceCauses {
  double formula = 0;     ///< Even at small angles: the formula's friction is not the model's.
  double drift = 0;       ///< The zero drifts.
  double amplitude = 0;   ///< The angles are not small.
  double sampling = 0;    ///< Samples are missing about the turning points.
  double resolution = 0;  ///< Levels stand in for values.
  double recording = 0;   ///< The readings are not the model's: noise, or another law.

  double total() const { return formula + drift + amplitude + sampling + resolution + recording; }
};

/// Formula `k`: what it gave for the recording, and the fit's value, all times `scale`.
DifferenceCauses SplitDifference(const FormulaStages& stages, Eigen::Index k, double scale, double closed_form,
                                 double fit);

/// What the causes are called where they depend on formula and recording.
struct CauseNames {
  std::string formula;
  std::string amplitude;
  std::string misfit;  ///< Where the recording's part exceeds 3 standard deviations of noise.
};

/// The parts that make a fifth of the difference or more, the largest first. std_dev: of it by noise alone, in `unit`.
std::string DescribeCauses(const DifferenceCauses& causes, double std_dev, const std::string& unit,
                           const CauseNames& names);

}  // namespace pendulum
