// SPDX-License-Identifier: Apache-2.0
#include "floor_kernel.h"

#include <algorithm>
#include <cstring>

#include "pendulum/base/instruction_set.h"

namespace pendulum::benchmarks {
namespace {

// Written once over vectors of samples and compiled for each target. It is inlined into functions for AVX-512, for AVX2
// with FMA, and for every CPU. Nothing is passed or returned by value, because the calling convention depends on the
// target.
#define PENDULUM_INLINE [[gnu::always_inline]] inline

/// One register of samples.
struct Avx512 {
  using Vector [[gnu::vector_size(64)]] = double;
};
struct Avx2 {
  using Vector [[gnu::vector_size(32)]] = double;
};
struct Portable {
  using Vector [[gnu::vector_size(16)]] = double;
};

/// A block of samples whose columns fit into the first-level cache, with room for lanes beyond a segment's end.
constexpr int kBlock = 256;
constexpr int kRoom = 32;  // four vectors

template <int W>
struct ColumnBlock {
  alignas(64) double column[W][kBlock + kRoom];
  int count = 0;  // below kBlock between segments
};

template <typename R>
constexpr int kLanesOf = sizeof(typename R::Vector) / sizeof(double);

template <typename Vector>
PENDULUM_INLINE void Load(const double* from, Vector& to) {
  std::memcpy(&to, from, sizeof to);
}

template <typename Vector>
PENDULUM_INLINE void Store(const Vector& from, double* to) {
  std::memcpy(to, &from, sizeof from);
}

/// W polynomials at V vectors of samples, in W V parallel Horner chains; column 0 becomes the residual. Lanes beyond
/// the segment hold undefined values; the next segment overwrites them.
template <typename R, int W, int V>
PENDULUM_INLINE void Evaluate(const FloorSegment& segment, const double* time, const double* value,
                              ColumnBlock<W>& block) {
  using Vector = typename R::Vector;
  constexpr int kLanes = kLanesOf<R>;
  double* const to = &block.column[0][block.count];
  Vector tau[V];
  Vector sum[W][V];
#pragma GCC unroll 8
  for (int v = 0; v < V; ++v) {
    Load(time + kLanes * v, tau[v]);
    tau[v] -= segment.start;
  }
#pragma GCC unroll 8
  for (int w = 0; w < W; ++w) {
#pragma GCC unroll 8
    for (int v = 0; v < V; ++v) sum[w][v] = Vector{} + segment.coefficient[segment.order][w];
  }
  for (int k = segment.order - 1; k >= 0; --k) {
#pragma GCC unroll 8
    for (int w = 0; w < W; ++w) {
#pragma GCC unroll 8
      for (int v = 0; v < V; ++v) sum[w][v] = sum[w][v] * tau[v] + segment.coefficient[k][w];
    }
  }
#pragma GCC unroll 8
  for (int v = 0; v < V; ++v) {
    Vector measured;
    Load(value + kLanes * v, measured);
    sum[0][v] = measured - sum[0][v];
#pragma GCC unroll 8
    for (int w = 0; w < W; ++w) Store(sum[w][v], to + (kBlock + kRoom) * w + kLanes * v);
  }
}

/// Sums over all samples: of products of two columns, and of columns.
template <typename R, int W>
struct Totals {
  typename R::Vector products[W][W] = {};
  typename R::Vector sums[W] = {};
};

/// Adds the products of each column from FIRST to LAST - 1 with itself and all later columns, and the columns' sums, in
/// registers.
template <int FIRST, int LAST, typename R, int W>
PENDULUM_INLINE void AddProducts(const ColumnBlock<W>& block, Totals<R, W>& totals) {
  using Vector = typename R::Vector;
  Vector part[LAST - FIRST][W] = {};
  Vector part_sum[LAST - FIRST] = {};
  for (int at = 0; at < block.count; at += kLanesOf<R>) {
    Vector column[W];
#pragma GCC unroll 8
    for (int j = FIRST; j < W; ++j) Load(&block.column[j][at], column[j]);
#pragma GCC unroll 8
    for (int i = FIRST; i < LAST; ++i) {
      part_sum[i - FIRST] += column[i];
#pragma GCC unroll 8
      for (int j = i; j < W; ++j) part[i - FIRST][j] += column[i] * column[j];
    }
  }
#pragma GCC unroll 8
  for (int i = FIRST; i < LAST; ++i) {
    totals.sums[i] += part_sum[i - FIRST];
#pragma GCC unroll 8
    for (int j = i; j < W; ++j) totals.products[i][j] += part[i - FIRST][j];
  }
}

/// Adds the squares of the only column, in four independent sums.
template <typename R>
PENDULUM_INLINE void AddSquares(const ColumnBlock<1>& block, Totals<R, 1>& totals) {
  constexpr int kParts = 4;
  constexpr int kLanes = kLanesOf<R>;
  typename R::Vector part[kParts] = {};
  for (int at = 0; at < block.count; at += kParts * kLanes) {
#pragma GCC unroll 8
    for (int i = 0; i < kParts; ++i) {
      typename R::Vector residual;
      Load(&block.column[0][at + kLanes * i], residual);
      part[i] += residual * residual;
    }
  }
  totals.products[0][0] += (part[0] + part[1]) + (part[2] + part[3]);
}

/// Adds the block's sums and empties the block.
template <typename R, int W>
PENDULUM_INLINE void AddBlock(ColumnBlock<W>& block, Totals<R, W>& totals) {
  // Clears the lanes beyond the count.
  for (int w = 0; w < W; ++w) std::fill_n(&block.column[w][block.count], kRoom, 0.0);
  if constexpr (W == 1) {
    AddSquares(block, totals);
  } else {
    AddProducts<0, 1>(block, totals);  // 7, 11 and 9 sums fit into the registers
    AddProducts<1, 3>(block, totals);
    AddProducts<3, W>(block, totals);
  }
  block.count = 0;
}

/// Evaluates one vector at the last sample. Uses copies, because nothing may be read beyond the last sample.
template <typename R, int W>
PENDULUM_INLINE void EvaluateLast(const FloorSegment& segment, const double* time, const double* value, int count,
                                  ColumnBlock<W>& block) {
  double times[kLanesOf<R>] = {};
  double values[kLanesOf<R>] = {};
  std::copy_n(time, count, times);
  std::copy_n(value, count, values);
  Evaluate<R, W, 1>(segment, times, values, block);
}

template <typename R, int W>
PENDULUM_INLINE void AddUp(const std::vector<FloorSegment>& segments, const FloorSamples& samples,
                           Totals<R, W>& totals) {
  constexpr int kLanes = kLanesOf<R>;
  constexpr int kWide = kLanes * (W == 1 ? 4 : 2);  // enough chains to keep two multipliers busy
  ColumnBlock<W> block;
  const int end = segments.back().last;
  for (const FloorSegment& segment : segments) {
    for (int at = segment.first; at < segment.last;) {
      const bool wide = segment.last - at > kLanes && at + kWide <= end;
      const int done = std::min(segment.last - at, wide ? kWide : kLanes);
      if (wide) {
        Evaluate<R, W, kWide / kLanes>(segment, samples.time + at, samples.value + at, block);
      } else if (at + kLanes <= end) {
        Evaluate<R, W, 1>(segment, samples.time + at, samples.value + at, block);
      } else {
        EvaluateLast<R>(segment, samples.time + at, samples.value + at, done, block);
      }
      at += done;
      block.count += done;
      if (block.count > kBlock - kRoom) AddBlock(block, totals);
    }
  }
  AddBlock(block, totals);
}

template <typename Vector>
PENDULUM_INLINE double Sum(const Vector& lanes) {
  double sum = 0;
  for (unsigned i = 0; i < sizeof lanes / sizeof sum; ++i) sum += lanes[i];
  return sum;
}

template <typename R>
PENDULUM_INLINE void SumOfSquares(const std::vector<FloorSegment>& segments, const FloorSamples& samples,
                                  double& result) {
  Totals<R, 1> totals;
  AddUp(segments, samples, totals);
  result = Sum(totals.products[0][0]);
}

/// Converts from residual first, without the column of ones, to the order of NormalMatrix.
template <typename R>
PENDULUM_INLINE void FillNormalMatrix(const std::vector<FloorSegment>& segments, const FloorSamples& samples,
                                      NormalMatrix& matrix) {
  constexpr int kOnes = kFloorColumns - 1;
  constexpr int kResidual = kFloorColumns;
  Totals<R, kFloorColumns> totals;
  AddUp(segments, samples, totals);
  for (int i = 0; i < kFloorColumns; ++i) {
    const int row = i == 0 ? kResidual : i - 1;
    matrix[row][kOnes] = matrix[kOnes][row] = Sum(totals.sums[i]);
    for (int j = i; j < kFloorColumns; ++j) {
      const int column = j == 0 ? kResidual : j - 1;
      matrix[row][column] = matrix[column][row] = Sum(totals.products[i][j]);
    }
  }
  matrix[kOnes][kOnes] = segments.back().last - segments.front().first;
}

// On other processors the portable target is the only one.
#ifdef PENDULUM_HAS_AVX
[[PENDULUM_AVX512]] void SumOfSquaresAvx512(const std::vector<FloorSegment>& segments, const FloorSamples& samples,
                                            double& result) {
  SumOfSquares<Avx512>(segments, samples, result);
}
[[PENDULUM_AVX512]] void FillNormalMatrixAvx512(const std::vector<FloorSegment>& segments, const FloorSamples& samples,
                                                NormalMatrix& matrix) {
  FillNormalMatrix<Avx512>(segments, samples, matrix);
}
[[PENDULUM_AVX2]] void SumOfSquaresAvx2(const std::vector<FloorSegment>& segments, const FloorSamples& samples,
                                        double& result) {
  SumOfSquares<Avx2>(segments, samples, result);
}
[[PENDULUM_AVX2]] void FillNormalMatrixAvx2(const std::vector<FloorSegment>& segments, const FloorSamples& samples,
                                            NormalMatrix& matrix) {
  FillNormalMatrix<Avx2>(segments, samples, matrix);
}
#else
constexpr auto SumOfSquaresAvx512 = SumOfSquares<Portable>;
constexpr auto FillNormalMatrixAvx512 = FillNormalMatrix<Portable>;
constexpr auto SumOfSquaresAvx2 = SumOfSquares<Portable>;
constexpr auto FillNormalMatrixAvx2 = FillNormalMatrix<Portable>;
#endif

}  // namespace

FloorTarget BestFloorTarget() {
  if (kInstructionSet == InstructionSet::kAvx512) return FloorTarget::kAvx512;
  return kInstructionSet == InstructionSet::kAvx2 ? FloorTarget::kAvx2 : FloorTarget::kPortable;
}

double FloorSumOfSquares(const std::vector<FloorSegment>& segments, const FloorSamples& samples, FloorTarget target) {
  double result = 0;
  if (target == FloorTarget::kAvx512) {
    SumOfSquaresAvx512(segments, samples, result);
  } else if (target == FloorTarget::kAvx2) {
    SumOfSquaresAvx2(segments, samples, result);
  } else {
    SumOfSquares<Portable>(segments, samples, result);
  }
  return result;
}

NormalMatrix FloorNormalMatrix(const std::vector<FloorSegment>& segments, const FloorSamples& samples,
                               FloorTarget target) {
  NormalMatrix matrix{};
  if (target == FloorTarget::kAvx512) {
    FillNormalMatrixAvx512(segments, samples, matrix);
  } else if (target == FloorTarget::kAvx2) {
    FillNormalMatrixAvx2(segments, samples, matrix);
  } else {
    FillNormalMatrix<Portable>(segments, samples, matrix);
  }
  return matrix;
}

}  // namespace pendulum::benchmarks
