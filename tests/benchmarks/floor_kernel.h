// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

/// The minimum arithmetic that the samples require: polynomials at every sample and sums of their products. Independent
/// of the library's own kernels.
namespace pendulum::benchmarks {

/// Angle [rad] and its derivatives with respect to inertia, viscous, coulomb, release_angle and release_time. The
/// derivative with respect to the zero is 1.
inline constexpr int kFloorColumns = 6;
inline constexpr int kFloorMaxOrder = 25;

/// Taylor polynomials of a part of the trajectory, and the samples for which they are valid.
struct FloorSegment {
  double start = 0;         ///< s
  int order = 0;            ///< At most kFloorMaxOrder.
  int first = 0, last = 0;  ///< Samples first .. last - 1.
  std::array<std::array<double, kFloorColumns>, kFloorMaxOrder + 1> coefficient;
};

/// Times [s] and values [rad, without the zero] of N samples; the arrays must outlive this object.
struct FloorSamples {
  const double* time = nullptr;
  const double* value = nullptr;
};

/// The columns of the normal matrix: five derivatives, the zero's ones, the residual (value - angle).
inline constexpr int kNormalSize = kFloorColumns + 1;
using NormalMatrix = std::array<std::array<double, kNormalSize>, kNormalSize>;

/// Instruction sets of the kernels: the baseline of every CPU, AVX2 with FMA, AVX-512.
enum class FloorTarget { kPortable, kAvx2, kAvx512 };

/// The widest target that this processor supports.
FloorTarget BestFloorTarget();

/// Σ (value - angle)^2 over all samples of the segments.
double FloorSumOfSquares(const std::vector<FloorSegment>& segments, const FloorSamples& samples, FloorTarget target);

/// Sums of all 28 products of columns, symmetric.
NormalMatrix FloorNormalMatrix(const std::vector<FloorSegment>& segments, const FloorSamples& samples,
                               FloorTarget target);

}  // namespace pendulum::benchmarks
