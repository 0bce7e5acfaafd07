// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace pendulum {

/// Weights w_0, w_1, ... of a mixture of χ² distributions with 0, 1, ... degrees of freedom. It is the distribution of
/// -2 log of a likelihood ratio if the simpler law is true (S. G. Self and K.-Y. Liang, JASA 82:605, 1987).
using ChiBarWeights = std::vector<double>;

/// Weights for added parameters: under the simpler law, `bounded` (0, 1 or 2) of them are at their bound and `free` of
/// them are inside their bounds. `correlation` ρ: between the estimates of two bounded parameters. One bounded
/// parameter has w_0 = w_1 = 1/2; two have w_1 = 1/2, w_2 = 1/4 + asin ρ / 2π. Each free parameter shifts the weights
/// by one degree of freedom.
ChiBarWeights WeightsAtBound(int bounded, int free, double correlation = 0);

/// Probability under the mixture that the statistic is at least this large; 1 for a statistic <= 0.
double ChiBarTail(const ChiBarWeights& weights, double statistic);

/// The mixture in words: "half χ²(0), half χ²(1)", "χ²(1)".
std::string DescribeMixture(const ChiBarWeights& weights);

}  // namespace pendulum
