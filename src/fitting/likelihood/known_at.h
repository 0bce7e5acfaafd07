// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace pendulum {

/// The arguments that determine a cost's result, apart from its noise.
struct Question {
  std::span<const double> parameters;
  double tolerance;
  std::size_t samples;
};

/// A cached result and its arguments. Solver, active set, search and judge ask for it at the same point in turn.
template <typename What>
struct KnownAt {
  std::vector<double> parameters;
  double tolerance = 0;
  std::size_t samples = 0;
  What value;

  bool IsAt(const Question& question) const {
    return std::ranges::equal(question.parameters, parameters) && tolerance == question.tolerance &&
           samples == question.samples;
  }

  /// Marks the present `value` as the result for `question`.
  void SetAt(const Question& question) {
    parameters.assign(question.parameters.begin(), question.parameters.end());
    tolerance = question.tolerance;
    samples = question.samples;
  }

  void SetAt(const Question& question, What what) {
    value = std::move(what);
    SetAt(question);
  }

  void Forget() { parameters.clear(); }
};

}  // namespace pendulum
