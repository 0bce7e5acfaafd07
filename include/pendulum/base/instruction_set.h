// SPDX-License-Identifier: Apache-2.0
#pragma once

// Functions that are compiled for what any processor of its kind has, and again for AVX2 with fused multiplication:
// chosen by what the processor has. Fused, results differ in their last bits. Where PENDULUM_HAS_AVX2 is not defined
// there is the one form only, so that a build by clang tests it.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define PENDULUM_HAS_AVX2
#define PENDULUM_AVX2 gnu::target("avx2,fma")

namespace pendulum {
inline const bool kUseAvx2 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
}  // namespace pendulum
#endif
