// SPDX-License-Identifier: Apache-2.0
#pragma once

// Some functions are compiled three times: for the baseline of the processor family, for AVX2 with fused multiply-add,
// and for AVX-512. The processor's features decide which one runs. Fused multiply-add changes the last bits of results.
// Without PENDULUM_HAS_AVX only the baseline exists; a build with clang tests it. fitting/sample_kernel.h repeats these
// targets.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define PENDULUM_HAS_AVX
#define PENDULUM_AVX2 gnu::target("avx2,fma")
#define PENDULUM_AVX512 gnu::target("avx2,fma,avx512f,avx512dq,avx512vl")
#endif

namespace pendulum {

/// The available instruction sets. Each includes all earlier ones.
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

/// The best instruction set of this processor.
inline const InstructionSet kInstructionSet = BestInstructionSet();

}  // namespace pendulum
