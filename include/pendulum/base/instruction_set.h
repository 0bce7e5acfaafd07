// SPDX-License-Identifier: Apache-2.0
#pragma once

// Functions that are compiled for what any processor of its kind has, and again for AVX2 with fused multiplication and
// for AVX-512: chosen by what the processor has. Fused, results differ in their last bits. Where PENDULUM_HAS_AVX is
// not defined there is the one form only, so that a build by clang tests it. fitting/sample_kernel.h has the targets
// once more.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define PENDULUM_HAS_AVX
#define PENDULUM_AVX2 gnu::target("avx2,fma")
#define PENDULUM_AVX512 gnu::target("avx2,fma,avx512f,avx512dq,avx512vl")
#endif

namespace pendulum {

/// The forms that there are, each with all that the ones before it have.
enum class InstructionSet { kBaseline, kAvx2, kAvx512 };

inline InstructionSet BestInstructionSet() {
#ifdef PENDULUM_HAS_AVX
  const bool has_avx2 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  const bool has_avx512 = __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
                          __builtin_cpu_supports("avx512vl") != 0;
  if (has_avx2) return has_avx512 ? InstructionSet::kAvx512 : InstructionSet::kAvx2;
#endif
  return InstructionSet::kBaseline;
}

/// What this processor has.
inline const InstructionSet kInstructionSet = BestInstructionSet();

}  // namespace pendulum
