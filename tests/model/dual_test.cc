// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/dual.h"

#include <cmath>
#include <random>
#include <utility>

#include <ceres/jet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::dual_test {
namespace {

using testing::DoubleNear;

/// The same random number with the same derivatives as a Dual and as a ceres::Jet.
template <int P>
std::pair<Dual<P>, ceres::Jet<double, P>> RandomPair(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> uniform(0.3, 1.7);
  std::pair<Dual<P>, ceres::Jet<double, P>> pair{Dual<P>(uniform(generator)), {}};
  pair.second.a = pair.first.a;
  for (int i = 0; i < P; ++i) {
    const double partial = uniform(generator) - 1;
    pair.first.v.set(i, partial);
    pair.second.v[i] = partial;
  }
  return pair;
}

template <int P>
void ExpectSame(const Dual<P>& actual, const ceres::Jet<double, P>& expected, const char* what) {
  EXPECT_THAT(actual.a, DoubleNear(expected.a, 1e-14)) << what;
  for (int i = 0; i < P; ++i) {
    EXPECT_THAT(actual.v[i], DoubleNear(expected.v[i], 1e-13)) << what << ", derivative " << i << " of " << P;
    EXPECT_EQ(actual.v.data()[i], actual.v[i]);
  }
}

/// Called with numbers of derivatives below, at and above the size of a quad.
template <int P>
void ExpectTheArithmeticOfJets() {
  std::mt19937_64 generator(20261123);
  for (int repetition = 0; repetition < 10; ++repetition) {
    const auto [x, jet_x] = RandomPair<P>(generator);
    const auto [y, jet_y] = RandomPair<P>(generator);
    ExpectSame(x + y, jet_x + jet_y, "x + y");
    ExpectSame(x - y, jet_x - jet_y, "x - y");
    ExpectSame(x * y, jet_x * jet_y, "x y");
    ExpectSame(x / y, jet_x / jet_y, "x / y");
    ExpectSame(-x, -jet_x, "-x");
    ExpectSame(x + 2.5, jet_x + 2.5, "x + s");
    ExpectSame(2.5 + x, 2.5 + jet_x, "s + x");
    ExpectSame(x - 2.5, jet_x - 2.5, "x - s");
    ExpectSame(2.5 - x, 2.5 - jet_x, "s - x");
    ExpectSame(x * 2.5, jet_x * 2.5, "x s");
    ExpectSame(2.5 * x, 2.5 * jet_x, "s x");
    ExpectSame(x / 2.5, jet_x / 2.5, "x / s");
    ExpectSame(2.5 / x, 2.5 / jet_x, "s / x");
    ExpectSame(exp(x), exp(jet_x), "exp x");
    ExpectSame(tanh(x), tanh(jet_x), "tanh x");
    ExpectSame(sqrt(x), sqrt(jet_x), "sqrt x");
    Dual<P> sum = x;
    sum += y;
    ExpectSame(sum, jet_x + jet_y, "x += y");
  }
}

TEST(Dual, HasTheArithmeticOfCeresJets) {
  ExpectTheArithmeticOfJets<1>();
  ExpectTheArithmeticOfJets<3>();
  ExpectTheArithmeticOfJets<4>();
  ExpectTheArithmeticOfJets<5>();
  ExpectTheArithmeticOfJets<8>();
  ExpectTheArithmeticOfJets<9>();
}

TEST(Dual, HasZeroDerivativesForANumber) {
  const Dual<5> number(0.25);
  const Dual<5> parameter(0.25, 3);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(number.v[i], 0);
    EXPECT_EQ(parameter.v[i], i == 3 ? 1 : 0);
  }
  EXPECT_EQ(number, parameter) << "derivatives are not compared";
}

TEST(Partials, AddTheProductWithABroadcastNumber) {
  Partials<5> sum;
  Partials<5> term;
  for (int i = 0; i < 5; ++i) {
    sum.set(i, 100);
    term.set(i, i);
  }
  sum.AddProduct(Quad{3, 3, 3, 3}, term);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(sum[i], 100 + 3 * i);
}

}  // namespace
}  // namespace pendulum::dual_test
