// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "pendulum/model/gravity/registry.h"

namespace pendulum {

/// A law of gravity chosen at run time. The functions are those of the law, see GravityModel.
class Gravity {
 public:
  constexpr Gravity() = default;

  template <GravityModel L>
  static constexpr Gravity Of() {
    Gravity gravity;
    gravity.index_ = GravityModels::IndexOf<L>();
    return gravity;
  }

  /// The law with this name, if there is one.
  static constexpr std::optional<Gravity> Named(std::string_view name) {
    for (std::size_t i = 0; i < GravityModels::kNames.size(); ++i) {
      if (GravityModels::kNames[i] != name) continue;
      Gravity gravity;
      gravity.index_ = i;
      return gravity;
    }
    return std::nullopt;
  }

  static const Gravity kSine, kLinear;

  /// Calls visit.operator()<L>() for the law L and returns its result.
  template <typename Visitor>
  [[gnu::always_inline]] constexpr decltype(auto) Visit(Visitor&& visit) const {
    return GravityModels::Visit(index_, visit);
  }

  constexpr std::string_view name() const { return GravityModels::kNames[index_]; }
  constexpr std::string_view title() const {
    return Visit([]<typename L>() { return L::kTitle; });
  }
  constexpr std::string_view about() const {
    return Visit([]<typename L>() { return L::kAbout; });
  }
  constexpr std::string_view formula() const {
    return Visit([]<typename L>() { return L::kFormula; });
  }
  constexpr bool is_linear() const {
    return Visit([]<typename L>() { return L::kIsLinear; });
  }
  constexpr double top() const {
    return Visit([]<typename L>() { return L::kTop; });
  }
  double Torque(double angle) const {
    return Visit([&]<typename L>() { return L::Torque(angle); });
  }
  double AngleAtTorque(double torque) const {
    return Visit([&]<typename L>() { return L::AngleAtTorque(torque); });
  }
  double Potential(double angle) const {
    return Visit([&]<typename L>() { return L::Potential(angle); });
  }
  double AngleAt(double torque, double potential) const {
    return Visit([&]<typename L>() { return L::AngleAt(torque, potential); });
  }
  double Chord(double angle) const {
    return Visit([&]<typename L>() { return L::Chord(angle); });
  }
  double AngleOfChord(double chord) const {
    return Visit([&]<typename L>() { return L::AngleOfChord(chord); });
  }
  double PeriodRatio(double amplitude) const {
    return Visit([&]<typename L>() { return L::PeriodRatio(amplitude); });
  }

  friend constexpr bool operator==(Gravity, Gravity) = default;

 private:
  std::size_t index_ = 0;
};

inline constexpr Gravity Gravity::kSine = Of<SineGravity>();
inline constexpr Gravity Gravity::kLinear = Of<LinearGravity>();

}  // namespace pendulum
