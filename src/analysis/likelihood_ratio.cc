// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/likelihood_ratio.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "pendulum/base/distributions.h"
#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"

namespace pendulum {
namespace {

std::string ShareText(double weight) {
  if (weight == 0.5) return "half ";
  return weight == 0.25 ? "a quarter " : NumberText(weight, 2) + " ";
}

}  // namespace

ChiBarWeights WeightsAtBound(int bounded, int free, double correlation) {
  ChiBarWeights weights(static_cast<std::size_t>(free), 0.0);
  if (bounded == 0) {
    weights.push_back(1);
  } else if (bounded == 1) {
    weights.insert(weights.end(), {0.5, 0.5});
  } else {
    const double both = 0.25 + std::asin(std::clamp(correlation, -1.0, 1.0)) / (2 * kPi);
    weights.insert(weights.end(), {0.5 - both, 0.5, both});
  }
  return weights;
}

double ChiBarTail(const ChiBarWeights& weights, double statistic) {
  if (!(statistic > 0)) return 1;
  double tail = 0;
  for (std::size_t freedom = 1; freedom < weights.size(); ++freedom) {
    if (weights[freedom] == 0) continue;
    tail += weights[freedom] * ChiSquareTail(statistic, static_cast<double>(freedom));
  }
  return tail;
}

std::string DescribeMixture(const ChiBarWeights& weights) {
  std::string text;
  for (std::size_t freedom = 0; freedom < weights.size(); ++freedom) {
    if (weights[freedom] == 0) continue;
    text += (text.empty() ? "" : ", ") + (weights[freedom] == 1 ? std::string() : ShareText(weights[freedom])) + "χ²(" +
            std::to_string(freedom) + ")";
  }
  return text;
}

}  // namespace pendulum
