// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/distributions.h"

#include <cmath>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace pendulum {
namespace {

using boost::math::chi_squared;
using boost::math::complement;
using boost::math::fisher_f;
using boost::math::normal;
using boost::math::students_t;
using Binomial = boost::math::binomial_distribution<double>;

}  // namespace

double NormalQuantile(double probability) { return quantile(normal(), probability); }

double ChiSquareTail(double x, double freedom) { return cdf(complement(chi_squared(freedom), x)); }

double ChiSquareQuantile(double probability, double freedom) { return quantile(chi_squared(freedom), probability); }

double StudentDensity(double t, double freedom) { return pdf(students_t(freedom), t); }

double StudentProbability(double t, double freedom) { return cdf(students_t(freedom), t); }

double StudentTail(double t, double freedom) { return cdf(complement(students_t(freedom), t)); }

double StudentQuantile(double probability, double freedom) { return quantile(students_t(freedom), probability); }

double FisherTail(double f, double numerator_freedom, double denominator_freedom) {
  return cdf(complement(fisher_f(numerator_freedom, denominator_freedom), f));
}

double BinomialLowerLimit(int successes, int trials, double tail) {
  return Binomial::find_lower_bound_on_p(trials, successes, tail);
}

double BinomialUpperLimit(int successes, int trials, double tail) {
  return Binomial::find_upper_bound_on_p(trials, successes, tail);
}

double TwoSidedP(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

}  // namespace pendulum
