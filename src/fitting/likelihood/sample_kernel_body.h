// SPDX-License-Identifier: Apache-2.0
//
// sample_kernel.h includes this file once for each instruction set, in a separate namespace. `Vector` is a vector of
// kLanes doubles that fits the registers of the set. For this reason there is no include guard and no #include.

static_assert(kParts % kLanes == 0);

inline Vector Load(const double* from) {
  Vector vector;
  std::memcpy(&vector, from, sizeof(vector));  // from any address
  return vector;
}

inline void Store(const Vector& vector, double* to) { std::memcpy(to, &vector, sizeof(vector)); }

/// Evaluates G vectors of samples at τ after a segment's start, by independent Horner chains for each column and for
/// the rate, the slope of the angle's polynomial. Finally converts the derivatives to those at a fixed time (MODEL.md
/// eq. (4.6)).
template <int G, bool kRelease, int P, typename T>
inline void EvaluateVectors(const Segment<T>& segment, const double* tau, double* rows) {
  std::array<Vector, G> at;
  std::array<Vector, G> angle;
  std::array<Vector, G> rate{};
  std::array<std::array<Vector, G>, P> partial;
  for (int g = 0; g < G; ++g) {
    at[g] = Load(&tau[g * kLanes]);
    angle[g] = Vector{} + segment.angle[segment.order];
    for (int p = 0; p < P; ++p) partial[p][g] = Vector{} + segment.partials[segment.order].data()[p];
  }
  for (int k = segment.order - 1; k >= 0; --k) {
    for (int g = 0; g < G; ++g) {
      if constexpr (P > 0) rate[g] = rate[g] * at[g] + angle[g];
      angle[g] = angle[g] * at[g] + segment.angle[k];
    }
    for (int p = 0; p < P; ++p) {
      for (int g = 0; g < G; ++g) partial[p][g] = partial[p][g] * at[g] + segment.partials[k].data()[p];
    }
  }
  for (int g = 0; g < G; ++g) {
    double* const to = &rows[g * kLanes];
    for (int p = 0; p < P; ++p)
      Store(partial[p][g] - rate[g] * segment.start_partials.data()[p], &to[p * kBlockStride]);
    if constexpr (kRelease && P > 0) Store(-rate[g], &to[P * kBlockStride]);
    Store(angle[g], &to[(kSegmentRows<T, kRelease> - 1) * kBlockStride]);
  }
}

/// Evaluates the samples from index i on, G vectors at a time while that many remain, then fewer.
template <int G, bool kRelease, int P, typename T>
inline void EvaluateFrom(int i, const Segment<T>& segment, const double* tau, int count, double* rows) {
  for (; i + (G - 1) * static_cast<int>(kLanes) < count; i += G * static_cast<int>(kLanes)) {
    EvaluateVectors<G, kRelease, P>(segment, tau + i, rows + i);
  }
  if constexpr (G > 1) EvaluateFrom<G - 1, kRelease, P>(i, segment, tau, count, rows);
}

template <bool kRelease, typename T>
void Evaluate(const Segment<T>& segment, const double* time, int count, double* rows) {
  constexpr int kRegisters = kLanes == 8 ? 32 : 16;
  constexpr int kVectors = kPartials<T> == 0 ? 4 : std::clamp(kRegisters / (kPartials<T> + 3), 1, 3);
  std::array<double, kBlockStride> tau;
  for (int i = 0; i < count; ++i) tau[i] = time[i] - segment.start;
  std::fill_n(tau.begin() + count, kParts, 0.0);
  EvaluateFrom<kVectors, kRelease, kPartials<T>>(0, segment, tau.data(), count, rows);
}

/// Products of row I with rows 0 to I, each in kParts partial sums regardless of the instruction set.
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
