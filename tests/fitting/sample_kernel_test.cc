// SPDX-License-Identifier: Apache-2.0
#include "fitting/sample_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::sample_kernel_test {
namespace {

using testing::DoubleNear;
using testing::Pointwise;

constexpr int kColumns = 6;
constexpr int kRows = 7;
constexpr int kFull = kBlock;

/// Coefficients of both signs that fall off as those of a swing do.
Polynomials<kColumns> Swings() {
  Polynomials<kColumns> polynomials;
  polynomials.order = 15;
  polynomials.derivative_order = 11;
  for (int k = 0; k <= polynomials.order; ++k) {
    for (int w = 0; w < kColumns; ++w) polynomials.coefficient[k][w] = std::cos(k + 0.7 * w) * std::pow(0.4, k);
  }
  return polynomials;
}

struct Block {
  SampleBlock<kRows> block;
  std::array<double, kBlockStride> tau{};

  Block() {
    for (auto& row : block.row) row.fill(0.25);
    for (std::size_t i = 0; i < kBlockStride; ++i) tau[i] = 0.3 * std::sin(0.1 * static_cast<double>(i));
  }
  double* rows() { return block.row[0].data(); }
};

TEST(EvaluateAt, IsThePolynomialAtEverySampleOfAnyCount) {
  const Polynomials<kColumns> swings = Swings();
  for (const int count : {1, 2, 3, 4, 5, 7, 8, 9, 12, 31, kFull}) {
    const auto at = std::make_unique<Block>();
    EvaluateAt(swings, at->tau.data(), count, at->rows());
    for (int w = 0; w < kColumns; ++w) {
      for (int i = 0; i < count; ++i) {
        double expected = 0;
        const int order = w + 1 == kColumns ? swings.order : swings.derivative_order;
        for (int k = order; k >= 0; --k) expected += swings.coefficient[k][w] * std::pow(at->tau[i], k);
        ASSERT_THAT(at->block.row[w][i], DoubleNear(expected, 1e-15)) << "column " << w << ", sample " << i;
      }
      EXPECT_EQ(at->block.row[w][count + 4], 0.25) << "beyond what vectors may reach, of " << count;
    }
    EXPECT_EQ(at->block.row[kColumns][0], 0.25) << "another row";
  }
}

TEST(SumProducts, AreTheSumsOverTheSamplesAlone) {
  for (const int count : {1, 3, 4, 30, kFull}) {
    const auto at = std::make_unique<Block>();
    EvaluateAt(Swings(), at->tau.data(), count, at->rows());
    RowProducts<kRows> products;
    SumProducts(at->block, count, products);
    for (int i = 0, k = 0; i < kRows; ++i) {
      for (int j = 0; j <= i; ++j, ++k) {
        long double expected = 0;
        for (int s = 0; s < count; ++s) {
          expected += static_cast<long double>(at->block.row[i][s]) * at->block.row[j][s];
        }
        EXPECT_THAT(products[k], DoubleNear(static_cast<double>(expected), 1e-13)) << i << ", " << j;
      }
    }
  }
}

#ifdef PENDULUM_HAS_AVX2
TEST(InstructionSets, AgreeUpToRounding) {
  if (!kUseAvx2) GTEST_SKIP() << "this processor has no AVX2";
  const Polynomials<kColumns> swings = Swings();
  for (const int count : {3, 12, 255, kFull}) {
    const auto narrow = std::make_unique<Block>();
    const auto wide = std::make_unique<Block>();
    baseline::Evaluate(swings, narrow->tau.data(), count, narrow->rows());
    avx2::Evaluate(swings, wide->tau.data(), count, wide->rows());
    for (int w = 0; w < kColumns; ++w) {
      for (int i = 0; i < count; ++i) {
        ASSERT_THAT(wide->block.row[w][i], DoubleNear(narrow->block.row[w][i], 1e-15)) << w << ", " << i;
      }
    }
    RowProducts<kRows> of_narrow;
    RowProducts<kRows> of_wide;
    for (const auto& block : {narrow.get(), wide.get()}) {
      for (auto& row : block->block.row) std::fill_n(row.begin() + count, kParts, 0.0);
    }
    baseline::SumProducts<kRows>(narrow->rows(), count, of_narrow.data());
    avx2::SumProducts<kRows>(wide->rows(), count, of_wide.data());
    EXPECT_NE(of_wide.back(), 0);
    EXPECT_THAT(of_wide, Pointwise(DoubleNear(1e-13), of_narrow)) << count;
  }
}
#endif

}  // namespace
}  // namespace pendulum::sample_kernel_test
