// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>

namespace pendulum {

/// Four doubles in one vector. A processor with narrower vectors handles them in pairs. A type that contains quads must
/// say alignas(kQuadAlignment). Code for wider instructions relies on this alignment, but in other code the type Quad
/// alone does not guarantee it.
using Quad [[gnu::vector_size(32)]] = double;
inline constexpr std::size_t kQuadAlignment = 32;

/// Partial derivatives with respect to P parameters, stored in quads. All members are inlined, because the convention
/// for passing a quad to a function depends on the instruction set.
template <int P>
class Partials {  // NOLINT(cppcoreguidelines-special-member-functions): a move is the same as a copy
 public:
  // Copies quad by quad. By default g++ copies half quads, and a following read of a whole quad must wait for both
  // halves.
  Partials() = default;
  [[gnu::always_inline]] Partials(const Partials& other) { *this = other; }
  [[gnu::always_inline]] Partials& operator=(const Partials& other) {
    for (std::size_t i = 0; i < kQuads; ++i) quad_[i] = other.quad_[i];
    return *this;
  }

  [[gnu::always_inline]] double operator[](int i) const { return quad_[i / 4][i % 4]; }
  /// P consecutive numbers.
  [[gnu::always_inline]] const double* data() const {
    return reinterpret_cast<const double*>(quad_.data());  // NOLINT: a quad may be read as its doubles
  }
  [[gnu::always_inline]] void set(int i, double value) { quad_[i / 4][i % 4] = value; }

  /// Adds s y, where s has the same value in all lanes.
  [[gnu::always_inline]] void AddProduct(const Quad& s, const Partials& y) {
    for (std::size_t i = 0; i < kQuads; ++i) quad_[i] += s * y.quad_[i];
  }

  [[gnu::always_inline]] Partials& operator+=(const Partials& y) {
    for (std::size_t i = 0; i < kQuads; ++i) quad_[i] += y.quad_[i];
    return *this;
  }

  [[gnu::always_inline]] Partials& operator-=(const Partials& y) {
    for (std::size_t i = 0; i < kQuads; ++i) quad_[i] -= y.quad_[i];
    return *this;
  }

  [[gnu::always_inline]] Partials& operator*=(double s) {
    for (std::size_t i = 0; i < kQuads; ++i) quad_[i] *= s;
    return *this;
  }

  [[gnu::always_inline]] friend Partials operator+(const Partials& x, const Partials& y) {
    Partials sum = x;
    sum += y;
    return sum;
  }

  [[gnu::always_inline]] friend Partials operator-(const Partials& x, const Partials& y) {
    Partials difference = x;
    difference -= y;
    return difference;
  }

  [[gnu::always_inline]] friend Partials operator*(double s, const Partials& x) {
    Partials product = x;
    product *= s;
    return product;
  }

 private:
  static constexpr std::size_t kQuads = (P + 3) / 4;

  alignas(P > 0 ? kQuadAlignment : 1) std::array<Quad, kQuads> quad_{};
};

static_assert(alignof(Partials<1>) == kQuadAlignment);

/// A dual number: value `a` and partial derivatives `v` with respect to P parameters, like ceres::Jet, but without
/// a dependency on Ceres. It has only the operations that equations of motion need.
template <int P>
struct Dual {
  Partials<P> v;
  double a = 0;

  Dual() = default;
  [[gnu::always_inline]] explicit Dual(double value) : a(value) {}
  /// The value of parameter number i: its partial derivative with respect to itself is 1.
  [[gnu::always_inline]] Dual(double value, int i) : a(value) { v.set(i, 1.0); }
  [[gnu::always_inline]] Dual(double value, const Partials<P>& partials) : v(partials), a(value) {}

  [[gnu::always_inline]] Dual& operator+=(const Dual& y) { return *this = *this + y; }

  [[gnu::always_inline]] friend Dual operator+(const Dual& x, const Dual& y) { return {x.a + y.a, x.v + y.v}; }
  [[gnu::always_inline]] friend Dual operator-(const Dual& x, const Dual& y) { return {x.a - y.a, x.v - y.v}; }
  [[gnu::always_inline]] friend Dual operator*(const Dual& x, const Dual& y) {
    return {x.a * y.a, y.a * x.v + x.a * y.v};
  }
  [[gnu::always_inline]] friend Dual operator/(const Dual& x, const Dual& y) {
    const double quotient = x.a / y.a;
    return {quotient, (1 / y.a) * (x.v - quotient * y.v)};
  }

  [[gnu::always_inline]] friend Dual operator+(double x, const Dual& y) { return {x + y.a, y.v}; }
  [[gnu::always_inline]] friend Dual operator+(const Dual& x, double y) { return {x.a + y, x.v}; }
  [[gnu::always_inline]] friend Dual operator-(double x, const Dual& y) { return Dual(x) - y; }
  [[gnu::always_inline]] friend Dual operator-(const Dual& x, double y) { return {x.a - y, x.v}; }
  [[gnu::always_inline]] friend Dual operator-(const Dual& x) { return -1.0 * x; }
  [[gnu::always_inline]] friend Dual operator*(double x, const Dual& y) { return {x * y.a, x * y.v}; }
  [[gnu::always_inline]] friend Dual operator*(const Dual& x, double y) { return y * x; }
  [[gnu::always_inline]] friend Dual operator/(double x, const Dual& y) { return Dual(x) / y; }
  [[gnu::always_inline]] friend Dual operator/(const Dual& x, double y) { return (1 / y) * x; }

  [[gnu::always_inline]] friend bool operator==(const Dual& x, const Dual& y) { return x.a == y.a; }

  // NOLINTBEGIN(readability-identifier-naming): the names of <cmath>
  [[gnu::always_inline]] friend Dual exp(const Dual& x) {
    const double value = std::exp(x.a);
    return {value, value * x.v};
  }
  [[gnu::always_inline]] friend Dual tanh(const Dual& x) {
    const double value = std::tanh(x.a);
    return {value, (1 - value * value) * x.v};
  }
  [[gnu::always_inline]] friend Dual sqrt(const Dual& x) {
    const double value = std::sqrt(x.a);
    return {value, (0.5 / value) * x.v};
  }
  // NOLINTEND(readability-identifier-naming)
};

/// Whether T is a Dual.
template <typename T>
concept DualNumber = requires(T x) {
  x.a;
  x.v;
};

/// The number of partial derivatives of T; 0 for a double.
template <typename T>
inline constexpr int kPartials = 0;
template <int P>
inline constexpr int kPartials<Dual<P>> = P;

template <typename T>
using PartialsFor = Partials<kPartials<T>>;

template <typename T>
double Value(const T& x) {
  if constexpr (DualNumber<T>) {
    return x.a;
  } else {
    return x;
  }
}

}  // namespace pendulum
