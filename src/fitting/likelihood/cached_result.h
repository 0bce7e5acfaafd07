// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace pendulum {

/// The arguments that determine a cost's result, apart from its noise.
struct EvaluationKey {
  std::span<const double> parameters;
  double tolerance;
  std::size_t samples;
};

/// A cached result and its arguments. Solver, active set, search and fit report request it at the same point in turn.
template <typename What>
struct CachedResult {
  std::vector<double> parameters;
  double tolerance = 0;
  std::size_t samples = 0;
  What value;

  bool IsAt(const EvaluationKey& evaluation_key) const {
    return std::ranges::equal(evaluation_key.parameters, parameters) && tolerance == evaluation_key.tolerance &&
           samples == evaluation_key.samples;
  }

  /// Marks the present `value` as the result for `evaluation_key`.
  void SetAt(const EvaluationKey& evaluation_key) {
    parameters.assign(evaluation_key.parameters.begin(), evaluation_key.parameters.end());
    tolerance = evaluation_key.tolerance;
    samples = evaluation_key.samples;
  }

  void SetAt(const EvaluationKey& evaluation_key, What what) {
    value = std::move(what);
    SetAt(evaluation_key);
  }

  void Forget() { parameters.clear(); }
};

}  // namespace pendulum
