// SPDX-License-Identifier: Apache-2.0
#include "pendulum/trajectory/energy_losses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <boost/math/quadrature/gauss.hpp>

#include "pendulum/base/try.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {
namespace {

using Eigen::Index;

template <FrictionModel F, typename T>
using FrictionOf = std::array<T, kFrictionParameters<F>>;

/// The friction parameters without other torques than that of parameter i.
template <FrictionModel F, typename T>
FrictionOf<F, T> Alone(FrictionOf<F, T> friction, std::size_t i) {
  for (std::size_t k = 0; k < friction.size(); ++k) {
    if (k != i && F::kParameters[k].scales_with_gravity()) friction[k] = T(0.0);
  }
  return friction;
}

/// The torques of law F: those that grow with the rate, as indices of their parameters, and whether there are others.
template <FrictionModel F>
struct Torques {
  Torques() {
    constexpr double kFast = 1e3, kFaster = 2e3;  // rad/s
    FrictionOf<F, double> ones;
    ones.fill(1);
    for (std::size_t i = 0; i < ones.size(); ++i) {
      if (!F::kParameters[i].scales_with_gravity()) continue;
      const FrictionOf<F, double> alone = Alone<F, double>(ones, i);
      const bool grows = F::template Torque<double>(kFaster, 1.0, alone.data()) >
                         1.5 * F::template Torque<double>(kFast, 1.0, alone.data());
      if (grows) growing.push_back(i);
      has_dry = has_dry || !grows;
    }
  }

  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const std::size_t i : growing) names.emplace_back(F::kParameters[i].name);
    if (has_dry) names.emplace_back("dry");
    return names;
  }

  std::vector<std::size_t> growing;
  bool has_dry = false;
};

/// An energy, and the work of each growing torque since the start.
template <typename T>
struct Account {
  T energy{};
  std::vector<T> work;
};

/// Keeps account of the energy of a motion.
template <FrictionModel F, DualNumber T>
class Accountant {
 public:
  Accountant(const Pendulum<F, T>& pendulum, StartKind start) : pendulum_(pendulum), start_(start) {
    for (const std::size_t i : torques_.growing) alone_.push_back(Alone<F, T>(pendulum.friction, i));
    const auto at_rest = [&](double direction) {
      return F::template Torque<T>(T(0.0), direction, pendulum.friction.data());
    };
    constant_ = 0.5 * (at_rest(1) + at_rest(-1));
    now_.work.resize(alone_.size());
  }

  void Take(const Segment<T>& segment) {
    const bool moves = segment.order > 0;
    if (!moves && marks_.empty()) return;  // held
    const Segment<T> rate = RateOf(segment);
    const double length = segment.end - segment.start;
    const double direction = !moves ? 0 : At(rate, 0.5 * length).a < 0 ? -1 : 1;
    if (marks_.empty()) now_.energy = EnergyAt(segment, rate, 0);
    if (direction != direction_) marks_.push_back(now_);
    direction_ = direction;
    if (!moves) return;
    for (std::size_t k = 0; k < alone_.size(); ++k) AddWork(k, rate, length);
    now_.energy = EnergyAt(segment, rate, length);
  }

  EnergyLosses Losses() const {
    EnergyLosses losses;
    if (!marks_.empty()) losses.whole = Shares(marks_.front(), now_);
    const std::size_t first = start_ == StartKind::kRelease ? 0 : 1;  // a moving start is within a half swing
    if (first + 1 < marks_.size()) losses.first_half_swing = Shares(marks_[first], marks_[first + 1]);
    return losses;
  }

 private:
  static T At(const Segment<T>& segment, double since) {
    const auto partials = [&](int n) { return PartialsAtFixedTime(segment, n); };
    return T(EvaluateSeries(segment.angle, segment.order, since),
             EvaluatePolynomial<PartialsFor<T>>(partials, segment.order, since));
  }

  T EnergyAt(const Segment<T>& angle, const Segment<T>& rate, double since) const {
    const T at = At(angle, since), moving = At(rate, since);
    const T potential(pendulum_.gravity.Potential(at.a), pendulum_.gravity.Torque(at.a) * at.v);
    return 0.5 * (pendulum_.inertia * (moving * moving)) + potential + constant_ * at;
  }

  void AddWork(std::size_t k, const Segment<T>& rate, double length) {
    using Rule = boost::math::quadrature::gauss<double, 10>;
    const auto add = [&](double place, double weight) {
      const T at = At(rate, 0.5 * length * (1 + place));
      const T torque = F::template Torque<T>(at, at.a < 0 ? -1 : 1, alone_[k].data());
      now_.work[k] += (0.5 * length * weight) * (torque * at);
    };
    for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
      for (const double side : {-1.0, 1.0}) add(side * Rule::abscissa()[i], Rule::weights()[i]);
    }
  }

  std::optional<LossShares> Shares(const Account<T>& from, const Account<T>& to) const {
    constexpr double kRounding = 1e-6;  // of the energy: less may be an error of the trajectory
    const T lost = from.energy - to.energy;
    if (!(lost.a > kRounding * std::abs(from.energy.a))) return std::nullopt;
    std::vector<T> shares;
    T dry(1.0);
    for (std::size_t k = 0; k < alone_.size(); ++k) {
      shares.push_back((to.work[k] - from.work[k]) / lost);
      dry = dry - shares.back();
    }
    if (torques_.has_dry) shares.push_back(dry);
    const auto count = static_cast<Index>(shares.size());
    LossShares losses{lost.a, Eigen::VectorXd(count), Eigen::MatrixXd::Zero(count, kFrictionParameters<F> + 3)};
    for (Index k = 0; k < count; ++k) {
      const T& share = shares[static_cast<std::size_t>(k)];
      losses.share[k] = share.a;
      for (int i = 0; i < kPartials<T>; ++i) losses.gradient(k, i) = share.v[i];
    }
    return losses;
  }

  const Pendulum<F, T>& pendulum_;
  const StartKind start_;
  const Torques<F> torques_;
  std::vector<FrictionOf<F, T>> alone_;
  T constant_{};  // torque in either direction, which takes no energy from a whole swing
  Account<T> now_;
  std::vector<Account<T>> marks_;  // at the start, each reversal, and a stop
  double direction_ = 0;
};

template <FrictionModel F, DualNumber T>
Result<EnergyLosses> LossesOf(Gravity gravity, StartKind kind, std::span<const double> motion,
                              const TraceOptions& options) {
  constexpr int kAngle = kFrictionParameters<F> + 1;
  Pendulum<F, T> pendulum{gravity, T(motion[0], 0), {}};
  for (int i = 1; i < kAngle; ++i) pendulum.friction[i - 1] = T(motion[i], i);
  Start<T> start{kind, 0, T(motion[kAngle], kAngle), T(0.0)};
  if (kind == StartKind::kRelease) {
    start.time = motion[kAngle + 1];
  } else {
    start.rate = T(motion[kAngle + 1], kAngle + 1);
  }
  Accountant<F, T> accountant(pendulum, kind);
  const TraceSummary summary =
      TraceTrajectory(pendulum, start, options, [&](const Segment<T>& segment) { accountant.Take(segment); });
  RETURN_IF_ERROR(CheckTraced(summary));
  return accountant.Losses();
}

}  // namespace

std::vector<std::string> LossNames(const MotionModel& model) {
  std::vector<std::string> names;
  FrictionModels::Visit(model.friction, [&]<typename F>() { names = Torques<F>().Names(); });
  return names;
}

Result<EnergyLosses> ComputeEnergyLosses(const MotionModel& model, StartKind start, std::span<const double> motion,
                                         const TraceOptions& options) {
  constexpr std::size_t kOfStart = 2;
  RETURN_IF_ERROR(CheckParameters(model, motion.first(std::max(motion.size(), kOfStart) - kOfStart)));
  Result<EnergyLosses> losses;
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    losses = start == StartKind::kRelease ? LossesOf<F, ReleaseDual<F>>(model.gravity, start, motion, options)
                                          : LossesOf<F, MovingDual<F>>(model.gravity, start, motion, options);
  });
  return losses;
}

}  // namespace pendulum
