// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace pendulum {

/// Weights w_0, w_1, ... of a mixture of χ² distributions with 0, 1, ... degrees of freedom (S. G. Self and K.-Y.
/// Liang, JASA 82:605, 1987): what -2 log of a likelihood ratio follows when the simpler law is true.
using ChiBarWeights = std::vector<double>;

/// Of `bounded` (0, 1 or 2) parameters at their bound under the simpler law beside `free` ones within theirs;
/// `correlation` of the two bounded ones' estimates. One: w_0 = w_1 = 1/2; two: w_1 = 1/2, w_2 = 1/4 + asin ρ / 2π.
ChiBarWeights WeightsAtBound(int bounded, int free, double correlation = 0);

/// Probability of a statistic at least as large under the mixture; 1 for a statistic <= 0.
double ChiBarTail(const ChiBarWeights& weights, double statistic);

/// "half χ²(0), half χ²(1)", "χ²(1)": the mixture in words.
std::string DescribeMixture(const ChiBarWeights& weights);

}  // namespace pendulum
