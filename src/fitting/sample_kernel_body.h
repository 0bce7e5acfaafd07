// SPDX-License-Identifier: Apache-2.0
//
// Included by sample_kernel.h once for each instruction set, in a namespace of its own: `Vector` is a vector of kLanes
// doubles that the set has registers for. No guard, and nothing included, for the same reason.

inline Vector Load(const double* from) {
  Vector vector;
  std::memcpy(&vector, from, sizeof(vector));  // from any address
  return vector;
}

inline void Store(const Vector& vector, double* to) { std::memcpy(to, &vector, sizeof(vector)); }

/// G vectors of samples: W chains of multiplications and additions for each, none of which waits for another.
template <int G, int W>
inline void EvaluateVectors(const Polynomials<W>& polynomials, const double* tau, double* rows) {
  std::array<Vector, G> at;
  std::array<std::array<Vector, W>, G> sum;
  for (int g = 0; g < G; ++g) {
    at[g] = Load(&tau[g * kLanes]);
    for (int w = 0; w < W; ++w) sum[g][w] = Vector{} + polynomials.coefficient[polynomials.order][w];
  }
  for (int k = polynomials.order - 1; k >= 0; --k) {
    for (int w = 0; w < W; ++w) {
      for (int g = 0; g < G; ++g) sum[g][w] = sum[g][w] * at[g] + polynomials.coefficient[k][w];
    }
  }
  for (int w = 0; w < W; ++w) {
    for (int g = 0; g < G; ++g) Store(sum[g][w], &rows[w * kBlockStride + g * kLanes]);
  }
}

template <int W>
void Evaluate(const Polynomials<W>& polynomials, const double* tau, int count, double* rows) {
  constexpr int kVectors = W == 1 ? 4 : W <= 6 || (kLanes == 8 && W <= 10) ? 2 : 1;  // as many as there are registers for
  int i = 0;
  for (; i + static_cast<int>((kVectors - 1) * kLanes) < count; i += static_cast<int>(kVectors * kLanes)) {
    EvaluateVectors<kVectors, W>(polynomials, tau + i, rows + i);
  }
  for (; i < count; i += static_cast<int>(kLanes)) EvaluateVectors<1, W>(polynomials, tau + i, rows + i);
}

/// Products of row I with rows 0 to I, each in kParts partial sums whatever the instruction set.
template <int I>
inline void SumRow(const double* rows, int count, double* sums) {
  constexpr std::size_t kVectors = kParts / kLanes;
  std::array<std::array<Vector, kVectors>, I + 1> sum{};
  for (int at = 0; at < count; at += static_cast<int>(kParts)) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      const double* const sample = rows + at + v * kLanes;
      const Vector x = Load(&sample[I * kBlockStride]);
      for (int j = 0; j <= I; ++j) sum[j][v] += x * Load(&sample[j * kBlockStride]);
    }
  }
  for (int j = 0; j <= I; ++j) {
    std::array<double, kParts> parts;
    for (std::size_t v = 0; v < kVectors; ++v) Store(sum[j][v], &parts[v * kLanes]);
    sums[j] = ((parts[0] + parts[1]) + (parts[2] + parts[3])) + ((parts[4] + parts[5]) + (parts[6] + parts[7]));
  }
}

template <int R, int I = 0>
void SumProducts(const double* rows, int count, double* sums) {
  SumRow<I>(rows, count, sums + I * (I + 1) / 2);
  if constexpr (I + 1 < R) SumProducts<R, I + 1>(rows, count, sums);
}
