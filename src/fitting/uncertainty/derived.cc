// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/derived.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pendulum/base/physics.h"
#include "pendulum/model/friction/viscous.h"
#include "pendulum/trajectory/energy_losses.h"

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

double ValueOf(const PowerProduct& product, const std::vector<double>& p) {
  return product.factor * std::pow(p[0], product.inertia_power) * std::pow(p[product.other], product.other_power);
}

Eigen::VectorXd GradientOf(const PowerProduct& product, const std::vector<double>& p) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(p.size()));
  gradient[0] = product.inertia_power * ValueOf(product, p) / p[0];
  if (product.other_power != 0) {
    PowerProduct lowered = product;
    lowered.factor *= product.other_power;
    lowered.other_power -= 1;
    gradient[product.other] = ValueOf(lowered, p);
  }
  return gradient;
}

double StdErrorOf(const Eigen::VectorXd& gradient, const Eigen::MatrixXd& covariance) {
  return std::sqrt(std::max(gradient.dot(covariance * gradient), 0.0));
}

/// Adds the shares of one part of a motion.
void AddShares(const std::vector<std::string>& names, const std::optional<LossShares>& losses,
               const std::string& of_what, std::size_t parameters, std::vector<DerivedQuantity>& quantities) {
  if (!losses) return;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    DerivedQuantity share{names[k] + "_loss_share" + of_what, "1", std::clamp(losses->share[row], 0.0, 1.0)};
    share.range = {0, 1};
    share.gradient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parameters));
    share.gradient.head(losses->gradient.cols()) = losses->gradient.row(row);
    share.is_of_recording = true;
    quantities.push_back(std::move(share));
  }
}

/// Unit of parameter / inertia: the unit of parameter / G, divided by s^2, the unit of inertia / G.
std::string UnitOverInertia(const ParameterInfo& info) {
  if (info.relative_unit == "s") return "1/s";
  if (info.relative_unit == "1") return "1/s^2";
  if (info.relative_unit == "s^2") return "1";
  return std::string(info.relative_unit) + "/s^2";
}

std::vector<PowerProduct> PowerProducts(const std::vector<ParameterInfo>& infos,
                                        const std::vector<double>& parameters) {
  std::vector<PowerProduct> products = {{"natural_frequency", "rad/s", 1, -0.5, 0, 0},
                                        {"small_angle_period", "s", 2 * kPi, 0.5, 0, 0},
                                        {"gravity_over_inertia", "1/s^2", 1, -1, 0, 0}};
  for (int i = 1; i < static_cast<int>(infos.size()); ++i) {
    if (!infos[i].scales_with_gravity()) continue;
    products.push_back({std::string(infos[i].name) + "_over_inertia", UnitOverInertia(infos[i]), 1, -1, i, 1});
    if (infos[i].name != kViscous.name) continue;
    products.push_back({"damping_ratio", "1", 0.5, -0.5, i, 1});
    if (!(parameters[i] > 0)) continue;
    products.push_back({"quality_factor", "1", 1, 0.5, i, -1});
    products.push_back({"decay_time", "s", 2, 1, i, -1});
  }
  return products;
}

/// Signed distances from the estimate to the ends of a derived quantity's interval.
class Distances {
 public:
  /// Propagates both ends of parameter i's interval. A missing end is at infinite distance on its side.
  void Add(const PowerProduct& product, std::vector<double> p, int i, const IntervalEnds& ends) {
    const double at = ValueOf(product, p);
    const double power = i == 0 ? product.inertia_power : product.other_power;
    for (const bool low : {true, false}) {
      const std::optional<double>& end = low ? ends.lower : ends.upper;
      p[i] = end.value_or(0);
      const double distance = end ? ValueOf(product, p) - at : kUnbounded;
      double& square = (power > 0) == low ? below_ : above_;
      square += distance * distance;
    }
  }

  std::optional<double> Below(double estimate) const { return End(estimate, -std::sqrt(below_)); }
  std::optional<double> Above(double estimate) const { return End(estimate, std::sqrt(above_)); }

 private:
  static std::optional<double> End(double estimate, double distance) {
    return std::isfinite(distance) ? std::optional(estimate + distance) : std::nullopt;
  }

  double below_ = 0;
  double above_ = 0;
};

}  // namespace

std::vector<DerivedQuantity> DerivedQuantities(const std::vector<ParameterInfo>& infos,
                                               const std::vector<double>& parameters) {
  std::vector<DerivedQuantity> derived;
  for (const PowerProduct& product : PowerProducts(infos, parameters)) {
    derived.push_back({product.name, product.unit, ValueOf(product, parameters)});
    derived.back().gradient = GradientOf(product, parameters);
  }
  return derived;
}

std::vector<DerivedQuantity> LossQuantities(const MotionModel& model, StartKind start,
                                            const std::vector<double>& parameters, double duration) {
  const std::vector<std::string> names = LossNames(model);
  const std::size_t of_motion = PhysicalParameters(model).size() + 2;
  TraceOptions options;
  options.end = duration;
  if (names.size() < 2) return {};
  const Result<EnergyLosses> losses = ComputeEnergyLosses(model, start, {parameters.data(), of_motion}, options);
  if (!losses) return {};
  std::vector<DerivedQuantity> quantities;
  AddShares(names, losses->whole, "", parameters.size(), quantities);
  AddShares(names, losses->first_half_swing, "_first_half_swing", parameters.size(), quantities);
  return quantities;
}

void SetDerivedErrors(const Eigen::MatrixXd& covariance, const std::vector<int>& at_bound,
                      std::vector<DerivedQuantity>& derived) {
  for (DerivedQuantity& quantity : derived) {
    const auto matters = [&](int i) { return quantity.gradient[i] != 0; };
    if (std::ranges::any_of(at_bound, matters)) continue;
    const double error = StdErrorOf(quantity.gradient, covariance);
    if (error > 0) quantity.std_error = error;
  }
}

/// Propagates each end of a parameter with the other parameters at their estimates, and adds the distances in
/// quadrature.
void SetDerivedIntervals(const std::vector<ParameterInfo>& infos, const std::vector<double>& parameters,
                         const std::vector<IntervalEnds>& intervals, std::vector<DerivedQuantity>& derived) {
  const std::vector<PowerProduct> products = PowerProducts(infos, parameters);
  for (std::size_t k = 0; k < products.size(); ++k) {
    const PowerProduct& product = products[k];
    Distances distances;
    distances.Add(product, parameters, 0, intervals[0]);
    if (product.other_power != 0) distances.Add(product, parameters, product.other, intervals[product.other]);
    derived[k].lower95 = distances.Below(derived[k].estimate);
    if (derived[k].lower95) *derived[k].lower95 = std::max(*derived[k].lower95, derived[k].range.lower);
    derived[k].upper95 = distances.Above(derived[k].estimate);
  }
}

void SetSymmetricIntervals(double t95, std::vector<DerivedQuantity>& derived) {
  for (DerivedQuantity& quantity : derived) {
    if (!quantity.std_error) continue;
    quantity.lower95 = std::max(quantity.estimate - t95 * *quantity.std_error, quantity.range.lower);
    quantity.upper95 = std::min(quantity.estimate + t95 * *quantity.std_error, quantity.range.upper);
  }
}

void AddSystematicErrors(ErrorSource source, const Eigen::MatrixXd& covariance, std::vector<DerivedQuantity>& derived) {
  for (DerivedQuantity& quantity : derived) {
    if (quantity.gradient.size() == 0) continue;
    quantity.systematic.Add(source, StdErrorOf(quantity.gradient, covariance));
  }
}

}  // namespace pendulum
