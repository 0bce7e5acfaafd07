// SPDX-License-Identifier: Apache-2.0
#include "fitting/swing/hold_agreement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>

#include "fitting/likelihood/level_likelihoods.h"
#include "pendulum/base/distributions.h"
#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/residuals/estimate_autocorrelation.h"
#include "pendulum/fitting/residuals/residual_diagnostics.h"
#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// A fit at its solution, in the units of its problem.
struct HeldFit {
  FitProblem problem;
  Eigen::VectorXd readings;  // N, of the model
  Eigen::MatrixXd jacobian;  // N x F, with respect to the free parameters
  NoiseModel noise;          // of the swing
  Index held = 0;            // number of samples before the release
};

/// Derivatives of the log-likelihood of each sample with respect to its modelled reading.
struct SampleScores {
  Eigen::VectorXd score, information;  // N
};

std::vector<Index> FreeIndices(const FitReport& fit) {
  std::vector<Index> free;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    if (!fit.parameters[i].fixed && !fit.parameters[i].at_bound) free.push_back(static_cast<Index>(i));
  }
  return free;
}

/// The noise of the fit, with the likeliest σ of the samples after the hold. Those of the hold may not be noise.
NoiseModel NoiseOfSwing(const FitReport& fit, const FitProblem& problem, const Eigen::VectorXd& readings, Index held) {
  NoiseModel noise = problem.noise;
  noise.family = fit.noise.family;
  noise.sigma = fit.noise.sigma;
  noise.resolution = fit.noise.resolution;
  noise.averaging = fit.noise.averaging;
  const Index moving = readings.size() - held;
  noise.sigma =
      MostLikelySigma(noise.From(held), problem.data.values().tail(moving), readings.tail(moving), 0.1 * noise.sigma);
  return noise;
}

std::optional<HeldFit> MakeHeldFit(const Recording& used, const FitReport& fit, const FitOptions& options) {
  constexpr Index kMinHeld = 8, kMinMoving = 30;
  FitOptions like = OptionsLike(fit, options);
  like.search.start_values = fit.start_values;
  Result<FitProblem> problem = MakeFitProblem(used, like);
  if (!problem || problem->infos.size() != fit.parameters.size()) return std::nullopt;
  HeldFit held{*std::move(problem), {}, {}, {}};
  std::vector<double> parameters;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    parameters.push_back(held.problem.Internal(i, fit.parameters[i].estimate));
  }
  const double release = parameters[*held.problem.Find(kReleaseTime.name)];
  held.held = (held.problem.data.times().array() < release).count();
  if (held.held < kMinHeld || used.size() - held.held < kMinMoving) return std::nullopt;
  const auto cost = MakeTrajectoryCost(held.problem.model, held.problem.start.start, held.problem.data);
  Eigen::MatrixXd all;
  if (!cost->Readings(parameters, &held.readings, &all)) return std::nullopt;
  held.jacobian = all(Eigen::all, FreeIndices(fit));
  held.noise = NoiseOfSwing(fit, held.problem, held.readings, held.held);
  return held;
}

SampleScores ScoresOf(const HeldFit& fit) {
  const auto values = fit.problem.data.values();
  const LevelLikelihoods likelihoods(fit.noise, values.size());
  SampleScores scores{Eigen::VectorXd(values.size()), Eigen::VectorXd(values.size())};
  for (Index i = 0; i < values.size(); ++i) {
    const NoiseLikelihood l = likelihoods.At(values[i], fit.readings[i], i);
    scores.score[i] = l.score;
    scores.information[i] = std::max(l.information, 0.0);
  }
  return scores;
}

/// Offset and creep of the hold, as changes of the readings: N x 2. The creep goes from -1/2 to 1/2.
Eigen::MatrixX2d ChangesOfHold(const HeldFit& fit) {
  Eigen::MatrixX2d changes = Eigen::MatrixX2d::Zero(fit.readings.size(), 2);
  const auto time = fit.problem.data.times().head(fit.held).array();
  changes.col(0).head(fit.held).setOnes();
  changes.col(1).head(fit.held) = (time - time.mean()) / (time[fit.held - 1] - time[0]);
  return changes;
}

/// The part of the changes that the parameters of the fit cannot imitate, with the information as weight.
Eigen::MatrixX2d Efficient(const Eigen::MatrixX2d& changes, const Eigen::MatrixXd& jacobian,
                           const Eigen::VectorXd& information) {
  const Eigen::VectorXd root = information.cwiseSqrt();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(root.asDiagonal() * jacobian);
  return changes - jacobian * solver.solve(root.asDiagonal() * changes);
}

/// The autocorrelation of the residuals after the hold; white if they are independent.
Autocorrelation CorrelationOfSwing(const HeldFit& fit, const std::stop_token& stop) {
  const Index moving = fit.readings.size() - fit.held;
  const NoiseModel noise = fit.noise.From(fit.held);
  const Eigen::VectorXd z = QuantileResiduals(noise, fit.problem.data.values().tail(moving), fit.readings.tail(moving));
  if (!MayBeCorrelated(z)) return {};
  return EstimateAutocorrelation(noise, fit.problem.data.times().tail(moving), z, fit.jacobian.bottomRows(moving),
                                 stop);
}

/// An upper bound of the bias of the mean of rounded readings of a constant value, which decays with σ as the first
/// harmonic of the rounding error. Readings that are taken for continuous may all be off by it during a hold.
double RoundingBias(const NoiseModel& noise) {
  const bool knows_rounding = noise.family == NoiseFamily::kQuantized || noise.family == NoiseFamily::kAveraged;
  if (knows_rounding || !(noise.resolution > 0)) return 0;
  return 0.5 * noise.resolution * std::exp(-2 * std::pow(kPi * noise.sigma / noise.resolution, 2));
}

}  // namespace

std::optional<HoldDisagreement> FindHoldDisagreement(const Recording& used, const FitReport& fit,
                                                     const FitOptions& options) {
  constexpr double kSurely = 1e-6;
  const bool is_testable = fit.termination == Termination::kConverged && fit.start == StartKind::kRelease &&
                           (used.quantity == Quantity::kAngle || used.quantity == Quantity::kRate) &&
                           fit.noise.family != NoiseFamily::kEdges;
  const std::optional<HeldFit> held = is_testable ? MakeHeldFit(used, fit, options) : std::nullopt;
  if (!held) return std::nullopt;
  const SampleScores scores = ScoresOf(*held);
  const Eigen::MatrixX2d efficient = Efficient(ChangesOfHold(*held), held->jacobian, scores.information);
  const Eigen::Vector2d slope = efficient.transpose() * scores.score;
  const Eigen::Matrix2d information = efficient.transpose() * scores.information.asDiagonal() * efficient;
  const auto statistic = [&](const Eigen::Matrix2d& variance) { return slope.dot(variance.ldlt().solve(slope)); };
  if (!(ChiSquareTail(std::max(statistic(information), 0.0), 2) < kSurely)) return std::nullopt;
  Eigen::Matrix2d variance = information;
  const Autocorrelation correlation = CorrelationOfSwing(*held, options.stop);
  if (correlation.kind != Autocorrelation::Kind::kWhite) {
    variance =
        CorrelatedSum(correlation, held->problem.data.times(), scores.information.cwiseSqrt().asDiagonal() * efficient);
  }
  const double chi_square = statistic(variance);
  if (!(std::isfinite(chi_square) && ChiSquareTail(std::max(chi_square, 0.0), 2) < kSurely)) return std::nullopt;
  const Eigen::Matrix2d inverse = information.inverse();
  const Eigen::Vector2d change = inverse * slope;
  const Eigen::Matrix2d covariance = inverse * variance * inverse;
  const double bias = RoundingBias(held->noise);
  if (std::abs(change[0]) < bias && std::abs(change[1]) < 2 * bias) return std::nullopt;
  return HoldDisagreement{change[0], std::sqrt(covariance(0, 0)), change[1], std::sqrt(covariance(1, 1))};
}

std::string Sentence(const HoldDisagreement& disagreement, const Recording& used) {
  constexpr double kClear = 3;  // standard errors
  const auto size = [&](double value) { return NumberText(std::abs(value), 2) + " " + used.value_unit(); };
  std::string text;
  if (std::abs(disagreement.offset) > kClear * disagreement.offset_error) {
    text = "its readings are " + size(disagreement.offset) + (disagreement.offset > 0 ? " above" : " below") +
           " those that the swing after it predicts";
  }
  if (std::abs(disagreement.creep) > kClear * disagreement.creep_error) {
    text += (text.empty() ? "its readings" : ", and they") + std::string(" creep by ") + size(disagreement.creep);
  }
  return text.empty() ? "its readings do not agree with the swing after it" : text;
}

}  // namespace pendulum
