// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include "pendulum/base/instruction_set.h"
#include "pendulum/model/dual.h"
#include "pendulum/trajectory/swing.h"

/// The arithmetic done for every sample. It is compiled for each useful instruction set and chosen by the features of
/// the processor: see instruction_set.h.
namespace pendulum {

/// Samples are processed in blocks of consecutive samples. The columns of a block stay in the first-level cache, and
/// sums over a block do not depend on the thread that computes them.
inline constexpr std::size_t kBlock = 256;
inline constexpr std::size_t kParts = 8;  ///< Partial sums of a product over a block: the lanes of the widest vector.
inline constexpr std::size_t kBlockStride = kBlock + kParts;  ///< Of a row: the last vector reaches beyond the samples.

/// R rows of numbers, one column for each sample of a block.
template <int R>
struct SampleBlock {
  alignas(64) std::array<std::array<double, kBlockStride>, R> row;
};

/// Products of R rows summed over a block: (0,0), (1,0), (1,1), (2,0), ...
template <int R>
using RowProducts = std::array<double, R*(R + 1) / 2>;

/// Number of rows that a segment of T fills. With a dual T these are the partial derivatives of the angle at a fixed
/// time, for a release also the derivative with respect to its instant, -θ', and last the angle. Otherwise it is only
/// the angle.
template <typename T, bool kRelease>
inline constexpr int kSegmentRows = 1;
template <int P, bool kRelease>
inline constexpr int kSegmentRows<Dual<P>, kRelease> = P + 1 + (kRelease ? 1 : 0);

namespace baseline {
inline constexpr std::size_t kLanes = 2;
using Vector [[gnu::vector_size(16)]] = double;
#include "fitting/likelihood/sample_kernel_body.h"
}  // namespace baseline

#ifdef PENDULUM_HAS_AVX
#pragma GCC push_options  // the same targets as in instruction_set.h
#pragma GCC target("avx2,fma")
namespace avx2 {
inline constexpr std::size_t kLanes = 4;
using Vector [[gnu::vector_size(32)]] = double;
#include "fitting/likelihood/sample_kernel_body.h"
}  // namespace avx2
#pragma GCC target("avx2,fma,avx512f,avx512dq,avx512vl")
namespace avx512 {
inline constexpr std::size_t kLanes = 8;
using Vector [[gnu::vector_size(64)]] = double;
#include "fitting/likelihood/sample_kernel_body.h"
}  // namespace avx512
#pragma GCC pop_options
#endif

/// Fills a segment's rows at the times [s] of `count` samples: derivatives with respect to the parameters of T and to
/// the instant of release, then the angle (MODEL.md eq. (4.6)). Writes up to kParts - 1 entries beyond the last sample.
template <bool kRelease, typename T>
void EvaluateAt(const Segment<T>& segment, const double* time, int count, double* rows) {
#ifdef PENDULUM_HAS_AVX
  if (kInstructionSet == InstructionSet::kAvx512) return avx512::Evaluate<kRelease>(segment, time, count, rows);
  if (kInstructionSet == InstructionSet::kAvx2) return avx2::Evaluate<kRelease>(segment, time, count, rows);
#endif
  baseline::Evaluate<kRelease>(segment, time, count, rows);
}

/// Sums all products of two rows over the first `count` samples. Overwrites the entries beyond the last sample.
template <int R>
void SumProducts(SampleBlock<R>& block, int count, RowProducts<R>& sums) {
  for (auto& row : block.row) std::fill_n(row.begin() + count, kParts, 0.0);
  const double* const rows = block.row[0].data();
#ifdef PENDULUM_HAS_AVX
  if (kInstructionSet == InstructionSet::kAvx512) return avx512::SumProducts<R>(rows, count, sums.data());
  if (kInstructionSet == InstructionSet::kAvx2) return avx2::SumProducts<R>(rows, count, sums.data());
#endif
  baseline::SumProducts<R>(rows, count, sums.data());
}

}  // namespace pendulum
