// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/derived.h"

#include <algorithm>
#include <cmath>

#include "pendulum/base/physics.h"
#include "pendulum/model/friction/viscous.h"

namespace pendulum {
namespace {

/// factor · inertia^a · p^b: every derived quantity is such a product (b is -1, 0 or 1).
struct PowerProduct {
  std::string name;
  std::string unit;
  double factor;
  double inertia_power;
  int other;  // index of p
  int other_power;
};

double Estimate(const PowerProduct& product, const std::vector<double>& p) {
  return product.factor * std::pow(p[0], product.inertia_power) * std::pow(p[product.other], product.other_power);
}

double StdError(const PowerProduct& product, const std::vector<double>& p, const Eigen::MatrixXd& covariance) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(covariance.rows());
  gradient[0] = product.inertia_power * Estimate(product, p) / p[0];
  if (product.other_power != 0) {
    PowerProduct lowered = product;
    lowered.factor *= product.other_power;
    lowered.other_power -= 1;
    gradient[product.other] = Estimate(lowered, p);
  }
  return std::sqrt(gradient.dot(covariance * gradient));
}

/// Unit of (parameter / inertia), from the parameter's unit per G over s^2.
std::string UnitOverInertia(const ParameterInfo& info) {
  if (info.relative_unit == "s") return "1/s";
  if (info.relative_unit == "1") return "1/s^2";
  if (info.relative_unit == "s^2") return "1";
  return std::string(info.relative_unit) + "/s^2";
}

}  // namespace

std::vector<DerivedQuantity> DerivedQuantities(const std::vector<ParameterInfo>& infos,
                                               const std::vector<double>& parameters, const Eigen::MatrixXd* covariance,
                                               const std::vector<int>& at_bound) {
  std::vector<PowerProduct> products = {{"natural_frequency", "rad/s", 1, -0.5, 0, 0},
                                        {"small_angle_period", "s", 2 * kPi, 0.5, 0, 0},
                                        {"gravity_over_inertia", "1/s^2", 1, -1, 0, 0}};
  for (int i = 1; i < static_cast<int>(infos.size()); ++i) {
    if (!infos[i].scales_with_gravity()) continue;
    products.push_back({std::string(infos[i].name) + "_over_inertia", UnitOverInertia(infos[i]), 1, -1, i, 1});
    if (infos[i].name != kViscous.name) continue;
    products.push_back({"damping_ratio", "1", 0.5, -0.5, i, 1});
    if (parameters[i] > 0) products.push_back({"quality_factor", "1", 1, 0.5, i, -1});
  }
  std::vector<DerivedQuantity> derived;
  for (const PowerProduct& product : products) {
    derived.push_back({product.name, product.unit, Estimate(product, parameters), std::nullopt});
    const bool bounded = std::find(at_bound.begin(), at_bound.end(), product.other) != at_bound.end();
    if (covariance == nullptr || bounded) continue;
    const double error = StdError(product, parameters, *covariance);
    if (error > 0) derived.back().std_error = error;
  }
  return derived;
}

}  // namespace pendulum
