// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string_view>
#include <tuple>

#include "pendulum/model/gravity/gravity_model.h"
#include "pendulum/model/gravity/linear.h"
#include "pendulum/model/gravity/sine.h"

namespace pendulum {

template <GravityModel... Ls>
struct GravityModelList {
  static constexpr std::array<std::string_view, sizeof...(Ls)> kNames = {Ls::kName...};

  /// One Recurrence of each law.
  template <typename T>
  using Recurrences = std::tuple<typename Ls::template Recurrence<T>...>;

  /// The place of a law in the list.
  template <typename L>
  static constexpr std::size_t IndexOf() {
    std::size_t index = 0;
    (void)((std::same_as<L, Ls> || (++index, false)) || ...);
    return index;
  }

  /// Calls visit.operator()<L>() for the law at this place and returns its result.
  template <typename Visitor>
  [[gnu::always_inline]] static constexpr decltype(auto) Visit(std::size_t index, Visitor&& visit) {
    return VisitFrom<0, Ls...>(index, visit);
  }

 private:
  template <std::size_t kIndex, typename L, typename... Rest, typename Visitor>
  [[gnu::always_inline]] static constexpr decltype(auto) VisitFrom(std::size_t index, Visitor& visit) {
    if constexpr (sizeof...(Rest) > 0) {
      if (index != kIndex) return VisitFrom<kIndex + 1, Rest...>(index, visit);
    }
    return visit.template operator()<L>();
  }
};

/// All laws of gravity. To add one, include its header above and add its name here; the first is the default.
using GravityModels = GravityModelList<SineGravity, LinearGravity>;

}  // namespace pendulum
