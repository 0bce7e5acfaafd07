// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pendulum {

// Statistical distributions, computed by Boost.Math. The headers of Boost.Math take seconds to compile, so in the
// libraries only distributions.cc includes them. All numbers are dimensionless. The caller ensures that x and f are
// finite and at least 0, t is not NaN, degrees of freedom are above 0 (not necessarily whole) and probabilities lie
// strictly between 0 and 1. Otherwise Boost throws std::domain_error or std::overflow_error.

inline constexpr double kNormal95 = 1.959963984540054;  ///< NormalQuantile(0.975): 95 % lie within ± this.

/// The quantile of the standard normal distribution: the x with P(X < x) = `probability`.
double NormalQuantile(double probability);

/// P(X > x) of a sum X of squares of `freedom` independent standard normal values.
double ChiSquareTail(double x, double freedom);

/// The x with P(X < x) = `probability`.
double ChiSquareQuantile(double probability, double freedom);

/// The density of Student's t.
double StudentDensity(double t, double freedom);

/// P(T < t).
double StudentProbability(double t, double freedom);

/// P(T > t).
double StudentTail(double t, double freedom);

/// The t with P(T < t) = `probability`.
double StudentQuantile(double probability, double freedom);

/// P(F > f) of a ratio F of two mean squares.
double FisherTail(double f, double numerator_freedom, double denominator_freedom);

/// Confidence limits of the probability of success after 0 <= `successes` <= `trials`. The true value lies beyond each
/// limit with probability `tail` at most (C. J. Clopper and E. S. Pearson, Biometrika 26 (1934) 404).
double BinomialLowerLimit(int successes, int trials, double tail);
double BinomialUpperLimit(int successes, int trials, double tail);

/// Probability that a standard normal variable has a larger magnitude than z.
double TwoSidedP(double z);

}  // namespace pendulum
