// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/energy_balance.h"

#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <boost/math/quadrature/gauss.hpp>

#include "pendulum/base/physics.h"
#include "pendulum/closed_form/period.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {
namespace {

/// Potential energy in units of G.
double Potential(Gravity gravity, double angle) {
  return gravity == Gravity::kSine ? 1 - std::cos(angle) : 0.5 * angle * angle;
}

/// ∫ T dθ over one half swing of the amplitude, for each parameter at 1 and the others at 0; θ = A sin φ smooths its
/// ends.
template <FrictionModel F>
Eigen::RowVectorXd LossPerParameter(Gravity gravity, double amplitude, double natural_frequency) {
  Eigen::RowVectorXd loss(kFrictionParameters<F>);
  for (int k = 0; k < kFrictionParameters<F>; ++k) {
    std::array<double, kFrictionParameters<F>> unit{};
    unit[k] = 1;
    const auto integrand = [&](double phi) {
      const double angle = amplitude * std::sin(phi);
      const double kinetic = std::max(2 * (Potential(gravity, amplitude) - Potential(gravity, angle)), 0.0);
      return F::Torque(natural_frequency * std::sqrt(kinetic), 1.0, unit.data()) * amplitude * std::cos(phi);
    };
    loss[k] = boost::math::quadrature::gauss<double, 15>::integrate(integrand, -kPi / 2, kPi / 2);
  }
  return loss;
}

/// Normal equations of U_i = U_run - Σ losses, one unknown U_run for each run without gaps (its means are subtracted).
class LossEquations {
 public:
  explicit LossEquations(int size) : normal(Eigen::MatrixXd::Zero(size, size)), right(Eigen::VectorXd::Zero(size)) {}

  void StartRun(double energy) {
    FinishRun();
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

}  // namespace

/// At a turning point the energy is U = 1 - cos A; between two, friction takes ∫ T(ω(θ)) dθ with ω(θ) = ω0 sqrt(2 (cos
/// θ - cos A)) and A the mean amplitude.
EnergyBalance BalanceEnergy(const MotionModel& model, const HalfSwingTable& table, double natural_frequency) {
  EnergyBalance balance;
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    LossEquations equations(kFrictionParameters<F>);
    for (const HalfSwing& half : table.half_swings) {
      const double before = AngleAmplitude(table.quantity, half.before, natural_frequency, table.gravity);
      const double after = AngleAmplitude(table.quantity, half.after, natural_frequency, table.gravity);
      if (!half.continues) equations.StartRun(Potential(table.gravity, before));
      equations.Add(LossPerParameter<F>(table.gravity, 0.5 * (before + after), natural_frequency),
                    Potential(table.gravity, after));
    }
    equations.FinishRun();
    balance = {equations.normal, equations.right};
  });
  return balance;
}

std::vector<double> FrictionFrom(const EnergyBalance& balance, const std::vector<bool>& left_out) {
  const auto size = static_cast<int>(balance.right.size());
  Eigen::VectorXd best = Eigen::VectorXd::Zero(size);
  double best_gain = 0;
  // Non-negative least squares by trying every set of positive components: exact, and K is at most a handful.
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
    const double gain = x.dot(right);  // how much of the losses is explained
    if (gain <= best_gain) continue;
    best_gain = gain;
    best.setZero();
    best(chosen) = x;
  }
  return {best.begin(), best.end()};
}

}  // namespace pendulum
