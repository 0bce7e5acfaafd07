// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

/// The arithmetic that remains when nothing but the samples is left to do: polynomials at every sample and sums of
/// their products. Independent of the library's own kernels.
namespace pendulum::benchmarks {

/// Angle [rad] and its derivatives by inertia, viscous, coulomb, release_angle and release_time; that by the zero is 1.
inline constexpr int kFloorColumns = 6;
inline constexpr int kFloorMaxOrder = 25;

/// Taylor polynomials of a stretch of the trajectory and the samples they hold for.
struct FloorSegment {
  double start = 0;         ///< s
  int order = 0;            ///< At most kFloorMaxOrder.
  int first = 0, last = 0;  ///< Samples first .. last - 1.
  std::array<std::array<double, kFloorColumns>, kFloorMaxOrder + 1> coefficient;
};

/// The samples, N each: s and rad, the zero taken out of the value. They must outlive what uses them.
struct FloorSamples {
  const double* time = nullptr;
  const double* value = nullptr;
};

/// The columns of the normal matrix: five derivatives, the zero's ones, the residual (value - angle).
inline constexpr int kNormalSize = kFloorColumns + 1;
using NormalMatrix = std::array<std::array<double, kNormalSize>, kNormalSize>;

/// What the kernels are compiled for: what every CPU of the kind has, AVX2 with FMA, AVX-512.
enum class FloorTarget { kPortable, kAvx2, kAvx512 };

/// The widest that runs.
FloorTarget BestFloorTarget();

/// Σ (value - angle)^2 over all samples of the segments.
double FloorSumOfSquares(const std::vector<FloorSegment>& segments, const FloorSamples& samples, FloorTarget target);

/// Sums of all 28 products of columns, symmetric.
NormalMatrix FloorNormalMatrix(const std::vector<FloorSegment>& segments, const FloorSamples& samples,
                               FloorTarget target);

}  // namespace pendulum::benchmarks
