// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/cramer_rao.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/Cholesky>

#include "pendulum/fitting/likelihood/edge_noise.h"
#include "pendulum/fitting/likelihood/reading_information.h"
#include "pendulum/fitting/likelihood/trajectory_cost.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Readings without noise (N) and their sensitivities (N x P).
struct Sensitivities {
  Eigen::VectorXd readings;
  Eigen::MatrixXd jacobian;
};

std::optional<Sensitivities> SensitivitiesAt(const SyntheticOptions& truth, const Eigen::VectorXd& time) {
  constexpr double kTolerance = 1e-12;  // rad
  TrajectoryData data;
  data.quantity = truth.quantity;
  for (const double instant : time) data.time.push_back(instant - time[0]);
  data.value.assign(data.time.size(), 0.0);
  data.natural_frequency = 1 / std::sqrt(truth.parameters.front());
  data.latest_release = data.time.back();
  std::vector<double> parameters = TrueParameters(truth);
  const bool events = truth.rows == RowTiming::kEvents;
  if (events) parameters.pop_back();  // the lag, which does not change other derivatives
  if (truth.start == StartKind::kRelease) parameters[truth.parameters.size() + 1] -= time[0];
  const std::unique_ptr<TrajectoryCost> cost = MakeTrajectoryCost(truth.model, truth.start, data);
  cost->set_tolerance(kTolerance);
  Sensitivities at;
  if (!cost->Readings(parameters, &at.readings, &at.jacobian)) return std::nullopt;
  if (!events) return at;
  at.jacobian.conservativeResize(Eigen::NoChange, at.jacobian.cols() + 1);
  at.jacobian.rightCols<1>() = -RatesOf(time, at.readings).array().sign();
  return at;
}

/// Information of the parameters and log σ, (P + 1) x (P + 1), from white Gaussian noise.
Eigen::MatrixXd WhiteInformation(const SyntheticOptions& truth, const Sensitivities& at) {
  const Index size = at.jacobian.cols();
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size + 1, size + 1);
  Eigen::MatrixXd weighted = at.jacobian;
  for (Index i = 0; i < at.readings.size(); ++i) {
    const Eigen::Matrix2d one = ReadingInformation(at.readings[i], truth.noise, truth.resolution, truth.range);
    weighted.row(i) *= one(0, 0);
    information.col(size).head(size) += one(0, 1) * at.jacobian.row(i).transpose();
    information(size, size) += one(1, 1);
  }
  information.topLeftCorner(size, size) = at.jacobian.transpose() * weighted;
  information.row(size).head(size) = information.col(size).head(size).transpose();
  return information;
}

/// Jᵀ R^-1 J from the innovations of each of J's columns. R is the covariance of AR(1) noise and white noise of
/// variance q²/12. On levels it is the bound of the best linear estimate, if the quantization noise is white (Widrow &
/// Kollár, Quantization Noise, 2008). For Gaussian noise the errors of log σ and of the mean are independent, so log σ
/// is left out.
Eigen::MatrixXd CorrelatedInformation(const SyntheticOptions& truth, const Sensitivities& at) {
  const double correlation = truth.noise_correlation;
  const double stationary = truth.noise * truth.noise;
  const double white = truth.resolution * truth.resolution / 12;
  Eigen::MatrixXd whitened(at.jacobian.rows(), at.jacobian.cols());
  Eigen::RowVectorXd predicted = Eigen::RowVectorXd::Zero(at.jacobian.cols());
  double variance = stationary;  // variance of the prediction of the AR(1) part
  for (Index i = 0; i < whitened.rows(); ++i) {
    const Eigen::RowVectorXd innovation = at.jacobian.row(i) - predicted;
    const double gain = variance / (variance + white);
    whitened.row(i) = innovation / std::sqrt(variance + white);
    predicted = correlation * (predicted + gain * innovation);
    variance = correlation * correlation * (1 - gain) * variance + (1 - correlation * correlation) * stationary;
  }
  return whitened.transpose() * whitened;
}

/// Lange, Little & Taylor, Journal of the American Statistical Association 84 (1989) 881, appendix B.
Eigen::MatrixXd StudentInformation(const SyntheticOptions& truth, const Sensitivities& at) {
  const double weight = (truth.noise_freedom + 1) / (truth.noise_freedom + 3) / (truth.noise * truth.noise);
  return weight * (at.jacobian.transpose() * at.jacobian);
}

/// Information in events: edges and their time stamps have normal errors. The first row is not an event.
Eigen::MatrixXd EdgeInformation(const SyntheticOptions& truth, const Sensitivities& at, const Eigen::VectorXd& time) {
  const Eigen::ArrayXd late = truth.time_noise * RatesOf(time, at.readings).array();
  Eigen::VectorXd weight = (truth.noise * truth.noise + late.square()).inverse();
  weight[0] = 0;
  return at.jacobian.transpose() * weight.asDiagonal() * at.jacobian;
}

/// The information about the parameters, and in some cases about log σ of the noise; std::nullopt without a closed
/// form.
std::optional<Eigen::MatrixXd> Information(const SyntheticOptions& truth, const Sensitivities& at,
                                           const Eigen::VectorXd& time) {
  if (truth.rows == RowTiming::kEvenFromEncoder || truth.oversample > 1) return std::nullopt;
  if (truth.rows == RowTiming::kEvents) return EdgeInformation(truth, at, time);
  const bool has_levels = truth.resolution > 0;
  const bool correlated = truth.noise_correlation != 0;
  const bool student = truth.noise_freedom > 0;
  if (truth.noise == 0 || (student && (has_levels || correlated))) return std::nullopt;
  if (truth.range && (!has_levels || correlated || student)) return std::nullopt;
  return student      ? StudentInformation(truth, at)
         : correlated ? CorrelatedInformation(truth, at)
                      : WhiteInformation(truth, at);
}

/// Square roots of the diagonal of the inverse; empty without an inverse. A parameter that no reading depends on is
/// removed first, so the others keep their bounds.
std::vector<std::optional<double>> BoundsOf(const Eigen::MatrixXd& information) {
  std::vector<std::optional<double>> bounds(static_cast<std::size_t>(information.rows()));
  std::vector<Index> determined;
  for (Index i = 0; i < information.rows(); ++i) {
    if (information(i, i) > 0) determined.push_back(i);
  }
  const Eigen::MatrixXd part = information(determined, determined);
  const Eigen::VectorXd scale = part.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> factor(scale.asDiagonal() * part * scale.asDiagonal());
  if (factor.info() != Eigen::Success) return bounds;
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(part.rows(), part.cols()));
  for (std::size_t k = 0; k < determined.size(); ++k) {
    const auto row = static_cast<Index>(k);
    bounds[static_cast<std::size_t>(determined[k])] = scale[row] * std::sqrt(inverse(row, row));
  }
  return bounds;
}

}  // namespace

std::vector<ParameterInfo> ParametersOf(const SyntheticOptions& run) {
  const ZeroMotion zero = run.rows == RowTiming::kEvents ? ZeroMotion::kLags : ZeroMotion::kNone;
  return FitParameters(run.model, run.start, run.quantity, zero, run.sensor);
}

std::vector<std::optional<double>> CramerRaoBounds(const SyntheticOptions& truth, const Eigen::VectorXd& time) {
  const std::size_t count = TrueParameters(truth).size();
  std::vector<std::optional<double>> bounds(count);
  // With another sensor, the bounds would have to include the priors of its parameters.
  if (truth.sensor.kind != SensorKind::kDirect) return bounds;
  const std::optional<Sensitivities> at = SensitivitiesAt(truth, time);
  const std::optional<Eigen::MatrixXd> information = at ? Information(truth, *at, time) : std::nullopt;
  if (!information) return bounds;
  const std::vector<std::optional<double>> all = BoundsOf(*information);
  std::copy_n(all.begin(), count, bounds.begin());
  return bounds;
}

std::vector<std::optional<double>> SharedCramerRaoBounds(const std::vector<SimulatedRun>& runs) {
  const auto shared = static_cast<Index>(runs.front().truth.parameters.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(shared, shared);
  for (const auto& [truth, time] : runs) {
    const std::optional<Sensitivities> at = SensitivitiesAt(truth, time);
    const std::optional<Eigen::MatrixXd> information = at ? Information(truth, *at, time) : std::nullopt;
    if (!information) return std::vector<std::optional<double>>(static_cast<std::size_t>(shared));
    const Index own = information->rows() - shared;
    const Eigen::MatrixXd mixed = information->bottomLeftCorner(own, shared);
    sum += information->topLeftCorner(shared, shared) -
           mixed.transpose() * information->bottomRightCorner(own, own).ldlt().solve(mixed);
  }
  return BoundsOf(sum);
}

}  // namespace pendulum
