// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/nesting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "pendulum/model/friction/registry.h"

namespace pendulum {
namespace {

bool Has(const std::vector<ParameterInfo>& infos, std::string_view name) {
  return std::ranges::find(infos, name, &ParameterInfo::name) != infos.end();
}

/// Parameters of the richer law that reduce it to the simpler one: the same torques, all other torques 0, and any value
/// for a reference rate.
template <FrictionModel F>
std::array<double, kFrictionParameters<F>> NullOf(const std::vector<ParameterInfo>& simpler) {
  std::array<double, kFrictionParameters<F>> p{};
  for (std::size_t k = 0; k < p.size(); ++k) {
    const ParameterInfo& info = F::kParameters[k];
    if (Has(simpler, info.name)) p[k] = 0.01 * (1 + 0.25 * static_cast<double>(k));
    if (info.lower > 0) p[k] = 1;
  }
  if constexpr (HasOrder<F>) p[F::kOrdered.larger] = std::max(p[F::kOrdered.larger], p[F::kOrdered.smaller]);
  return p;
}

/// Whether the torque changes with parameter k at any of a few rates, in either direction, or at a reversal.
template <FrictionModel F>
bool AffectsTorque(std::array<double, kFrictionParameters<F>> p, std::size_t k) {
  const auto torques = [&] {
    std::array<double, 7> at{};
    std::size_t i = 0;
    for (const double rate : {0.0, 0.5, 2.0}) {
      for (const double direction : {1.0, -1.0}) at[i++] = F::Torque(direction * rate, direction, p.data());
    }
    if constexpr (FrictionWithState<F>) at[i] = F::Stiffness(p.data());
    return at;
  };
  const auto before = torques();
  p[k] += p[k] + 0.1 < F::kParameters[k].upper ? 0.1 : -0.1;
  return torques() != before;
}

}  // namespace

std::optional<Nesting> FindNesting(const MotionModel& simpler, const MotionModel& richer) {
  const std::vector<ParameterInfo> few = PhysicalParameters(simpler);
  const std::vector<ParameterInfo> many = PhysicalParameters(richer);
  const bool within = std::ranges::all_of(few, [&](const ParameterInfo& info) { return Has(many, info.name); });
  if (simpler.gravity != richer.gravity || !within || few.size() >= many.size()) return std::nullopt;
  Nesting nesting;
  FrictionModels::Visit(richer.friction, [&]<typename F>() {
    const auto null = NullOf<F>(few);
    for (std::size_t k = 0; k < null.size(); ++k) {
      const ParameterInfo& info = F::kParameters[k];
      if (Has(few, info.name)) continue;
      nesting.added.push_back(info);
      if (!AffectsTorque<F>(null, k)) {
        nesting.unidentified.push_back(info.name);
      } else {
        ++(info.lower < 0 ? nesting.free : nesting.bounded);
      }
    }
  });
  return nesting;
}

std::optional<MotionModel> LargestNestedModel(const MotionModel& model) {
  std::optional<MotionModel> richest;
  for (const MotionModel& other : MotionModels()) {
    if (!FindNesting(other, model)) continue;
    if (!richest || PhysicalParameters(*richest).size() < PhysicalParameters(other).size()) richest = other;
  }
  return richest;
}

OrderedPair FindOrderedPair(const MotionModel& model) {
  OrderedPair pair;
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    if constexpr (HasOrder<F>) pair = {F::kOrdered.larger + 1, F::kOrdered.smaller + 1};
  });
  return pair;
}

}  // namespace pendulum
