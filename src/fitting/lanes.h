// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

#include "pendulum/model/series.h"

namespace pendulum {

/// Samples are evaluated side by side in lanes: their Horner chains do not wait for each other and fill vector
/// registers.
inline constexpr int kLanes = 8;
using Lanes = std::array<double, kLanes>;

/// Polynomials in τ of everything that is wanted at a sample: W columns, the same order.
template <int W>
struct Columns {
  int order = 0;
  std::array<std::array<double, W>, kMaxOrder + 1> coefficient;

  void Evaluate(const Lanes& tau, std::array<Lanes, W>& out) const {
    for (int w = 0; w < W; ++w) {
      Lanes sum;
      sum.fill(coefficient[order][w]);
      for (int k = order - 1; k >= 0; --k) {
        for (int i = 0; i < kLanes; ++i) sum[i] = sum[i] * tau[i] + coefficient[k][w];
      }
      out[w] = sum;
    }
  }
};

/// Sums over samples of all products of W columns, in four partial sums each.
template <int W>
class Products {
 public:
  void Add(const std::array<Lanes, W>& columns) {
    int pair = 0;
    for (int i = 0; i < W; ++i) {
      for (int j = 0; j <= i; ++j, ++pair) {
        for (int lane = 0; lane < kLanes; ++lane) sums_[pair][lane % kParts] += columns[i][lane] * columns[j][lane];
      }
    }
  }

  Eigen::MatrixXd Matrix() const {
    Eigen::MatrixXd matrix(W, W);
    int pair = 0;
    for (int i = 0; i < W; ++i) {
      for (int j = 0; j <= i; ++j, ++pair) {
        double sum = 0;
        for (const double part : sums_[pair]) sum += part;
        matrix(i, j) = matrix(j, i) = sum;
      }
    }
    return matrix;
  }

 private:
  static constexpr int kParts = 4;
  std::array<std::array<double, kParts>, W*(W + 1) / 2> sums_{};
};

}  // namespace pendulum
