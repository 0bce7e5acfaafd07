// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/energy_balance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <Eigen/Cholesky>
#include <boost/math/quadrature/gauss.hpp>

#include "pendulum/base/physics.h"
#include "pendulum/closed_form/period.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {
namespace {

/// ∫ T dθ over one half swing of this amplitude. In entry k, parameter k is 1 and the other parameters are 0, except a
/// reference rate, which keeps its value. The substitution θ = A sin φ makes the integrand smooth at the ends.
template <FrictionModel F>
Eigen::RowVectorXd LossPerParameter(Gravity gravity, double amplitude, double natural_frequency, double reference) {
  Eigen::RowVectorXd loss(kFrictionParameters<F>);
  for (int k = 0; k < kFrictionParameters<F>; ++k) {
    std::array<double, kFrictionParameters<F>> unit{};
    if constexpr (HasReference<F>) unit.back() = reference;
    if (unit[k] == 0) unit[k] = 1;
    const auto integrand = [&](double phi) {
      const double angle = amplitude * std::sin(phi);
      const double kinetic = std::max(2 * (gravity.Potential(amplitude) - gravity.Potential(angle)), 0.0);
      const double load = 1 - gravity.Potential(angle) + kinetic;
      return TorqueUnder<F>(load, natural_frequency * std::sqrt(kinetic), 1.0, unit.data()) * amplitude * std::cos(phi);
    };
    loss[k] = boost::math::quadrature::gauss<double, 15>::integrate(integrand, -kPi / 2, kPi / 2);
  }
  return loss;
}

/// Normal equations of U_i = U_run - Σ losses, with one unknown U_run per run without gaps, eliminated by subtracting
/// means.
class LossEquations {
 public:
  explicit LossEquations(int size) : normal(Eigen::MatrixXd::Zero(size, size)), right(Eigen::VectorXd::Zero(size)) {}

  void StartRun(double energy) {
    rows_.assign(1, Eigen::RowVectorXd::Zero(right.size()));
    energies_.assign(1, energy);
  }
  void Add(const Eigen::RowVectorXd& loss, double energy) {
    rows_.emplace_back(rows_.back() + loss);
    energies_.push_back(energy);
  }
  void FinishRun() {
    Eigen::RowVectorXd mean_row = Eigen::RowVectorXd::Zero(right.size());
    double mean_energy = 0;
    const auto count = static_cast<double>(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      mean_row += rows_[i] / count;
      mean_energy += energies_[i] / count;
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Eigen::RowVectorXd row = rows_[i] - mean_row;
      normal += row.transpose() * row;
      right -= row.transpose() * (energies_[i] - mean_energy);
    }
    rows_.clear();
    energies_.clear();
  }

  Eigen::MatrixXd normal;
  Eigen::VectorXd right;

 private:
  std::vector<Eigen::RowVectorXd> rows_;
  std::vector<double> energies_;
};

template <FrictionModel F>
EnergyBalance BalanceAt(Gravity gravity, const TurningPointTable& table, double natural_frequency, double reference) {
  LossEquations equations(kFrictionParameters<F>);
  const auto amplitude_at = [&](std::size_t point) {
    return AngleAmplitude(table.quantity, table.Amplitude(point), natural_frequency, gravity);
  };
  for (const auto& [first, last] : table.Runs()) {
    double before = amplitude_at(first);
    equations.StartRun(gravity.Potential(before));
    for (std::size_t i = first + 1; i <= last; ++i) {
      const double after = amplitude_at(i);
      equations.Add(LossPerParameter<F>(gravity, 0.5 * (before + after), natural_frequency, reference),
                    gravity.Potential(after));
      before = after;
    }
    equations.FinishRun();
  }
  return {equations.normal, equations.right, reference};
}

/// The reduction of the sum of squares by the best friction. It only ranks the balances of one table.
double ExplainedSumOfSquares(const EnergyBalance& balance) {
  const std::vector<double> friction = FrictionFrom(balance);
  double gain = 0;  // excludes the reference, whose equation is not solved
  for (std::size_t k = 0; k + 1 < friction.size(); ++k)
    gain += friction[k] * balance.right[static_cast<Eigen::Index>(k)];
  return gain;
}

double LargestAngle(Gravity gravity, const TurningPointTable& table, double natural_frequency) {
  double largest = 0;
  for (const auto& [first, last] : table.Runs()) {
    for (std::size_t i = first; i < last; ++i) {
      largest = std::max(largest, AngleAmplitude(table.quantity, table.Amplitude(i), natural_frequency, gravity));
    }
  }
  return largest;
}

/// The values of the law's reference from which a search starts.
template <HasReference F>
std::vector<double> References(Gravity gravity, const TurningPointTable& table, double natural_frequency) {
  const double angle = LargestAngle(gravity, table, natural_frequency);
  std::vector<double> references;
  if constexpr (HasRateScale<F>) {
    const double rate = natural_frequency * std::sqrt(2 * gravity.Potential(angle));
    for (const double scale : F::kRateScales) references.push_back(scale * rate);
  } else {
    for (const double scale : F::kAngleScales)
      references.push_back(std::max(scale * angle, F::kParameters.back().lower));
  }
  return references;
}

}  // namespace

/// At a turning point the energy is U = 1 - cos A. Between two turning points friction takes ∫ T(ω(θ)) dθ, with
/// ω(θ) = ω0 sqrt(2 (cos θ - cos A)) and the mean amplitude A.
std::vector<EnergyBalance> BalanceEnergy(const MotionModel& model, const TurningPointTable& table,
                                         double natural_frequency) {
  std::vector<EnergyBalance> balances;
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    const auto balance_at = [&](double reference) {
      balances.push_back(BalanceAt<F>(model.gravity, table, natural_frequency, reference));
    };
    if constexpr (HasReference<F>) {
      for (const double reference : References<F>(model.gravity, table, natural_frequency)) balance_at(reference);
      std::ranges::stable_sort(balances, std::ranges::greater(), ExplainedSumOfSquares);
    } else {
      balance_at(0);
    }
  });
  return balances;
}

std::vector<double> FrictionFrom(const EnergyBalance& balance, const std::vector<bool>& left_out) {
  const bool has_reference = balance.reference > 0;
  const auto size = static_cast<int>(balance.right.size()) - (has_reference ? 1 : 0);
  Eigen::VectorXd best = Eigen::VectorXd::Zero(balance.right.size());
  if (has_reference) best[size] = balance.reference;
  double best_gain = 0;
  // Non-negative least squares that tries every set of positive components: exact, and fast because K is small.
  for (unsigned set = 1; set < (1U << size); ++set) {
    std::vector<int> chosen;
    bool allowed = true;
    for (int k = 0; k < size; ++k) {
      if (!(set & (1U << k))) continue;
      chosen.push_back(k);
      allowed = allowed && (left_out.empty() || !left_out[k]);
    }
    if (!allowed) continue;
    const Eigen::VectorXd right = balance.right(chosen);
    const Eigen::VectorXd x = balance.normal(chosen, chosen).ldlt().solve(right);
    if (!x.allFinite() || x.minCoeff() < 0) continue;
    const double gain = x.dot(right);  // how much of the losses these components explain
    if (gain <= best_gain) continue;
    best_gain = gain;
    best.head(size).setZero();
    best(chosen) = x;
  }
  return {best.begin(), best.end()};
}

}  // namespace pendulum
