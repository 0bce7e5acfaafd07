// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pendulum {

/// Distributions of statistics, by Boost.Math. Its headers are read here alone, for they take seconds to compile.
/// Degrees of freedom are above 0 and need not be whole; a probability is within (0, 1), a sum of squares at least 0;
/// anything else, not a number too, is Boost's std::domain_error.

/// x below which a standard normal value lies with this probability.
double NormalQuantile(double probability);

/// P(X > x) of a sum of squares of `freedom` standard normal values.
double ChiSquareTail(double x, double freedom);
double ChiSquareQuantile(double probability, double freedom);

/// Of Student's t.
double StudentDensity(double t, double freedom);
double StudentProbability(double t, double freedom);  // P(T < t)
double StudentTail(double t, double freedom);         // P(T > t)
double StudentQuantile(double probability, double freedom);

/// P(F > f) of a ratio of mean squares with `above` and `below` degrees of freedom.
double FisherTail(double f, double above, double below);

/// The limits of the probability of a success, each of which errs with probability `tail` at most, after so many
/// successes (C. J. Clopper and E. S. Pearson, Biometrika 26 (1934) 404).
double BinomialLowerLimit(int successes, int trials, double tail);
double BinomialUpperLimit(int successes, int trials, double tail);

}  // namespace pendulum
