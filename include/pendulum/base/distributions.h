// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pendulum {

// Distributions of statistics, by Boost.Math, which takes seconds to compile: in the libraries distributions.cc alone
// includes it. All numbers are dimensionless. Callers see to it that x and f are finite and at least 0, t is a number,
// degrees of freedom above 0, whole or not, and probabilities strictly between 0 and 1: otherwise Boost throws
// std::domain_error or std::overflow_error.

/// The x below which a standard normal value lies with this probability.
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

/// Limits of the probability of a success after 0 <= `successes` <= `trials`: the truth lies beyond each with
/// probability `tail` at most (C. J. Clopper and E. S. Pearson, Biometrika 26 (1934) 404).
double BinomialLowerLimit(int successes, int trials, double tail);
double BinomialUpperLimit(int successes, int trials, double tail);

}  // namespace pendulum
