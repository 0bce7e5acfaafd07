// SPDX-License-Identifier: Apache-2.0
#include "pendulum/trajectory/scatter.h"

#include <cstddef>
#include <random>
#include <string>

#include <boost/random/normal_distribution.hpp>

#include "pendulum/base/format.h"

namespace pendulum {
namespace {

constexpr int kMaxDraws = 1000;

/// mt19937_64 seeded through std::seed_seq, whose algorithm the standard specifies. SimulateRecording seeds
/// its generator with the number itself, so its draws differ.
std::mt19937_64 GeneratorOf(std::uint64_t seed) {
  constexpr std::uint64_t kLow = 0xFFFFFFFF;
  constexpr unsigned int kHigh = 32;
  std::seed_seq sequence{seed & kLow, seed >> kHigh};
  return std::mt19937_64(sequence);
}

/// The rule that the values violate, such as "viscous is -0.1, below 0"; empty if they are admissible.
std::string ViolatedRule(std::span<const ScatteredParameter> parameters, OrderedPair order,
                         const std::vector<double>& values) {
  const auto name_and_value = [&](std::size_t i) {
    return std::string(parameters[i].info.name) + " is " + NumberText(values[i]);
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto [lower, upper] = ParameterRange{parameters[i].info.lower, parameters[i].info.upper};
    if (values[i] < lower) return name_and_value(i) + ", below " + NumberText(lower);
    if (values[i] > upper) return name_and_value(i) + ", above " + NumberText(upper);
  }
  if (order.larger < 0) return "";
  const auto larger = static_cast<std::size_t>(order.larger), smaller = static_cast<std::size_t>(order.smaller);
  if (values[larger] >= values[smaller]) return "";
  return name_and_value(larger) + ", below " + std::string(parameters[smaller].info.name) + ", which is " +
         NumberText(values[smaller]);
}

}  // namespace

Result<std::vector<double>> ScatterParameters(std::span<const ScatteredParameter> parameters, OrderedPair order,
                                              std::uint64_t seed) {
  std::mt19937_64 generator = GeneratorOf(seed);
  boost::random::normal_distribution<double> draw;
  std::vector<double> values(parameters.size());
  std::string violation;
  for (int i = 0; i < kMaxDraws; ++i) {
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] = parameters[k].mean + parameters[k].std_dev * draw(generator);
    }
    violation = ViolatedRule(parameters, order, values);
    if (violation.empty()) return values;
  }
  return Error(StatusCode::kInvalidArgument, "of " + std::to_string(kMaxDraws) + " draws with seed " +
                                                 std::to_string(seed) + " none is within the bounds (in the last, " +
                                                 violation + "); make the standard deviations smaller");
}

}  // namespace pendulum
