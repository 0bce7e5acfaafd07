// SPDX-License-Identifier: Apache-2.0
#include "fitting/likelihood/sample_kernel.h"

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

constexpr int kRows = 7;
constexpr int kFull = kBlock;
constexpr double kStart = 1.25;  // s

/// Coefficients of both signs that decrease like those of a swing.
template <typename T>
Segment<T> Swing() {
  Segment<T> segment;
  segment.start = kStart;
  segment.order = 15;
  for (int k = 0; k <= segment.order; ++k) {
    segment.angle[k] = std::cos(k) * std::pow(0.4, k);
    if constexpr (DualNumber<T>) {
      for (int p = 0; p < kPartials<T>; ++p) segment.partials[k].set(p, std::cos(k + 0.7 * (p + 1)) * std::pow(0.4, k));
    }
  }
  if constexpr (DualNumber<T>) {
    for (int p = 0; p < kPartials<T>; ++p) segment.start_partials.set(p, 0.1 * p - 0.2);
  }
  return segment;
}

struct Block {
  SampleBlock<kRows> block;
  std::array<double, kBlockStride> time{};

  Block() {
    for (auto& row : block.row) row.fill(0.25);
    for (std::size_t i = 0; i < kBlockStride; ++i) time[i] = kStart + 0.3 * std::sin(0.1 * static_cast<double>(i));
  }
  double* rows() { return block.row[0].data(); }
};

/// Σ coefficient(k) τ^k, computed directly.
template <typename Coefficient>
double Polynomial(const Coefficient& coefficient, int order, double tau) {
  double sum = 0;
  for (int k = order; k >= 0; --k) sum += coefficient(k) * std::pow(tau, k);
  return sum;
}

/// Value of row w at τ: partial derivatives at fixed time, for a release -θ', then the angle.
template <bool kRelease, typename T>
double Expected(const Segment<T>& swing, int w, double tau) {
  if (w + 1 == kSegmentRows<T, kRelease>) return Polynomial([&](int k) { return swing.angle[k]; }, swing.order, tau);
  const auto rate = [&](int k) { return (k + 1) * swing.angle[k + 1]; };
  if (w == kPartials<T>) return -Polynomial(rate, swing.order - 1, tau);
  if constexpr (DualNumber<T>) {
    return Polynomial([&](int k) { return PartialsAtFixedTime(swing, k)[w]; }, swing.order, tau);
  }
  return 0;
}

template <typename T, bool kRelease>
void ExpectColumns() {
  const Segment<T> swing = Swing<T>();
  constexpr int kWidth = kSegmentRows<T, kRelease>;
  for (const int count : {1, 2, 3, 4, 5, 7, 8, 9, 12, 17, 24, 31, kFull}) {
    const auto at = std::make_unique<Block>();
    EvaluateAt<kRelease>(swing, at->time.data(), count, at->rows());
    for (int w = 0; w < kWidth; ++w) {
      for (int i = 0; i < count; ++i) {
        const double expected = Expected<kRelease>(swing, w, at->time[i] - kStart);
        ASSERT_THAT(at->block.row[w][i], DoubleNear(expected, 1e-15)) << "column " << w << ", sample " << i;
      }
      if (count + 7 < kFull) {
        EXPECT_EQ(at->block.row[w][count + 7], 0.25) << "beyond what vectors may reach";
      }
    }
    if (kWidth < kRows) {
      EXPECT_EQ(at->block.row[kWidth][0], 0.25) << "another row";
    }
  }
}

TEST(EvaluateAt, MatchesTheSegmentForAnyNumberOfSamples) {
  ExpectColumns<double, false>();
  ExpectColumns<double, true>();
  ExpectColumns<Dual<4>, true>();
  ExpectColumns<Dual<5>, false>();
}

TEST(SumProducts, SumsOnlyTheGivenSamples) {
  for (const int count : {1, 3, 4, 30, kFull}) {
    const auto at = std::make_unique<Block>();
    EvaluateAt<true>(Swing<Dual<4>>(), at->time.data(), count, at->rows());
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

#ifdef PENDULUM_HAS_AVX
/// Compares the columns and sums of products of two kernels.
template <typename Narrow, typename Wide>
void ExpectAgreement(const Narrow& narrow, const Wide& wide) {
  for (const int count : {3, 12, 255, kFull}) {
    std::array<std::unique_ptr<Block>, 2> at = {std::make_unique<Block>(), std::make_unique<Block>()};
    std::array<RowProducts<kRows>, 2> sums;
    narrow(*at[0], count, sums[0]);
    wide(*at[1], count, sums[1]);
    for (int w = 0; w < kRows; ++w) {
      for (int i = 0; i < count; ++i) {
        ASSERT_THAT(at[1]->block.row[w][i], DoubleNear(at[0]->block.row[w][i], 1e-15)) << w << ", " << i;
      }
    }
    EXPECT_NE(sums[1].back(), 0);
    EXPECT_THAT(sums[1], Pointwise(DoubleNear(1e-13), sums[0])) << count;
  }
}

void ClearBeyond(Block& at, int count) {
  for (auto& row : at.block.row) std::fill_n(row.begin() + count, kParts, 0.0);
}

void Narrow(Block& at, int count, RowProducts<kRows>& sums) {
  baseline::Evaluate<true>(Swing<Dual<4>>(), at.time.data(), count, at.rows());
  ClearBeyond(at, count);
  baseline::SumProducts<kRows>(at.rows(), count, sums.data());
}

TEST(InstructionSets, Avx2AgreesUpToRounding) {
  if (kInstructionSet < InstructionSet::kAvx2) GTEST_SKIP() << "this processor has no AVX2";
  ExpectAgreement(Narrow, [](Block& at, int count, RowProducts<kRows>& sums) {
    avx2::Evaluate<true>(Swing<Dual<4>>(), at.time.data(), count, at.rows());
    ClearBeyond(at, count);
    avx2::SumProducts<kRows>(at.rows(), count, sums.data());
  });
}

TEST(InstructionSets, Avx512AgreesUpToRounding) {
  if (kInstructionSet < InstructionSet::kAvx512) GTEST_SKIP() << "this processor has no AVX-512";
  ExpectAgreement(Narrow, [](Block& at, int count, RowProducts<kRows>& sums) {
    avx512::Evaluate<true>(Swing<Dual<4>>(), at.time.data(), count, at.rows());
    ClearBeyond(at, count);
    avx512::SumProducts<kRows>(at.rows(), count, sums.data());
  });
}
#endif

}  // namespace
}  // namespace pendulum::sample_kernel_test
